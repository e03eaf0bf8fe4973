# SPDX-License-Identifier: GPL-3.0-or-later
"""`monocell propose`: a calibrated cell and a plane in, boxes and cylinders standing on it out."""

from __future__ import annotations

import argparse
from pathlib import Path

from ...core.align.propose import Proposal, propose
from ...core.cell import Cell
from ...core.document.cell_file import read_cell, write_cell
from ...core.document.entries import object_entry
from ...core.errors import InvalidValue
from ...core.picture.overlay import draw_overlay
from ...core.picture.pictures import eight_bits, read_picture_told
from ...core.reference import ReferencePlane
from ..cli import DONE
from ..pictures import write_picture
from ..told import millimetres, point_told, print_json, table, warn


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's own arguments."""
    parser.add_argument("cell", type=Path, help="calibrated cell document with its picture")
    parser.add_argument(
        "--on", metavar="REFERENCE", help="the plane they stand on (default: the cell's only one)"
    )
    parser.add_argument("--out", type=Path, help="write the cell with the believed ones added")
    parser.add_argument(
        "--overlay", type=Path, help="write the picture with all of them drawn on it"
    )
    parser.add_argument("--json", action="store_true", help="print JSON")


def run(args: argparse.Namespace) -> int:
    """Propose, tell, write."""
    cell = read_cell(args.cell)
    plane = _plane(cell, args.on)
    if cell.picture is None:
        raise InvalidValue(f"{args.cell}: names no picture; without one nothing can be proposed")
    path = cell.path_of(cell.picture)
    if args.overlay is not None and args.overlay.resolve() == path.resolve():
        raise InvalidValue(f"{args.overlay}: the overlay would replace the picture; name another")
    camera = cell.standing_camera()
    picture, told = read_picture_told(path, camera.intrinsics)
    warn(told)
    proposals = propose(camera, picture, plane, cell.objects)
    if args.overlay is not None:
        things = [proposal.thing for proposal in proposals]
        write_picture(args.overlay, draw_overlay(eight_bits(picture), camera, things))
    if args.out is not None:
        believed = [proposal.thing for proposal in proposals if proposal.believed]
        write_cell(cell.with_objects([*cell.objects, *believed]), args.out)
    if args.json:
        print_json([_entry(proposal) for proposal in proposals])
    else:
        _tell(proposals, plane)
    return DONE


def _plane(cell: Cell, name: str | None) -> ReferencePlane:
    """The plane of that name, or the only one. Raises InvalidValue."""
    if name is not None:
        reference = cell.reference(name)
        if not isinstance(reference, ReferencePlane):
            raise InvalidValue(f"{name}: things stand on a plane, and this is a line")
        return reference
    planes = [r for r in cell.placed_references if isinstance(r, ReferencePlane)]
    if len(planes) != 1:
        listed = ", ".join(plane.name for plane in planes) or "none"
        raise InvalidValue(f"which plane do they stand on? the cell has {listed}: say --on NAME")
    return planes[0]


def _tell(proposals: tuple[Proposal, ...], plane: ReferencePlane) -> None:
    """One proposal a line, and why some are not believed."""
    if not proposals:
        print(f"nothing that stands on {plane.name} was found; pick it instead")
        return
    rows = []
    for proposal in proposals:
        thing = proposal.thing
        sizes = ", ".join(
            f"{name} {millimetres(size, None, 1)}"
            for name, size in zip(thing.size_names, thing.sizes, strict=True)
        )
        rows.append(
            (
                thing.name,
                thing.kind,
                f"{proposal.score:.2f}",
                "yes" if proposal.believed else "no",
                sizes,
                point_told(thing.world_from_object.translation),
            )
        )
    print(table(("proposal", "kind", "score", "believed", "sizes", "centre"), rows))
    warn(
        [
            f"{proposal.thing.name} is not believed: {'; '.join(proposal.reasons)}"
            for proposal in proposals
            if not proposal.believed
        ]
    )


def _entry(proposal: Proposal) -> dict[str, object]:
    return {
        "object": object_entry(proposal.thing),
        "score": proposal.score,
        "believed": proposal.believed,
        "why": proposal.why,
        "reasons": proposal.reasons,
    }
