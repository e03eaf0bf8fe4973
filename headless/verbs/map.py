# SPDX-License-Identifier: GPL-3.0-or-later
"""`monocell map`: pixels and a reference in, points in the world with their errors out."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ...core.document.cell_file import read_cell
from ...core.errors import InvalidValue
from ...core.modelling.map_pixels import MappedPixels, map_pixels
from ...core.reference import Reference, kind_of
from ...core.references.resolve import resolved_reference
from ..told import millimetres, point_told, print_json, table, warn


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's own arguments."""
    parser.add_argument("cell", type=Path, help="calibrated cell document")
    parser.add_argument(
        "--on",
        required=True,
        metavar="REFERENCE",
        help="a reference of the cell, or a face, edge or axis of an object, such as crate.top",
    )
    parser.add_argument(
        "pixels",
        type=float,
        nargs="+",
        metavar="U V",
        help="pixels, two numbers each; the centre of the top left one is 0 0",
    )
    parser.add_argument(
        "--pick-sigma",
        type=float,
        default=1.0,
        metavar="PIXELS",
        help="1 sigma of a pick in pixels (default 1)",
    )
    parser.add_argument("--json", action="store_true", help="print JSON")


def run(args: argparse.Namespace) -> int:
    """Work the references out, map, tell."""
    if len(args.pixels) % 2:
        raise InvalidValue(
            f"{len(args.pixels)} numbers are no pixels; give U and V of each, such as 640 480"
        )
    cell = read_cell(args.cell)
    camera = cell.standing_camera()
    reference, doubts = resolved_reference(cell, args.on, args.pick_sigma)
    pixels = np.array(args.pixels).reshape(-1, 2)
    mapped = map_pixels(camera, reference, pixels, args.pick_sigma)
    if args.json:
        print_json(_entry(reference, pixels, mapped, doubts))
    else:
        tell(pixels, mapped)
    if camera.covariance is None:
        warn(["the camera's pose states no error: each ± leaves it out"])
    warn([*doubts, *mapped.warnings])
    return 0


def tell(pixels: np.ndarray, mapped: MappedPixels) -> None:
    """One pixel a line, with 1 sigma along the world's axes."""
    rows = [
        (
            f"({u:.1f}, {v:.1f})",
            point_told(point),
            "± (" + ", ".join(millimetres(s)[:-3] for s in sigma) + ") mm",
        )
        for (u, v), point, sigma in zip(pixels, mapped.points, mapped.sigmas, strict=True)
    ]
    print(table(("pixel", "point", "1 sigma along x, y, z"), rows))


def _entry(
    reference: Reference, pixels: np.ndarray, mapped: MappedPixels, doubts: Sequence[str]
) -> dict[str, object]:
    columns = (pixels, mapped.points, mapped.sigmas, mapped.covariances)
    return {
        "reference": reference.name,
        "kind": kind_of(reference),
        "points": [
            {"pixel": pixel, "point": point, "sigma": sigma, "covariance": covariance}
            for pixel, point, sigma, covariance in zip(*columns, strict=True)
        ],
        "warnings": [*doubts, *mapped.warnings],
    }
