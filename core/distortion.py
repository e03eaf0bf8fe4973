# SPDX-License-Identifier: GPL-3.0-or-later
"""Lens distortion: rays to the distorted image plane and back, with derivatives.

The image plane is at unit distance: a pixel is `fx * x + cx, fy * y + cy` of a distorted (x, y).
Models and coefficient order are those of OpenCV and ROS, so calibrations carry over unchanged.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from .arrays import Array, frozen
from .errors import InvalidValue
from .radial import RadialProfile

COEFFICIENTS = {"none": 0, "plumb_bob": 5, "rational_polynomial": 8, "equidistant": 4}
# rational models of wide lenses reach thousands; far beyond, powers overflow
LARGEST_COEFFICIENT = 1e9
NEWTON_STEPS = 25
# Newton's error squares itself: after a step this small less than 1e-9 px is left
CONVERGED = 3e-7
FOLD_START = 0.8


@dataclass(frozen=True, eq=False)
class Distortion:
    """A distortion model by name with its coefficients.

    - `none`: no coefficients
    - `plumb_bob`: k1 k2 p1 p2 k3 (Brown-Conrady)
    - `rational_polynomial`: k1 k2 p1 p2 k3 k4 k5 k6
    - `equidistant`: k1 k2 k3 k4 (Kannala-Brandt fisheye)

    A polynomial turns back on itself beyond some angle: rays past it, and rays behind the camera,
    are not imaged, and both directions of the map give NaN there.

    Raises InvalidValue for an unknown model or a wrong number of coefficients.
    """

    model: str = "none"
    coefficients: Array = field(default_factory=lambda: np.zeros(0))

    def __post_init__(self) -> None:
        if self.model not in COEFFICIENTS:
            known = ", ".join(COEFFICIENTS)
            raise InvalidValue(f"distortion.model: {self.model!r} is none of {known}")
        coefficients = frozen(self.coefficients, (None,), "distortion.coefficients")
        if len(coefficients) != COEFFICIENTS[self.model]:
            raise InvalidValue(
                f"distortion.coefficients: {self.model} has {COEFFICIENTS[self.model]}, "
                f"got {len(coefficients)}"
            )
        if len(coefficients) and np.abs(coefficients).max() > LARGEST_COEFFICIENT:
            raise InvalidValue(
                f"distortion.coefficients: {np.abs(coefficients).max():g} is no lens's; "
                "calibrate the lens again"
            )
        object.__setattr__(self, "coefficients", coefficients)

    def distort(self, rays: ArrayLike) -> Array:
        """Directions (N, 3) of any length to distorted image-plane points (N, 2)."""
        return self._from_rays(np.asarray(rays, dtype=float))

    def distort_with_jacobian(self, rays: ArrayLike) -> tuple[Array, Array]:
        """`distort` and its derivative by the direction's components, (N, 2, 3)."""
        r = np.asarray(rays, dtype=float)
        if self.model == "equidistant":
            return self._from_rays(r), self._fisheye_jacobian(r)
        plane, plane_from_ray = _pinhole(r)
        distorted, (a, b, c) = self._polynomial(plane[:, 0], plane[:, 1])
        inner = np.stack([np.stack([a, b], 1), np.stack([b, c], 1)], 1)
        jacobian: Array = inner @ plane_from_ray
        return self._masked(np.stack(distorted, 1), plane), jacobian

    def undistort(self, distorted: ArrayLike) -> Array:
        """Distorted image-plane points (N, 2) to unit rays (N, 3), to machine precision.

        OpenCV's undistortPoints stops after five fixed-point steps, which is 0.46 px off in the
        corners of a wide lens; this is Newton's method started from the exact radial inverse.
        """
        d = np.asarray(distorted, dtype=float)
        if self.model == "equidistant":
            return self._fisheye_rays(d)
        plain = self.model == "none"
        # where no ray is imaged Newton's method runs off to infinity, and NaN is the answer
        with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
            x, y = (d[:, 0], d[:, 1]) if plain else self._undistort_polynomial(d)
        rays = np.empty((len(d), 3))
        rays[:, 2] = 1.0 / np.sqrt(x * x + y * y + 1.0)
        np.multiply(x, rays[:, 2], out=rays[:, 0])
        np.multiply(y, rays[:, 2], out=rays[:, 1])
        return rays

    # -- the forward map ------------------------------------------------------------------------

    @cached_property
    def _profile(self) -> RadialProfile:
        return RadialProfile.of(self.model, self.coefficients)

    def _from_rays(self, rays: Array) -> Array:
        if self.model == "equidistant":
            planar = np.hypot(rays[:, 0], rays[:, 1])
            angle = np.arctan2(planar, rays[:, 2])
            angle_d = self._profile.distorted(angle)
            # at the axis planar is 0 and the direction is free: the scale tends to 1 / z
            on_axis = planar < 1e-300
            scale = np.where(on_axis, 0.0, angle_d / np.where(on_axis, 1.0, planar))
            return rays[:, :2] * scale[:, None]
        plane, _ = _pinhole(rays)
        if self.model == "none":
            return plane
        distorted, _ = self._polynomial(plane[:, 0], plane[:, 1])
        return self._masked(np.stack(distorted, 1), plane)

    def _polynomial(self, x: Array, y: Array) -> tuple[tuple[Array, Array], tuple[Array, ...]]:
        """Brown-Conrady, x (1 + k1 s + ...) + 2 p1 x y + p2 (s + 2 x^2) with s = x^2 + y^2.

        The derivative is symmetric: it is returned as (dxd/dx, dxd/dy = dyd/dx, dyd/dy).
        """
        p1, p2 = self._tangential
        xx, yy, xy2 = x * x, y * y, 2 * x * y
        s = xx + yy
        gain, slope = self._profile.gain_and_slope(s)
        p1y, p2x = p1 * y, p2 * x
        xd = x * gain + p1 * xy2 + p2 * (s + 2 * xx)
        yd = y * gain + p1 * (s + 2 * yy) + p2 * xy2
        mixed = xy2 * slope + 2 * (p1 * x + p2 * y)
        by_x = gain + 2 * (xx * slope + p1y + 3 * p2x)
        by_y = gain + 2 * (yy * slope + 3 * p1y + p2x)
        return (xd, yd), (by_x, mixed, by_y)

    @property
    def _tangential(self) -> tuple[float, float]:
        if self.model == "none":
            return 0.0, 0.0
        return float(self.coefficients[2]), float(self.coefficients[3])

    def _masked(self, distorted: Array, plane: Array) -> Array:
        """NaN where the undistorted radius lies beyond the fold of the polynomial."""
        limit = self._profile.limit
        if np.isfinite(limit):
            distorted[(plane * plane).sum(1) > limit * limit] = np.nan
        return distorted

    def _fisheye_jacobian(self, rays: Array) -> Array:
        x, y, z = rays.T
        planar2 = np.maximum(x * x + y * y, 1e-300)
        planar, norm2 = np.sqrt(planar2), planar2 + z * z
        angle = np.arctan2(planar, z)
        angle_d, slope = self._profile.distorted(angle), self._profile.slope(angle)
        ratio = angle_d / planar
        # image = (x, y) * ratio with ratio a function of planar and z
        by_planar = (slope * z / norm2 - ratio) / planar2
        jacobian = np.empty((len(rays), 2, 3))
        jacobian[:, 0, 0] = ratio + x * x * by_planar
        jacobian[:, 1, 1] = ratio + y * y * by_planar
        jacobian[:, 0, 1] = jacobian[:, 1, 0] = x * y * by_planar
        jacobian[:, 0, 2] = -x * slope / norm2
        jacobian[:, 1, 2] = -y * slope / norm2
        axis = planar < 1e-12 * np.abs(z)
        jacobian[axis] = np.array([[1.0, 0, 0], [0, 1.0, 0]]) / z[axis, None, None]
        return jacobian

    # -- the inverse map ------------------------------------------------------------------------

    def _fisheye_rays(self, d: Array) -> Array:
        x, y = d[:, 0], d[:, 1]
        radius = np.sqrt(x * x + y * y)
        angle = self._profile.undistorted(radius)
        # sin(angle) / radius tends to 1 on the axis
        scale = np.where(radius < 1e-300, 1.0, np.sin(angle) / np.maximum(radius, 1e-300))
        rays = np.empty((len(d), 3))
        np.multiply(x, scale, out=rays[:, 0])
        np.multiply(y, scale, out=rays[:, 1])
        np.cos(angle, out=rays[:, 2])
        return rays

    def _undistort_polynomial(self, d: Array) -> tuple[Array, Array]:
        xd: Array = d[:, 0].copy()
        yd: Array = d[:, 1].copy()
        ratio = self._profile.ratio_roughly(np.square(xd) + np.square(yd))
        x, y = xd * ratio, yd * ratio
        self._newton_step(x, y, xd, yd)
        step = self._newton_step(x, y, xd, yd)
        # two steps end it but near a fold: there they start again from further in, whence Newton
        # climbs without overshooting (the curve is concave)
        slow = np.flatnonzero(~(step <= CONVERGED))
        inner = FOLD_START * ratio[slow]
        x[slow], y[slow] = xd[slow] * inner, yd[slow] * inner
        for _ in range(NEWTON_STEPS):
            if not len(slow):
                break
            xs, ys = x[slow], y[slow]
            step = self._newton_step(xs, ys, xd[slow], yd[slow])
            x[slow], y[slow] = xs, ys
            slow = slow[~(step <= CONVERGED)]
        # no ray reaches a pixel past the fold: Newton then wanders, or lands beyond the limit
        x[slow] = np.nan
        x[x * x + y * y > self._profile.limit**2] = np.nan
        y[np.isnan(x)] = np.nan
        return x, y

    def _newton_step(self, x: Array, y: Array, xd: Array, yd: Array) -> Array:
        """Move x, y in place; the length of the move, (N,), is returned."""
        (at_x, at_y), (a, b, c) = self._polynomial(x, y)
        ex, ey = np.subtract(xd, at_x, out=at_x), np.subtract(yd, at_y, out=at_y)
        scale = 1.0 / (a * c - b * b)
        dx, dy = (c * ex - b * ey) * scale, (a * ey - b * ex) * scale
        x += dx
        y += dy
        return np.maximum(np.abs(dx, out=dx), np.abs(dy, out=dy))


def _pinhole(rays: Array) -> tuple[Array, Array]:
    """(x / z, y / z) of rays in front of the camera, NaN behind it, and the derivative."""
    z = np.where(rays[:, 2] > 0, rays[:, 2], np.nan)
    plane = rays[:, :2] / z[:, None]
    jacobian = np.zeros((len(rays), 2, 3))
    jacobian[:, 0, 0] = jacobian[:, 1, 1] = 1.0 / z
    jacobian[:, :, 2] = -plane / z[:, None]
    return plane, jacobian
