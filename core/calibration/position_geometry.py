# SPDX-License-Identifier: GPL-3.0-or-later
"""What a set of ball positions can tell: how long, how far from a line and from a plane it is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array
from ..errors import DegeneratePositions, TooFewSightings

# nearer to a line than this share of their length, positions leave the turn about it to the noise
REFUSED_OFF_LINE, WARNED_OFF_LINE = 0.02, 0.1
SAME_PLACE = 1e-6


@dataclass(frozen=True)
class PositionGeometry:
    """Of N positions: their length, and how far the farthest is off the best line and plane, m."""

    count: int
    length: float
    off_line: float
    off_plane: float

    @property
    def turn_per_millimetre(self) -> float:
        """How far one millimetre of error turns the pose about the best line, radians."""
        return float(np.arctan2(1e-3, self.off_line))

    def warnings(self) -> tuple[str, ...]:
        """What to tell of positions that hold the pose badly."""
        if self.off_line >= WARNED_OFF_LINE * self.length:
            return ()
        return (f"{self.told()}; hold the ball farther off that line once more",)

    def told(self) -> str:
        """The geometry in words, with its effect on the pose."""
        return (
            f"the {self.count} ball positions lie within {1e3 * self.off_line:.1f} mm of a line "
            f"{1e3 * self.length:.0f} mm long: 1 mm of error turns the camera by "
            f"{np.degrees(self.turn_per_millimetre):.2g} deg about it"
        )


def geometry_of(positions_world: ArrayLike) -> PositionGeometry:
    """Measure positions (N, 3) in metres."""
    p = np.asarray(positions_world, dtype=float)
    centred = p - p.mean(axis=0)
    _, _, axes = np.linalg.svd(centred)
    along = centred @ axes.T
    length = float(np.ptp(along[:, 0]))
    off_line = float(np.linalg.norm(along[:, 1:], axis=1).max())
    return PositionGeometry(len(p), length, off_line, float(np.abs(along[:, 2]).max()))


def check_positions(positions_world: ArrayLike) -> PositionGeometry:
    """The geometry of positions that can hold a pose.

    Raises TooFewSightings for fewer than three, DegeneratePositions for fewer than three different
    ones and for positions on a line.
    """
    p = np.asarray(positions_world, dtype=float).reshape(-1, 3)
    if len(p) < 3:
        raise TooFewSightings(
            f"a pose needs the ball at three positions or more, there "
            f"{'is' if len(p) == 1 else 'are'} {len(p)}; add sightings"
        )
    different = _different(p)
    if different < 3:
        raise DegeneratePositions(
            f"the {len(p)} sightings have only {different} different ball position"
            f"{'' if different == 1 else 's'}; three are needed, not on a line"
        )
    geometry = geometry_of(p)
    if geometry.off_line < REFUSED_OFF_LINE * geometry.length:
        raise DegeneratePositions(
            f"{geometry.told()}; hold the ball at least "
            f"{1e3 * WARNED_OFF_LINE * geometry.length:.0f} mm off that line"
        )
    return geometry


def _different(points: Array) -> int:
    """How many different places there are; three stand for more."""
    kept: list[Array] = []
    for point in points:
        if len(kept) == 3:
            break
        if all(np.linalg.norm(point - other) > SAME_PLACE for other in kept):
            kept.append(point)
    return len(kept)
