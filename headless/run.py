# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line from a checkout: `blender --background --python headless/run.py -- VERB ...`.

The checkout's folder becomes the package `monocell`, whatever it is called. The exit status is the
command's: 0 done, 2 the input is at fault, 3 the answer can't be trusted.

Cycles reads everything after `--` too, with argparse's abbreviations: an option that begins one of
its own (`--c`, `--cy`) ends Blender before this script is reached. Spell options out.
"""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path

NEEDED = {"numpy": "numpy", "cv2": "opencv-python-headless==4.11.0.86"}


def main() -> int:
    """Run the verb that stands after `--`."""
    missing = [pip for module, pip in NEEDED.items() if importlib.util.find_spec(module) is None]
    if missing:
        print(
            f"monocell: this Blender's Python lacks {' and '.join(missing)}: install the extension "
            f"(it brings them), or run {sys.executable} -m pip install {' '.join(missing)}",
            file=sys.stderr,
        )
        return 2
    _import_checkout()
    from monocell.headless.cli import main as run

    return int(run(arguments_after_dashes(sys.argv)))


def arguments_after_dashes(argv: list[str]) -> list[str]:
    """What Blender leaves to scripts; nothing without a `--`."""
    return argv[argv.index("--") + 1 :] if "--" in argv else []


def _import_checkout() -> None:
    """Load the folder above this one as `monocell`."""
    root = Path(__file__).resolve().parent.parent
    spec = importlib.util.spec_from_file_location(
        "monocell", root / "__init__.py", submodule_search_locations=[str(root)]
    )
    if spec is None or spec.loader is None:
        raise ImportError(f"{root / '__init__.py'} is not there: run this file from a checkout")
    package = importlib.util.module_from_spec(spec)
    sys.modules["monocell"] = package
    spec.loader.exec_module(package)


if __name__ == "__main__":
    sys.exit(main())
