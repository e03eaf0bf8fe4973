# SPDX-License-Identifier: GPL-3.0-or-later
"""A lens as a vector of parameters and back, and how its pixels change with them."""

from __future__ import annotations

import numpy as np
from numpy.polynomial import polynomial as poly

from ..arrays import Array
from ..distortion import COEFFICIENTS, Distortion
from ..intrinsics import Intrinsics

COEFFICIENT_NAMES = {
    "none": (),
    "plumb_bob": ("k1", "k2", "p1", "p2", "k3"),
    "rational_polynomial": ("k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"),
    "equidistant": ("k1", "k2", "k3", "k4"),
}


# a third radial coefficient is often more than a lens needs, and then bends where no corner is
WITHOUT_K3 = (8,)


def parameter_names(model: str) -> tuple[str, ...]:
    """`fx fy cx cy` and the coefficients of a distortion model, in the order of `parameters_of`."""
    return ("fx", "fy", "cx", "cy", *COEFFICIENT_NAMES[model])


def parameters_of(lens: Intrinsics) -> Array:
    """The vector (P,) of a lens: focal lengths, principal point, coefficients."""
    return np.array([lens.fx, lens.fy, lens.cx, lens.cy, *lens.distortion.coefficients])


def with_parameters(lens: Intrinsics, parameters: Array) -> Intrinsics:
    """A lens of the same size and model with other parameters. Raises InvalidValue."""
    fx, fy, cx, cy = (float(v) for v in parameters[:4])
    distortion = Distortion(lens.distortion.model, parameters[4:])
    return Intrinsics(lens.width, lens.height, fx, fy, cx, cy, distortion)


def in_model(lens: Intrinsics, model: str) -> Intrinsics:
    """The same focal length and principal point, in `model` with all coefficients zero."""
    plain = Distortion(model, np.zeros(COEFFICIENTS[model]))
    return Intrinsics(lens.width, lens.height, lens.fx, lens.fy, lens.cx, lens.cy, plain)


def picture_corners(lens: Intrinsics) -> Array:
    """The centres of the picture's four corner pixels, (4, 2)."""
    u, v = lens.width - 1.0, lens.height - 1.0
    return np.array([[0.0, 0.0], [u, 0.0], [0.0, v], [u, v]])


def images_corners(lens: Intrinsics) -> bool:
    """Whether a ray reaches each corner of the picture: no polynomial folds back before."""
    return bool(np.isfinite(lens.rays(picture_corners(lens))).all())


def pixels_by_parameters(lens: Intrinsics, points_camera: Array) -> Array:
    """The derivative of `lens.project` by the parameters: points (N, 3) to (N, 2, P)."""
    plane = lens.distortion.distort(points_camera)
    by_coefficients = _by_coefficients(lens.distortion, points_camera)
    derivative = np.zeros((len(plane), 2, 4 + by_coefficients.shape[2]))
    for axis, focal in ((0, lens.fx), (1, lens.fy)):
        derivative[:, axis, axis] = plane[:, axis]
        derivative[:, axis, 2 + axis] = 1.0
        derivative[:, axis, 4:] = focal * by_coefficients[:, axis]
    return derivative


def _by_coefficients(distortion: Distortion, points: Array) -> Array:
    """The derivative of the distorted plane point by the coefficients, (N, 2, K)."""
    count = COEFFICIENTS[distortion.model]
    if count == 0:
        return np.zeros((len(points), 2, 0))
    if distortion.model == "equidistant":
        planar = np.maximum(np.hypot(points[:, 0], points[:, 1]), 1e-300)
        angle = np.arctan2(planar, points[:, 2])
        powers = angle[:, None] ** np.array([3, 5, 7, 9])
        return (points[:, :2] / planar[:, None])[:, :, None] * powers[:, None]
    plane = points[:, :2] / points[:, 2:]
    derivative = np.zeros((len(points), 2, count))
    x, y = plane.T
    s = x * x + y * y
    derivative[:, :, 2] = np.stack([2 * x * y, s + 2 * y * y], 1)
    derivative[:, :, 3] = np.stack([s + 2 * x * x, 2 * x * y], 1)
    above, below = _by_radial(distortion, s)
    derivative[:, :, [0, 1, 4]] = plane[:, :, None] * above[:, None]
    if count == 8:
        derivative[:, :, 5:] = plane[:, :, None] * below[:, None]
    return derivative


def _by_radial(distortion: Distortion, s: Array) -> tuple[Array, Array]:
    """How N(s) / D(s) changes with k1 k2 k3, and with k4 k5 k6: (N, 3) each."""
    k = distortion.coefficients
    above = poly.polyval(s, [1.0, k[0], k[1], k[4]])
    below = poly.polyval(s, [1.0, *k[5:8]])
    powers = s[:, None] ** np.array([1, 2, 3])
    return powers / below[:, None], -powers * (above / below**2)[:, None]
