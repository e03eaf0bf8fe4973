# SPDX-License-Identifier: GPL-3.0-or-later
"""The demo's steps, each a room of the house at work: pictures, calibration, modelling, motion."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

from ...core.align.align_cell import align_cell
from ...core.align.result import Aligned
from ...core.ball.sphere import outline_pixels
from ...core.calibration.calibrate import Calibration, calibrate_cell
from ...core.camera import Camera
from ...core.cell import Cell
from ...core.document.cell_file import read_cell, write_cell
from ...core.modelling.modelled import Modelled
from ...core.modelling.solve import model_cell
from ...core.picture.overlay import BallOutline, draw_overlay
from ...core.picture.pictures import read_picture
from ..pictures import write_picture
from ..told import progress
from .hand import pick_objects
from .photographs import PICTURE, Held, photograph_cell, photograph_sightings
from .plan_of_cell import (
    BALL_IN_FLANGE,
    BALL_RADIUS,
    FLOOR,
    STEM_RADIUS,
    ball_positions,
    true_camera,
    true_objects,
)

TRUTH, CELL = "truth.cell.json", "cell.cell.json"
PICK_SIGMA_PIXELS = 1.0
COLORS = {"used": (90, 220, 90), "doubtful": (0, 190, 255), "rejected": (60, 60, 255)}


def make_pictures(out: Path) -> Cell:
    """Render the photographs and write the truth; returns the true cell."""
    from ..robot.arm import Arm, HeldBall

    camera, objects = true_camera(), true_objects()
    ball = HeldBall(BALL_RADIUS, BALL_IN_FLANGE, STEM_RADIUS)
    with Arm(ball=ball) as arm:
        held: list[Held] = []
        for position in ball_positions():
            joints = arm.joints_reaching(position, point_flange=BALL_IN_FLANGE)
            held.append((arm.parts(joints), arm.ball_center(joints), arm.world_from_flange(joints)))
        sightings = photograph_sightings(camera, out, held)
        photograph_cell(camera, objects, arm.parts(arm.rest), out / PICTURE)
    truth = Cell(camera, PICTURE, sightings, (FLOOR,), objects, folder=out)
    write_cell(truth, out / TRUTH)
    return truth


def hand_over(truth: Cell, seed: int) -> Path:
    """Write what a real site would send: pictures, lens, robot positions, and a hand's picks.

    The camera's pose and the objects stay behind: only the picks, off by a hand's error, follow.
    """
    picks = pick_objects(truth.camera, truth.objects, PICK_SIGMA_PIXELS, seed)
    camera = Camera(truth.camera.intrinsics)
    given = replace(truth, camera=camera, objects=(), sketches=picks)
    write_cell(given, truth.folder / CELL)
    return truth.folder / CELL


@dataclass(frozen=True, eq=False)
class Estimate:
    """What the demo made of its pictures: the cell, and what each step says of itself."""

    cell: Cell
    calibration: Calibration
    modelled: tuple[Modelled, ...]
    aligned: Aligned

    @property
    def warnings(self) -> tuple[str, ...]:
        """All doubts, in the order of the steps."""
        picked = (warning for one in self.modelled for warning in one.warnings)
        found = self.aligned.objects.items()
        edges = (f"{name}: not aligned: {why}" for name, one in found for why in one.reasons)
        return (*self.calibration.warnings, *picked, *edges)


def estimate(path: Path) -> Estimate:
    """Calibrate, model and align what the document holds, and write it back."""
    progress("calibrating from the pictures")
    cell, calibration = calibrate_cell(read_cell(path))
    progress("modelling from the picks")
    picked, modelled = model_cell(cell, PICK_SIGMA_PIXELS)
    progress("aligning on the picture's edges")
    assert cell.picture is not None
    picture = read_picture(cell.path_of(cell.picture), cell.camera.intrinsics)
    solved, aligned = align_cell(picked, picture)
    write_cell(solved, path)
    return Estimate(solved, calibration, modelled, aligned)


def draw_overlays(cell: Cell, calibration: Calibration, out: Path) -> tuple[Path, Path]:
    """The cell's picture with wire-frames, and one of the ball's pictures with all outlines."""
    intrinsics = cell.camera.intrinsics
    balls = []
    for report in calibration.sightings:
        centre = cell.camera.pose.apply(report.center_world)
        pixels = outline_pixels(intrinsics, centre, BALL_RADIUS)
        balls.append(BallOutline(pixels, COLORS[report.status]))
    assert cell.picture is not None
    picture = read_picture(cell.path_of(cell.picture), intrinsics)
    overlay = out / "overlay.png"
    write_picture(overlay, draw_overlay(picture, cell.camera, cell.objects, balls))
    first = read_picture(cell.path_of(cell.sightings[0].picture), intrinsics)
    sightings = out / "sightings.png"
    write_picture(sightings, draw_overlay(first, cell.camera, (), balls))
    return overlay, sightings
