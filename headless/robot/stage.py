# SPDX-License-Identifier: GPL-3.0-or-later
"""A PyBullet world that is only looked at: shapes in; depth and who is seen, per pixel, out."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core.arrays import Array
from ...core.closing import Closing
from ...core.mesh_part import MeshPart
from ...core.pose import Pose
from .bullet import position_and_quaternion, pybullet
from .environment import WorldMesh


@dataclass(frozen=True, eq=False)
class View:
    """A perspective eye: where it is, what is at its middle, its vertical angle in radians.

    `near` and `far` bound what is seen, in metres along the line of sight.
    """

    eye: Array
    target: Array
    angle: float
    near: float
    far: float

    def camera_from_world(self) -> Pose:
        """OpenCV axes: x right, y down, z forward."""
        return Pose.looking_at(self.eye, self.target, [0, 0, 1])

    def focal(self, height: int) -> float:
        """Focal length in pixels of a picture that high."""
        return float(height / 2 / np.tan(self.angle / 2))


@dataclass(frozen=True, eq=False)
class Layer:
    """What a view sees at each pixel.

    `depth` (H, W) along the optical axis in metres, infinite where nothing is; `body` (H, W) the
    number of the shape, -1 where nothing is.
    """

    view: View
    depth: Array
    body: NDArray[np.int64]

    def points_world(self) -> Array:
        """The seen points (H, W, 3); pixels without any are put at the far end."""
        height, width = self.depth.shape
        rays = pixel_rays(self.view, width, height)
        depth = np.where(np.isfinite(self.depth), self.depth, self.view.far)
        return self.view.camera_from_world().inverse().apply(rays * depth[..., None])


def pixel_rays(view: View, width: int, height: int) -> Array:
    """Where each pixel's centre looks (H, W, 3) in the camera frame, scaled to z = 1."""
    u, v = np.meshgrid(np.arange(width), np.arange(height))
    focal = view.focal(height)
    x, y = (u - (width - 1) / 2) / focal, (v - (height - 1) / 2) / focal
    return np.stack([x, y, np.ones_like(x)], axis=-1)


class Stage(Closing):
    """A world of visual shapes; a context manager that ends it."""

    def __init__(self) -> None:
        self._p: Any = pybullet()
        self._client: int = self._p.connect(self._p.DIRECT)

    def __enter__(self) -> Stage:
        return self

    def close(self) -> None:
        """End the PyBullet world."""
        self._p.disconnect(self._client)

    def add_mesh(self, mesh: WorldMesh) -> int:
        """Triangles where they stand; its number."""
        # one vertex per corner: PyBullet would smooth over the edges of a box otherwise
        corners = mesh.vertices[mesh.faces].reshape(-1, 3)
        return self._add(
            Pose.identity(),
            self._p.GEOM_MESH,
            vertices=corners.tolist(),
            indices=list(range(len(corners))),
        )

    def add_part(self, part: MeshPart) -> int:
        """A link's mesh file where it stands; its number."""
        return self._add(
            part.world_from_mesh,
            self._p.GEOM_MESH,
            fileName=str(part.path),
            meshScale=part.scale.tolist(),
        )

    def move(self, body: int, world_from_shape: Pose) -> None:
        """Put a shape elsewhere."""
        self._p.resetBasePositionAndOrientation(
            body, *position_and_quaternion(world_from_shape), physicsClientId=self._client
        )

    def remove(self, body: int) -> None:
        """Take a shape away."""
        self._p.removeBody(body, physicsClientId=self._client)

    def seen(self, view: View, width: int, height: int) -> Layer:
        """What the view sees."""
        p = self._p
        looking = p.computeViewMatrix(view.eye.tolist(), view.target.tolist(), [0, 0, 1])
        lens = p.computeProjectionMatrixFOV(
            np.degrees(view.angle), width / height, view.near, view.far
        )
        picture = p.getCameraImage(
            width,
            height,
            looking,
            lens,
            shadow=0,
            renderer=p.ER_TINY_RENDERER,
            flags=p.ER_SEGMENTATION_MASK_OBJECT_AND_LINKINDEX,
            physicsClientId=self._client,
        )
        buffer = np.reshape(picture[3], (height, width)).astype(float)
        marks = np.reshape(picture[4], (height, width))
        # the lower 24 bits are the body, above them the link
        body = np.where(marks >= 0, marks & 0xFFFFFF, -1)
        depth = view.far * view.near / (view.far - (view.far - view.near) * buffer)
        return Layer(view, np.where(body >= 0, depth, np.inf), body)

    def _add(self, pose: Pose, kind: int, **shape: Any) -> int:
        looks = self._p.createVisualShape(kind, physicsClientId=self._client, **shape)
        position, quaternion = position_and_quaternion(pose)
        return int(
            self._p.createMultiBody(
                0, -1, looks, position, quaternion, physicsClientId=self._client
            )
        )
