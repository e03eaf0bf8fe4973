# SPDX-License-Identifier: GPL-3.0-or-later
"""A board or a tag rendered where a rig held its ball: a plan and a kind in, linear light out.

- `charuco`: a plate of 150 mm with 3 x 3 squares. Of the boards a gripper can hold it is the finest
  whose markers OpenCV still reads 3 m away (2.5 px a cell)
- `tag`: an AprilTag 36h11 of 70 mm on a plate of 90 mm

The plate faces the camera but for 15 to 35 degrees, since a tilted plane tells its pose best.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from monocell.core.pose import Pose
from monocell.core.rotation import rotation_from_vector
from monocell.scene.gripper import grip_frame, gripper_blocks
from monocell.scene.panel import STUB_RADIUS, stub_centre
from monocell.scene.work_cell import Panel, WorkCell
from rendered_rigs import (
    CACHE,
    SHADOW_SAMPLES,
    RenderedRig,
    digest_of,
    keep,
    keep_layers,
    kept_patches,
    rendered_rig,
    shadow_window,
    window_around,
)
from rig_plans import REACH, RigPlan, corners_world

KINDS = ("charuco", "tag")
PLATE = {"charuco": 0.150, "tag": 0.090}
SQUARES, SQUARE, MARKER = 3, 0.050, 0.0375
TAG, TAG_CELLS = 0.070, 8
INK, PAPER = 0.04, 0.80
SAMPLES, MARGIN = 64, 10


@dataclass(frozen=True, eq=False)
class HeldPanels:
    """The same rig with panels in the gripper, and where each of them was: origin in its middle."""

    rig: RenderedRig
    world_from_panel: tuple[Pose, ...]


def charuco_board() -> cv2.aruco.CharucoBoard:
    """OpenCV's board; its points count from the plate's top left corner."""
    dictionary = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_4X4_50)
    return cv2.aruco.CharucoBoard((SQUARES, SQUARES), SQUARE, MARKER, dictionary)


def tag_dictionary() -> cv2.aruco.Dictionary:
    return cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_APRILTAG_36h11)


def rendered_panels(plan: RigPlan, kind: str, cache: Path = CACHE) -> HeldPanels:
    """The rig holding panels, from the cache, or rendered now and put there."""
    poses = _poses(plan, kind)
    empty = rendered_rig(plan, cache=cache)
    file = cache / f"{plan.name}-{digest_of(plan)}-{kind}.npz"
    if not file.is_file():
        _render(plan, kind, poses, file)
    with np.load(file) as kept:
        patches = kept_patches(kept, len(poses))
    return HeldPanels(RenderedRig(plan, empty.background, patches), poses)


def _poses(plan: RigPlan, kind: str) -> tuple[Pose, ...]:
    rng = np.random.default_rng([23, KINDS.index(kind), plan.seed])
    return tuple(_facing(plan, place, PLATE[kind], rng) for place in plan.positions)


def _facing(plan: RigPlan, place: np.ndarray, size: float, rng: np.random.Generator) -> Pose:
    """Facing the camera but for a tilt, upright but for a turn, and above the table."""
    world_from_camera = plan.camera.pose.inverse().rotation
    ray = plan.camera.pose.apply(place)
    turn = rng.uniform(0, 2 * np.pi)
    axis = np.array([np.cos(turn), np.sin(turn), 0.0])
    tilt = rotation_from_vector(axis * np.radians(rng.uniform(15, 35)))
    roll = rotation_from_vector(np.array([0, 0, rng.uniform(-0.5, 0.5)]))
    off_axis = np.cross([0, 0, 1.0], ray / np.linalg.norm(ray))
    facing = rotation_from_vector(off_axis / np.linalg.norm(off_axis) * _angle(ray))
    rotation = world_from_camera @ facing @ tilt @ roll
    corners = size / 2 * np.array([[x, y, 0.0] for x in (-1, 1) for y in (-1, 1)])
    lowest = float((place + corners @ rotation.T)[:, 2].min())
    return Pose(rotation, place + np.array([0, 0, max(0.0, 0.01 - lowest)]))


def _angle(ray: np.ndarray) -> float:
    return float(np.arctan2(np.hypot(ray[0], ray[1]), ray[2]))


def _panel(pose: Pose, kind: str) -> Panel:
    size = PLATE[kind]
    # the flange behind the plate looks out of it
    flange = pose @ Pose(np.diag([1.0, -1.0, -1.0]), np.array([0, 0, REACH]))
    return Panel(pose, np.array([size, size]), _print(kind), flange)


def _print(kind: str) -> np.ndarray:
    """Albedo, finer than any picture of it."""
    if kind == "charuco":
        ink = charuco_board().generateImage((960, 960), marginSize=0, borderBits=1)
    else:
        cell = 80
        tag = cv2.aruco.generateImageMarker(tag_dictionary(), 0, TAG_CELLS * cell)
        border = round((PLATE["tag"] / TAG - 1) / 2 * TAG_CELLS * cell)
        ink = cv2.copyMakeBorder(tag, *[border] * 4, cv2.BORDER_CONSTANT, value=255)
    return np.where(ink > 127, PAPER, INK)


def _render(plan: RigPlan, kind: str, poses: tuple[Pose, ...], file: Path) -> None:
    import bpy
    from monocell.scene.stage import Stage

    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    kept: dict[str, np.ndarray] = {}
    with Stage(WorkCell(plan.camera, lab=plan.lab)) as stage:
        for i, pose in enumerate(poses):
            panel = _panel(pose, kind)
            stage.hold(panel)
            things = _outermost(panel)
            shadow = shadow_window(stage.cell, plan, things)
            layers = [] if shadow is None else [(shadow, SHADOW_SAMPLES)]
            layers.append((window_around(plan, plan.camera.project(things), MARGIN), SAMPLES))
            keep_layers(kept, stage, i, layers)
    keep(file, kept)


def _outermost(panel: Panel) -> np.ndarray:
    """The corners of the plate and of the gripper behind it, (N, 3) in the world."""
    half = panel.size / 2
    flat = np.array([[x * half[0], y * half[1], 0.0] for x in (-1, 1) for y in (-1, 1)])
    centre, flange = stub_centre(panel), panel.world_from_flange
    world_from_grip = grip_frame(centre, flange)
    blocks = gripper_blocks(STUB_RADIUS, float(np.linalg.norm(centre - flange.translation)))
    parts = [corners_world(world_from_grip @ b.grip_from_block, b) for b in blocks]
    return np.concatenate([panel.world_from_panel.apply(flat), *parts])
