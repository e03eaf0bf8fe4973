# SPDX-License-Identifier: GPL-3.0-or-later
"""A camera that rides on the robot's flange: its place there, and where the flange stood."""

from __future__ import annotations

from dataclasses import dataclass, replace

from .arrays import Array
from .camera import Camera
from .covariance import checked_covariance
from .pose import Pose


@dataclass(frozen=True, eq=False)
class Mount:
    """Where the camera sits on the flange: `camera_from_flange`, absent until calibrated.

    `covariance` (6, 6) is on its left twist, in the camera frame; `world_from_flange` is where the
    flange stood when the cell's picture was taken.
    """

    camera_from_flange: Pose | None = None
    covariance: Array | None = None
    world_from_flange: Pose | None = None

    def __post_init__(self) -> None:
        if self.covariance is not None:
            checked = checked_covariance(self.covariance, 6, "mount.covariance")
            object.__setattr__(self, "covariance", checked)

    def placed(self, camera: Camera) -> Camera:
        """The camera as it stood for the cell's picture; without a pose where that is not known.

        `camera_from_world = camera_from_flange . flange_from_world`; a left twist stays the same,
        and so does its covariance.
        """
        if self.camera_from_flange is None or self.world_from_flange is None:
            return replace(camera, camera_from_world=None, covariance=None)
        camera_from_world = self.camera_from_flange @ self.world_from_flange.inverse()
        return camera.placed(camera_from_world, self.covariance)
