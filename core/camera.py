# SPDX-License-Identifier: GPL-3.0-or-later
"""A camera in the world: intrinsics, pose and the pose's covariance."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from .arrays import Array
from .covariance import checked_covariance
from .errors import NoPose
from .intrinsics import Intrinsics
from .pose import Pose


@dataclass(frozen=True, eq=False)
class Camera:
    """Intrinsics with a `camera_from_world`, absent until the camera is calibrated.

    `covariance` (6, 6) is on the twist of `Pose.perturbed`: rotation vector in radians, then
    translation in metres, both in the camera frame. It is None when nothing is known of the error.
    """

    intrinsics: Intrinsics
    camera_from_world: Pose | None = None
    covariance: Array | None = None

    def __post_init__(self) -> None:
        if self.covariance is not None:
            object.__setattr__(
                self, "covariance", checked_covariance(self.covariance, 6, "camera.covariance")
            )

    @property
    def pose(self) -> Pose:
        """`camera_from_world`. Raises NoPose when the camera is not calibrated yet."""
        if self.camera_from_world is None:
            raise NoPose("the camera has no pose yet: calibrate it, or give camera_from_world")
        return self.camera_from_world

    @property
    def centre_world(self) -> Array:
        """The optical centre (3,) in the world."""
        return self.pose.inverse().translation

    def placed(self, camera_from_world: Pose, covariance: ArrayLike | None = None) -> Camera:
        """The same camera at another place."""
        matrix = None if covariance is None else np.asarray(covariance, dtype=float)
        return replace(self, camera_from_world=camera_from_world, covariance=matrix)

    def project(self, points_world: ArrayLike) -> Array:
        """World points (N, 3) to pixels (N, 2); NaN where they are not imaged."""
        return self.intrinsics.project(self.pose.apply(points_world))

    def rays_world(self, pixels: ArrayLike) -> tuple[Array, Array]:
        """Where the rays of pixels (N, 2) start, (3,), and their unit directions (N, 3)."""
        pose = self.pose.inverse()
        return pose.translation, pose.rotate(self.intrinsics.rays(pixels))

    def centre_sigma(self) -> Array | None:
        """1 sigma of the optical centre along the world axes, (3,) in metres."""
        if self.covariance is None:
            return None
        # the centre moves by -R^T v under the twist (w, v): rotating about itself moves nothing
        rotation = self.pose.rotation
        return np.sqrt(np.diag(rotation.T @ self.covariance[3:, 3:] @ rotation))

    def rotation_sigma(self) -> Array | None:
        """1 sigma of the rotation about the camera's axes, (3,) in radians."""
        return None if self.covariance is None else np.sqrt(np.diag(self.covariance[:3, :3]))
