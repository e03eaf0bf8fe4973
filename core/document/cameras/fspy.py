# SPDX-License-Identifier: GPL-3.0-or-later
"""fSpy's JSON export, parsed: focal length and principal point to a Camera.

fSpy's image plane has its origin in the middle of the picture, spans -1 to 1 along the longer side,
and its y points up. It knows no distortion. Its pose has no scale of its own: not read.
"""

from __future__ import annotations

import math
from typing import Any

from ...camera import Camera
from ...distortion import Distortion
from ...errors import DocumentError
from ..fields import Fields, keyed
from .coefficients import from_corner

REQUIRED = ("principalPoint", "imageWidth", "imageHeight")
OPTIONAL = (
    "relativeFocalLength",
    "horizontalFieldOfView",
    "verticalFieldOfView",
    "viewTransform",
    "cameraTransform",
    "vanishingPoints",
    "vanishingPointAxes",
)


def is_fspy(document: Any) -> bool:
    """Whether a parsed JSON document is fSpy's."""
    return isinstance(document, dict) and "principalPoint" in document


def camera_from_fspy(document: dict[str, Any]) -> Camera:
    """The camera of an fSpy export. Raises DocumentError."""
    fields = keyed(document, "", REQUIRED, OPTIONAL)
    width, height = fields.whole("imageWidth"), fields.whole("imageHeight")
    middle = keyed(fields.raw("principalPoint"), "principalPoint", ("x", "y"), ())
    half = max(width, height) / 2
    focal = half * _relative_focal(fields)
    cx, cy = width / 2 + half * middle.number("x"), height / 2 - half * middle.number("y")
    return Camera(from_corner((width, height), (focal, focal), (cx, cy), Distortion()))


def _relative_focal(fields: Fields) -> float:
    """The focal length in halves of the longer side.

    What fSpy calls the horizontal field of view is that of the longer side.
    """
    if fields.has("relativeFocalLength"):
        return fields.number("relativeFocalLength")
    if not fields.has("horizontalFieldOfView"):
        raise DocumentError("relativeFocalLength: is missing")
    angle = fields.number("horizontalFieldOfView")
    if not 0 < angle < math.pi:
        raise DocumentError(f"horizontalFieldOfView: {angle:g} is no angle in radians below pi")
    return 1 / math.tan(angle / 2)
