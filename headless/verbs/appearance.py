# SPDX-License-Identifier: GPL-3.0-or-later
"""`monocell appearance`: a cell with objects in, colours and textures from its picture out."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ...core.arrays import Mask
from ...core.cell import Cell
from ...core.document.cell_file import read_cell, write_cell
from ...core.errors import InvalidValue, PictureError
from ..told import print_json, progress, table, warn

if TYPE_CHECKING:
    from ...core.look.looks import Look

JPEG = (".jpg", ".jpeg")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's own arguments."""
    parser.add_argument("cell", type=Path, help="cell document with camera pose and objects")
    parser.add_argument("--out", type=Path, help="write the cell with its objects looking so")
    parser.add_argument(
        "--only", nargs="+", metavar="NAME", help="look at these objects, not at all"
    )
    parser.add_argument(
        "--texture",
        nargs="+",
        metavar="NAME",
        default=[],
        help="give these objects pictures of their faces, PNG files beside the document of --out",
    )
    parser.add_argument(
        "--texture-all", action="store_true", help="give all that are looked at such pictures"
    )
    parser.add_argument(
        "--hidden",
        type=Path,
        metavar="MASK",
        help="picture that is white where something that is not modelled (an arm, a cable) hides "
        "the objects, black elsewhere",
    )
    parser.add_argument("--json", action="store_true", help="print JSON")


def run(args: argparse.Namespace) -> int:
    """Look at the objects in the picture, tell, write."""
    from ...core.look.looks import looks_of
    from ...core.look.texture_files import with_looks
    from ...core.picture.pictures import read_picture_told

    if (args.texture or args.texture_all) and args.out is None:
        raise InvalidValue("--texture: textures are files beside a document; name it with --out")
    cell = read_cell(args.cell)
    cell.standing_camera()  # without a pose it is refused before the picture is read
    _refuse_nothing_to_look_at(cell, args.cell)
    assert cell.picture is not None
    names, textured = args.only, args.texture
    if args.texture_all:
        textured = [thing.name for thing in cell.objects if names is None or thing.name in names]
    picture, told = read_picture_told(cell.path_of(cell.picture), cell.camera.intrinsics)
    warn(told)
    looks = list(
        looks_of(
            cell,
            picture,
            names=names,
            textured=textured,
            hidden=None if args.hidden is None else _mask(args.hidden),
            jpeg=cell.path_of(cell.picture).suffix.lower() in JPEG,
        )
    )
    if args.out is not None:
        write_cell(with_looks(cell, looks, args.out), args.out)
    if args.json:
        print_json([_entry(look) for look in looks])
    else:
        tell(looks)
    warn([warning for look in looks for warning in look.warnings])
    warn([f"{s.name} is picked but not solved yet: run monocell model" for s in cell.sketches])
    return 0


def tell(looks: list[Look]) -> None:
    """One object a line, then its faces."""
    rows = []
    for look in looks:
        sample = look.color
        if sample.color is None:
            rows.append((look.thing.name, "not seen", "", "0", "", ""))
            continue
        kind = "uniform" if sample.uniform else f"uniform {100 * sample.share:.0f} %"
        rows.append(
            (
                look.thing.name,
                " ".join(f"{part:.3f}" for part in sample.color),
                " ".join(f"{part:.3f}" for part in sample.spread),
                str(sample.pixels),
                kind,
                " ".join(f"{face.face} {100 * face.seen:.0f} %" for face in look.faces),
            )
        )
    print(table(("object", "colour (linear)", "1 sigma", "pixels", "surface", "seen of"), rows))
    for look in looks:
        for face in look.unseen:
            progress(f"{look.thing.name}.{face.face}: no texture, {face.why}")


def _refuse_nothing_to_look_at(cell: Cell, path: Path) -> None:
    if cell.picture is None:
        raise InvalidValue(f"{path}: picture: is missing, and objects get their looks from it")
    if not cell.objects:
        raise InvalidValue(
            f"{path}: no object is solved, so there is nothing to look at"
            + ("; run monocell model first" if cell.sketches else "")
        )


def _mask(path: Path) -> Mask:
    from ...core.picture.pictures import eight_bits, read_picture

    mask: Mask = eight_bits(read_picture(path)).max(axis=2) > 127
    share = float(np.mean(mask))
    if share > 0.98:
        raise PictureError(
            f"{path}: is white over {100 * share:.0f} % of the picture, which leaves nothing to "
            "see; it must be black where objects show"
        )
    return mask


def _entry(look: Look) -> dict[str, object]:
    sample = look.color
    return {
        "object": look.thing.name,
        "color": sample.color,
        "spread": sample.spread,
        "pixels": sample.pixels,
        "share": sample.share,
        "uniform": sample.uniform,
        "seen": {face.face: face.seen for face in look.faces},
        "unseen": {face.face: face.why for face in look.unseen},
        "warnings": look.warnings,
    }
