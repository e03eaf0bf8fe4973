# SPDX-License-Identifier: GPL-3.0-or-later
"""Random cells of every kind as outlines and clicks without pictures: a seed in, all truth out."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from monocell.core import Camera, Distortion, Intrinsics, Pose
from monocell.core.ball.outline import SphereOutline
from monocell.core.ball.sphere import OutlineRays, outline_pixels, sphere_from_rays, tangency
from monocell.core.calibration.calibrate import calibrate_outlines
from monocell.core.mount import Mount
from monocell.core.sighting import PointSighting, SphereSighting

RADIUS = 0.04
LENS = Intrinsics(
    1280, 960, 1200.0, 1197.0, 652.0, 471.0, Distortion("plumb_bob", [-0.12, 0.04, 5e-4, -3e-4, 0])
)
KINDS = ("known", "flange", "mounted")


@dataclass(frozen=True)
class Errors:
    """What is wrong in a rig: of outlines and clicks in pixels, of the robot in metres; what the
    user states of ball and lens."""

    noise: float = 0.2
    click: float = 0.5
    robot: float = 0.0
    stated_radius: float = RADIUS
    stated_lens: Intrinsics = LENS


@dataclass(frozen=True, eq=False)
class Rig:
    """The truth, `pose` being camera_from_world or, of a mounted camera, camera_from_flange."""

    pose: Pose
    offset: np.ndarray | None
    mount: Mount | None
    sightings: list
    outlines: list
    lens: Intrinsics

    def calibrated(self, **how):
        return calibrate_outlines(
            Camera(self.lens), self.sightings, self.outlines, mount=self.mount, **how
        )

    def errors(self, calibration):
        """How far a calibration is off: metres, degrees, and in its own sigmas."""
        found = calibration.fit.camera_from_base
        motion = found @ self.pose.inverse()
        twist = np.concatenate([motion.rotation_vector(), motion.translation])
        place = found.inverse().translation - self.pose.inverse().translation
        sigmas = np.sqrt(twist @ np.linalg.solve(calibration.fit.covariance, twist))
        turn = np.degrees(np.linalg.norm(twist[:3]))
        return float(np.linalg.norm(place)), float(turn), float(sigmas)

    def with_sightings(self, sightings):
        return replace(self, sightings=list(sightings))


def rig_of(seed, count, kind="known", points=0, how=None, turn=0.5):
    """`count` sightings, the first `points` of them clicks."""
    how, rng = how or Errors(), np.random.default_rng(seed)
    pose, offset, mount = _camera(rng, kind)
    sightings, outlines = [], []
    bias = rng.normal(0, 0.05)
    while len(sightings) < count:
        place, flange, centre = _held(rng, kind, pose, offset, turn)
        pixel = LENS.project(centre[None])[0]
        if centre[2] < 0.3 or not (80 < pixel[0] < 1200 and 80 < pixel[1] < 880):
            continue
        place = None if place is None else place + rng.normal(0, how.robot, 3)
        if flange is not None:
            flange = Pose(flange.rotation, flange.translation + rng.normal(0, how.robot, 3))
        name = f"pose_{len(sightings)}.png"
        if len(sightings) < points:
            clicked = pixel + rng.normal(0, how.click, 2)
            sightings.append(PointSighting(name, place, clicked, how.click, flange))
            outlines.append(None)
        else:
            sightings.append(SphereSighting(name, place, how.stated_radius, None, flange))
            outlines.append(outline_of(rng, centre, how, bias))
    return Rig(pose, offset, mount, sightings, outlines, how.stated_lens)


def outline_of(rng, centre, how, bias=0.0, count=90):
    """The outline of a ball as the picture would give it."""
    exact = outline_pixels(LENS, centre, RADIUS, count)
    normals = tangency(OutlineRays.of(LENS, exact), centre, RADIUS).normals
    pixels = exact + normals * (bias + rng.normal(0, how.noise, count))[:, None]
    rays = OutlineRays.of(how.stated_lens, pixels)
    found = sphere_from_rays(rays.rays, how.stated_radius)
    left = tangency(rays, found, how.stated_radius).residual_pixels
    sigma, all_used = np.full(count, how.noise), np.ones(count, dtype=bool)
    return SphereOutline(
        found, 1e-6 * np.eye(3), how.stated_radius, pixels, sigma, left, all_used,
        1.0, 10.0, 0.0, how.noise, 0.7, (),
    )  # fmt: skip


def _camera(rng, kind):
    if kind == "mounted":
        pose = Pose.from_rotation_vector(rng.normal(0, 0.6, 3), rng.uniform(-0.1, 0.1, 3))
        return pose, rng.uniform([0.3, -0.3, 0.0], [0.7, 0.3, 0.1]), Mount()
    eye = np.array([2.0, 0.0, 1.3]) + rng.uniform(-0.4, 0.4, 3)
    pose = Pose.looking_at(eye, [0.25, 0.0, 0.35], [0, 0, 1])
    return pose, rng.uniform(-0.15, 0.15, 3) if kind == "flange" else None, None


def _held(rng, kind, pose, offset, turn):
    """The place in the world where it is given, the flange's pose, and the centre in the camera."""
    place = rng.uniform([-0.3, -0.5, 0.05], [0.7, 0.5, 0.8])
    if kind == "known":
        return place, None, pose.apply(place)
    if kind == "flange":
        flange = Pose.from_rotation_vector(rng.normal(0, turn, 3), place)
        return None, flange, pose.apply(flange.apply(offset))
    eye = offset + np.array([*rng.uniform(-0.4, 0.4, 2), rng.uniform(0.5, 1.0)])
    up = rng.normal([1.0, 0.0, 0.0], 1, 3)
    camera_from_world = Pose.looking_at(eye, offset + rng.uniform(-0.15, 0.15, 3), up)
    return None, camera_from_world.inverse() @ pose, camera_from_world.apply(offset)
