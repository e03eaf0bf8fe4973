# SPDX-License-Identifier: GPL-3.0-or-later
"""The checkout's source files by room, and what each of them imports."""

from __future__ import annotations

import ast
from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PACKAGE_ROOMS = ("core", "scene", "addon", "headless")
ROOMS = (*PACKAGE_ROOMS, "tests", "benchmarks", "docs", "samples")
# what tools leave behind in a checkout; hidden folders are left out by their dot
LEFT_BEHIND = ("__pycache__", "build", "dist", "out", "wheels", "node_modules")


def python_files(*rooms: str) -> list[Path]:
    """Every Python file of the rooms, the root's own files with none."""
    found = [path for room in rooms for path in (ROOT / room).rglob("*.py")]
    return sorted(path for path in found if not _left_behind(path))


def all_python_files() -> list[Path]:
    return sorted([*ROOT.glob("*.py"), *python_files(*ROOMS)])


def text_files() -> list[Path]:
    """Every file of the checkout that is text, whatever its ending."""
    found = [path for path in ROOT.rglob("*") if path.is_file() and not _left_behind(path)]
    return sorted(path for path in found if b"\0" not in path.read_bytes()[:4096])


def name_of(path: Path) -> str:
    """The path as a test's name shows it."""
    return path.relative_to(ROOT).as_posix()


@cache
def tree_of(path: Path) -> ast.Module:
    return ast.parse(path.read_text(encoding="utf-8"), str(path))


def absolute_imports(path: Path) -> set[str]:
    """Top-level names of all absolute imports, those inside functions too."""
    names: set[str] = set()
    for node in ast.walk(tree_of(path)):
        if isinstance(node, ast.Import):
            names |= {alias.name.split(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.level == 0 and node.module:
            names.add(node.module.split(".")[0])
    return names


def rooms_reached(path: Path) -> set[str]:
    """The parts of the package that relative imports lead to, as paths like `headless/robot`."""
    reached: set[str] = set()
    for node in ast.walk(tree_of(path)):
        if isinstance(node, ast.ImportFrom) and node.level:
            base = path.parents[node.level - 1].relative_to(ROOT)
            if node.module:
                reached.add((base / node.module.replace(".", "/")).as_posix())
            else:
                reached |= {(base / alias.name).as_posix() for alias in node.names}
    return reached


def _left_behind(path: Path) -> bool:
    parts = path.relative_to(ROOT).parts
    return any(
        part in LEFT_BEHIND or part.startswith(".") or part.endswith(".egg-info") for part in parts
    )
