# SPDX-License-Identifier: GPL-3.0-or-later
"""Cells with everything in them, for documents: drawn at random, and one fixed."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from drawn import lenses, numbers, poses, vectors
from hypothesis import strategies as st
from monocell.core import (
    Appearance,
    Box,
    Camera,
    Cell,
    Cylinder,
    ReferenceLine,
    ReferencePlane,
    Sketch,
    SphereSighting,
)
from monocell.core.mount import Mount
from monocell.core.sighting import PointSighting

NAMES = st.text(min_size=1, max_size=8).filter(lambda name: name.isprintable())
FILES = st.sampled_from(["cell.png", "pictures/a b.png", "../été.jpg", "深.png"])
SIZES = numbers(1e-4, 1e3)
DIRECTIONS = vectors(2.0).filter(lambda v: np.linalg.norm(v) > 1e-3)
PIXELS = st.tuples(numbers(-500, 4000), numbers(-500, 4000)).map(list)
LOOKS = st.none() | st.tuples(*[numbers(0, 1)] * 3).map(Appearance)


@st.composite
def covariances(draw, size):
    root = np.random.default_rng(draw(st.integers(0, 2**32 - 1))).normal(size=(size, size))
    matrix = root @ root.T * draw(st.sampled_from([1e-12, 1e-6, 1.0]))
    return (matrix + matrix.T) / 2


@st.composite
def sightings(draw, mounted):
    window = st.tuples(numbers(-9, 900), numbers(-9, 900), numbers(8, 900), numbers(8, 900))
    known = draw(st.booleans())
    place = draw(vectors(3.0)) if known else None
    flange = draw(poses()) if mounted or not known else None
    target = draw(st.just("") | NAMES)
    if draw(st.booleans()):
        pixel, sigma = draw(PIXELS), draw(numbers(0.01, 9))
        return PointSighting(draw(FILES), place, pixel, sigma, flange, target)
    radius = draw(SIZES)
    return SphereSighting(draw(FILES), place, radius, draw(st.none() | window), flange, target)


@st.composite
def mounts(draw):
    pose = draw(st.none() | poses())
    spread = draw(covariances(6)) if pose is not None else None
    return Mount(pose, spread, draw(st.none() | poses()))


@st.composite
def things(draw, name, planes):
    picks = draw(st.dictionaries(NAMES, st.lists(st.none() | PIXELS, max_size=3), max_size=2))
    look, on = draw(LOOKS), draw(st.sampled_from(planes) if planes else st.none())
    kind = draw(st.sampled_from(["box", "cylinder"]))
    known = {"size_y": 0.25} if kind == "box" and draw(st.booleans()) else {}
    if on is not None and draw(st.booleans()):
        return Sketch(name, kind, on, picks, known, look)
    common = {"on": on, "picks": picks, "known": known, "appearance": look}
    pose = draw(poses())
    if kind == "box":
        spread = draw(st.none() | covariances(9))
        size = [draw(SIZES), draw(SIZES), draw(SIZES)]
        return Box(name, pose, **common, covariance=spread, size=size)
    spread = draw(st.none() | covariances(8))
    radius, height = draw(SIZES), draw(SIZES)
    return Cylinder(name, pose, **common, covariance=spread, radius=radius, height=height)


@st.composite
def cells(draw):
    planes = draw(st.lists(NAMES, max_size=2, unique=True))
    references = tuple(
        draw(st.sampled_from([ReferencePlane, ReferenceLine]))(
            name, draw(vectors(2.0)), draw(DIRECTIONS)
        )
        for name in planes
    )
    names = draw(st.lists(NAMES, max_size=3, unique=True))
    listed = [draw(things(name, planes)) for name in names]
    pose, mount = draw(st.none() | poses()), draw(st.none() | mounts())
    camera = Camera(draw(lenses()), pose, draw(covariances(6)) if pose is not None else None)
    return Cell(
        camera if mount is None else mount.placed(camera),
        draw(st.none() | FILES),
        tuple(draw(st.lists(sightings(mount is not None), max_size=2))),
        references,
        tuple(thing for thing in listed if not isinstance(thing, Sketch)),
        tuple(thing for thing in listed if isinstance(thing, Sketch)),
        Path(),
        mount,
    )


def whole_document():
    """A valid document with every field that there is."""
    return {
        "monocell": 1,
        "camera": {
            "width": 1280,
            "height": 960,
            "fx": 1200.0,
            "fy": 1195.0,
            "cx": 652.3,
            "cy": 471.8,
            "distortion": {
                "model": "plumb_bob",
                "coefficients": [-0.28, 0.09, 0.0006, -0.0004, -0.01],
            },
            "camera_from_world": {
                "rotation": [[1, 0, 0], [0, 0, -1], [0, 1, 0]],
                "translation": [0.1, 0.2, 2.0],
            },
            "covariance": (1e-6 * np.eye(6)).tolist(),
        },
        "picture": "cell.png",
        "sightings": [
            {
                "picture": "pose_00.png",
                "center": [0.1, 0.0, 0.3],
                "radius": 0.04,
                "window": [600, 420, 120, 120],
            }
        ],
        "references": [
            {"name": "floor", "kind": "plane", "point": [0, 0, 0], "normal": [0, 0, 1]},
            {"name": "edge", "kind": "line", "point": [0, 0, 0], "direction": [1, 0, 0]},
        ],
        "objects": [
            {
                "name": "block",
                "kind": "box",
                "on": "floor",
                "size": [0.2, 0.1, 0.15],
                "world_from_object": _turned(),
                "covariance": (1e-6 * np.eye(9)).tolist(),
                "known": {"size_z": 0.15},
                "picks": {"base": [[1, 2], [3, 4.5], None]},
                "appearance": {"color": [0.8, 0.2, 0.2]},
            },
            {
                "name": "new",
                "kind": "box",
                "on": "floor",
                "known": {"size_z": 0.15},
                "picks": {"base": [[1, 2], [3, 4.5], [5, 6]]},
                "appearance": {"color": [0.8, 0.2, 0.2]},
            },
            {
                "name": "drum",
                "kind": "cylinder",
                "on": "floor",
                "radius": 0.1,
                "height": 0.3,
                "world_from_object": _turned(),
                "covariance": (1e-6 * np.eye(8)).tolist(),
            },
        ],
    }


def _turned():
    return {"rotation": [[0, -1, 0], [1, 0, 0], [0, 0, 1]], "translation": [0.4, 0.2, 0.075]}
