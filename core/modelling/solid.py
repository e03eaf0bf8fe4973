# SPDX-License-Identifier: GPL-3.0-or-later
"""A solid while it is being fitted: bare arrays that move along the object's tangent."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..arrays import Array
from ..pose import Pose
from ..primitives import Primitive, polygon_centre
from ..rotation import rotation_from_vector


class Solid(NamedTuple):
    """Where a solid stands, `rotation` (3, 3) and `place` (3,) in the world, and its parameters.

    Nothing is checked here: a fit may pass through shapes that can't be.
    """

    kind: str
    rotation: Array
    place: Array
    parameters: Array

    @staticmethod
    def of(thing: Primitive) -> Solid:
        """The object as a solid."""
        pose = thing.world_from_object
        return Solid(thing.kind, pose.rotation, pose.translation, thing.parameters)

    def moved(self, step: Array) -> Solid:
        """Moved along its tangent (6 + P,): rotation about its origin, motion, parameters."""
        place, parameters = self.place + step[3:6], self.parameters + step[6:]
        rotation = rotation_from_vector(step[:3]) @ self.rotation
        if self.kind == "prism":
            # the polygon's place is the pose's alone
            polygon = parameters[1:].reshape(-1, 2)
            centre = polygon_centre(polygon)
            place = place + rotation[:, :2] @ centre
            parameters = np.concatenate([parameters[:1], (polygon - centre).ravel()])
        return Solid(self.kind, rotation, place, parameters)

    def applied(self, thing: Primitive) -> Primitive:
        """`thing` with this place and shape. Raises InvalidValue for a shape that can't be."""
        pose = Pose(self.rotation, self.place)
        return replace(thing.with_parameters(self.parameters), world_from_object=pose)

    def eye(self, centre_world: Array) -> Array:
        """A world point (3,) in the solid's frame."""
        local: Array = (centre_world - self.place) @ self.rotation
        return local
