# SPDX-License-Identifier: GPL-3.0-or-later
"""Cells with everything in them, for documents: drawn at random, and one fixed."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from drawn import lenses, numbers, poses, vectors
from hypothesis import assume
from hypothesis import strategies as st
from monocell.core import (
    Appearance,
    Camera,
    Cell,
    Composite,
    Motion,
    ReferenceLine,
    ReferencePlane,
    Relation,
    Sketch,
    SphereSighting,
)
from monocell.core.mount import Mount
from monocell.core.primitives import KINDS, polygon_centre
from monocell.core.shape.polygons import polygon_area
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
def motions(draw, others):
    kind = draw(st.sampled_from(["static", "movable", "attached"] if others else ["static"]))
    if kind == "static":
        return Motion()
    weight = draw(st.sampled_from(["mass", "density", None]))
    weighed = {} if weight is None else {weight: draw(SIZES)}
    if kind == "movable":
        return Motion(kind, **weighed)
    to, joint = draw(st.sampled_from(others)), draw(st.sampled_from(["fixed", "hinge", "slider"]))
    if joint == "fixed":
        return Motion(kind, to=to, joint=joint, **weighed)
    limits = draw(st.none() | st.tuples(numbers(-3, 0), numbers(0, 3)))
    way = {"axis": draw(DIRECTIONS), "point": draw(st.none() | vectors(1.0)), "limits": limits}
    return Motion(kind, to=to, joint=joint, **weighed, **way)


@st.composite
def relations(draw, planes, others):
    faces = [*planes, *(f"{other}.axis" for other in others)]
    kinds = (["parallel", "touches", "leans_on"] if faces else []) + (
        ["same_size", "symmetric"] if others and faces else []
    )
    if not kinds:
        return ()
    kind, own = draw(st.sampled_from(kinds)), draw(st.none() | st.just("centre"))
    if kind not in ("same_size", "symmetric"):
        return (Relation(kind, draw(st.sampled_from(faces)), own),)
    about = draw(st.sampled_from(faces)) if kind == "symmetric" else None
    return (Relation(kind, draw(st.sampled_from(others)), None, about),)


@st.composite
def shapes(draw, kind):
    """The sizes of a kind, and how many parameters it has."""
    if kind == "box":
        return {"size": [draw(SIZES), draw(SIZES), draw(SIZES)]}, 3
    if kind == "prism":
        turns = np.sort(draw(st.lists(numbers(0, 6.2), min_size=3, max_size=7, unique=True)))
        polygon = np.stack([np.cos(turns), np.sin(turns)], axis=1) * draw(SIZES)
        area = polygon_area(polygon) / np.ptp(polygon, axis=0).max() ** 2
        assume(np.diff(turns).min() > 1e-2 and area > 1e-3)
        shape = {"polygon": polygon - polygon_centre(polygon), "height": draw(SIZES)}
        return shape, 1 + polygon.size
    sizes = {name: draw(SIZES) for name in KINDS[kind].size_names}
    if kind == "tube":
        sizes["inner_radius"] = sizes["radius"] * draw(numbers(0.01, 0.99))
    if kind == "cone":
        sizes["top_radius"] = draw(st.sampled_from([0.0, sizes["top_radius"]]))
    return sizes, len(sizes)


@st.composite
def things(draw, name, planes, others):
    picks = draw(st.dictionaries(NAMES, st.lists(st.none() | PIXELS, max_size=3), max_size=2))
    faces = [*planes, *(f"{other}.base" for other in others)]
    look, on = draw(LOOKS), draw(st.none() | st.sampled_from(faces) if faces else st.none())
    kind = draw(st.sampled_from(list(KINDS)))
    known = {KINDS[kind].size_names[-1]: 0.25} if draw(st.booleans()) else {}
    held, motion = draw(relations(planes, others)), draw(motions(others))
    if draw(st.booleans()):
        return Sketch(name, kind, on, picks, known, look, held, motion)
    shape, count = draw(shapes(kind))
    common = {"on": on, "picks": picks, "known": known, "appearance": look}
    common |= {"relations": held, "motion": motion}
    spread = draw(st.none() | covariances(6 + count))
    return KINDS[kind](name, draw(poses()), **common, covariance=spread, **shape)


@st.composite
def composites(draw, names):
    if not names or draw(st.booleans()):
        return ()
    parts = draw(st.lists(st.sampled_from(names), min_size=1, unique=True))
    return (Composite(f"all of {parts[0]}", tuple(parts)),)


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
    # what holds a thing, or what it hangs on, comes before it; a ball has no base to stand on
    listed = []
    for name in names:
        others = [one.name for one in listed if one.kind != "sphere" and name not in planes]
        listed.append(draw(things(name, planes, others)))
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
        draw(composites(names)),
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
            *_other_kinds(),
        ],
        "composites": [
            {
                "name": "arm",
                "parts": ["cup", "pipe"],
                "motion": {"kind": "movable", "mass": 2.5},
            }
        ],
    }


def _other_kinds():
    """A sketch without anything that it stands on, and the kinds beside box and cylinder."""
    hinge = {"axis": [0.0, 0.0, 1.0], "point": [0.1, 0.0, 0.0], "limits": [-0.5, 1.5]}
    return [
        {"name": "hanging", "kind": "sphere", "known": {"radius": 0.05}, "picks": {"rim": []}},
        {
            "name": "ball",
            "kind": "sphere",
            "relations": [
                {"kind": "touches", "to": "block.top"},
                {"kind": "touches", "to": "edge"},
            ],
            "radius": 0.05,
            "world_from_object": _turned(),
            "motion": {"kind": "movable", "density": 700.0},
        },
        {
            "name": "cup",
            "kind": "cone",
            "on": "block.top",
            "radius": 0.05,
            "top_radius": 0.0,
            "height": 0.2,
            "world_from_object": _turned(),
        },
        {
            "name": "pipe",
            "kind": "tube",
            "relations": [{"kind": "same_size", "to": "drum", "own": "height"}],
            "radius": 0.05,
            "inner_radius": 0.03,
            "height": 0.3,
            "world_from_object": _turned(),
        },
        {
            "name": "flap",
            "kind": "prism",
            "relations": [{"kind": "symmetric", "to": "block", "about": "floor"}],
            "polygon": [[-0.1, -0.1], [0.2, -0.1], [-0.1, 0.2]],
            "height": 0.02,
            "world_from_object": _turned(),
            "covariance": (1e-6 * np.eye(13)).tolist(),
            "motion": {"kind": "attached", "mass": 0.4, "to": "drum", "joint": "hinge"} | hinge,
        },
    ]


def _turned():
    return {"rotation": [[0, -1, 0], [1, 0, 0], [0, 0, 1]], "translation": [0.4, 0.2, 0.075]}
