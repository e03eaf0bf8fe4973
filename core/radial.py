# SPDX-License-Identifier: GPL-3.0-or-later
"""The radial part of a distortion model: a curve over the radius (or angle), and its inverse."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.polynomial import polynomial as poly

from .arrays import Array

TABLE_NODES = 2048
RATIO_NODES = 8192
NEWTON_STEPS = 8
# rd^2 up to here is found by index: all of a fisheye, 72 degrees of a pinhole; beyond, by search
WIDEST_RATIO_TABLE = 10.0
# a polynomial that never folds is tabulated up to this radius (an angle of 84 degrees)
WIDEST_PLANE_RADIUS = 10.0
# rays behind the image plane of a fisheye still hit it, up to straight backwards
WIDEST_ANGLE = np.pi


@dataclass(frozen=True, eq=False)
class RadialProfile:
    """`distorted(r) = r * N(r^2) / D(r^2)`, for r the plane radius or (fisheye) the angle.

    N and D are coefficient arrays, lowest power first. `limit` is the r at which the curve first
    stops rising; beyond it no ray is imaged.
    """

    numerator: Array
    denominator: Array
    widest: float

    @staticmethod
    def of(model: str, coefficients: Array) -> RadialProfile:
        k = coefficients
        if model == "equidistant":
            return RadialProfile(np.array([1.0, *k]), np.ones(1), WIDEST_ANGLE)
        if model == "plumb_bob":
            return RadialProfile(np.array([1.0, k[0], k[1], k[4]]), np.ones(1), np.inf)
        if model == "rational_polynomial":
            return RadialProfile(
                np.array([1.0, k[0], k[1], k[4]]), np.array([1.0, k[5], k[6], k[7]]), np.inf
            )
        return RadialProfile(np.ones(1), np.ones(1), np.inf)

    @cached_property
    def limit(self) -> float:
        """The first radius at which the slope is zero or the curve has a pole."""
        n, d = self.numerator, self.denominator
        # slope of r N/D over s = r^2:  (N D + 2 s (N' D - N D')) / D^2
        cross = poly.polysub(poly.polymul(_d(n), d), poly.polymul(n, _d(d)))
        slope = poly.polyadd(poly.polymul(n, d), 2 * poly.polymul([0.0, 1.0], cross))
        return min(self.widest, _first_positive_root(slope), _first_positive_root(d))

    def gain_and_slope(self, s: Array) -> tuple[Array, Array]:
        """N/D and its derivative by s = r^2."""
        n, dn = _horner(self.numerator, s)
        if len(self.denominator) == 1:
            return n, dn
        d, dd = _horner(self.denominator, s)
        gain = n / d
        return gain, (dn - gain * dd) / d

    def distorted(self, r: Array) -> Array:
        """The curve itself; NaN beyond the limit."""
        gain, _ = self.gain_and_slope(r * r)
        return np.where(r <= self.limit, r * gain, np.nan)

    def slope(self, r: Array) -> Array:
        """Derivative of `distorted` by r."""
        gain, by_s = self.gain_and_slope(r * r)
        return gain + 2 * r * r * by_s

    def ratio_roughly(self, rd2: Array) -> Array:
        """r / rd to about 1e-7 from a table over rd^2: a start for Newton's method."""
        table, cells_per_unit = self._ratio_table
        place = rd2 * cells_per_unit
        np.minimum(place, len(table) - 1.001, out=place)
        # NaN has no cell; any start will do, for NaN is what Newton makes of it
        cell = np.nan_to_num(place, copy=False).astype(np.intp)
        place -= cell
        low = table.take(cell)
        ratio: Array = low + place * (table.take(cell + 1) - low)
        beyond = rd2 > WIDEST_RATIO_TABLE
        if beyond.any():
            radius = np.sqrt(rd2[beyond])
            ratio[beyond] = np.interp(radius, self._table[1], self._table[0]) / radius
        return ratio

    def undistorted(self, rd: Array) -> Array:
        """The exact inverse; NaN beyond what the curve reaches."""
        farthest = self._table[1][-1]
        # beyond the curve Newton would run off to infinity
        near = np.minimum(rd, farthest)
        r = self._newton(near * self.ratio_roughly(near * near), near)
        r[~(rd <= farthest * (1 + 1e-12))] = np.nan
        return r

    def _newton(self, r: Array, rd: Array) -> Array:
        for _ in range(NEWTON_STEPS):
            s = r * r
            gain, by_s = self.gain_and_slope(s)
            slope = gain + 2 * s * by_s
            step = (r * gain - rd) / np.maximum(slope, 1e-6, out=slope)
            r = r - step
            # the error squares itself with every step: less than 1e-12 is left
            if not (np.abs(step, out=step) > 1e-7).any():
                break
        return r

    @cached_property
    def _ratio_table(self) -> tuple[Array, float]:
        """Values of r / rd at equal steps of rd^2, and how many steps there are to a unit."""
        reach = min(float(self._table[1][-1]) ** 2, WIDEST_RATIO_TABLE)
        rd = np.sqrt(np.linspace(0.0, reach, RATIO_NODES))
        r = self._newton(np.interp(rd, self._table[1], self._table[0]), rd)
        ratio = np.divide(r, rd, out=np.ones_like(r), where=rd > 0)
        return ratio, (RATIO_NODES - 1) / reach

    @cached_property
    def _table(self) -> tuple[Array, Array]:
        # at the limit itself a rational curve may have its pole
        nodes = np.linspace(0.0, min(self.limit * (1 - 1e-9), WIDEST_PLANE_RADIUS), TABLE_NODES)
        gain, _ = self.gain_and_slope(nodes * nodes)
        return nodes, nodes * gain


def _d(p: Array) -> Array:
    derivative: Array = poly.polyder(p)
    return derivative


def _horner(p: Array, s: Array) -> tuple[Array, Array]:
    value, derivative = np.full_like(s, p[-1]), np.zeros_like(s)
    for c in p[-2::-1]:
        derivative = derivative * s + value
        value = value * s + c
    return value, derivative


def _first_positive_root(p: Array) -> float:
    """The radius sqrt(s) of the smallest positive real root s, infinite if there is none."""
    trimmed = poly.polytrim(p, tol=1e-14)
    if len(trimmed) < 2:
        return float("inf")
    roots = poly.polyroots(trimmed)
    real = roots[np.abs(roots.imag) < 1e-9 * np.maximum(1.0, np.abs(roots))].real
    positive = real[real > 1e-12]
    return float(np.sqrt(positive.min())) if len(positive) else float("inf")
