# SPDX-License-Identifier: GPL-3.0-or-later
"""The camera that a user states: a file, or numbers typed beside a picture, in; a Camera out."""

from __future__ import annotations

from collections.abc import Callable
from math import radians, tan
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from ...core.camera import Camera
from ...core.distortion import Distortion
from ...core.errors import DocumentError, InvalidValue
from ...core.intrinsics import Intrinsics

# what a lens sees: narrower is a telescope, wider no pinhole
LEAST_DEGREES, MOST_DEGREES = 0.5, 170.0


# what is typed, and for which a picture's size is needed
TYPED = (
    *("camera_source", "focal_x", "focal_y", "field_degrees"),
    *("centred", "centre_x", "centre_y", "lens_model", "coefficients"),
)


def stated_camera(inputs: Any, picture: Path) -> Callable[[], Camera]:
    """What gives the camera of the scene's inputs, for a picture's size, without asking Blender.

    It may read the whole picture for its size, and be left to a thread. Raises DocumentError and
    InvalidValue, at once or then, for a file or numbers that are no camera, PictureError for a
    picture that can't be read.
    """
    camera = camera_for(inputs)
    return lambda: camera(lambda: _size(picture))


def camera_for(inputs: Any) -> Callable[[Callable[[], tuple[int, int]]], Camera]:
    """The camera of the scene's inputs for pictures of a size, asked for where it is needed.

    Raises DocumentError and InvalidValue, at once or when called, for a file or numbers that are no
    camera.
    """
    import bpy

    if inputs.camera_source == "FILE":
        if not inputs.camera:
            raise DocumentError("no camera file chosen: choose one, or type the camera's numbers")
        from ...core.document.camera_file import read_camera

        known = read_camera(bpy.path.abspath(inputs.camera))
        return lambda size: known
    if inputs.camera_source == "BOARD":
        from .lens_estimate import estimated_camera

        estimated = estimated_camera(inputs.id_data.monocell_lens.estimate)
        return lambda size: estimated
    typed = SimpleNamespace(**{name: getattr(inputs, name) for name in TYPED})
    return lambda size: _typed_camera(typed, *size())


def parsed_coefficients(text: str) -> list[float]:
    """Numbers parted by blanks or commas. Raises InvalidValue naming what is no number."""
    numbers = []
    for word in text.replace(",", " ").replace(";", " ").split():
        try:
            numbers.append(float(word))
        except ValueError:
            raise InvalidValue(f"lens coefficients: {word!r:.20} is no number") from None
    return numbers


def _typed_camera(inputs: Any, width: int, height: int) -> Camera:
    cx, cy = inputs.centre_x, inputs.centre_y
    if inputs.centred:
        cx, cy = (width - 1) / 2, (height - 1) / 2
    fx, fy = _focal(inputs, width)
    lens = Distortion(inputs.lens_model, parsed_coefficients(inputs.coefficients))
    return Camera(Intrinsics(width, height, fx, fy, cx, cy, lens))


def _focal(inputs: Any, width: int) -> tuple[float, float]:
    if inputs.camera_source == "PIXELS":
        return inputs.focal_x, inputs.focal_y or inputs.focal_x
    if not LEAST_DEGREES <= inputs.field_degrees <= MOST_DEGREES:
        raise InvalidValue(
            f"field of view: {inputs.field_degrees:g} degrees; a pinhole camera has "
            f"{LEAST_DEGREES:g} to {MOST_DEGREES:g}"
        )
    focal = width / 2 / tan(radians(inputs.field_degrees) / 2)
    return focal, focal


def _size(picture: Path) -> tuple[int, int]:
    from ...core.picture.pictures import upright_size

    return upright_size(picture)
