# SPDX-License-Identifier: GPL-3.0-or-later
"""The ways of picking that `pick_ways.py` tries: for each a random object, held and picked so."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from monocell.core import Pose
from monocell.core.primitives import Box, Cone, Cylinder, Prism, Sphere, Tube, polygon_centre
from monocell.core.reference import ReferencePlane
from monocell.core.relation import Relation
from pick_scenes import (
    FLOOR,
    RAMP,
    ROPE,
    WALL,
    NotSeen,
    Task,
    box_picks,
    on_side,
    prism_picks,
    random_camera,
    round_picks,
    standing,
    turned,
)

Rng = np.random.Generator
LYING = (np.pi / 2, 0.0, 0.0)


@dataclass(frozen=True)
class Way:
    """A name, and what makes a random task of this way."""

    name: str
    make: Callable[[Rng], Task]


def _enough(picks: dict, least: int) -> dict:
    if sum(p is not None for pixels in picks.values() for p in pixels) < least:
        raise NotSeen
    return picks


def _size(rng: Rng) -> np.ndarray:
    return rng.uniform(0.06, 0.3, 3)


def _box(rng: Rng, plane: ReferencePlane, base, top, least: int, known: tuple[str, ...] = ()):
    size = _size(rng)
    truth = Box("it", standing(rng, plane, size[2]), size=size)
    camera = random_camera(rng)
    picks = _enough(box_picks(truth, camera, base, top), least)
    return Task(camera, truth, picks, plane.name, known=known)


def _base_and_height(rng: Rng) -> Task:
    task = _box(rng, FLOOR, range(4), range(4), 7)
    base = [i for i, p in enumerate(task.picks["base"]) if p is not None]
    if len(base) < 3:
        raise NotSeen
    top = [p if i == base[0] else None for i, p in enumerate(task.picks["top"])]
    return Task(task.camera, task.truth, {**task.picks, "top": top}, "floor")


def _top_and_one(rng: Rng) -> Task:
    task = _box(rng, FLOOR, range(4), range(4), 7)
    base = [i for i, p in enumerate(task.picks["base"]) if p is not None]
    kept = [p if i == base[0] else None for i, p in enumerate(task.picks["base"])]
    if any(p is None for p in task.picks["top"]):
        raise NotSeen
    return Task(task.camera, task.truth, {**task.picks, "base": kept}, "floor")


def _leaning_box(rng: Rng) -> Task:
    size = _size(rng)
    # its y+ face lies against the wall, turned any way on it
    at = standing(rng, WALL, size[1])
    truth = Box("it", turned(at, (-np.pi / 2, 0, 0)), size=size)
    camera = random_camera(rng)
    picks = _enough(box_picks(truth, camera, range(4), range(4)), 6)
    return Task(camera, truth, picks, relations=(Relation("leans_on", "wall", "y+"),))


def _free_box(rng: Rng, known: tuple[str, ...], least: int) -> Task:
    size = _size(rng)
    at = standing(rng, FLOOR, size[2], rng.uniform(0, 0.3))
    truth = Box("it", turned(at, rng.uniform(-2, 2, 3)), size=size)
    camera = random_camera(rng)
    picks = _enough(box_picks(truth, camera, range(4), range(4)), least)
    return Task(camera, truth, picks, known=known)


def _cylinder_size(rng: Rng) -> tuple[float, float]:
    return rng.uniform(0.04, 0.15), rng.uniform(0.08, 0.4)


def _cylinder(rng: Rng, known: tuple[str, ...] = (), plane=FLOOR, **counts: int) -> Task:
    radius, height = _cylinder_size(rng)
    truth = Cylinder("it", standing(rng, plane, height), radius=radius, height=height)
    camera = random_camera(rng)
    picks = round_picks(truth, camera, rng, **counts)
    return Task(camera, truth, picks, plane.name, known=known)


def _top_sides(rng: Rng, *sides: tuple[float, int]) -> Task:
    """Three of the rim, and of the top so many about each turn from the side facing the camera."""
    task = _cylinder(rng, rim=3)
    tops = [on_side(task.truth, task.camera, rng, turn, count) for turn, count in sides]
    return replace(task, picks={**task.picks, "top": [p for top in tops for p in top]})


def _lying(rng: Rng, **counts: int) -> Task:
    radius, height = _cylinder_size(rng)
    at = turned(standing(rng, FLOOR, 2 * radius), LYING)
    truth = Cylinder("it", at, radius=radius, height=height)
    camera = random_camera(rng)
    picks = round_picks(truth, camera, rng, **counts)
    return Task(camera, truth, picks, relations=(Relation("lies_on", "floor"),))


def _shoulder(rng: Rng) -> Task:
    trunk = Cylinder("trunk", standing(rng, FLOOR, 0.6), radius=0.05, height=0.6)
    radius, height = rng.uniform(0.03, 0.08), rng.uniform(0.15, 0.4)
    along = trunk.world_from_object @ Pose.from_rotation_vector(
        [0, 0, rng.uniform(-np.pi, np.pi)], [0, 0, rng.uniform(0.0, 0.25)]
    )
    truth = Cylinder("it", turned(along, LYING), radius=radius, height=height)
    camera = random_camera(rng)
    picks = round_picks(truth, camera, rng, rim=3, top=3, sides=2)
    relations = (Relation("perpendicular", "trunk.axis"), Relation("centred_on", "trunk.axis"))
    return Task(camera, truth, picks, relations=relations, things={"trunk": trunk})


def _on_a_face(rng: Rng) -> Task:
    size = _size(rng)
    crate = Box("crate", standing(rng, FLOOR, size[2], 0.1), size=size)
    radius, height = rng.uniform(0.03, 0.08), rng.uniform(0.08, 0.3)
    out = Pose.from_rotation_vector([0, np.pi / 2, 0], [size[0] / 2 + height / 2, 0.01, 0.02])
    truth = Cylinder("it", crate.world_from_object @ out, radius=radius, height=height)
    camera = random_camera(rng)
    picks = round_picks(truth, camera, rng, rim=3, top=3)
    return Task(camera, truth, picks, "crate.x+", things={"crate": crate})


def _free_round(rng: Rng) -> Task:
    radius, height = _cylinder_size(rng)
    at = turned(standing(rng, FLOOR, height, rng.uniform(0, 0.3)), rng.uniform(-2, 2, 3))
    truth = Cylinder("it", at, radius=radius, height=height)
    camera = random_camera(rng)
    picks = round_picks(truth, camera, rng, rim=4, top=4, sides=2)
    return Task(camera, truth, picks, known=("radius",))


def _cone(rng: Rng, *, pointed: bool, lying: bool = False, **counts: int) -> Task:
    radius, height = _cylinder_size(rng)
    top = 0.0 if pointed else radius * rng.uniform(0.4, 1.5)
    at = standing(rng, FLOOR, height)
    relations: tuple[Relation, ...] = ()
    if lying:
        slope = np.arctan2(radius - top, height)
        middle = (radius + top) / 2 * np.cos(slope)
        at = turned(standing(rng, FLOOR, 2 * middle), (np.pi / 2 + slope, 0, 0))
        relations = (Relation("lies_on", "floor"),)
    truth = Cone("it", at, radius=radius, top_radius=top, height=height)
    camera = random_camera(rng)
    picks = round_picks(truth, camera, rng, **counts)
    known = ("top_radius",) if pointed else ()
    return Task(camera, truth, picks, None if lying else "floor", relations, known)


def _tube(rng: Rng, *, lying: bool = False, **counts: int) -> Task:
    radius, height = _cylinder_size(rng)
    at = standing(rng, FLOOR, height)
    if lying:
        at = turned(standing(rng, FLOOR, 2 * radius), LYING)
    inner = radius * rng.uniform(0.4, 0.9)
    truth = Tube("it", at, radius=radius, inner_radius=inner, height=height)
    camera = random_camera(rng)
    picks = round_picks(truth, camera, rng, **counts)
    relations = (Relation("lies_on", "floor"),) if lying else ()
    return Task(camera, truth, picks, None if lying else "floor", relations)


def _ball(rng: Rng, held: str, known: tuple[str, ...] = (), count: int = 4) -> Task:
    radius = rng.uniform(0.03, 0.15)
    at = standing(rng, FLOOR, 2 * radius, rng.uniform(0.1, 0.4) if held in ("", "rope") else 0.0)
    place, on, relations = at.translation, None, ()
    if held == "floor":
        on = "floor"
    if held == "wall":
        place = standing(rng, WALL, 2 * radius).translation
        relations = (Relation("touches", "wall"),)
    if held == "rope":
        side = rng.normal(size=3)
        side -= ROPE.direction * (side @ ROPE.direction)
        middle = ROPE.point + rng.uniform(0.1, 0.4) * ROPE.direction
        place = middle + radius * side / np.linalg.norm(side)
        relations = (Relation("touches", "rope"),)
    truth = Sphere("it", Pose(np.eye(3), place), radius=radius)
    camera = random_camera(rng)
    picks = round_picks(truth, camera, rng, outline=count)
    return Task(camera, truth, picks, on, relations, known)


def _prism(rng: Rng, *, lying: bool = False) -> Task:
    count, height = int(rng.integers(3, 7)), rng.uniform(0.06, 0.3)
    angle = 2 * np.pi * (np.arange(count) + rng.uniform(-0.25, 0.25, count)) / count
    away = rng.uniform(0.1, 0.18, count)
    polygon = np.stack([away * np.cos(angle), away * np.sin(angle)], axis=1)
    polygon = polygon - polygon_centre(polygon)
    at = standing(rng, FLOOR, height)
    relations: tuple[Relation, ...] = ()
    if lying:
        along = polygon[1] - polygon[0]
        out = np.array([along[1], -along[0]]) / np.linalg.norm(along)
        # side 0 turned down: its outward normal to the floor
        turn = -np.pi / 2 - np.arctan2(out[1], out[0])
        at = standing(rng, FLOOR, 2 * float(polygon[0] @ out))
        at = turned(turned(at, LYING), (0, 0, turn))
        relations = (Relation("stands_on", "floor", "side0"),)
    truth = Prism("it", at, polygon=polygon, height=height)
    camera = random_camera(rng)
    return Task(camera, truth, prism_picks(truth, camera), None if lying else "floor", relations)


ALL = range(4)
WAYS = (
    Way("box: three base corners and one of top", _base_and_height),
    Way("box: all corners that show", lambda r: _box(r, FLOOR, ALL, ALL, 7)),
    Way("box: the top face and one base corner", _top_and_one),
    Way("box: on a ramp, all that show", lambda r: _box(r, RAMP, ALL, ALL, 6)),
    Way("box: a face on a wall", _leaning_box),
    Way("box: floating, one size known", lambda r: _free_box(r, ("size_z",), 6)),
    Way(
        "box: floating, all sizes known", lambda r: _free_box(r, ("size_x", "size_y", "size_z"), 6)
    ),
    Way("cylinder: three of rim, three of top", lambda r: _cylinder(r, rim=3, top=3)),
    Way("cylinder: three of rim, top once in front", lambda r: _top_sides(r, (0.0, 1))),
    Way("cylinder: three of rim, top twice in front", lambda r: _top_sides(r, (0.0, 2))),
    Way("cylinder: three of rim, top thrice in front", lambda r: _top_sides(r, (0.0, 3))),
    Way("cylinder: three of rim, top once at the back", lambda r: _top_sides(r, (np.pi, 1))),
    Way(
        "cylinder: three of rim, top in front and back",
        lambda r: _top_sides(r, (0.0, 1), (np.pi, 1)),
    ),
    Way(
        "cylinder: two sides, one of rim, two of top", lambda r: _cylinder(r, rim=1, top=2, sides=2)
    ),
    Way("cylinder: five of rim, five of top, sides", lambda r: _cylinder(r, rim=5, top=5, sides=4)),
    Way("cylinder: on a ramp", lambda r: _cylinder(r, plane=RAMP, rim=3, top=3, sides=2)),
    Way(
        "cylinder: known height, rim and sides", lambda r: _cylinder(r, ("height",), rim=2, sides=2)
    ),
    Way("cylinder: lying, both ends and sides", lambda r: _lying(r, rim=4, top=3, sides=2)),
    Way("cylinder: lying, both ends", lambda r: _lying(r, rim=4, top=3)),
    Way("cylinder: the shoulder on a trunk", _shoulder),
    Way("cylinder: on the side of a crate", _on_a_face),
    Way("cylinder: floating, known radius", _free_round),
    Way("cone: frustum by its rims", lambda r: _cone(r, pointed=False, rim=3, top=3)),
    Way(
        "cone: frustum by sides and rims", lambda r: _cone(r, pointed=False, rim=2, top=4, sides=2)
    ),
    Way("cone: pointed, rim and apex", lambda r: _cone(r, pointed=True, rim=3, apex=1)),
    Way(
        "cone: pointed, rim, sides and apex",
        lambda r: _cone(r, pointed=True, rim=2, sides=2, apex=1),
    ),
    Way(
        "cone: lying frustum", lambda r: _cone(r, pointed=False, lying=True, rim=4, top=4, sides=2)
    ),
    Way("tube: rim, top and hole", lambda r: _tube(r, rim=3, top=3, hole=3)),
    Way("tube: lying", lambda r: _tube(r, lying=True, rim=4, top=3, sides=2, hole=3)),
    Way("sphere: floating, known radius", lambda r: _ball(r, "", ("radius",))),
    Way("sphere: on the floor", lambda r: _ball(r, "floor")),
    Way("sphere: on the floor, known radius", lambda r: _ball(r, "floor", ("radius",), 3)),
    Way("sphere: against a wall", lambda r: _ball(r, "wall")),
    Way("sphere: touching a line", lambda r: _ball(r, "rope")),
    Way("prism: all corners that show", _prism),
    Way("prism: lying on a side", lambda r: _prism(r, lying=True)),
)
