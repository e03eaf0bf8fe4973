# SPDX-License-Identifier: GPL-3.0-or-later
"""The undistorted picture behind the camera's view: pixels go in, a packed background comes out."""

from __future__ import annotations

from typing import Any

import bpy
from numpy.typing import NDArray

from ..core.intrinsics import Intrinsics
from ..core.picture.plate import Plate, plate_of

NAME = "monocell background"


def show_background(
    camera_object: Any, picture: NDArray[Any], intrinsics: Intrinsics, *, alpha: float = 1.0
) -> Any:
    """Show a picture as `core.pictures.read_picture` gives it behind the camera's view.

    That is (H, W, 3) blue, green, red, 8 or 16 bits, as it came from the lens; the rest is as for
    `show_plate`. Raises PictureError for another size.
    """
    return show_plate(camera_object, plate_of(NAME, picture, intrinsics), alpha=alpha)


def show_plate(camera_object: Any, plate: Plate, *, alpha: float = 1.0) -> Any:
    """Show an undistorted picture behind the camera's view, so straight edges meet straight models.

    It is stretched over the camera's frame, which has the same K, and packed into the .blend. A
    second call replaces the first. Returns the bpy image.
    """
    old, image = _image_of(camera_object), _packed_image(plate)
    background = _background_of(camera_object, old)
    background.image, background.source = image, "IMAGE"
    background.alpha, background.display_depth = alpha, "BACK"
    # the frame has the picture's shape, pixel aspect included: nothing is cropped or barred
    background.frame_method = "STRETCH"
    background.show_background_image = True
    camera_object.data.show_background_images = True
    # a copy of the camera may still show it
    if old is not None and not old.users:
        bpy.data.images.remove(old)
        image.name = NAME
    return image


def _image_of(camera_object: Any) -> Any | None:
    for background in camera_object.data.background_images:
        if background.image is not None and NAME in background.image:
            return background.image
    return None


def _background_of(camera_object: Any, image: Any | None) -> Any:
    backgrounds = camera_object.data.background_images
    for background in backgrounds:
        if image is not None and background.image == image:
            return background
    return backgrounds.new()


def _packed_image(plate: Plate) -> Any:
    """A Blender image that holds the plate's bytes; Blender decodes them when it first draws."""
    image = bpy.data.images.new(NAME, 1, 1, alpha=False)
    image[NAME] = True
    image.pack(data=plate.png, data_len=len(plate.png))
    image.source = "FILE"
    return image
