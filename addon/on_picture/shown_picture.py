# SPDX-License-Identifier: GPL-3.0-or-later
"""What the view shows, to look at closely: a scene in, its picture out, and what is drawn of it."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from typing import Any

import cv2
import numpy as np

from ...core.arrays import Array
from ...core.errors import MonocellError
from ...core.intrinsics import Intrinsics
from ...core.picture.pictures import Picture, read_picture
from ...core.picture.undistortion import undistorted_window
from ..cell.document import bare_cell


class ViewPixels:
    """What lies behind the camera view, undistorted where it is looked at.

    `pixels[top:bottom, left:right]` are (h, w, 3), red, green, blue in sRGB from 0 to 1.
    """

    def __init__(self, picture: Picture, intrinsics: Intrinsics) -> None:
        self._picture, self._intrinsics = picture, intrinsics
        self.shape = picture.shape

    def __getitem__(self, part: tuple[slice, slice]) -> Array:
        rows, columns = part
        size = columns.stop - columns.start, rows.stop - rows.start
        window = (columns.start, rows.start, *size)
        flat = undistorted_window(self._picture, self._intrinsics, window)
        return np.asarray(flat[:, :, ::-1] / float(np.iinfo(flat.dtype).max))


def shown_picture(scene: Any) -> Picture | None:
    """The picture (H, W, 3) that the scene shows, as it came; None where it can't be read."""
    name, cell = scene.monocell_cell.shown_picture, bare_cell(scene)
    if not name:
        return None
    path, inner = cell.path_of(name), cell.camera.intrinsics
    try:
        return _read(path, path.stat().st_mtime_ns, (inner.width, inner.height))
    except (OSError, MonocellError):
        # a picture that was moved is still shown, but can't be measured
        return None


def view_pixels(scene: Any) -> ViewPixels | None:
    """The pixels of the picture that the scene shows; None where it shows none."""
    picture, lens = shown_picture(scene), bare_cell(scene).camera.intrinsics
    if picture is not None:
        return ViewPixels(picture, lens)
    packed = _packed_picture(scene)
    return None if packed is None else ViewPixels(packed, lens.undistorted())


# each tool that starts asks for it, and one of 24 megapixels takes a third of a second to read
@lru_cache(maxsize=1)
def _read(path: Path, changed: int, size: tuple[int, int]) -> Picture:
    # of a camera only the size is asked for
    return read_picture(path, Intrinsics(*size, 1.0, 1.0, 0.0, 0.0))


def _packed_picture(scene: Any) -> Picture | None:
    """The undistorted picture that Blender keeps, for where its file is gone."""
    camera = scene.monocell_cell.camera
    backgrounds = camera.data.background_images if camera is not None else ()
    image = next((b.image for b in backgrounds if b.image is not None), None)
    if image is None or image.packed_file is None:
        return None
    return cv2.imdecode(np.frombuffer(image.packed_file.data, np.uint8), cv2.IMREAD_COLOR)
