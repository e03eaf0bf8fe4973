# SPDX-License-Identifier: GPL-3.0-or-later
"""Random calibration rigs to be rendered: a family and a seed in, all that is true of one out.

- `plain`: 5-8 positions, balls of four clear colours, a perfect or a usual lens
- `paper`: 80 positions, as in the paper's figure 2b, a clear ball and a perfect lens
- `varied`: 4-8 positions, also balls of the background's colour, strong and fisheye lenses, light
  from all sides, up to 40 % of the outline hidden by the gripper
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from monocell.core.ball.sphere import outline_pixels, outline_rays
from monocell.core.camera import Camera
from monocell.core.distortion import Distortion
from monocell.core.intrinsics import Intrinsics
from monocell.core.pose import Pose
from monocell.core.rotation import rotation_from_vector
from monocell.scene.gripper import Block, grip_frame, gripper_blocks
from monocell.scene.work_cell import Lab

FAMILIES = ("plain", "varied", "paper")
RADIUS, REACH = 0.04, 0.19
WORK_LOW, WORK_HIGH = np.array([-0.2, -0.5, 0.06]), np.array([0.75, 0.5, 0.75])
APART, RIM = 0.16, 70
# name, colour in linear light, roughness
BALLS = (
    ("orange", (0.75, 0.32, 0.08), 0.60),
    ("glossy blue", (0.03, 0.10, 0.55), 0.15),
    ("white", (0.78, 0.78, 0.76), 0.50),
    ("dark grey", (0.05, 0.05, 0.055), 0.50),
)


@dataclass(frozen=True, eq=False)
class RigPlan:
    """What is true of a rig: camera, ball positions (N, 3), flange poses, and how all looks.

    `hidden` (N,) is the share of each outline behind the gripper. `exposure` is what the middle
    brightness of the empty picture becomes, in linear light. `seed` also seeds a picture's noise.
    """

    family: str
    seed: int
    camera: Camera
    positions: np.ndarray
    flanges: tuple[Pose, ...]
    hidden: np.ndarray
    ball: str
    ball_color: np.ndarray
    ball_roughness: float
    lab: Lab
    exposure: float

    @property
    def name(self) -> str:
        return f"{self.family}-{self.seed:03d}"


def random_plan(family: str, seed: int) -> RigPlan:
    """The rig of that family and seed, always the same."""
    rng = np.random.default_rng([FAMILIES.index(family), seed])
    varied = family == "varied"
    lab = random_lab(rng, varied)
    camera = _camera(rng, varied)
    if family == "paper":
        lens = camera.intrinsics.undistorted()
        camera = replace(camera, intrinsics=lens)
    lab = replace(lab, to_lamp=before_the_walls(lab.to_lamp, camera))
    count = int(rng.integers(4, 9) if varied else rng.integers(5, 9))
    if family == "paper":
        positions = _positions(rng, camera, 80, 0.0)
    else:
        positions = _positions(rng, camera, count, APART)
    most = 0.4 if varied else 0.25
    held = [_held(rng, camera, place, rng.uniform(0, most)) for place in positions]
    ball, color, roughness = _ball(rng, lab, varied)
    return RigPlan(
        family,
        seed,
        camera,
        positions,
        tuple(flange for flange, _ in held),
        np.array([share for _, share in held]),
        ball,
        np.array(color),
        roughness,
        lab,
        float(rng.uniform(0.10, 0.24)),
    )


def gripper_of(centre: np.ndarray, flange: Pose) -> list[tuple[Pose, Block]]:
    """The blocks of the gripper, each with its pose in the world."""
    world_from_grip = grip_frame(centre, flange)
    blocks = gripper_blocks(RADIUS, float(np.linalg.norm(centre - flange.translation)))
    return [(world_from_grip @ block.grip_from_block, block) for block in blocks]


def corners_world(pose: Pose, block: Block) -> np.ndarray:
    """The eight corners of a block, (8, 3)."""
    signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    return pose.apply(signs * block.size / 2)


def hidden_share(camera: Camera, centre: np.ndarray, flange: Pose) -> float:
    """The share of the ball's outline that the gripper covers."""
    to_ball = camera.pose.apply(centre)
    rays = outline_rays(to_ball, RADIUS, np.arange(180) * (2 * np.pi / 180))
    touched = rays * np.sqrt(to_ball @ to_ball - RADIUS**2)
    ends = camera.pose.inverse().apply(touched)
    covered = np.zeros(len(ends), bool)
    for pose, block in gripper_of(centre, flange):
        covered |= _between(pose, block, camera.centre_world, ends)
    return float(covered.mean())


def _between(pose: Pose, block: Block, eye: np.ndarray, ends: np.ndarray) -> np.ndarray:
    """Which lines from `eye` to `ends` (N, 3) cross the block."""
    start = pose.inverse().apply(eye)
    way = pose.inverse().apply(ends) - start
    near, far = ((side * block.size / 2 - start) / way for side in (-1, 1))
    enter = np.minimum(near, far).max(axis=1)
    leave = np.maximum(near, far).min(axis=1)
    return (enter < leave) & (leave > 0) & (enter < 1 - 1e-4)


def _camera(rng: np.random.Generator, varied: bool) -> Camera:
    fisheye = varied and rng.random() < 0.2
    kind = rng.random()
    focal, distance = rng.uniform(1150, 1250), rng.uniform(2.0, 3.0)
    if fisheye:
        lens = Distortion("equidistant", rng.normal(0, [0.02, 0.004, 0.0, 0.0]))
        focal, distance = rng.uniform(820, 950), rng.uniform(1.6, 2.1)
    elif kind < 0.4:
        lens = Distortion()
    else:
        k1 = rng.uniform(-0.28, -0.05) if varied else rng.uniform(-0.15, -0.05)
        lens = Distortion("plumb_bob", np.array([k1, -0.3 * k1, *rng.normal(0, 5e-4, 2), 0.0]))
    cx, cy = np.array([639.5, 479.5]) + rng.uniform(-15, 15, 2)
    intrinsics = Intrinsics(1280, 960, focal, focal * rng.uniform(0.995, 1.005), cx, cy, lens)
    target = np.array([0.3, 0.0, 0.3]) + rng.uniform(-0.1, 0.1, 3)
    around, up = rng.uniform(-1.0, 1.0), np.radians(rng.uniform(12, 50))
    towards = [np.cos(up) * np.cos(around), np.cos(up) * np.sin(around), np.sin(up)]
    level = Pose.looking_at(target + distance * np.array(towards), target, [0, 0, 1])
    roll = Pose.from_rotation_vector([0, 0, rng.normal(0, 0.06)], np.zeros(3))
    return Camera(intrinsics, roll @ level)


def _positions(rng: np.random.Generator, camera: Camera, count: int, apart: float) -> np.ndarray:
    """Places all over the work space that the camera sees, none nearer than that to another."""
    places: list[np.ndarray] = []
    while len(places) < count:
        place = rng.uniform(WORK_LOW, WORK_HIGH)
        outline = outline_pixels(camera.intrinsics, camera.pose.apply(place), RADIUS, 16)
        low, high = outline.min(axis=0) - RIM, outline.max(axis=0) + RIM
        size = [camera.intrinsics.width, camera.intrinsics.height]
        if not ((low > 0).all() and (high < size).all()):
            continue
        if all(np.linalg.norm(place - other) > apart for other in places):
            places.append(place)
    return np.array(places)


def _held(
    rng: np.random.Generator, camera: Camera, place: np.ndarray, wanted: float
) -> tuple[Pose, float]:
    """The flange, of many that a robot could take, that hides about the share that is wanted."""
    best, off = None, np.inf
    tried = 0
    while tried < 40 or best is None:
        tried += 1
        along = rng.normal(size=3)
        along /= np.linalg.norm(along)
        if along[2] > 0.3:
            continue
        flange = _pointing(along, rng.uniform(0, 2 * np.pi), place)
        low = min(corners_world(*part)[:, 2].min() for part in gripper_of(place, flange))
        share = hidden_share(camera, place, flange)
        if low > 0.005 and abs(share - wanted) < off and share <= 0.4:
            best, off = (flange, share), abs(share - wanted)
    return best


def _pointing(along: np.ndarray, turn: float, place: np.ndarray) -> Pose:
    """A flange whose z axis is `along`, REACH before the place, turned about it."""
    side = np.cross(along, [1.0, 0, 0] if abs(along[0]) < 0.7 else [0, 1.0, 0])
    side = rotation_from_vector(along * turn) @ (side / np.linalg.norm(side))
    rotation = np.stack([side, np.cross(along, side), along], axis=1)
    return Pose(rotation, place - REACH * along)


def random_lab(rng: np.random.Generator, varied: bool) -> Lab:
    """How a room may be painted and lit; `varied` also from the sides."""
    light = np.clip(rng.uniform(0.1, 0.65) * rng.uniform(0.7, 1.2, 3), 0.03, 0.8)
    grains = ((1.2, 38.0, 1.0), (25.0, 25.0, 25.0), (60.0, 60.0, 60.0), (6.0, 6.0, 6.0))
    away = rng.uniform(-0.6, 0.6, 2) if not varied else rng.uniform(-1.6, 1.6, 2)
    return Lab(
        table_dark=light * rng.uniform(0.35, 0.95),
        table_light=light,
        grain=np.array(grains[rng.integers(len(grains))]),
        wall=np.clip(rng.uniform(0.15, 0.6) * rng.uniform(0.7, 1.2, 3), 0.03, 0.8),
        dado=np.clip(rng.uniform(0.04, 0.4) * rng.uniform(0.6, 1.3, 3), 0.02, 0.8),
        floor=np.clip(rng.uniform(0.05, 0.4) * rng.uniform(0.8, 1.2, 3), 0.03, 0.8),
        to_lamp=np.array([*away, 1.0]),
        lamp_size=float(rng.uniform(0.15, 1.2)),
        lamp_watts=float(rng.uniform(25, 160)),
        ambient=float(rng.uniform(0.25, 0.8)),
    )


def before_the_walls(to_lamp: np.ndarray, camera: Camera) -> np.ndarray:
    """The far sides have walls: a lamp that leans far that way would light their backs."""
    away = -np.sign(camera.centre_world[:2] - [0.35, 0.0])
    lean = np.minimum(to_lamp[:2] * away, 0.6) * away
    return np.array([*lean, to_lamp[2]])


def _ball(
    rng: np.random.Generator, lab: Lab, varied: bool
) -> tuple[str, tuple[float, ...] | np.ndarray, float]:
    if varied and rng.random() < 0.2:
        table = rng.random() < 0.6
        color = 0.5 * (lab.table_dark + lab.table_light) if table else lab.dado
        return ("like the table" if table else "like the wall"), color, 0.6
    return BALLS[rng.integers(len(BALLS))]
