# SPDX-License-Identifier: GPL-3.0-or-later
"""A small rig whose truth is known: a camera, places of the ball, its pictures and outlines."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import cv2
import numpy as np
from monocell.core import Camera, Cell, Distortion, Intrinsics, Pose, SphereSighting
from monocell.core.ball.sphere import OutlineRays, outline_pixels, tangency
from monocell.core.calibration.observation import OutlineObservation, Place
from monocell.core.picture.synthetic import Ball, Photographer, photograph

RADIUS = 0.04
LENS = Intrinsics(
    480, 360, 700.0, 698.0, 243.2, 177.4, Distortion("plumb_bob", [-0.15, 0.05, 4e-4, -3e-4, 0.0])
)
POSE = Pose.looking_at([1.5, -0.3, 0.9], [0.1, 0.0, 0.25], [0, 0, 1])
# spread over the picture and in depth, neither in line nor in one plane
PLACES = np.array(
    [
        [0.05, -0.30, 0.10],
        [0.30, 0.22, 0.15],
        [-0.10, 0.10, 0.45],
        [0.35, -0.15, 0.40],
        [0.00, 0.33, 0.30],
        [0.15, 0.00, 0.05],
    ]
)
QUIET = Photographer(noise_grey_levels=1.0, supersampling=4)


def picture_of(place_world, how=QUIET, intrinsics=LENS):
    ball = Ball(tuple(POSE.apply(place_world)), RADIUS)
    return photograph(intrinsics, (ball,), how)


def window_around(place_world, margin=40.0):
    u, v = LENS.project(POSE.apply(place_world)[None])[0]
    return (u - margin, v - margin, 2 * margin, 2 * margin)


def write_rig(folder: Path, places=PLACES, names=None, windows=False) -> Cell:
    """Pictures on disk and the cell as a robot would tell it: lens, positions, no pose."""
    sightings = []
    for i, place in enumerate(places):
        name = names[i] if names else f"pose_{i}.png"
        if not (folder / name).exists():
            picture = picture_of(place, replace(QUIET, seed=i))
            cv2.imwrite(str(folder / name), picture)
        window = window_around(place) if windows else None
        sightings.append(SphereSighting(name, place, RADIUS, window))
    return Cell(Camera(LENS), sightings=tuple(sightings), folder=folder)


@dataclass(frozen=True)
class OutlineNoise:
    """Errors of outlines in pixels: of each point, and one shared by all points of all balls."""

    sigma: float = 0.0
    bias: float = 0.0


def exact_outlines(places, noise=None, rng=None, count=80):
    """Outlines without pictures: projected exactly, moved along their normals by the noise."""
    how = noise or OutlineNoise()
    observations = []
    for place in places:
        centre = POSE.apply(place)
        pixels = outline_pixels(LENS, centre, RADIUS, count)
        normals = tangency(OutlineRays.of(LENS, pixels), centre, RADIUS).normals
        off = np.full(count, how.bias)
        if how.sigma > 0:
            off = off + rng.normal(0, how.sigma, count)
        outline = OutlineRays.of(LENS, pixels + normals * off[:, None])
        stated = np.full(count, max(how.sigma, 0.01))
        observations.append(OutlineObservation(outline, stated, Place(place), RADIUS, LENS))
    return observations


def pose_twist(estimate, truth=POSE):
    """By which twist (6,) of `Pose.perturbed` an estimate is off, to first order."""
    motion = estimate @ truth.inverse()
    return np.concatenate([motion.rotation_vector(), motion.translation])


def sigmas_off(twist, covariance):
    """The error in stated sigmas over all directions."""
    return float(np.sqrt(twist @ np.linalg.solve(covariance, twist)))
