# SPDX-License-Identifier: GPL-3.0-or-later
"""How well a pose is known: a joint fit in, 1 sigma and the 95 % ellipsoids of its camera out."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache

import numpy as np

from ..arrays import Array
from ..camera import Camera
from .joint_pose import JointFit

SHARE = 0.95
# chi-squared of three degrees of freedom, and from where on Fisher's F is no different
CHI_SQUARED_95 = 7.814727903
MANY = 1e5
NODES, WEIGHTS = np.polynomial.legendre.leggauss(64)


@dataclass(frozen=True, eq=False)
class Ellipsoid:
    """Half lengths (3,) of its axes, longest first, and their unit directions (3, 3), one a row.

    A direction and its opposite are the same axis; the one with the larger sum is given.
    """

    semi_axes: Array
    directions: Array


@dataclass(frozen=True, eq=False)
class PoseError:
    """1 sigma and where the truth lies with 95 % of confidence.

    - `position_sigma` (3,) of the optical centre along the world's axes, metres
    - `rotation_sigma` (3,) about the camera's axes, radians
    - `position`, metres, and `rotation`, radians: the ellipsoids, with directions in the world
    - `freedom`: how many numbers checked the fit; `reach`: semi-axis over its 1 sigma
    """

    position_sigma: Array
    rotation_sigma: Array
    position: Ellipsoid
    rotation: Ellipsoid
    freedom: int
    reach: float

    @property
    def position_total(self) -> float:
        """1 sigma over all directions, metres: the root of the sum of squares."""
        return float(np.linalg.norm(self.position_sigma))

    @property
    def rotation_total(self) -> float:
        """1 sigma over all axes, radians."""
        return float(np.linalg.norm(self.rotation_sigma))


def pose_error(camera: Camera, fit: JointFit) -> PoseError | None:
    """The error of a camera placed by `fit`; None where its covariance is unknown."""
    position, rotation = camera.centre_sigma(), camera.rotation_sigma()
    if camera.covariance is None or position is None or rotation is None:
        return None
    world_from_camera = camera.pose.rotation.T
    reach = reach_95(fit)
    turn, shift = camera.covariance[:3, :3], camera.covariance[3:, 3:]
    return PoseError(
        position,
        rotation,
        ellipsoid(world_from_camera @ shift @ world_from_camera.T, reach),
        ellipsoid(world_from_camera @ turn @ world_from_camera.T, reach),
        fit.asked.freedom,
        reach,
    )


def ellipsoid(covariance: Array, reach: float) -> Ellipsoid:
    """The ellipsoid of a covariance (3, 3) whose semi-axes are `reach` of its sigmas."""
    values, vectors = np.linalg.eigh(covariance)
    directions = vectors.T[::-1]
    signs = np.where(directions.sum(axis=1) < 0, -1.0, 1.0)
    return Ellipsoid(reach * np.sqrt(np.maximum(values[::-1], 0.0)), directions * signs[:, None])


def reach_95(fit: JointFit) -> float:
    """How many of its stated sigmas the 95 % ellipsoid of a fit reaches.

    Three statements are made, and the widest counts, because none can be told from the others:

    - the outlines' own sigmas are right: chi-squared of three degrees of freedom;
    - they are wrong by one factor, known only from how far the sightings disagree: `3 F(3, f)` on
      that scale, whose tails are fat where few sightings tell it;
    - what exceeds them comes from the positions, as the stated covariance has it (`place_sigma`):
      a ball's distance is told too badly to show that, so it is known from fewer equations, two a
      sighting, and judged by `3 F` of those, as far as it makes up the disagreement.

    The stated covariance already carries `misfit`, which only widens; so the scale is taken from
    the sightings themselves.
    """
    freedom = fit.asked.freedom
    found = sum(say.pull for say in fit.says) / freedom
    # the edge bias is told by the balls' sizes, not across the line of sight
    across = max(1, 2 * len(fit.says) - (len(fit.unknowns) - 1))
    of_places = 1 - 1 / fit.disagreement**2 if fit.place_sigma > 0 else 0.0
    squares = (
        CHI_SQUARED_95,
        found * three_f_quantile(freedom),
        of_places * three_f_quantile(across) + (1 - of_places) * CHI_SQUARED_95,
    )
    return math.sqrt(max(squares)) / fit.misfit


@cache
def three_f_quantile(freedom: float, share: float = SHARE) -> float:
    """Three times the quantile of Fisher's F(3, freedom); chi-squared(3)'s for infinitely many.

    >>> round(three_f_quantile(5) / 3, 3), round(three_f_quantile(1e9), 3)
    (5.409, 7.815)
    """
    # beyond, the integrand is so narrow that chi-squared is the better number
    degrees = min(freedom, MANY)
    low, high = 0.0, math.pi / 2
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if _three_f_cdf(middle, degrees) < share else (low, middle)
    if freedom >= MANY and share == SHARE:
        return CHI_SQUARED_95
    return degrees * math.tan(low) ** 2


def three_f_tail(value: float, freedom: float) -> float:
    """The chance that `3 F(3, freedom)` exceeds `value`."""
    degrees = min(freedom, MANY)
    return max(0.0, 1.0 - _three_f_cdf(math.atan(math.sqrt(max(value, 0.0) / degrees)), degrees))


def _three_f_cdf(angle: float, freedom: float) -> float:
    """The chance that `3 F(3, freedom) < freedom tan(angle)^2`.

    The incomplete beta function I_x(3/2, freedom/2) with `x = sin(angle)^2`, which makes its
    integrand smooth: `sin^2 cos^(freedom - 1)`.
    """
    at = 0.5 * angle * (NODES + 1)
    log_beta = math.lgamma(1.5) + math.lgamma(freedom / 2) - math.lgamma(1.5 + freedom / 2)
    integrand = np.sin(at) ** 2 * np.cos(at) ** (freedom - 1)
    return float(angle * (WEIGHTS @ integrand) / math.exp(log_beta))
