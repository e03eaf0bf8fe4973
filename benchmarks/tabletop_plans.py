# SPDX-License-Identifier: GPL-3.0-or-later
"""Random table tops to be rendered: a seed in, all that is true of one out.

Eight to ten boxes and cylinders of 3 to 25 cm along each side stand on the table, turned at will,
before a camera 2 to 3 m away with a usual lens. They hide parts of each other, but of each enough
is seen that a person would say what it is.
"""

from __future__ import annotations

import colorsys
from dataclasses import dataclass

import numpy as np
from monocell.core.appearance import Appearance
from monocell.core.camera import Camera
from monocell.core.distortion import Distortion
from monocell.core.intrinsics import Intrinsics
from monocell.core.pose import Pose
from monocell.core.primitives import Box, Cylinder, Primitive
from monocell.core.rotation import rotation_from_vector
from monocell.scene.work_cell import Lab
from rig_plans import before_the_walls, random_lab
from sight import seen_shares

SMALLEST, LARGEST = 0.03, 0.25
# where things stand on the table, and how far apart the circles round them are at least
LOW, HIGH, GAP = np.array([0.02, -0.38]), np.array([0.68, 0.38]), 0.006
# of each thing at least this share is seen past the others, and so many pixels
SEEN_SHARE, SEEN_PIXELS, RIM = 0.45, 250, 24
COARSE = 3
PATTERNS = ("plain", "plain", "plain", "plain", "halves", "bands", "checker", "speckles")
TRIES = 400


@dataclass(frozen=True, eq=False)
class Look:
    """What a thing is painted with: roughness from 0 to 1, a pattern, its second colour and size.

    `scale` is the width of a band or square in metres.
    """

    roughness: float
    pattern: str
    second: np.ndarray
    scale: float


@dataclass(frozen=True, eq=False)
class TabletopPlan:
    """What is true of a table top. `seen` is the share of each thing that no other hides."""

    seed: int
    camera: Camera
    things: tuple[Primitive, ...]
    looks: tuple[Look, ...]
    seen: np.ndarray
    lab: Lab
    exposure: float

    @property
    def name(self) -> str:
        return f"tabletop-{self.seed:03d}"


def random_tabletop(seed: int) -> TabletopPlan:
    """The table top of that seed, always the same."""
    rng = np.random.default_rng([101, seed])
    camera = random_camera(rng)
    lab = random_lab(rng, varied=True)
    lab = _lit(lab, before_the_walls(lab.to_lamp, camera))
    count = int(rng.integers(8, 11))
    while True:
        things = _standing(rng, lab, count)
        if things is None:
            continue
        seen = _seen(camera, things)
        if seen is not None:
            break
    looks = tuple(_look(rng) for _ in things)
    return TabletopPlan(seed, camera, things, looks, seen, lab, float(rng.uniform(0.12, 0.24)))


def random_camera(rng: np.random.Generator) -> Camera:
    """A camera with a usual lens, 2 to 3 m from the things, from any side."""
    focal = rng.uniform(1100, 1300)
    k1 = rng.uniform(-0.22, 0.06)
    lens = Distortion("plumb_bob", np.array([k1, -0.3 * k1, *rng.normal(0, 5e-4, 2), 0.0]))
    cx, cy = np.array([639.5, 479.5]) + rng.uniform(-15, 15, 2)
    intrinsics = Intrinsics(1280, 960, focal, focal * rng.uniform(0.995, 1.005), cx, cy, lens)
    target = np.array([*(LOW + HIGH) / 2, 0.08]) + rng.uniform(-0.06, 0.06, 3)
    around, up = rng.uniform(-np.pi, np.pi), np.radians(rng.uniform(20, 55))
    towards = np.array([np.cos(up) * np.cos(around), np.cos(up) * np.sin(around), np.sin(up)])
    level = Pose.looking_at(target + rng.uniform(2.0, 3.0) * towards, target, [0, 0, 1])
    roll = Pose.from_rotation_vector([0, 0, rng.normal(0, 0.05)], np.zeros(3))
    return Camera(intrinsics, roll @ level)


def _lit(lab: Lab, to_lamp: np.ndarray) -> Lab:
    return Lab(**(vars(lab) | {"to_lamp": to_lamp}))


def _standing(rng: np.random.Generator, lab: Lab, count: int) -> tuple[Primitive, ...] | None:
    """Things none of which stands in another; None where no room was left."""
    things: list[Primitive] = []
    for _ in range(TRIES):
        thing = _thing(rng, lab, len(things))
        if all(_apart(thing, other) for other in things):
            things.append(thing)
        if len(things) == count:
            return tuple(things)
    return None


def _thing(rng: np.random.Generator, lab: Lab, number: int) -> Primitive:
    size, place = rng.uniform(SMALLEST, LARGEST, 3), rng.uniform(LOW, HIGH)
    yaw = rotation_from_vector(np.array([0, 0, rng.uniform(-np.pi, np.pi)]))
    pose = Pose(yaw, np.array([*place, size[2] / 2]))
    shared = {"on": "table", "appearance": Appearance(_color(rng, lab))}
    if rng.random() < 0.55:
        return Box(f"box {number}", pose, size=size, **shared)
    return Cylinder(f"can {number}", pose, radius=size[0] / 2, height=size[2], **shared)


def _apart(thing: Primitive, other: Primitive) -> bool:
    way = (thing.world_from_object.translation - other.world_from_object.translation)[:2]
    return bool(np.linalg.norm(way) > _reach(thing) + _reach(other) + GAP)


def _reach(thing: Primitive) -> float:
    """The radius of the circle round what stands on the table."""
    if isinstance(thing, Cylinder):
        return thing.radius
    return float(np.linalg.norm(thing.half_extent[:2]))


def _seen(camera: Camera, things: tuple[Primitive, ...]) -> np.ndarray | None:
    """Which share of each is seen; None where one leaves the picture or is too little seen."""
    lens = camera.intrinsics
    for thing in things:
        pixels = camera.project(thing.world_from_object.apply(_bounds(thing)))
        size = np.array([lens.width, lens.height])
        if not ((pixels > RIM) & (pixels < size - RIM)).all():
            return None
    us, vs = np.meshgrid(np.arange(0, lens.width, COARSE), np.arange(0, lens.height, COARSE))
    eye, rays = camera.rays_world(np.stack([us.ravel(), vs.ravel()], axis=1).astype(float))
    whole, share = seen_shares(eye, rays, things)
    enough = (share >= SEEN_SHARE) & (share * whole * COARSE**2 >= SEEN_PIXELS)
    return share if enough.all() else None


def _bounds(thing: Primitive) -> np.ndarray:
    signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    return signs * thing.half_extent


def _look(rng: np.random.Generator) -> Look:
    second = np.array(
        colorsys.hsv_to_rgb(rng.random(), rng.uniform(0, 0.9), rng.uniform(0.02, 0.8))
    )
    pattern = PATTERNS[rng.integers(len(PATTERNS))]
    return Look(float(rng.uniform(0.12, 0.85)), pattern, second, float(rng.uniform(0.012, 0.05)))


def _color(rng: np.random.Generator, lab: Lab) -> np.ndarray:
    """Any colour in linear light; one in eight is nearly the table's own."""
    if rng.random() < 0.125:
        table = 0.5 * (lab.table_dark + lab.table_light)
        return np.clip(table * rng.uniform(0.8, 1.25), 0.02, 0.85)
    hsv = rng.random(), rng.uniform(0, 0.95), rng.uniform(0.15, 0.9) ** 2.2 + 0.02
    return np.clip(colorsys.hsv_to_rgb(*hsv), 0.015, 0.85)
