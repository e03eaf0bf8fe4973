# SPDX-License-Identifier: GPL-3.0-or-later
"""Distortion as files write it in, one of our models with its own number of coefficients out."""

from __future__ import annotations

import numpy as np

from ...arrays import Array
from ...distortion import COEFFICIENTS, Distortion
from ...errors import DocumentError
from ...intrinsics import Intrinsics

# the names that ROS, OpenCV and calibration tools give the models
MODEL_NAMES = {
    "plumb_bob": "plumb_bob",
    "rational_polynomial": "rational_polynomial",
    "equidistant": "equidistant",
    "fisheye": "equidistant",
}


def named_model(name: str) -> str:
    """Our name of a model as ROS or OpenCV spell it. Raises DocumentError."""
    if name not in MODEL_NAMES:
        known = ", ".join(MODEL_NAMES)
        raise DocumentError(f"distortion_model: {name!r} is none of {known}")
    return MODEL_NAMES[name]


def padded(model: str, values: Array) -> Distortion:
    """Files often leave out trailing zeros, or write more zeros than the model has.

    Raises DocumentError for coefficients beyond the model's.
    """
    wanted = COEFFICIENTS[model]
    if np.any(values[wanted:]):
        raise DocumentError(
            f"distortion_coefficients: {len(values)} numbers, but {model} has {wanted}; "
            "thin-prism and tilt terms are not supported"
        )
    kept = np.zeros(wanted)
    kept[: min(wanted, len(values))] = values[:wanted]
    return simplest(model, kept)


def simplest(model: str, values: Array) -> Distortion:
    """The model with its coefficients; `none` where a pinhole's coefficients are all zero."""
    plain = model != "equidistant" and not np.any(values)
    return Distortion("none") if plain else Distortion(model, values)


def from_matrix(width: int, height: int, k: Array, distortion: Distortion) -> Intrinsics:
    """Intrinsics of a camera matrix (3, 3). Raises DocumentError for a skew."""
    if abs(k[0, 1]) > 1e-6 * abs(k[0, 0]):
        raise DocumentError(f"camera_matrix: a skew of {k[0, 1]:g} px is not supported")
    return Intrinsics(width, height, k[0, 0], k[1, 1], k[0, 2], k[1, 2], distortion)


def from_corner(
    size: tuple[int, int], focal: tuple[float, float], middle: tuple[float, float], lens: Distortion
) -> Intrinsics:
    """Intrinsics of a format whose pixels count from the **corner** of the top-left pixel.

    There its centre is (0.5, 0.5), here it is (0, 0): the principal point moves by half a pixel.
    """
    return Intrinsics(*size, *focal, middle[0] - 0.5, middle[1] - 0.5, lens)
