# SPDX-License-Identifier: GPL-3.0-or-later
"""ViSP's camera XML (vpXmlParserCamera): text with one camera to a Camera.

Its pixels count from centres, as here. Its distortion `kud` from undistorted to distorted is the
first radial coefficient; the opposite way, `kdu`, is not needed beside it.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET

import numpy as np

from ...camera import Camera
from ...errors import DocumentError
from ...intrinsics import Intrinsics
from ..fields import Fields, number
from .coefficients import simplest

PLAIN, DISTORTED = "perspectiveProjWithoutDistortion", "perspectiveProjWithDistortion"


def is_visp(text: str) -> bool:
    """Whether an XML text holds a camera of ViSP."""
    return "<px>" in text and "<u0>" in text


def camera_from_visp(text: str) -> Camera:
    """The one camera of the file, with its distortion if it has one. Raises DocumentError."""
    cameras = list(_root(text).iter("camera"))
    if len(cameras) != 1:
        raise DocumentError(f"holds {len(cameras)} cameras; keep the one that took the pictures")
    camera = cameras[0]
    models = {_text(model, "type"): model for model in camera.iter("model")}
    model = models.get(DISTORTED, models.get(PLAIN))
    if model is None:
        found = ", ".join(sorted(models)) or "none"
        raise DocumentError(f"model: {found} is not supported, only {PLAIN} and {DISTORTED} are")
    coefficients = np.zeros(5)
    if _text(model, "type") == DISTORTED:
        coefficients[0] = _number(model, "kud")
    width, height = (_whole(camera, name) for name in ("image_width", "image_height"))
    fx, fy, cx, cy = (_number(model, name) for name in ("px", "py", "u0", "v0"))
    distortion = simplest("plumb_bob", coefficients)
    return Camera(Intrinsics(width, height, fx, fy, cx, cy, distortion))


def _root(text: str) -> ET.Element:
    # entities have no place in a camera file, and can grow without bounds
    if "<!DOCTYPE" in text or "<!ENTITY" in text:
        raise DocumentError("a camera file needs no DOCTYPE; remove it")
    try:
        return ET.fromstring(text)
    except ET.ParseError as error:
        raise DocumentError(f"is not XML ({error})") from None


def _text(element: ET.Element, name: str) -> str:
    found = element.findtext(name)
    if found is None:
        raise DocumentError(f"{name}: is missing")
    return found.strip()


def _number(element: ET.Element, name: str) -> float:
    text = _text(element, name)
    try:
        return number(float(text), name)
    except ValueError:
        raise DocumentError(f"{name}: expected a number, got {text!r:.40}") from None


def _whole(element: ET.Element, name: str) -> int:
    return Fields({name: _number(element, name)}, "").whole(name)
