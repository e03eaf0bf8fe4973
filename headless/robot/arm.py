# SPDX-License-Identifier: GPL-3.0-or-later
"""A robot arm from its URDF: joint angles in, poses of the flange, links and ball out, and back."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ...core.arrays import Array, frozen, positive
from ...core.closing import Closing
from ...core.errors import DocumentError, InvalidValue, MissingPackage
from ...core.mesh_part import MeshPart
from ...core.pose import Pose
from ...core.rotation import hat
from .bullet import chatter_off, pose_of, position_and_quaternion, pybullet
from .visuals import Visual, visuals

BASE = -1
# the default arm with its elbow up, its hand forward and down
READY = (0.0, 0.6, 0.0, -1.3, 0.0, 1.2, 0.0)
# a continuous joint has no limits in its URDF; two turns either way are plenty
FREE_TURN = 2 * np.pi


@dataclass(frozen=True, eq=False)
class HeldBall:
    """A ball fixed to the flange: `radius` and its centre (3,) in the flange frame, metres.

    `stem_radius` is that of the straight rod from the flange frame's origin to the ball's centre
    which holds it, None when there is nothing between.
    """

    radius: float
    center_flange: Array
    stem_radius: float | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "radius", positive(self.radius, "ball radius"))
        center = frozen(self.center_flange, (3,), "ball centre in the flange")
        object.__setattr__(self, "center_flange", center)
        if self.stem_radius is not None:
            positive(self.stem_radius, "ball stem_radius")


class Arm(Closing):
    """An arm in a PyBullet world of its own; a context manager that ends that world.

    `joints` (n,) are the angles in radians (metres for sliding joints) of the moving joints between
    the base and the flange, in that order; all others stay at zero. The flange is the frame of the
    URDF link called `flange`, the last link without it. For the default arm (KUKA LBR iiwa 14) that
    is the frame of link 7, whose face lies 45 mm further along its z axis. `rest` (n,) are the
    angles that inverse kinematics is drawn to: zero, but for the default arm, which has better.

    Raises DocumentError for a URDF that can't be read or a flange that is none of its links.
    """

    def __init__(
        self,
        urdf: str | Path | None = None,
        world_from_base: Pose | None = None,
        *,
        flange: str | None = None,
        ball: HeldBall | None = None,
        rest: ArrayLike | None = None,
    ) -> None:
        self.urdf = default_urdf() if urdf is None else Path(urdf)
        self.world_from_base = world_from_base or Pose.identity()
        self.ball = ball
        self._p: Any = pybullet()
        self.client: int = self._p.connect(self._p.DIRECT)
        self._folder = tempfile.TemporaryDirectory(prefix="monocell-arm-")
        try:
            self.body = self._loaded()
            self._read_joints(flange)
            self.rest = self._resting(READY if urdf is None and rest is None else rest)
            self._visuals: tuple[Visual, ...] = visuals(self, Path(self._folder.name))
        except BaseException:
            self.close()
            raise

    def __enter__(self) -> Arm:
        return self

    def close(self) -> None:
        """End the PyBullet world; the mesh files written for primitive visuals go with it."""
        if self._p.isConnected(self.client):
            self._p.disconnect(self.client)
        self._folder.cleanup()

    def link_name(self, link: int) -> str:
        """The URDF's name of a Bullet link index (-1 is the base)."""
        return self._names[link]

    def carrier(self, link: int) -> int:
        """The link next to the base that `link` is rigidly one with: that of a moving joint."""
        while link != BASE and link not in self.moving:
            link = self._parents[link]
        return link

    def neighbours(self, link: int, other: int) -> bool:
        """Whether two links are rigidly one, or one joint apart; such are meant to touch."""
        a, b = self.carrier(link), self.carrier(other)
        return a == b or any(
            x != BASE and self.carrier(self._parents[x]) == y for x, y in ((a, b), (b, a))
        )

    def chain(self, link: int) -> list[int]:
        """The links from the base (left out) to `link`, in order."""
        chain = []
        while link != BASE:
            chain.append(link)
            link = self._parents[link]
        return chain[::-1]

    def checked(self, joints: ArrayLike) -> Array:
        """`joints` as (n,) within the limits. Raises InvalidValue naming the joint."""
        q = frozen(joints, (len(self.moving),), "joints")
        # a limit that went through a file comes back with its last digits changed
        outside = np.flatnonzero((q < self.lower - 1e-6) | (q > self.upper + 1e-6))
        if len(outside):
            i = int(outside[0])
            raise InvalidValue(
                f"joints[{i}]: {q[i]:.4f} is outside {self.joint_names[i]}'s limits "
                f"{self.lower[i]:.4f} to {self.upper[i]:.4f}"
            )
        return q

    def move(self, joints: Array) -> None:
        """Put the arm (and the collision shapes of its links) at `joints`."""
        self._p.resetJointStatesMultiDof(
            self.body, self.moving, joints[:, None].tolist(), physicsClientId=self.client
        )

    def world_from_link(self, link: int) -> Pose:
        """The pose of a link's URDF frame where the arm stands now."""
        if link == BASE:
            return self.world_from_base
        # Bullet also gives the link's own frame, but in single precision
        return self._world_from_mass(link) @ self._mass_from_link[link]

    def world_from_flange(self, joints: ArrayLike) -> Pose:
        """Forward kinematics. Raises InvalidValue for joints outside their limits."""
        self.move(self.checked(joints))
        return self.world_from_link(self.flange)

    def ball_center(self, joints: ArrayLike) -> Array:
        """The held ball's centre (3,) in the world. Raises InvalidValue when there is no ball."""
        if self.ball is None:
            raise InvalidValue("the arm holds no ball; give Arm a HeldBall")
        return self.world_from_flange(joints).apply(self.ball.center_flange)

    def jacobian(self, joints: ArrayLike, point_world: ArrayLike) -> tuple[Array, Array]:
        """How a point (3,) fixed to the flange moves and the flange turns with the joints.

        Two arrays (3, n), in world axes: metres and radians per unit of each joint.
        """
        self.move(self.checked(joints))
        point = np.asarray(point_world, dtype=float)
        columns = [self._column(i, point) for i in range(len(self.moving))]
        return np.array([c[0] for c in columns]).T, np.array([c[1] for c in columns]).T

    def joints_reaching(
        self,
        target: Pose | ArrayLike,
        *,
        point_flange: ArrayLike = (0.0, 0.0, 0.0),
        pointing: ArrayLike | None = None,
        rest: ArrayLike | None = None,
        seed: int = 0,
        starts: int = 48,
        accept: Callable[[Array], bool] | None = None,
    ) -> Array:
        """Joint angles (n,) within the limits that bring the flange to `target`; see `ik.reach`."""
        from .ik import Goal, reach

        goal = Goal.of(target, point_flange, pointing)
        return reach(self, goal, self.rest if rest is None else rest, seed, starts, accept)

    def parts(self, joints: ArrayLike) -> tuple[MeshPart, ...]:
        """The visual meshes where they stand at `joints`, colours in linear light."""
        self.move(self.checked(joints))
        return tuple(
            MeshPart(v.path, self.world_from_link(v.link) @ v.link_from_mesh, v.scale, v.color)
            for v in self._visuals
        )

    def _column(self, i: int, point: Array) -> tuple[Array, Array]:
        # Bullet states the axis in the link's inertial frame
        axis = self._world_from_mass(self.moving[i]).rotate(self._axes[i])
        if self.slides[i]:
            return axis, np.zeros(3)
        origin = self.world_from_link(self.moving[i]).translation
        return hat(axis) @ (point - origin), axis

    def _world_from_mass(self, link: int) -> Pose:
        state = self._p.getLinkState(
            self.body, link, computeForwardKinematics=1, physicsClientId=self.client
        )
        return pose_of(state[0], state[1])

    def _loaded(self) -> int:
        if not self.urdf.is_file():
            raise DocumentError(f"{self.urdf}: there is no such URDF file")
        position, quaternion = position_and_quaternion(self.world_from_base)
        try:
            with chatter_off():
                return int(
                    self._p.loadURDF(
                        str(self.urdf),
                        position,
                        quaternion,
                        useFixedBase=True,
                        physicsClientId=self.client,
                    )
                )
        except self._p.error:
            raise DocumentError(
                f"{self.urdf}: PyBullet can't load this URDF; its reasons are on standard error"
            ) from None

    def _read_joints(self, flange: str | None) -> None:
        count = self._p.getNumJoints(self.body, physicsClientId=self.client)
        infos = [
            self._p.getJointInfo(self.body, i, physicsClientId=self.client) for i in range(count)
        ]
        base = self._p.getBodyInfo(self.body, physicsClientId=self.client)[0].decode()
        self._names: dict[int, str] = {BASE: base} | {
            i: info[12].decode() for i, info in enumerate(infos)
        }
        self._parents = {i: int(info[16]) for i, info in enumerate(infos)}
        self.flange = self._link_called(flange)
        turning = (self._p.JOINT_REVOLUTE, self._p.JOINT_PRISMATIC)
        chain = [i for i in self.chain(self.flange) if infos[i][2] in turning]
        if not chain:
            raise DocumentError(f"{self.urdf}: no joint moves the link {self._names[self.flange]}")
        self.moving = chain
        self.joint_names = tuple(infos[i][1].decode() for i in chain)
        self._axes = [np.array(infos[i][13]) for i in chain]
        self.slides = [infos[i][2] == self._p.JOINT_PRISMATIC for i in chain]
        limits = [
            (lo, hi) if lo < hi else (-FREE_TURN, FREE_TURN)
            for lo, hi in (infos[i][8:10] for i in chain)
        ]
        self.lower = frozen([lo for lo, _ in limits], (None,), "lower limits")
        self.upper = frozen([hi for _, hi in limits], (None,), "upper limits")
        self.links = (BASE, *range(count))
        self._mass_from_link = {i: self._inertial_frame(i).inverse() for i in range(count)}
        # what no joint of ours moves can't be brought into collision, nor out of it
        self.fixed_links = frozenset(i for i in self.links if self.carrier(i) == BASE)

    def _resting(self, rest: ArrayLike | None) -> Array:
        zero = np.clip(np.zeros(len(self.moving)), self.lower, self.upper)
        return zero if rest is None else self.checked(rest)

    def _inertial_frame(self, link: int) -> Pose:
        info = self._p.getDynamicsInfo(self.body, link, physicsClientId=self.client)
        return pose_of(info[3], info[4])

    def _link_called(self, flange: str | None) -> int:
        if flange is None:
            return max(self._names)
        for link, name in self._names.items():
            if name == flange:
                return link
        raise DocumentError(
            f"{self.urdf}: no link is called {flange!r}; there is {', '.join(self._names.values())}"
        )


def default_urdf() -> Path:
    """The KUKA LBR iiwa 14 that comes with pybullet. Raises MissingPackage."""
    pybullet()
    try:
        import pybullet_data
    except ImportError:
        raise MissingPackage(
            "pybullet_data is not installed; install it with: pip install 'monocell[robot]'"
        ) from None
    return Path(pybullet_data.getDataPath()) / "kuka_iiwa" / "model.urdf"
