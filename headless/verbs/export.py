# SPDX-License-Identifier: GPL-3.0-or-later
"""`monocell export`: a cell in, the virtual environment out, in the format its ending tells."""

from __future__ import annotations

import argparse
from pathlib import Path

from ...core.cell import Cell
from ...core.document.cell_file import read_cell
from ...core.formats.endings import FORMATS, known_ending
from ...core.formats.text_formats import WRITERS, write_text_format
from ..blender import require_blender
from ..told import warn


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's own arguments."""
    parser.add_argument("cell", type=Path, help="cell document")
    parser.add_argument("out", type=Path, help="the file to write; its ending tells the format")
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    listed = "\n".join(f"  {ending:<8}{told}" for ending, told in FORMATS.items())
    parser.epilog = f"endings:\n{listed}\nWhat each keeps stands in docs/formats.md."


def run(args: argparse.Namespace) -> int:
    """Export, through Blender where the format is one of its own."""
    ending = known_ending(args.out)
    cell = read_cell(args.cell)
    if ending in WRITERS:
        warnings = write_text_format(cell, args.out)
    else:
        warnings = _through_blender(cell, args.out)
    warn([*warnings, *_not_solved(cell)])
    print(args.out)
    return 0


def _through_blender(cell: Cell, out: Path) -> tuple[str, ...]:
    require_blender()
    from ...scene.export import export_cell

    return export_cell(cell, out)


def _not_solved(cell: Cell) -> list[str]:
    return [f"{s.name} is picked but not solved yet: run monocell model" for s in cell.sketches]
