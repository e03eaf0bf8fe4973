# SPDX-License-Identifier: GPL-3.0-or-later
"""Which ending is which text format, and a cell to the files of one."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

from ..atomic import atomic_files
from ..cell import Cell
from .identifiers import identifiers
from .mjcf import mjcf
from .moveit_scene import moveit_scene
from .sdf import sdf
from .urdf import urdf
from .written import Written

WRITERS: Mapping[str, Callable[[Cell, str, str], Written]] = {
    ".urdf": urdf,
    ".sdf": sdf,
    ".world": sdf,
    ".xml": mjcf,
    ".mjcf": mjcf,
    ".scene": moveit_scene,
}


def write_text_format(cell: Cell, path: str | Path) -> tuple[str, ...]:
    """Write a cell's solved objects by the ending of `path`, one of `WRITERS`; the warnings.

    The file and the meshes beside it appear together or not at all. Raises DocumentError when they
    can't be written, InvalidValue for masses that are given twice.
    """
    target = Path(path)
    (name,) = identifiers([target.stem])
    written = WRITERS[target.suffix.lower()](cell, name, f"{name}_meshes")
    with atomic_files(target) as temporary:
        for file, text in written.beside.items():
            place = temporary.parent / file
            place.parent.mkdir(exist_ok=True)
            place.write_text(text, encoding="ascii")
        temporary.write_text(written.text, encoding="utf-8")
    return written.warnings
