# SPDX-License-Identifier: GPL-3.0-or-later
"""What `monocell find` was asked, made ready: arguments in; pictures, hints, windows, balls out."""

from __future__ import annotations

import argparse
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ..core.arrays import Array
from ..core.ball.find import find_sphere, find_spheres
from ..core.ball.hints import FindHints, color_named
from ..core.ball.outline import SphereOutline
from ..core.ball.prediction import Prediction, predicted
from ..core.ball.three_parameter_vote import vote_for_sphere
from ..core.camera import Camera
from ..core.cell import Cell
from ..core.document.camera_file import read_camera
from ..core.document.cell_file import read_cell
from ..core.errors import InvalidValue, SphereNotFound
from ..core.picture.pictures import Picture, read_picture, read_picture_told
from ..core.sighting import SphereSighting

# how far a ball may be from where an approximate pose puts it, when nobody says
WITHIN_MILLIMETRES = 50.0
# the vote searches so many of the ball's radii around its start, when nobody says
VOTED_RADII = 1.5
MOST_BALLS = 40


@dataclass(frozen=True, eq=False)
class Job:
    """One picture, its camera, and all that is known of the ball; `prediction` may be absent."""

    picture: Picture
    camera: Camera
    sighting: SphereSighting
    hints: FindHints
    prediction: Prediction | None
    told: tuple[str, ...] = ()

    @staticmethod
    def of(args: argparse.Namespace) -> Job:
        """The job that the arguments state, with the checks a document's sighting gets."""
        cell = None if args.near_pose is None else read_cell(args.near_pose)
        if args.radius is None:
            raise InvalidValue(
                "--radius is missing: the ball's radius in metres; see monocell find --help"
            )
        # the radius and the window are refused with their numbers
        asked = SphereSighting(str(args.picture), np.zeros(3), args.radius, args.window)
        camera = _camera(args, cell)
        prediction = None
        if cell is not None:
            place = _place(args, cell)
            prediction = predicted(cell.camera, place, asked.radius, _within(args))
            asked = replace(asked, window=prediction.window)
        picture, told = read_picture_told(args.picture, camera.intrinsics, linear=args.linear)
        return Job(picture, camera, asked, _hints(args, camera, prediction), prediction, told)

    def doubts(self, ball: SphereOutline) -> tuple[str, ...]:
        """What the prediction has against a ball, and a tag against the picture."""
        if self.prediction is None:
            return self.told
        return (*self.told, *self.prediction.doubts(ball.centre_camera))


@dataclass(frozen=True, eq=False)
class Seen:
    """A cell's sighting: the ball found, or None, why or with which doubts, and metres aside."""

    sighting: SphereSighting
    ball: SphereOutline | None
    warnings: tuple[str, ...]
    aside: float | None = None


@dataclass(frozen=True, eq=False)
class Vote:
    """The baseline's centre (3,), and how far from the outline's: pixels aside, metres deeper."""

    centre_camera: Array
    aside_pixels: float
    deeper: float


def check_together(args: argparse.Namespace) -> None:
    """Raises InvalidValue for arguments that contradict each other or miss one another."""
    from_cell = args.picture.suffix.lower() == ".json"
    if from_cell:
        for name in ("window", "near_pose", "center", "joints", "overlay", "count", "radius"):
            if getattr(args, name) is not None:
                raise InvalidValue(
                    f"--{name.replace('_', '-')} does not go with a cell document, whose "
                    "sightings say it; give a picture"
                )
        if args.method == "vote":
            raise InvalidValue("--method vote goes with one picture, not with a cell document")
    for name in ("center", "joints", "within"):
        if getattr(args, name) is not None and args.near_pose is None and not from_cell:
            raise InvalidValue(
                f"--{name} needs --near-pose CELL: a camera's pose turns a place into a window"
            )
    if args.near_pose is not None and args.window is not None:
        raise InvalidValue("--window and --near-pose both say where to look; give one of them")
    if args.center is not None and args.joints is not None:
        raise InvalidValue("--center and --joints both say where the ball is; give one of them")
    for name in ("urdf", "flange", "offset"):
        if getattr(args, name) is not None and args.joints is None:
            raise InvalidValue(f"--{name} needs --joints: the arm's joint angles in radians")


def find_balls(job: Job, count: int | str | None) -> tuple[SphereOutline, ...]:
    """The best ball, or as many as were asked for."""
    asked, lens = job.sighting, job.camera.intrinsics
    if count is None:
        return (find_sphere(job.picture, lens, asked.radius, asked.window, hints=job.hints),)
    most = MOST_BALLS if isinstance(count, str) else count
    return find_spheres(job.picture, lens, asked.radius, asked.window, hints=job.hints, most=most)


def vote_beside(job: Job, ball: SphereOutline) -> Vote:
    """The vote around the predicted place, or around the measured one where none is predicted."""
    start, reach = ball.centre_camera, VOTED_RADII * ball.radius
    if job.prediction is not None:
        start, reach = job.prediction.centre_camera, max(job.prediction.reach, 0.1 * ball.radius)
    lens = job.camera.intrinsics
    centre = vote_for_sphere(job.picture, lens, ball.radius, start, reach)
    one, other = lens.project(np.stack([centre, ball.centre_camera]))
    deeper = float(np.linalg.norm(centre) - np.linalg.norm(ball.centre_camera))
    return Vote(centre, float(np.linalg.norm(one - other)), deeper)


def find_in_cell(args: argparse.Namespace) -> tuple[Seen, ...]:
    """Every sighting of a cell, looked for where its window or the camera's pose says.

    Raises SphereNotFound when none is found.
    """
    cell = read_cell(args.picture)
    if not cell.sightings:
        raise InvalidValue(
            f"{args.picture}: the cell has no sightings; add some, or name a picture"
        )
    camera = _camera(args, cell)
    found = tuple(_seen(args, cell, camera, sighting) for sighting in cell.sightings)
    if all(seen.ball is None for seen in found):
        raise SphereNotFound(
            f"{args.picture}: the ball was found in none of {len(found)} sightings; "
            f"{found[0].sighting.picture}: {found[0].warnings[0]}"
        )
    return found


def _seen(args: argparse.Namespace, cell: Cell, camera: Camera, sighting: SphereSighting) -> Seen:
    path = cell.path_of(sighting.picture)
    picture, told = read_picture_told(path, camera.intrinsics, linear=args.linear)
    # the sighting is named where they are told
    told = tuple(words.removeprefix(f"{path.name}: ") for words in told)
    try:
        prediction = None
        if cell.camera.camera_from_world is not None:
            posed = Camera(camera.intrinsics, cell.camera.pose, cell.camera.covariance)
            place = sighting.center_world
            prediction = predicted(posed, place, sighting.radius, _within(args))
        window = sighting.window
        if window is None and prediction is not None:
            window = prediction.window
        hints = _hints(args, camera, prediction)
        ball = find_sphere(picture, camera.intrinsics, sighting.radius, window, hints=hints)
    except SphereNotFound as error:
        return Seen(sighting, None, (str(error),))
    if prediction is None:
        return Seen(sighting, ball, (*told, *ball.warnings))
    doubts = (*told, *ball.warnings, *prediction.doubts(ball.centre_camera))
    return Seen(sighting, ball, doubts, prediction.aside(ball.centre_camera))


def _camera(args: argparse.Namespace, cell: Cell | None) -> Camera:
    if args.camera is not None:
        return read_camera(args.camera)
    if cell is None:
        raise InvalidValue(
            "--camera is missing: a camera file or a cell document; see monocell find --help"
        )
    return cell.camera


def _place(args: argparse.Namespace, cell: Cell) -> Array:
    """Where the ball is in the world (3,): as stated, by the joints, or by the cell's sighting."""
    if args.center is not None:
        return np.array(args.center)
    if args.joints is not None:
        return _held(args)
    asked = args.picture.resolve()
    for sighting in cell.sightings:
        if cell.path_of(sighting.picture).resolve() == asked:
            return sighting.center_world
    raise InvalidValue(
        f"{args.near_pose}: none of its {len(cell.sightings)} sightings is of {args.picture}; "
        "say where the ball is by --center X Y Z or by --joints"
    )


def _held(args: argparse.Namespace) -> Array:
    """The centre (3,) of the ball that the arm holds, in the world, which is the arm's base."""
    from .robot.arm import Arm

    offset = np.array(args.offset or (0.0, 0.0, 0.0))
    with Arm(args.urdf, flange=args.flange) as arm:
        return arm.world_from_flange(args.joints).apply(offset)


def _within(args: argparse.Namespace) -> float:
    millimetres = WITHIN_MILLIMETRES if args.within is None else args.within
    if not 0 < millimetres < np.inf:
        raise InvalidValue(f"--within: must be above zero, got {millimetres:g} mm")
    return float(millimetres) / 1e3


def _hints(args: argparse.Namespace, camera: Camera, prediction: Prediction | None) -> FindHints:
    rough = args.rough_radius
    if rough is None and prediction is not None:
        rough = prediction.radius_pixels
    color = None if args.color is None else color_named(args.color)
    background = None
    if args.background is not None:
        _refuse_itself(args.background, args.picture)
        background = read_picture(args.background, camera.intrinsics, linear=args.linear)
    return FindHints(rough, color, background)


def _refuse_itself(background: Path, picture: Path) -> None:
    if background.resolve() == picture.resolve():
        raise InvalidValue(f"{background}: the background is the picture itself; name another")
