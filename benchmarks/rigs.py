# SPDX-License-Identifier: GPL-3.0-or-later
"""Random calibration rigs with ray-traced pictures: a seed in, pictures and a true cell out."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from monocell.core.camera import Camera
from monocell.core.cell import Cell
from monocell.core.distortion import Distortion
from monocell.core.intrinsics import Intrinsics
from monocell.core.picture.pictures import Picture
from monocell.core.picture.synthetic import Ball, Photographer, photograph
from monocell.core.pose import Pose
from monocell.core.sighting import SphereSighting

RADIUS = 0.04


def random_rig(
    seed: int, sightings: int, how: Photographer, *, fingers: bool = False
) -> tuple[Cell, dict[str, Picture]]:
    """A true cell and its pictures by name: 1280x960, f 1200 px, a 40 mm ball 1.8 to 3 m away."""
    rng = np.random.default_rng(seed)
    lens = Distortion("plumb_bob", np.array([-0.12, 0.04, 0.0005, -0.0003, 0.0]))
    intrinsics = Intrinsics(1280, 960, 1200.0, 1197.0, 652.0, 471.0, lens)
    eye = np.array([2.0, 0.0, 1.3]) + rng.uniform(-0.4, 0.4, 3)
    pose = Pose.looking_at(eye, [0.25, 0.0, 0.35], [0, 0, 1])
    balls, pictures = [], {}
    while len(balls) < sightings:
        centre = rng.uniform([-0.3, -0.5, 0.05], [0.7, 0.5, 0.8])
        seen = intrinsics.project(pose.apply(centre)[None])[0]
        if not (60 < seen[0] < 1220 and 60 < seen[1] < 900):
            continue
        name = f"pose_{len(balls)}.png"
        ball = Ball(tuple(pose.apply(centre)), RADIUS, tuple(rng.uniform(0.1, 0.8, 3)))
        light = tuple(rng.normal(size=3) * [1, 0.4, 0.3] + [0, -1, -0.6])
        hidden = _fingers(intrinsics, ball) if fingers else ()
        shot = replace(how, light=light, hidden=hidden, seed=1000 * seed + len(balls))
        pictures[name] = photograph(intrinsics, (ball,), shot)
        balls.append(SphereSighting(name, centre, RADIUS))
    return Cell(Camera(intrinsics, pose), sightings=tuple(balls)), pictures


def _fingers(intrinsics: Intrinsics, ball: Ball) -> tuple[tuple[float, float, float, float], ...]:
    """Two dark bars over the ball's left and right."""
    u, v = intrinsics.project(np.array(ball.centre_camera)[None])[0]
    r = intrinsics.fx * ball.radius / ball.centre_camera[2]
    return (
        (u - 0.95 * r, v - 2.2 * r, 0.42 * r, 2.6 * r),
        (u + 0.5 * r, v - 2.2 * r, 0.42 * r, 2.6 * r),
    )
