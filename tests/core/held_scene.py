# SPDX-License-Identifier: GPL-3.0-or-later
"""Solids held in many ways, and the exact pixels of what shows of them."""

from __future__ import annotations

import numpy as np
from monocell.core import Pose, ReferenceLine, Sketch
from monocell.core.modelling.candidates import choose
from monocell.core.modelling.pick_plan import PickPlan
from monocell.core.modelling.pick_visibility import hidden_picks
from monocell.core.rotation import rotation_from_vector
from monocell.core.shape.anchors import anchors
from monocell.core.shape.curves import curves_seen
from picked_scene import FLOOR, RAMP, WALL, camera

ROPE = ReferenceLine("rope", np.array([0.1, 0.1, 0.0]), np.array([0.1, 0.0, 1.0]))
REFERENCES = {r.name: r for r in (FLOOR, RAMP, WALL, ROPE)}
CURVES = {"rim": "base rim", "top": "top rim", "sides": "side", "outline": "outline"}


def solve(sketch, things=None, sigma=1.0, cam=None):
    """The chosen fit of a sketch."""
    return choose(cam or camera(), sketch, REFERENCES, things or {}, sigma)


def standing(plane, height, x=0.0, y=0.0, yaw=0.4):
    """A pose on a plane, its origin half a height above it."""
    at = Pose.from_rotation_vector([0, 0, yaw], [x, y, height / 2])
    return plane.world_from_plane @ at


def turned(pose, vector):
    """A pose turned in its own frame."""
    return pose @ Pose(rotation_from_vector(np.array(vector, dtype=float)), np.zeros(3))


def corners(thing, names, cam=None, seen_only=False):
    """Pixels of named corners; None for those that the object hides, if only seen ones count."""
    cam = cam or camera()
    points, _ = anchors(thing.kind, thing.parameters, names)
    pixels = cam.project(thing.world_from_object.apply(points))
    away = hidden_picks(thing, cam, PickPlan(pixels, tuple(names), labels=tuple(names)))
    return [None if seen_only and i in away else pixel.tolist() for i, pixel in enumerate(pixels)]


def shown(thing, cam=None, **counts):
    """Pixels spread over what shows of each curve: `rim=4, top=3, sides=2, hole=3`."""
    cam = cam or camera()
    seen = curves_seen(thing, cam)
    eye = thing.world_from_object.inverse().apply(cam.centre_world)
    names = {**CURVES, "hole": "top hole" if eye[2] > 0 else "base hole"}
    picks = {}
    for role, count in counts.items():
        rows = [i for i, n in enumerate(seen.names) if n.startswith(names[role])]
        rows = [i for i in rows if seen.visible[i]]
        spans = np.array([seen.ends[i][1] - seen.ends[i][0] for i in rows])
        picks[role] = []
        for k in range(count):
            if role == "sides":
                row, t = rows[k % 2], (-0.5, 0.4, 0.6, -0.2)[k % 4]
            else:
                way, at = (k + 0.37) / count * spans.sum(), 0
                while way > spans[at]:
                    way, at = way - spans[at], at + 1
                row, t = rows[at], seen.ends[rows[at]][0] + way
            point = seen.chosen(np.array([row])).points(np.array([t]))[0]
            pixel = cam.project(thing.world_from_object.apply(point)[None])[0]
            picks[role].append(pixel.tolist())
    return picks


def sketched(thing, picks, on=None, relations=(), known=(), name="it"):
    """A sketch of a truth, with the true values of its `known` sizes."""
    sizes = dict(zip(thing.size_names, map(float, thing.sizes), strict=True))
    return Sketch(
        name,
        thing.kind,
        on,
        picks,
        {size: sizes[size] for size in known},
        relations=tuple(relations),
    )


def assert_same(solved, truth, atol=1e-7):
    """The same place and sizes; a solid of revolution may be turned about its axis."""
    np.testing.assert_allclose(solved.sizes, truth.sizes, atol=atol)
    np.testing.assert_allclose(
        solved.world_from_object.translation, truth.world_from_object.translation, atol=atol
    )
    axes = [t.world_from_object.rotation[:, 2] for t in (solved, truth)]
    if truth.kind != "sphere":
        np.testing.assert_allclose(axes[0], axes[1], atol=10 * atol)
