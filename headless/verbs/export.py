# SPDX-License-Identifier: GPL-3.0-or-later
"""`monocell export`: a cell in, the virtual environment as glTF out."""

from __future__ import annotations

import argparse
from pathlib import Path

from ...core.document.cell_file import read_cell
from ...core.errors import InvalidValue
from ..blender import require_blender
from ..told import warn


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's own arguments."""
    parser.add_argument("cell", type=Path, help="cell document")
    parser.add_argument("out", type=Path, help="the file to write, ending in .glb")


def run(args: argparse.Namespace) -> int:
    """Export through Blender."""
    if args.out.suffix.lower() != ".glb":
        raise InvalidValue(f"{args.out}: the ending must be .glb; other formats are not written")
    cell = read_cell(args.cell)
    require_blender()
    from ...scene.gltf import export_gltf

    export_gltf(cell, args.out)
    if cell.sketches:
        warn([f"{s.name} is picked but not solved yet: run monocell model" for s in cell.sketches])
    print(args.out)
    return 0
