# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects, composites and how they move in; bodies in a PyBullet world with their joints out.

What stands still is a body of its own without mass. What moves as one, with all that hangs on it by
hinges and sliders, is one multibody: exact masses, centres of mass and moments of inertia, joints
with their limits and without motors. Nothing moves before the world is stepped.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...core.arrays import Array
from ...core.bodies import Body, rigid_bodies
from ...core.composite import Composite
from ...core.pose import Pose
from ...core.primitives import Primitive
from ...core.shape.mass import centre_of_mass, inertia
from ...core.shape.masses import DEFAULT_DENSITY, masses
from .bullet import pose_of, position_and_quaternion, pybullet
from .shapes import add_obstacle, collision_shape

BASE = -1


@dataclass(frozen=True, eq=False)
class Placed:
    """Where an object is in the world: link `link` (-1 is the base) of the body `body`.

    `mass_from_object` leads from the object's frame to the link's centre of mass, which is what
    Bullet tells the pose of.
    """

    body: int
    link: int
    mass_from_object: Pose


@dataclass(frozen=True, eq=False)
class _Link:
    """An object on its way into a multibody: its frame stands at the joint, turned as the object.

    `parent` is a number in the same list; the first has none.
    """

    thing: Primitive
    mass: float
    frame_from_object: Pose
    frame_from_mass: Pose
    moments: Array
    parent: int | None
    joint: str
    axis: Array
    limits: tuple[float, float] | None


def add_objects(
    client: int, objects: Sequence[Primitive], composites: Sequence[Composite] = ()
) -> tuple[tuple[Placed, ...], tuple[str, ...]]:
    """Put all objects into the world; where each is, and what had to be assumed.

    What moves and says neither mass nor density is as dense as water. Raises InvalidValue for
    joints that can't be, naming the objects, and for masses given twice.
    """
    bodies = rigid_bodies(objects, composites)
    weights, assumed = masses(objects, composites)
    placed: dict[int, Placed] = {}
    for root, tree in _trees(bodies):
        if bodies[root].motion.kind == "static":
            for part in bodies[root].parts[1 if len(tree) > 1 else 0 :]:
                placed[part] = _standing(client, objects[part])
        if len(tree) > 1 or bodies[root].motion.kind != "static":
            placed |= _add_tree(client, objects, weights, bodies, tree)
    moving = {part for body in bodies if body.motion.kind != "static" for part in body.parts}
    unsure = [objects[i].name for i in sorted(moving) if objects[i].name in assumed]
    warnings = (
        (
            f"no mass or density is given of {', '.join(unsure)}: taken as {DEFAULT_DENSITY:g} "
            "kg/m^3, the density of water",
        )
        if unsure
        else ()
    )
    return tuple(placed[i] for i in range(len(objects))), warnings


def world_from_object(client: int, placed: Placed) -> Pose:
    """Where an object stands now, after the world may have been stepped."""
    p: Any = pybullet()
    if placed.link == BASE:
        state = p.getBasePositionAndOrientation(placed.body, physicsClientId=client)
    else:
        state = p.getLinkState(
            placed.body, placed.link, computeForwardKinematics=1, physicsClientId=client
        )
    return pose_of(state[0], state[1]) @ placed.mass_from_object


def _trees(bodies: Sequence[Body]) -> list[tuple[int, list[int]]]:
    """Each body that hangs on none, with all that hang on it, itself first."""
    trees: dict[int, list[int]] = {}
    root_of: dict[int, int] = {}
    for i, body in enumerate(bodies):
        root_of[i] = i if body.parent is None else root_of[body.parent]
        trees.setdefault(root_of[i], []).append(i)
    return list(trees.items())


def _standing(client: int, thing: Primitive) -> Placed:
    return Placed(add_obstacle(client, thing), BASE, Pose.identity())


def _add_tree(
    client: int,
    objects: Sequence[Primitive],
    weights: Array,
    bodies: Sequence[Body],
    tree: Sequence[int],
) -> dict[int, Placed]:
    links: list[_Link] = []
    number: dict[int, int] = {}
    for i in tree:
        body = bodies[i]
        still = body.motion.kind == "static"
        # the parts of a static root that no joint needs are bodies of their own
        for part in body.parts[: 1 if still else None]:
            number[part] = len(links)
            parent = None
            if part != body.parts[0]:
                parent = number[body.parts[0]]
            elif body.parent is not None:
                parent = number[bodies[body.parent].parts[0]]
            mass = 0.0 if still else float(weights[part])
            links.append(_link(objects[part], mass, body, parent, joined=part == body.owner))
    made = _create(client, links)
    return {part: Placed(made, k - 1, _mass_from_object(links[k])) for part, k in number.items()}


def _link(thing: Primitive, mass: float, body: Body, parent: int | None, joined: bool) -> _Link:
    motion = body.motion
    joint = motion.joint if joined and motion.joint in ("hinge", "slider") else "fixed"
    axis, point = np.array([0.0, 0, 1]), np.zeros(3)
    if joint != "fixed" and motion.axis is not None and motion.point is not None:
        axis, point = motion.axis, motion.point
    moments, turn = np.linalg.eigh(inertia(thing))
    if np.linalg.det(turn) < 0:
        turn[:, 0] *= -1
    frame_from_object = Pose(np.eye(3), -point)
    frame_from_mass = frame_from_object @ Pose(turn, centre_of_mass(thing))
    limits = motion.limits if joint != "fixed" else None
    return _Link(
        thing,
        mass,
        frame_from_object,
        frame_from_mass,
        moments * mass,
        parent,
        joint or "fixed",
        axis,
        limits,
    )


def _mass_from_object(link: _Link) -> Pose:
    return link.frame_from_mass.inverse() @ link.frame_from_object


def _create(client: int, links: Sequence[_Link]) -> int:
    p: Any = pybullet()
    joints = {"fixed": p.JOINT_FIXED, "hinge": p.JOINT_REVOLUTE, "slider": p.JOINT_PRISMATIC}
    shapes = [collision_shape(client, k.thing, k.frame_from_object) for k in links]
    frames = [k.thing.world_from_object @ k.frame_from_object.inverse() for k in links]
    offsets = [
        position_and_quaternion(frames[k.parent].inverse() @ frame)
        for k, frame in zip(links[1:], frames[1:], strict=True)
        if k.parent is not None
    ]
    masses_at = [position_and_quaternion(k.frame_from_mass) for k in links]
    base = position_and_quaternion(frames[0])
    rest = links[1:]
    body = p.createMultiBody(
        links[0].mass,
        shapes[0],
        -1,
        *base,
        baseInertialFramePosition=masses_at[0][0],
        baseInertialFrameOrientation=masses_at[0][1],
        linkMasses=[k.mass for k in rest],
        linkCollisionShapeIndices=shapes[1:],
        linkVisualShapeIndices=[-1] * len(rest),
        linkPositions=[at for at, _ in offsets],
        linkOrientations=[turn for _, turn in offsets],
        linkInertialFramePositions=[at for at, _ in masses_at[1:]],
        linkInertialFrameOrientations=[turn for _, turn in masses_at[1:]],
        # Bullet counts the base as 0 here, the links from 1
        linkParentIndices=[k.parent for k in rest],
        linkJointTypes=[joints[k.joint] for k in rest],
        linkJointAxis=[k.axis.tolist() for k in rest],
        physicsClientId=client,
    )
    for i, link in enumerate(links):
        _set_dynamics(client, body, i - 1, link)
    return int(body)


def _set_dynamics(client: int, body: int, number: int, link: _Link) -> None:
    p: Any = pybullet()
    if link.mass > 0:
        moments = link.moments.tolist()
        p.changeDynamics(body, number, localInertiaDiagonal=moments, physicsClientId=client)
    if link.joint == "fixed":
        return
    # Bullet brakes every joint until it is told not to
    p.setJointMotorControl2(body, number, p.VELOCITY_CONTROL, force=0, physicsClientId=client)
    if link.limits is not None:
        # in a call of their own: given with anything else, Bullet forgets them
        lower, upper = link.limits
        p.changeDynamics(
            body, number, jointLowerLimit=lower, jointUpperLimit=upper, physicsClientId=client
        )
