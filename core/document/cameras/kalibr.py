# SPDX-License-Identifier: GPL-3.0-or-later
"""Kalibr's camchain YAML, parsed: one pinhole camera, radtan or equidistant, to a Camera.

Pixels count from centres, as here. Poses in a camchain are relative to other sensors: not read.
"""

from __future__ import annotations

import re
from typing import Any

import numpy as np

from ...camera import Camera
from ...distortion import Distortion
from ...errors import DocumentError
from ...intrinsics import Intrinsics
from ..fields import Fields, items, keyed
from .coefficients import padded

REQUIRED = ("camera_model", "intrinsics", "resolution")
OPTIONAL = ("distortion_model", "distortion_coeffs")
# relative poses and what else Kalibr notes of a sensor
OTHER_KEYS = ("rostopic", "cam_overlaps", "T_cn_cnm1", "T_cam_imu", "timeshift_cam_imu")
MODELS = {"radtan": "plumb_bob", "equidistant": "equidistant", "none": "none"}
CAMERA = re.compile(r"cam\d+")


def is_kalibr(document: Any) -> bool:
    """Whether a parsed YAML document is a camchain."""
    return isinstance(document, dict) and any(CAMERA.fullmatch(str(key)) for key in document)


def camera_from_kalibr(document: dict[str, Any]) -> Camera:
    """The one camera of a camchain. Raises DocumentError, also for a chain of several."""
    if len(document) != 1:
        names = ", ".join(str(name) for name in document)
        raise DocumentError(f"holds {names}; keep the one camera that took the pictures")
    (name, entry), *_ = document.items()
    fields = keyed(entry, str(name), REQUIRED, (*OPTIONAL, *OTHER_KEYS))
    if fields.text("camera_model") != "pinhole":
        raise DocumentError(
            f"{fields.path('camera_model')}: {fields.text('camera_model')!r} is not supported, "
            "only pinhole is"
        )
    fx, fy, cx, cy = fields.vector("intrinsics", 4)
    width, height = fields.vector("resolution", 2)
    return Camera(Intrinsics(width, height, fx, fy, cx, cy, _distortion(fields)))


def _distortion(fields: Fields) -> Distortion:
    name = fields.text("distortion_model") if fields.has("distortion_model") else "none"
    if name not in MODELS:
        known = ", ".join(MODELS)
        raise DocumentError(f"{fields.path('distortion_model')}: {name!r} is none of {known}")
    count = 0 if name == "none" else 4
    given = items(fields.raw("distortion_coeffs") or [], fields.path("distortion_coeffs"))
    if count == 0 and not any(given):
        return Distortion()
    return padded(MODELS[name], np.array(fields.vector("distortion_coeffs", count)))
