# SPDX-License-Identifier: GPL-3.0-or-later
"""nerfstudio's (and Instant NGP's) transforms.json, parsed: its intrinsics to a Camera.

Its pixels count from the corner of the top-left pixel, whose centre is (0.5, 0.5) there. The poses
of its frames are those of other pictures: not read. What else stands in the file is left alone.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ...camera import Camera
from ...distortion import Distortion
from ...errors import DocumentError
from ..fields import Fields
from .coefficients import from_corner, simplest

MODELS = {
    "OPENCV": "plumb_bob",
    "PINHOLE": "none",
    "SIMPLE_PINHOLE": "none",
    "OPENCV_FISHEYE": "equidistant",
}
COEFFICIENTS = {
    "none": (),
    "plumb_bob": ("k1", "k2", "p1", "p2", "k3"),
    "equidistant": ("k1", "k2", "k3", "k4"),
}
ALL_COEFFICIENTS = ("k1", "k2", "k3", "k4", "k5", "k6", "p1", "p2")


def is_nerfstudio(document: Any) -> bool:
    """Whether a parsed JSON document is a transforms.json."""
    return isinstance(document, dict) and bool(
        {"fl_x", "camera_angle_x", "frames", "applied_transform"} & set(document)
    )


def camera_from_nerfstudio(document: dict[str, Any]) -> Camera:
    """The camera that all frames share. Raises DocumentError, also where each has its own."""
    fields = Fields(document, "")
    frames = fields.items("frames")
    if any(isinstance(frame, dict) and "fl_x" in frame for frame in frames):
        raise DocumentError("frames[0].fl_x: every frame has a camera of its own; give one")
    for name in ("w", "h"):
        if not fields.has(name):
            raise DocumentError(f"{name}: is missing")
    width, height = fields.whole("w"), fields.whole("h")
    fx = _focal(fields, "fl_x", "camera_angle_x", width)
    fy = _focal(fields, "fl_y", "camera_angle_y", height, fx)
    cx = fields.number("cx") if fields.has("cx") else width / 2
    cy = fields.number("cy") if fields.has("cy") else height / 2
    return Camera(from_corner((width, height), (fx, fy), (cx, cy), _distortion(fields)))


def _focal(
    fields: Fields, key: str, angle_key: str, size: int, otherwise: float | None = None
) -> float:
    if fields.has(key):
        return fields.number(key)
    if fields.has(angle_key):
        angle = fields.number(angle_key)
        if not 0 < angle < math.pi:
            raise DocumentError(f"{angle_key}: {angle:g} is no angle in radians below pi")
        return size / 2 / math.tan(angle / 2)
    if otherwise is None:
        raise DocumentError(f"{key}: is missing")
    return otherwise


def _distortion(fields: Fields) -> Distortion:
    model = fields.text("camera_model") if fields.has("camera_model") else "OPENCV"
    if fields.raw("is_fisheye") is True:
        model = "OPENCV_FISHEYE"
    if model not in MODELS:
        raise DocumentError(f"camera_model: {model!r} is none of {', '.join(MODELS)}")
    names = COEFFICIENTS[MODELS[model]]
    for name in ALL_COEFFICIENTS:
        if name not in names and fields.has(name) and fields.number(name) != 0:
            raise DocumentError(f"{name}: {fields.number(name):g} has no place in {model}")
    values = [fields.number(name) if fields.has(name) else 0.0 for name in names]
    return simplest(MODELS[model], np.array(values))
