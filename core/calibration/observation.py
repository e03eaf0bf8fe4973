# SPDX-License-Identifier: GPL-3.0-or-later
"""What was measured of one target, and where the robot says it is: the fit's input, one a sighting.

One equation holds for every cell: `centre_camera = camera_from_base . base_from_carrier . offset`.
A ball at a known place has the world as its carrier; one on the flange of an arm before a fixed
camera is carried by the flange; before a camera on the flange, the flange is the base and the world
carries the ball.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from ..arrays import Array
from ..ball.sphere import OutlineRays
from ..intrinsics import Intrinsics
from ..pose import Pose

IDENTITY = Pose.identity()


@dataclass(frozen=True, eq=False)
class Place:
    """Where a target is: `offset` (3,) in a carrier that stands at `base_from_carrier`, metres.

    An `offset` of None is unknown, and is the same for all sightings of one `target`.
    """

    offset: Array | None
    base_from_carrier: Pose = field(default=IDENTITY)
    target: str = ""

    def in_base(self, offset: Array | None = None) -> Array:
        """The place (3,) in the base, with the `offset` given where it is unknown."""
        known = self.offset if self.offset is not None else offset
        assert known is not None
        return self.base_from_carrier.apply(known)


@dataclass(frozen=True, eq=False)
class OutlineObservation:
    """Outline points (N,) of a ball of `radius` metres at `place`, with their sigmas (N,).

    Without `intrinsics` the lens is not asked and can't be refined.
    """

    outline: OutlineRays
    sigma_pixels: Array
    place: Place
    radius: float
    intrinsics: Intrinsics | None = None


@dataclass(frozen=True, eq=False)
class PointObservation:
    """A point at `place`, seen at one pixel, `outline` (1,), whose numbers have `sigma_pixels`."""

    outline: OutlineRays
    sigma_pixels: float
    place: Place
    intrinsics: Intrinsics | None = None


Observation = OutlineObservation | PointObservation


def numbers_told(observation: Observation) -> int:
    """How many numbers of its target's centre a sighting tells: three of a ball, two of a point."""
    return 3 if isinstance(observation, OutlineObservation) else 2
