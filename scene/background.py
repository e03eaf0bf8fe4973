# SPDX-License-Identifier: GPL-3.0-or-later
"""The undistorted picture behind the camera's view: pixels go in, a packed background comes out."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

from ..core.intrinsics import Intrinsics
from ..core.picture.undistortion import undistorted_picture

NAME = "monocell background"


def show_background(
    camera_object: Any, picture: NDArray[Any], intrinsics: Intrinsics, *, alpha: float = 1.0
) -> Any:
    """Show a picture as `core.pictures.read_picture` gives it behind the camera's view.

    That is (H, W, 3) blue, green, red, 8 or 16 bits, as it came from the lens.

    What is shown is the undistorted picture, so that straight edges meet straight models. It is
    stretched over the camera's frame, which has the same K, and packed into the .blend. A second
    call replaces the first. Returns the bpy image. Raises PictureError for another size.
    """
    image = _fill_image(_image_of(camera_object), undistorted_picture(picture, intrinsics))
    background = _background_of(camera_object, image)
    background.image, background.source = image, "IMAGE"
    background.alpha, background.display_depth = alpha, "BACK"
    # the frame has the picture's shape, pixel aspect included: nothing is cropped or barred
    background.frame_method = "STRETCH"
    background.show_background_image = True
    camera_object.data.show_background_images = True
    return image


def _image_of(camera_object: Any) -> Any | None:
    for background in camera_object.data.background_images:
        if background.image is not None and NAME in background.image:
            return background.image
    return None


def _background_of(camera_object: Any, image: Any) -> Any:
    backgrounds = camera_object.data.background_images
    for background in backgrounds:
        if background.image == image:
            return background
    return backgrounds.new()


def _fill_image(image: Any | None, picture: NDArray[Any]) -> Any:
    height, width = picture.shape[:2]
    if image is None:
        image = bpy.data.images.new(NAME, width, height, alpha=False)
        image[NAME] = True
    elif tuple(image.size) != (width, height):
        image.scale(width, height)
    rows = np.ones((height, width, 4), np.float32)
    rows[:, :, :3] = picture[::-1, :, ::-1] / np.float32(np.iinfo(picture.dtype).max)
    image.pixels.foreach_set(rows.ravel())
    image.update()
    image.pack()
    return image
