# SPDX-License-Identifier: GPL-3.0-or-later
"""A cell to a file of any format, told by its ending; what could not be kept comes back."""

from __future__ import annotations

from pathlib import Path

from ..core.cell import Cell
from ..core.formats.endings import known_ending
from ..core.formats.text_formats import WRITERS, write_text_format
from .gltf import export_gltf
from .mesh_formats import export_meshes


def export_cell(cell: Cell, path: str | Path) -> tuple[str, ...]:
    """Write a cell's solved objects, and its camera where the format has one; the warnings.

    Raises InvalidValue for an unknown ending, and as the writers do.
    """
    ending = known_ending(path)
    if ending in WRITERS:
        return write_text_format(cell, path)
    if ending in (".glb", ".gltf"):
        export_gltf(cell, path)
    else:
        export_meshes(cell, path)
    return ()
