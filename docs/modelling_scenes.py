# SPDX-License-Identifier: GPL-3.0-or-later
"""The objects of the pictures of `modelling.md`, how each is held, and where it is picked."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from monocell.core import Camera, Intrinsics, Pose, ReferenceLine, ReferencePlane, Sketch
from monocell.core.arrays import Array
from monocell.core.primitives import (
    Box,
    Cone,
    Cylinder,
    Primitive,
    Prism,
    Sphere,
    Tube,
    polygon_centre,
)
from monocell.core.relation import Relation
from monocell.core.rotation import rotation_from_vector
from monocell.core.shape.anchors import anchors
from monocell.core.shape.curves import curves_seen

CAMERA = Camera(
    Intrinsics(480, 340, 620.0, 620.0, 240.0, 165.0),
    Pose.looking_at([0.45, -1.05, 0.75], [0.0, 0.0, 0.1], [0.0, 0.0, 1.0]),
)
FLOOR = ReferencePlane("floor", np.zeros(3), np.array([0.0, 0.0, 1.0]))
WALL = ReferencePlane("wall", np.array([0.0, 0.3, 0.0]), np.array([0.0, -1.0, 0.0]))
ROPE = ReferenceLine("rope", np.array([0.0, 0.05, 0.0]), np.array([0.0, 0.0, 1.0]))
REFERENCES = {r.name: r for r in (FLOOR, WALL, ROPE)}
CORNERS = ("x-y-", "x+y-", "x+y+", "x-y+")
CURVES = {"rim": "base rim", "top": "top rim", "sides": "side", "outline": "outline"}
LYING = (np.pi / 2, 0.0, 0.0)


@dataclass(frozen=True)
class Scene:
    """A file's name, what was picked, what else stands there, and which references are drawn."""

    file: str
    sketch: Sketch
    things: Mapping[str, Primitive] = field(default_factory=dict)
    shown: Sequence[str] = ()


def _at(height: float, x: float = 0.0, y: float = 0.0, yaw: float = 0.35) -> Pose:
    return Pose.from_rotation_vector([0, 0, yaw], [x, y, height / 2])


def _turned(pose: Pose, vector: Sequence[float]) -> Pose:
    return pose @ Pose(rotation_from_vector(np.array(vector)), np.zeros(3))


def _pixels(thing: Primitive, names: Sequence[str]) -> list[list[float]]:
    points, _ = anchors(thing.kind, thing.parameters, names)
    pixels: list[list[float]] = CAMERA.project(thing.world_from_object.apply(points)).tolist()
    return pixels


def _corners(thing: Primitive, base: Sequence[int], top: Sequence[int], count: int = 4) -> dict:
    picks = {}
    for role, places in (("base", base), ("top", top)):
        names = [f"{CORNERS[i]}{role}" if count == 4 else f"{role}{i}" for i in range(count)]
        pixels = _pixels(thing, names)
        last = max(places, default=-1) + 1
        picks[role] = [pixels[i] if i in places else None for i in range(last)]
    return {role: pixels for role, pixels in picks.items() if pixels}


def _shown(thing: Primitive, **shares: Sequence[float]) -> dict:
    """Pixels at these shares of what shows of a curve; on a side, the first digit tells which."""
    seen = curves_seen(thing, CAMERA)
    eye = thing.world_from_object.inverse().apply(CAMERA.centre_world)
    names = {**CURVES, "hole": "top hole" if eye[2] > 0 else "base hole"}
    picks = {}
    for role, wanted in shares.items():
        rows = [i for i, n in enumerate(seen.names) if n.startswith(names[role])]
        rows = [i for i in rows if seen.visible[i]]
        picks[role] = [_on(thing, rows, share, role == "sides") for share in wanted]
    return picks


def _on(thing: Primitive, rows: list[int], share: float, is_side: bool) -> list[float]:
    seen = curves_seen(thing, CAMERA)
    if is_side:
        row, t = rows[int(share)], 2 * (share % 1.0) - 1
    else:
        spans = np.array([seen.ends[i][1] - seen.ends[i][0] for i in rows])
        way, at = share * spans.sum(), 0
        while way > spans[at]:
            way, at = way - spans[at], at + 1
        row, t = rows[at], seen.ends[rows[at]][0] + way
    point: Array = seen.chosen(np.array([row])).points(np.array([t]))[0]
    pixel: list[float] = CAMERA.project(thing.world_from_object.apply(point)[None])[0].tolist()
    return pixel


def _scene(
    file: str,
    truth: Primitive,
    picks: dict,
    on: str | None = None,
    relations: Sequence[Relation] = (),
    known: Sequence[str] = (),
    things: Mapping[str, Primitive] | None = None,
    shown: Sequence[str] = (),
) -> Scene:
    sizes = dict(zip(truth.size_names, map(float, truth.sizes), strict=True))
    sketch = Sketch(
        "it", truth.kind, on, picks, {n: sizes[n] for n in known}, relations=tuple(relations)
    )
    return Scene(file, sketch, things or {}, shown)


def _boxes() -> list[Scene]:
    box = Box("it", _at(0.2, yaw=0.9), size=[0.26, 0.22, 0.2])
    hung = Box(
        "it",
        _turned(Pose(WALL.world_from_plane.rotation, [0, 0.22, 0.18]), (-np.pi / 2, 0.3, 0)),
        size=[0.3, 0.16, 0.2],
    )
    free = Box("it", _turned(_at(0.4), (0.5, 0.35, 0.3)), size=[0.28, 0.2, 0.16])
    every = range(4)
    return [
        _scene("box_base", box, _corners(box, (0, 1, 3), (1,)), "floor"),
        _scene("box_corners", box, _corners(box, (0, 1, 3), every), "floor"),
        _scene("box_top", box, _corners(box, (0,), every), "floor"),
        _scene(
            "box_wall",
            hung,
            _corners(hung, (0, 1), every),
            None,
            [Relation("leans_on", "wall", "y+")],
            shown=("wall",),
        ),
        _scene("box_floating", free, _corners(free, (0, 1, 3), every), None, (), ("size_x",)),
    ]


def _cylinders() -> list[Scene]:
    drum = Cylinder("it", _at(0.26), radius=0.12, height=0.26)
    lying = Cylinder("it", _turned(_at(0.2, yaw=1.1), LYING), radius=0.1, height=0.34)
    trunk = Cylinder("trunk", _at(0.2, 0.0, 0.0), radius=0.07, height=0.2)
    across = Pose.from_rotation_vector([0, 0, 1.15], [0.0, 0.0, 0.25])
    shoulder = Cylinder("it", _turned(across, LYING), radius=0.075, height=0.34)
    crate = Box("crate", _at(0.26, -0.1, 0.05, -0.5), size=[0.26, 0.26, 0.26])
    knob = crate.world_from_object @ Pose.from_rotation_vector(
        [0, np.pi / 2, 0], [0.13 + 0.07, 0, 0]
    )
    held = [Relation("perpendicular", "trunk.axis"), Relation("centred_on", "trunk.axis")]
    return [
        _scene("cylinder_rims", drum, _shown(drum, rim=(0.1, 0.5, 0.9), top=(0.1, 0.6)), "floor"),
        _scene(
            "cylinder_sides",
            drum,
            _shown(drum, sides=(0.4, 1.6), rim=(0.5,), top=(0.15, 0.6)),
            "floor",
        ),
        _scene(
            "cylinder_lying",
            lying,
            _shown(lying, rim=(0.1, 0.35, 0.6, 0.85), top=(0.2, 0.8), sides=(0.5, 1.5)),
            None,
            [Relation("lies_on", "floor")],
        ),
        _scene(
            "cylinder_shoulder",
            shoulder,
            _shown(shoulder, rim=(0.1, 0.4, 0.75), top=(0.2, 0.8), sides=(0.7, 1.3)),
            None,
            held,
            (),
            {"trunk": trunk},
        ),
        _scene(
            "cylinder_face",
            Cylinder("it", knob, radius=0.07, height=0.14),
            _shown(
                Cylinder("it", knob, radius=0.07, height=0.14),
                rim=(0.2, 0.8),
                top=(0.05, 0.35, 0.7),
            ),
            "crate.x+",
            (),
            (),
            {"crate": crate},
        ),
    ]


def _other_round() -> list[Scene]:
    frustum = Cone("it", _at(0.24), radius=0.15, top_radius=0.08, height=0.24)
    cone = Cone("it", _at(0.28), radius=0.14, top_radius=0.0, height=0.28)
    tube = Tube("it", _at(0.22), radius=0.14, inner_radius=0.1, height=0.22)
    resting = Sphere("it", _at(0.26), radius=0.13)
    hung = Sphere("it", _at(0.5), radius=0.11)
    beside = Sphere("it", Pose(np.eye(3), [0.09, 0.05, 0.25]), radius=0.09)
    apex = {"apex": _pixels(cone, ["apex"])}
    around = (0.05, 0.3, 0.55, 0.8)
    return [
        _scene(
            "cone_rims",
            frustum,
            _shown(frustum, rim=(0.1, 0.5, 0.9), top=(0.1, 0.4, 0.75), sides=(0.5, 1.5)),
            "floor",
        ),
        _scene("cone_apex", cone, {**_shown(cone, rim=(0.1, 0.5, 0.9)), **apex}, "floor"),
        _scene(
            "tube",
            tube,
            _shown(tube, rim=(0.1, 0.5, 0.9), top=(0.1, 0.4, 0.75), hole=(0.15, 0.6)),
            "floor",
        ),
        _scene("sphere_floating", hung, _shown(hung, outline=around), None, (), ("radius",)),
        _scene("sphere_floor", resting, _shown(resting, outline=around), "floor"),
        _scene(
            "sphere_line",
            beside,
            _shown(beside, outline=around),
            None,
            [Relation("touches", "rope")],
            shown=("rope",),
        ),
    ]


def _prisms() -> list[Scene]:
    polygon = np.array([[-0.16, -0.1], [0.12, -0.14], [0.18, 0.02], [0.04, 0.14], [-0.14, 0.1]])
    polygon = polygon - polygon_centre(polygon)
    prism = Prism("it", _at(0.16, yaw=0.2), polygon=polygon, height=0.16)
    roof = np.array([[-0.16, 0.0], [0.16, 0.0], [0.0, 0.18]])
    low = polygon_centre(roof)
    # side 0 down on the floor: the polygon stands upright, z along the ridge
    stood = Pose.from_rotation_vector([0, 0, 0.4], [0, 0, low[1]])
    tent = Prism("it", _turned(stood, LYING), polygon=roof - low, height=0.3)
    return [
        _scene("prism", prism, _corners(prism, (0, 1, 2), range(5), 5), "floor"),
        _scene(
            "prism_side",
            tent,
            _corners(tent, (2,), (0, 1, 2), 3) | {"base": _corners(tent, (1, 2), (), 3)["base"]},
            None,
            [Relation("stands_on", "floor", "side0")],
        ),
    ]


SCENES = (*_boxes(), *_cylinders(), *_other_round(), *_prisms())
