# SPDX-License-Identifier: GPL-3.0-or-later
"""What stands behind a camera's view: a cell's picture in, the undistorted one as a PNG out."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import cv2
import numpy as np

from ..cell import Cell
from ..errors import PictureError
from ..intrinsics import Intrinsics
from .pictures import Picture, read_picture_told
from .undistortion import undistorted_picture

# photographs hardly get smaller beyond it, and take much longer
COMPRESSION = 1


@dataclass(frozen=True, eq=False)
class Plate:
    """A picture of a cell by its `name` there, undistorted, 8 bits, as the bytes of a PNG file.

    `told` is what is to be said of it while it is shown.
    """

    name: str
    png: bytes
    told: tuple[str, ...] = ()


def read_plate(cell: Cell, name: str, watch: Callable[[str], None] | None = None) -> Plate:
    """Read, undistort and encode a picture of the cell; `watch` is told each step.

    Raises PictureError for a picture that can't be read or is not of the camera's size.
    """
    tell, intrinsics = watch or _nobody, cell.camera.intrinsics
    tell(f"reading {name}")
    picture, told = read_picture_told(cell.path_of(name), intrinsics)
    tell("undistorting it")
    flat = undistorted_picture(picture, intrinsics)
    tell("packing it")
    return Plate(name, encoded(flat), told)


def plate_of(name: str, picture: Picture, intrinsics: Intrinsics) -> Plate:
    """The plate of pixels (H, W, 3) as they came from the lens. Raises PictureError."""
    return Plate(name, encoded(undistorted_picture(picture, intrinsics)))


def encoded(picture: Picture) -> bytes:
    """Pixels (H, W, 3) of 8 or 16 bits as an 8-bit PNG, rounded to the nearest level."""
    if picture.dtype == np.uint16:
        # 65535 is 257 times 255
        picture = np.asarray(cv2.convertScaleAbs(picture, alpha=1 / 257))
    done, data = cv2.imencode(".png", picture, [cv2.IMWRITE_PNG_COMPRESSION, COMPRESSION])
    if not done:
        raise PictureError(f"OpenCV can't encode a picture of shape {picture.shape} as PNG")
    return data.tobytes()


def _nobody(step: str) -> None:
    """Where nobody asked to be told."""
