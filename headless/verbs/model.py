# SPDX-License-Identifier: GPL-3.0-or-later
"""`monocell model`: a cell with picks in, metric objects with their errors out."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...core.cell import Cell
from ...core.document.cell_file import read_cell, write_cell
from ...core.document.entries import object_entry
from ...core.errors import InvalidValue
from ...core.modelling.modelled import Modelled
from ...core.modelling.solve import model
from ..told import millimetres, point_told, print_json, table, warn

if TYPE_CHECKING:
    from ...core.align.result import Aligned


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's own arguments."""
    parser.add_argument("cell", type=Path, help="calibrated cell document whose objects have picks")
    parser.add_argument("--out", type=Path, help="write the cell with its objects solved")
    parser.add_argument(
        "--pick-sigma",
        type=float,
        default=1.0,
        metavar="PIXELS",
        help="1 sigma of a pick in pixels (default 1)",
    )
    parser.add_argument(
        "--joint",
        action="store_true",
        help="solve all objects and the camera's own error as one problem, so that what is known "
        "of one improves the others",
    )
    parser.add_argument(
        "--align",
        nargs="*",
        metavar="NAME",
        help="refine these objects (none named: all) on the edges of the cell's picture",
    )
    parser.add_argument("--json", action="store_true", help="print JSON")


def run(args: argparse.Namespace) -> int:
    """Solve every object that has picks, align on the picture where that is asked, tell, write."""
    cell = read_cell(args.cell)
    if not any(thing.picks for thing in cell.things):
        raise InvalidValue(f"{args.cell}: no object has picks, so there is nothing to model")
    modelling = model(cell, args.pick_sigma, joint=args.joint)
    solved, aligned = modelling.cell, None
    if args.align is not None:
        solved, aligned = _aligned(solved, args.align)
    if args.out is not None:
        write_cell(solved, args.out)
    if args.json:
        print_json(_document(modelling.results, aligned))
    else:
        tell(modelling.results)
        if aligned is not None:
            print()
            tell_aligned(aligned)
    if cell.camera.covariance is None:
        warn(["the camera's pose states no error: each ± holds the picks' error alone"])
    warn([*modelling.warnings, *(warning for m in modelling.results for warning in m.warnings)])
    return 0


def _aligned(cell: Cell, names: list[str]) -> tuple[Cell, Aligned]:
    """The cell with its objects on the picture's edges, and what was found of each."""
    from ...core.align.align_cell import align_cell
    from ...core.picture.pictures import read_picture_told
    from ...core.references.resolve import resolve_references

    if cell.picture is None:
        raise InvalidValue("--align needs the cell's picture, and the document names none")
    picture, told = read_picture_told(cell.path_of(cell.picture), cell.camera.intrinsics)
    warn(told)
    moved, found = align_cell(cell, picture, names or None)
    return resolve_references(moved)[0], found


def tell_aligned(aligned: Aligned) -> None:
    """One object a line: where the edges put it, and whether that is believed."""
    rows = []
    for name, found in aligned.objects.items():
        thing, sigma = found.thing, found.thing.size_sigma()
        sizes = ", ".join(
            millimetres(size, None if sigma is None else sigma[i], 1)
            for i, size in enumerate(thing.sizes)
        )
        edges = f"{found.before_pixels:.2f} -> {found.rms_pixels:.2f}"
        told = "aligned" if found.believed else "as picked"
        rows.append((name, told, sizes, edges, f"{100 * found.supported:.0f} %"))
    print(table(("object", "is now", "sizes", "px from the edges", "of its outline"), rows))
    warn(aligned.warnings)
    for name, found in aligned.objects.items():
        warn([f"{name}: not aligned: {reason}" for reason in found.reasons])
        warn(found.warnings)


def tell(modelled: tuple[Modelled, ...]) -> None:
    """One object a line."""
    rows = []
    for m in modelled:
        sigma, place = m.object.size_sigma(), m.object.position_sigma()
        sizes = ", ".join(
            f"{name} {millimetres(size, None if sigma is None else sigma[i], 1)}"
            for i, (name, size) in enumerate(zip(m.object.size_names, m.object.sizes, strict=True))
        )
        where = point_told(m.object.world_from_object.translation)
        spread = "" if place is None else f"± {1e3 * float((place**2).sum() ** 0.5):.1f} mm"
        rows.append(
            (m.object.name, m.object.kind, sizes, f"{where} {spread}", f"{m.rms_pixels:.2f}")
        )
    print(table(("object", "kind", "sizes", "centre", "rms px"), rows))


def _document(results: tuple[Modelled, ...], aligned: Aligned | None) -> Any:
    entries = [_entry(m) for m in results]
    if aligned is None:
        return entries
    found = {
        name: {
            "believed": one.believed,
            "reasons": one.reasons,
            "object": object_entry(one.thing),
            "moved_pixels": one.moved_pixels,
            "before_pixels": one.before_pixels,
            "rms_pixels": one.rms_pixels,
            "supported": one.supported,
            "warnings": one.warnings,
        }
        for name, one in aligned.objects.items()
    }
    return {"modelled": entries, "aligned": found}


def _entry(m: Modelled) -> dict[str, object]:
    return {
        "object": object_entry(m.object),
        "position_sigma": m.object.position_sigma(),
        "size_sigma": m.object.size_sigma(),
        "residual_pixels": m.residual_pixels,
        "rms_pixels": m.rms_pixels,
        "warnings": m.warnings,
    }
