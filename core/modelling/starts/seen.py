# SPDX-License-Identifier: GPL-3.0-or-later
"""The rays of an object's picks in, how far each is from any guess of the solid out.

Distances are taken between rays and solid, across the ray and over its length: pixels to first
order, whatever the lens, without projecting anything.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ...arrays import Array
from ...rotation import hat
from .trials import Trials

HEIGHT = {"cylinder": 1, "cone": 2, "tube": 2}
# of a cylinder both ends have its one radius
TOP_RADIUS = {"cylinder": 0, "cone": 1, "tube": 0}
# radii beyond this share of the distance are doubted, by so many pixels for every such share
LARGE, GENTLE = 0.3, 3.0


def _no_rays() -> Array:
    return np.zeros((0, 3))


@dataclass(frozen=True, eq=False)
class Seen:
    """Unit rays (N, 3) in the world from `origin` (3,), by what they were picked on.

    `points` go to the material points `by` (K, 3, P) (see `core.shape.anchors`), `rim` and `top` to
    the ends of a round solid, `hole` to the inner rim at the end that faces the camera, `sides` to
    its silhouette, `outline` to a ball's. `focal` turns radians into pixels.
    """

    kind: str
    origin: Array
    focal: float
    points: Array = field(default_factory=_no_rays)
    by: Array = field(default_factory=lambda: np.zeros((0, 3, 1)))
    rim: Array = field(default_factory=_no_rays)
    top: Array = field(default_factory=_no_rays)
    hole: Array = field(default_factory=_no_rays)
    sides: Array = field(default_factory=_no_rays)
    outline: Array = field(default_factory=_no_rays)

    def residuals(self, trials: Trials) -> Array:
        """Of every guess, (M, R), in pixels to first order; a point gives three, of rank two."""
        if self.kind == "sphere":
            return self.focal * self._outline(trials)
        parts = [self._points(trials)] if len(self.points) else []
        if self.kind in HEIGHT:
            parts += [*self._round(trials), self._too_large(trials)]
        return self.focal * np.concatenate(parts, axis=1)

    def facing(self, trials: Trials) -> Array:
        """+1 where the top is the end nearer to the camera, -1 where the base is, (M,)."""
        towards = ((self.origin - trials.place) * trials.rotation[:, :, 2]).sum(axis=1)
        side: Array = np.where(towards >= 0, 1.0, -1.0)
        return side

    def _points(self, trials: Trials) -> Array:
        sight = trials.points(self.by) - self.origin
        away = np.sqrt((sight**2).sum(axis=2, keepdims=True))
        missed = (sight[:, :, None] @ hat(self.points))[:, :, 0] / away
        behind = (sight * self.points).sum(axis=2) <= 0
        missed[behind] = np.inf
        return missed.reshape(len(trials), 3 * len(self.points))

    def _round(self, trials: Trials) -> list[Array]:
        radius = trials.parameters[:, 0]
        top = trials.parameters[:, TOP_RADIUS[self.kind]]
        parts = []
        below = np.full(len(trials), -1.0)
        if len(self.rim):
            parts.append(self._ring(trials, below, radius, self.rim))
        if len(self.top):
            parts.append(self._ring(trials, -below, top, self.top))
        if len(self.hole):
            inner = trials.parameters[:, 1]
            parts.append(self._ring(trials, self.facing(trials), inner, self.hole))
        if len(self.sides):
            parts.append(self._sides(trials, radius, top))
        return parts

    def _too_large(self, trials: Trials) -> Array:
        """A gentle push back from radii that only picks which tell nothing would make so large."""
        away = np.linalg.norm(trials.place - self.origin, axis=1)
        share = np.abs(trials.parameters[:, 0]) / away / LARGE
        push: Array = GENTLE / self.focal * np.maximum(share - 1.0, 0.0)[:, None]
        return push

    def _ring(self, trials: Trials, end: Array, radius: Array, rays: Array) -> Array:
        """Angles (M, N) between rays and the circle round an end, across its image."""
        axis = trials.rotation[:, :, 2]
        level = (end * trials.parameters[:, HEIGHT[self.kind]] / 2)[:, None]
        centre = trials.place + level * axis - self.origin
        along = axis @ rays.T
        # the way round the circle times the distance from its centre, as far as it is along a ray
        square = (hat(axis) @ centre[:, :, None])[:, :, 0] @ rays.T
        with np.errstate(divide="ignore", invalid="ignore"):
            depth = (centre * axis).sum(axis=1)[:, None] / along
            away2 = depth * (depth - 2 * centre @ rays.T) + (centre**2).sum(axis=1)[:, None]
            away = np.sqrt(np.maximum(away2, 1e-18))
            # foreshortened as seen
            turned = np.sqrt(np.maximum(1 - (square / away) ** 2, 1e-12))
            missed = (away - radius[:, None]) * np.abs(along) / (depth * turned)
        return np.where(depth > 0, missed, np.inf)

    def _sides(self, trials: Trials, radius: Array, top: Array) -> Array:
        """Angles (M, N) by which rays miss the endless cone through both ends."""
        height = trials.parameters[:, HEIGHT[self.kind]]
        slope = ((radius - top) / np.where(height == 0, np.nan, height))[:, None]
        local = np.swapaxes(trials.rotation, 1, 2)
        eye = (local @ (self.origin - trials.place)[:, :, None])[:, None, :, 0]
        rays = self.sides @ np.swapaxes(local, 1, 2)
        with np.errstate(divide="ignore", invalid="ignore"):
            flat = np.sqrt((rays[:, :, :2] ** 2).sum(axis=2))
            nearest = -(eye[:, :, :2] * rays[:, :, :2]).sum(axis=2) / flat**2
            away = np.abs(eye[:, :, 0] * rays[:, :, 1] - eye[:, :, 1] * rays[:, :, 0]) / flat
            # where the ray comes nearest to a cone, not to its axis
            lean = slope * rays[:, :, 2] / flat
            level = np.sqrt(np.maximum(1 - lean**2, 1e-12))
            depth = nearest - lean * away / (flat * level)
            out = away * level + slope * (eye[:, :, 2] + nearest * rays[:, :, 2])
            missed = (out - ((radius + top) / 2)[:, None]) / (depth * np.sqrt(1 + slope**2))
        # from inside the endless cone, or from over its point, no side is seen edge-on
        reach = np.abs((radius + top) / 2 - slope[:, 0] * eye[:, 0, 2])
        shown = reach < np.hypot(eye[:, 0, 0], eye[:, 0, 1])
        return np.where((depth > 0) & shown[:, None], missed, np.inf)

    def _outline(self, trials: Trials) -> Array:
        sight = trials.place - self.origin
        away = np.linalg.norm(sight, axis=1)
        axis = sight / away[:, None]
        across = np.linalg.norm(np.cross(axis[:, None], self.outline), axis=2)
        angle = np.arctan2(across, axis @ self.outline.T)
        share = trials.parameters[:, 0] / away
        with np.errstate(invalid="ignore"):
            missed: Array = angle - np.arcsin(np.where(np.abs(share) < 1, share, np.nan))[:, None]
        return missed
