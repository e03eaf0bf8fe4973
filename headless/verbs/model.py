# SPDX-License-Identifier: GPL-3.0-or-later
"""`monocell model`: a cell with picks in, metric objects with their errors out."""

from __future__ import annotations

import argparse
from pathlib import Path

from ...core.document.cell_file import read_cell, write_cell
from ...core.document.entries import object_entry
from ...core.errors import InvalidValue
from ...core.modelling.modelled import Modelled
from ...core.modelling.solve import model
from ..told import millimetres, point_told, print_json, table, warn


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
    parser.add_argument("--json", action="store_true", help="print JSON")


def run(args: argparse.Namespace) -> int:
    """Solve every object that has picks, tell, write."""
    cell = read_cell(args.cell)
    if not any(thing.picks for thing in cell.things):
        raise InvalidValue(f"{args.cell}: no object has picks, so there is nothing to model")
    modelling = model(cell, args.pick_sigma, joint=args.joint)
    solved, modelled = modelling.cell, modelling.results
    if args.out is not None:
        write_cell(solved, args.out)
    if args.json:
        print_json([_entry(m) for m in modelled])
    else:
        tell(modelled)
    if cell.camera.covariance is None:
        warn(["the camera's pose states no error: each ± holds the picks' error alone"])
    warn([*modelling.warnings, *(warning for m in modelled for warning in m.warnings)])
    return 0


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


def _entry(m: Modelled) -> dict[str, object]:
    return {
        "object": object_entry(m.object),
        "position_sigma": m.object.position_sigma(),
        "size_sigma": m.object.size_sigma(),
        "residual_pixels": m.residual_pixels,
        "rms_pixels": m.rms_pixels,
        "warnings": m.warnings,
    }
