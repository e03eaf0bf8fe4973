# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of a board in, the lens they tell with what to think of it, and that as text, out."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from ...core.errors import InvalidValue, PictureError

ENDINGS = (".png", ".jpg", ".jpeg", ".tif", ".tiff", ".bmp", ".webp", ".pgm", ".ppm")
# the lens models that are tried one after the other
MODELS_TRIED = 4


@dataclass(frozen=True)
class LensEstimate:
    """What is kept of `core.lens.LensCalibration`: `camera` as a document's entry.

    `sigmas` are 1 sigma in pixels of fx, fy, cx and cy, None where the pictures leave them open;
    `used` of `pictures` pictures are in the fit.
    """

    verdict: str
    camera: dict[str, Any]
    rms_pixels: float
    sigmas: dict[str, float] | None
    used: int
    pictures: int
    warnings: tuple[str, ...]


def board_of(inputs: Any) -> Any:
    """The board that the inputs state. Raises InvalidValue for one that can't be."""
    from ...core.lens.board import CharucoBoard, Chessboard
    from .place_inputs import decimals

    square, marker = (float(side) for side in decimals([inputs.square, inputs.marker]))
    if inputs.board == "chessboard":
        return Chessboard(inputs.corners_x, inputs.corners_y, square)
    return CharucoBoard(inputs.squares_x, inputs.squares_y, square, marker, inputs.dictionary)


def pictures_in(folder: Path, chosen: Sequence[str]) -> tuple[str, ...]:
    """The names chosen, or where none is, of all pictures of the folder, in order.

    Raises PictureError for a folder without any.
    """
    if chosen:
        return tuple(sorted(chosen))
    there = sorted(folder.iterdir()) if folder.is_dir() else []
    names = tuple(path.name for path in there if path.suffix.lower() in ENDINGS)
    if not names:
        raise PictureError(f"{folder}: there is no picture in this folder; choose those of a board")
    return names


def estimated(
    folder: Path, names: Sequence[str], board: Any, model: str, watch: Callable[[str], None]
) -> LensEstimate:
    """The lens from a board's pictures. Raises what `calibrate_lens` raises."""
    from ...core.camera import Camera
    from ...core.document.entries import camera_entry
    from ...core.lens.calibrate_lens import calibrate_lens, pattern_told
    from ...core.picture.pictures import read_picture

    found = calibrate_lens(
        names, lambda name: read_picture(folder / name), board, model, watch=watch
    )
    sigmas, told = found.quality.sigmas(), pattern_told(found.board, board)
    return LensEstimate(
        found.verdict,
        camera_entry(Camera(found.lens)),
        float(found.fit.rms_pixels),
        None if sigmas is None else {name: sigmas[name] for name in ("fx", "fy", "cx", "cy")},
        sum(picture.status == "used" for picture in found.pictures),
        len(found.pictures),
        (*([told] if told else []), *found.warnings),
    )


def told_estimate(found: LensEstimate) -> str:
    """One line: verdict, focal length with 1 sigma, rms and pictures."""
    focal = f"{found.camera['fx']:.1f}"
    if found.sigmas is not None:
        focal += f" ± {found.sigmas['fx']:.1f}"
    return (
        f"Lens {found.verdict}: focal length {focal} px, {found.rms_pixels:.2f} px rms, "
        f"{found.used} of {found.pictures} pictures"
    )


def dump_estimate(found: LensEstimate) -> str:
    """Text for the scene."""
    return json.dumps(asdict(found), allow_nan=False)


def parse_estimate(text: str) -> LensEstimate | None:
    """The inverse of `dump_estimate`; None for an empty text."""
    if not text:
        return None
    fields = json.loads(text)
    return LensEstimate(**fields | {"warnings": tuple(fields["warnings"])})


def estimated_camera(text: str) -> Any:
    """The camera of an estimate's text. Raises InvalidValue without one that can be believed."""
    from ...core.document.entries import camera_from_entry

    found = parse_estimate(text)
    if found is None:
        raise InvalidValue("no lens estimated yet: press Estimate, and choose a board's pictures")
    if found.verdict == "failed":
        why = found.warnings[0] if found.warnings else "its pictures contradict each other"
        raise InvalidValue(f"the lens estimate failed: {why}; take better pictures of the board")
    return camera_from_entry(found.camera)
