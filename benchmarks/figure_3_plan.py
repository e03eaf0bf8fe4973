# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene of the paper's figure 3, rebuilt: what stands and hangs where, what is picked of it.

Blocks and a drum on the floor; an arm of a base, a trunk on it, a shoulder across the trunk, an
upper arm flush with the shoulder's end, a forearm at a right angle to that; two balls that hang
from nothing that is seen.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from honest_hand import ball_picks, box_picks, can_picks, hand_of
from monocell.core.appearance import Appearance
from monocell.core.camera import Camera
from monocell.core.distortion import Distortion
from monocell.core.intrinsics import Intrinsics
from monocell.core.pose import Pose
from monocell.core.primitives import Box, Cylinder, Primitive, Sphere
from monocell.core.reference import ReferencePlane
from monocell.core.relation import Relation
from monocell.core.rotation import rotation_from_vector
from monocell.core.sketch import Sketch
from monocell.scene.work_cell import Lab, Table, WorkCell

PICK_SIGMA_PIXELS = 1.0
FLOOR = ReferencePlane("floor", np.zeros(3), np.array([0.0, 0.0, 1.0]))
UP = np.array([0.0, 0.0, 1.0])
# where the arm stands, which way its shoulder points, and how far its upper arm leans
ARM = np.array([0.10, 0.25])
SHOULDER_AZIMUTH, LEAN = np.radians(-68.0), np.radians(34.0)

# what the operator says of each, beside its pixels
RELATIONS = {
    "trunk": (Relation("stands_on", "base.top"), Relation("centred_on", "base.axis")),
    "shoulder": (
        Relation("perpendicular", "trunk.axis"),
        Relation("centred_on", "trunk.axis"),
    ),
    "upper arm": (Relation("leans_on", "shoulder.top", own="y-"),),
    "forearm": (Relation("stands_on", "upper arm.x-"),),
}
KNOWN = {"ball": {"radius": 0.06}, "small ball": {"radius": 0.045}}
ON_FLOOR = ("block", "post", "beam", "drum", "base")


def true_things() -> tuple[Primitive, ...]:
    """Everything in the scene, as it is."""
    return (*_on_floor(), *_arm(), *_balls())


def camera() -> Camera:
    """Who looks: 2.8 m away, a usual lens."""
    lens = Distortion("plumb_bob", np.array([-0.11, 0.04, 0.0003, -0.0004, 0.0]))
    intrinsics = Intrinsics(1280, 960, 1180.0, 1177.0, 644.0, 472.0, lens)
    return Camera(intrinsics, Pose.looking_at([2.25, -1.55, 1.5], [0.2, -0.02, 0.44], UP))


def other_side() -> Camera:
    """Another place to look from, on the other side of the arm, with a perfect lens."""
    intrinsics = Intrinsics(960, 720, 900.0, 900.0, 479.5, 359.5)
    return Camera(intrinsics, Pose.looking_at([1.3, 1.95, 1.6], [0.25, 0.0, 0.42], UP))


def work_cell(things: tuple[Primitive, ...]) -> WorkCell:
    """These things in a hall, on a floor panel."""
    lab = Lab(
        table_dark=np.array([0.27, 0.28, 0.29]),
        table_light=np.array([0.34, 0.35, 0.36]),
        grain=np.full(3, 9.0),
        wall=np.array([0.50, 0.53, 0.55]),
        dado=np.array([0.10, 0.17, 0.21]),
        lamp_watts=105.0,
        to_lamp=np.array([0.75, -0.35, 1.0]),
    )
    table = Table(np.array([0.3, 0.0]), np.array([2.6, 2.4]), 0.1)
    return WorkCell(camera(), things, table=table, lab=lab)


def sketches(seed: int = 3) -> tuple[Sketch, ...]:
    """What an operator picks of the picture, each point off by a pixel, and says of each thing."""
    looking, things = camera(), true_things()
    hand = hand_of(looking, np.random.default_rng([109, seed]), PICK_SIGMA_PIXELS)
    eye = looking.centre_world
    picked = []
    for thing in things:
        others = [other for other in things if other is not thing]
        if isinstance(thing, Box):
            picks = box_picks(thing, eye, others, hand)
        elif isinstance(thing, Cylinder):
            picks = can_picks(thing, eye, others, hand)
        else:
            picks = ball_picks(thing, looking, others, hand)
        picked.append(
            Sketch(
                thing.name,
                thing.kind,
                "floor" if thing.name in ON_FLOOR else None,
                picks,
                KNOWN.get(thing.name, {}),
                thing.appearance,
                RELATIONS.get(thing.name, ()),
            )
        )
    return tuple(picked)


def _on_floor() -> list[Primitive]:
    things: list[Primitive] = [
        _block("block", (0.72, 0.12), 25, (0.26, 0.18, 0.14), (0.62, 0.16, 0.05)),
        _block("post", (0.98, -0.22), -12, (0.14, 0.14, 0.26), (0.04, 0.20, 0.42)),
        _block("beam", (0.30, -0.55), 52, (0.42, 0.10, 0.11), (0.58, 0.42, 0.06)),
    ]
    things.append(_can("drum", (-0.25, -0.42), 0.0, 0.15, 0.34, (0.05, 0.30, 0.16)))
    return things


def _arm() -> list[Primitive]:
    grey, orange = (0.30, 0.31, 0.33), (0.72, 0.24, 0.03)
    base = _can("base", ARM, 0.0, 0.17, 0.12, (0.10, 0.10, 0.11))
    trunk = _can("trunk", ARM, 0.12, 0.095, 0.46, orange)
    across = np.array([np.cos(SHOULDER_AZIMUTH), np.sin(SHOULDER_AZIMUTH), 0.0])
    ahead = np.cross(UP, across)
    middle = np.array([*ARM, 0.66])
    # its z axis along `across`: towards the camera is its top
    turned = np.stack([np.cross(UP, across), UP, across], axis=1)
    shoulder = Cylinder("shoulder", Pose(turned, middle), radius=0.08, height=0.36)
    along = np.cos(LEAN) * UP + np.sin(LEAN) * ahead
    rotation = np.stack([np.cross(across, along), across, along], axis=1)
    size = np.array([0.10, 0.08, 0.48])
    root = middle + across * (0.18 + size[1] / 2)
    upper = Box("upper arm", Pose(rotation, root + 0.17 * along), size=size)
    # the forearm stands on the face that looks ahead and down
    forward = -rotation[:, 0]
    side = np.stack([np.cross(across, forward), across, forward], axis=1)
    start = root + 0.345 * along + forward * size[0] / 2
    forearm = Cylinder("forearm", Pose(side, start + 0.2 * forward), radius=0.036, height=0.4)
    return [
        base,
        trunk,
        _coloured(shoulder, grey),
        _coloured(upper, orange),
        _coloured(forearm, grey),
    ]


def _balls() -> list[Primitive]:
    ball = Sphere("ball", Pose(np.eye(3), np.array([0.95, 0.62, 0.86])), radius=0.06)
    small = Sphere("small ball", Pose(np.eye(3), np.array([0.30, -0.75, 0.72])), radius=0.045)
    return [_coloured(ball, (0.75, 0.70, 0.62)), _coloured(small, (0.60, 0.05, 0.10))]


def _block(
    name: str,
    place: tuple[float, float],
    degrees: float,
    size: tuple[float, float, float],
    color: tuple[float, float, float],
) -> Primitive:
    turn = rotation_from_vector(np.radians(degrees) * UP)
    return _coloured(
        Box(name, Pose(turn, np.array([*place, size[2] / 2])), size=np.array(size)), color
    )


def _can(
    name: str,
    place: tuple[float, float] | np.ndarray,
    level: float,
    radius: float,
    height: float,
    color: tuple[float, float, float],
) -> Primitive:
    pose = Pose(np.eye(3), np.array([*place, level + height / 2]))
    return _coloured(Cylinder(name, pose, radius=radius, height=height), color)


def _coloured(thing: Primitive, color: tuple[float, float, float]) -> Primitive:
    return replace(thing, appearance=Appearance(np.array(color)))
