# SPDX-License-Identifier: GPL-3.0-or-later
"""COLMAP's cameras.txt: text with one camera to a Camera.

COLMAP counts from the corner of the top-left pixel, whose centre is (0.5, 0.5) there.
"""

from __future__ import annotations

import re

import numpy as np

from ...arrays import Array
from ...camera import Camera
from ...distortion import COEFFICIENTS, Distortion
from ...errors import DocumentError
from .coefficients import from_corner, simplest

# how many focal lengths, our model, and where each further parameter goes among its coefficients
MODELS: dict[str, tuple[int, str, tuple[int, ...]]] = {
    "SIMPLE_PINHOLE": (1, "none", ()),
    "PINHOLE": (2, "none", ()),
    "SIMPLE_RADIAL": (1, "plumb_bob", (0,)),
    "RADIAL": (1, "plumb_bob", (0, 1)),
    "OPENCV": (2, "plumb_bob", (0, 1, 2, 3)),
    "FULL_OPENCV": (2, "rational_polynomial", (0, 1, 2, 3, 4, 5, 6, 7)),
    "OPENCV_FISHEYE": (2, "equidistant", (0, 1, 2, 3)),
    "SIMPLE_RADIAL_FISHEYE": (1, "equidistant", (0,)),
    "RADIAL_FISHEYE": (1, "equidistant", (0, 1)),
}
LINE = re.compile(r"\d+\s+[A-Z][A-Z_]+\s+\d+\s+\d+\s")


def is_colmap(text: str) -> bool:
    """Whether a file's text looks like cameras.txt."""
    lines = _lines(text)
    return bool(lines) and LINE.match(lines[0] + " ") is not None


def camera_from_colmap(text: str) -> Camera:
    """The one camera of a cameras.txt. Raises DocumentError, also where there are several."""
    lines = _lines(text)
    if len(lines) != 1:
        raise DocumentError(
            f"holds {len(lines)} cameras; keep the line of the one that took the pictures"
        )
    _, model, width, height, *parameters = lines[0].split()
    if model not in MODELS:
        known = ", ".join(MODELS)
        raise DocumentError(f"{model}: this camera model is not supported, only {known} are")
    focals, name, places = MODELS[model]
    values = _numbers(parameters, model, focals + 2 + len(places))
    focal = (float(values[0]), float(values[focals - 1]))
    middle = (float(values[focals]), float(values[focals + 1]))
    size = (int(width), int(height))
    lens = _distortion(name, places, values[focals + 2 :])
    return Camera(from_corner(size, focal, middle, lens))


def _distortion(model: str, places: tuple[int, ...], values: Array) -> Distortion:
    coefficients = np.zeros(COEFFICIENTS[model])
    coefficients[list(places)] = values
    return simplest(model, coefficients)


def _lines(text: str) -> list[str]:
    lines = [line.strip() for line in text.splitlines()]
    return [line for line in lines if line and not line.startswith("#")]


def _numbers(words: list[str], model: str, count: int) -> Array:
    if len(words) != count:
        raise DocumentError(f"{model}: expected {count} parameters, got {len(words)}")
    try:
        return np.array([float(word) for word in words])
    except ValueError:
        raise DocumentError(f"{model}: its parameters are not all numbers") from None
