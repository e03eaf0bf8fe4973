# SPDX-License-Identifier: GPL-3.0-or-later
"""Random objects of every kind, held in every way, and the pixels that show of them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from monocell.core import Camera, Distortion, Intrinsics, Pose, ReferenceLine, ReferencePlane
from monocell.core.modelling.pick_plan import PickPlan
from monocell.core.modelling.pick_visibility import hidden_picks
from monocell.core.primitives import Primitive
from monocell.core.relation import Relation
from monocell.core.rotation import rotation_from_vector
from monocell.core.shape.anchors import anchor_names, anchors
from monocell.core.shape.curves import curves_seen
from monocell.core.sketch import Sketch

LENS = Distortion("plumb_bob", np.array([-0.12, 0.04, 0.0004, -0.0003, 0.0]))
FLOOR = ReferencePlane("floor", np.zeros(3), np.array([0.0, 0.0, 1.0]))
RAMP = ReferencePlane("ramp", np.array([0.1, 0.0, 0.05]), np.array([0.25, -0.15, 1.0]))
WALL = ReferencePlane("wall", np.array([0.0, 0.6, 0.0]), np.array([0.15, -1.0, 0.05]))
ROPE = ReferenceLine("rope", np.array([0.1, 0.1, 0.0]), np.array([0.1, 0.0, 1.0]))
REFERENCES = {r.name: r for r in (FLOOR, RAMP, WALL, ROPE)}
CORNERS = ("x-y-", "x+y-", "x+y+", "x-y+")
# the least share of an object's height that a way may leave out at the ends of a rim
RIM_MARGIN = 0.04


class NotSeen(Exception):
    """This object does not show what the way needs; another is tried."""


@dataclass(frozen=True)
class Task:
    """A truth, what was picked of it without error, and what it is held by."""

    camera: Camera
    truth: Primitive
    picks: Mapping[str, list[list[float] | None]]
    on: str | None = None
    relations: tuple[Relation, ...] = ()
    known: tuple[str, ...] = ()
    things: Mapping[str, Primitive] = field(default_factory=dict)

    def sketch(self, rng: np.random.Generator, sigma: float) -> Sketch:
        """What an operator whose hand trembles by `sigma` pixels picks."""
        picks = {
            role: [None if p is None else (p + rng.normal(0, sigma, 2)).tolist() for p in pixels]
            for role, pixels in self.picks.items()
        }
        sizes = dict(zip(self.truth.size_names, map(float, self.truth.sizes), strict=True))
        known = {name: sizes[name] for name in self.known}
        return Sketch("it", self.truth.kind, self.on, picks, known, relations=self.relations)

    def scene_truth(self) -> Primitive:
        """The truth as a fit may start from it."""
        sizes = dict(zip(self.truth.size_names, map(float, self.truth.sizes), strict=True))
        known = {name: sizes[name] for name in self.known}
        return replace(self.truth, on=self.on, relations=self.relations, known=known)


def random_camera(rng: np.random.Generator) -> Camera:
    """A camera 1.5 to 3 m away, 20 to 55 degrees above the floor, rolled a little."""
    away, turn = rng.uniform(1.5, 3.0), rng.uniform(-1.9, -1.2)
    rise = np.radians(rng.uniform(20, 55))
    eye = away * np.array([np.cos(rise) * np.cos(turn), np.cos(rise) * np.sin(turn), np.sin(rise)])
    up = np.array([rng.normal(0, 0.05), rng.normal(0, 0.05), 1.0])
    pose = Pose.looking_at(eye, rng.normal([0, 0, 0.1], 0.03), up)
    return Camera(
        Intrinsics(1280, 960, 1000.0 * away / 2, 995.0 * away / 2, 650.3, 470.8, LENS), pose
    )


def standing(
    rng: np.random.Generator, plane: ReferencePlane, height: float, lift: float = 0.0
) -> Pose:
    """A place on a plane, turned at random, its middle half a height (and `lift`) above it."""
    yaw = Pose.from_rotation_vector(
        [0, 0, rng.uniform(-np.pi, np.pi)],
        [rng.uniform(-0.3, 0.3), rng.uniform(-0.25, 0.25), height / 2 + lift],
    )
    return plane.world_from_plane @ yaw


def turned(pose: Pose, vector: Sequence[float]) -> Pose:
    """A pose turned in its own frame."""
    return pose @ Pose(rotation_from_vector(vector), np.zeros(3))


def corner_pixels(
    truth: Primitive, camera: Camera, wanted: Sequence[str], *, hidden: bool = False
) -> dict[str, np.ndarray]:
    """Pixels of the corners whose names are wanted, only those that show unless `hidden`."""
    names = [n for n in anchor_names(truth.kind, len(truth.parameters)) if n in wanted]
    points, _ = anchors(truth.kind, truth.parameters, names)
    pixels = camera.project(truth.world_from_object.apply(points))
    away = set() if hidden else _hidden(truth, camera, names, pixels)
    found = {n: p for i, (n, p) in enumerate(zip(names, pixels, strict=True)) if i not in away}
    if not all(camera.intrinsics.contains(p[None])[0] for p in found.values()):
        raise NotSeen
    return found


def _hidden(truth: Primitive, camera: Camera, names: Sequence[str], pixels: np.ndarray) -> set[int]:
    plan = PickPlan(pixels, tuple(names), labels=tuple(names))
    return set(hidden_picks(truth, camera, plan))


def on_curves(
    truth: Primitive, camera: Camera, rng: np.random.Generator, name: str, count: int
) -> list[np.ndarray]:
    """`count` pixels spread at random over what shows of a curve."""
    seen = curves_seen(truth, camera)
    rows = [i for i, n in enumerate(seen.names) if n.startswith(name) and seen.visible[i]]
    # silhouettes are taken in turn, arcs by their length
    spans = np.array([seen.ends[i][1] - seen.ends[i][0] for i in rows])
    if not len(rows) or spans.sum() < 0.9:
        raise NotSeen
    shares = (np.arange(count) + rng.uniform(0.15, 0.85, count)) / count
    shares = RIM_MARGIN + (1 - 2 * RIM_MARGIN) * shares
    pixels = []
    for k, share in enumerate(shares):
        if name == "side":
            if len(rows) < 2:
                raise NotSeen
            row, t = rows[k % 2], rng.uniform(-0.8, 0.8)
        else:
            way, at = share * spans.sum(), 0
            while way > spans[at]:
                way, at = way - spans[at], at + 1
            row, t = rows[at], seen.ends[rows[at]][0] + way
        point = seen.chosen(np.array([row])).points(np.array([t]))[0]
        pixels.append(camera.project(truth.world_from_object.apply(point)[None])[0])
    if not camera.intrinsics.contains(np.array(pixels)).all():
        raise NotSeen
    return pixels


def on_side(
    truth: Primitive, camera: Camera, rng: np.random.Generator, turn: float, count: int
) -> list[np.ndarray]:
    """`count` pixels spread over the quarter of the top rim about `turn` from the facing side."""
    eye = truth.world_from_object.inverse().apply(camera.centre_world)
    shares = (np.arange(count) + rng.uniform(0.0, 1.0, count)) / count - 0.5
    angles = np.arctan2(eye[1], eye[0]) + turn + shares * np.pi / 2
    radius, level = truth.sizes[0], truth.half_extent[2]
    ring = np.column_stack([radius * np.cos(angles), radius * np.sin(angles)])
    points = np.column_stack([ring, np.full(count, level)])
    pixels = camera.project(truth.world_from_object.apply(points))
    if eye[2] < level or not camera.intrinsics.contains(pixels).all():
        raise NotSeen
    return list(pixels)


def round_picks(
    truth: Primitive, camera: Camera, rng: np.random.Generator, **counts: int
) -> dict[str, list]:
    """Picks by role: `rim=3, top=2, sides=2, hole=2, apex=1, outline=4`."""
    eye = truth.world_from_object.inverse().apply(camera.centre_world)
    curves = {
        "rim": "base rim",
        "top": "top rim",
        "sides": "side",
        "hole": "top hole" if eye[2] > 0 else "base hole",
        "outline": "outline",
    }
    picks = {}
    for role, count in counts.items():
        if role == "apex":
            points, _ = anchors("cone", truth.parameters, ["apex"])
            picks[role] = list(camera.project(truth.world_from_object.apply(points)))
        else:
            picks[role] = on_curves(truth, camera, rng, curves[role], count)
    return picks


def box_picks(truth: Primitive, camera: Camera, base: Sequence[int], top: Sequence[int]) -> dict:
    """Those of the wanted corners, by their places round the base, that show; null for others."""
    wanted = [f"{CORNERS[i]}base" for i in base] + [f"{CORNERS[i]}top" for i in top]
    found = corner_pixels(truth, camera, wanted)
    return {role: [found.get(f"{CORNERS[i]}{role}") for i in range(4)] for role in ("base", "top")}


def prism_picks(truth: Primitive, camera: Camera) -> dict:
    """All corners that show; each below or above at least."""
    names = anchor_names("prism", len(truth.parameters))
    found = corner_pixels(truth, camera, [n for n in names if not n.endswith("centre")])
    count = (len(truth.parameters) - 1) // 2
    picks = {role: [found.get(f"{role}{i}") for i in range(count)] for role in ("base", "top")}
    if any(a is None and b is None for a, b in zip(picks["base"], picks["top"], strict=True)):
        raise NotSeen
    return picks
