# SPDX-License-Identifier: GPL-3.0-or-later
"""Pixels picked on a cylinder in, their distances in pixels to any cylinder's exact outline out.

The outline is what the lens makes of the base circle, the top circle and the two lines where the
plane of sight touches.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..arrays import Array
from ..intrinsics import Intrinsics
from ..pose import Pose
from .curve_distance import Curve, Feet, nearest_feet, nearest_samples
from .pick_fit import PickEquations

CIRCLE_SAMPLES = np.linspace(-np.pi, np.pi, 48, endpoint=False)
LONGEST_TURN = 0.2
# a pick this far (in radians) behind the limb is hidden for sure
LIMB_MARGIN = 0.15


@dataclass(frozen=True, eq=False)
class CylinderPicks:
    """Pixels (N, 2) picked on the base circle, the top circle and the sides of one cylinder."""

    intrinsics: Intrinsics
    camera_from_plane: Pose
    rim: Array
    top: Array
    sides: Array

    def equations(self, parameters: Array) -> PickEquations:
        """Signed distances of rim, top and sides from (x, y, radius, height), with derivatives."""
        x, y, radius, height = parameters
        on_top = np.repeat([0.0, 1.0], [len(self.rim), len(self.top)])
        circles = self._circle_feet(x, y, radius, height * on_top)
        angles, sides = self._side_feet(x, y, radius)
        # where the touching point turns round the cylinder it stays in the plane of sight, so that
        # the outline's image only slides along itself: its motion needs no term here
        parts = [
            _by_parameters(circles, _outward(circles.parameters), on_top),
            _by_parameters(sides, _outward(angles), np.zeros(len(angles))),
        ]
        return PickEquations(
            np.concatenate([p.residuals for p in parts]),
            np.concatenate([p.by_parameters for p in parts]),
            np.concatenate([p.by_twist for p in parts]),
        )

    def hidden(self, parameters: Array) -> int:
        """How many rim and top picks would lie where the cylinder hides its own circles."""
        x, y, radius, height = parameters
        origin = self.camera_from_plane.inverse().translation
        away = origin[:2] - [x, y]
        facing = np.arctan2(away[1], away[0])
        limb = np.arccos(min(radius / max(float(np.hypot(*away)), 1e-300), 1.0))
        levels = np.repeat([0.0, height], [len(self.rim), len(self.top)])
        feet = self._circle_feet(x, y, radius, levels)
        turned = np.abs(np.angle(np.exp(1j * (feet.parameters - facing))))
        seen_from_above = (levels > 0) & (origin[2] > height)
        return int(((turned > limb + LIMB_MARGIN) & ~seen_from_above).sum())

    def _circle_feet(self, x: float, y: float, radius: float, levels: Array) -> Feet:
        pixels = np.concatenate([self.rim, self.top])
        scene = (
            self.intrinsics,
            self.camera_from_plane,
            _circle_curve(x, y, radius, levels),
        )
        starts = nearest_samples(*scene, CIRCLE_SAMPLES, pixels)
        return nearest_feet(*scene, starts, pixels, LONGEST_TURN)

    def _side_feet(self, x: float, y: float, radius: float) -> tuple[Array, Feet]:
        angles, levels = self._silhouettes(x, y, radius)
        curve = _upright_curve(x, y, radius, angles)
        feet = nearest_feet(
            self.intrinsics, self.camera_from_plane, curve, levels, self.sides, np.inf
        )
        return angles, feet

    @cached_property
    def _side_rays(self) -> Array:
        return self.camera_from_plane.inverse().rotate(self.intrinsics.rays(self.sides))

    def _silhouettes(self, x: float, y: float, radius: float) -> tuple[Array, Array]:
        """The angle of the outline that each side pick is on, and the level where its ray passes.

        The outlines are where the plane of sight touches: outward . (origin - centre) = radius.
        NaN when the camera is inside the endless cylinder, from where no side is seen edge-on.
        """
        origin, rays = self.camera_from_plane.inverse().translation, self._side_rays
        away = origin[:2] - [x, y]
        distance = float(np.hypot(*away))
        half = np.arccos(radius / distance) if distance > abs(radius) else np.nan
        flat = rays[:, :2]
        side = np.where(away[0] * flat[:, 1] - away[1] * flat[:, 0] > 0, 1.0, -1.0)
        angles = np.arctan2(away[1], away[0]) + side * half
        touching = np.array([x, y]) + radius * _outward(angles)[:, :2]
        depth = ((touching - origin[:2]) * flat).sum(1) / np.maximum((flat**2).sum(1), 1e-18)
        return angles, origin[2] + depth * rays[:, 2]


def _by_parameters(feet: Feet, outward: Array, raised: Array) -> PickEquations:
    by = np.empty((len(feet.distances), 4))
    by[:, :2] = feet.by_point[:, :2]
    by[:, 2] = (feet.by_point * outward).sum(1)
    by[:, 3] = feet.by_point[:, 2] * raised
    return PickEquations(feet.distances, by, feet.by_twist)


def _outward(angles: Array) -> Array:
    return np.stack([np.cos(angles), np.sin(angles), np.zeros_like(angles)], axis=-1)


def _circle_curve(x: float, y: float, radius: float, levels: Array) -> Curve:
    centres = np.column_stack([np.full_like(levels, x), np.full_like(levels, y), levels])

    def curve(angles: Array) -> tuple[Array, Array]:
        outward = _outward(angles)
        tangents = radius * (outward @ [[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 0.0]])
        return centres + radius * outward, tangents

    return curve


def _upright_curve(x: float, y: float, radius: float, angles: Array) -> Curve:
    def curve(levels: Array) -> tuple[Array, Array]:
        up = np.zeros((*levels.shape, 3))
        up[..., 2] = 1.0
        return np.array([x, y, 0.0]) + radius * _outward(angles) + levels[..., None] * up, up

    return curve
