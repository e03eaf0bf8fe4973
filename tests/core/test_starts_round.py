# SPDX-License-Identifier: GPL-3.0-or-later
"""Round solids come back from their rims and sides, standing, lying, held or known; slips told."""

from __future__ import annotations

import numpy as np
import pytest
from held_scene import ROPE, assert_same, shown, sketched, solve, standing, turned
from monocell.core import Pose
from monocell.core.errors import PickError
from monocell.core.primitives import Box, Cone, Cylinder, Sphere, Tube
from monocell.core.relation import Relation
from monocell.core.shape.anchors import anchors
from picked_scene import FLOOR, RAMP, WALL, camera

LYING = (np.pi / 2, 0.0, 0.0)


def solved(thing, picks, things=None, **held):
    return solve(sketched(thing, picks, **held), things).fitted.thing


def cylinder(at, radius=0.08, height=0.22):
    return Cylinder("it", at, radius=radius, height=height)


def cone(top, plane=FLOOR, height=0.25):
    return Cone("it", standing(plane, height), radius=0.1, top_radius=top, height=height)


def apex(thing):
    points, _ = anchors("cone", thing.parameters, ["apex"])
    return camera().project(thing.world_from_object.apply(points)).tolist()


@pytest.mark.parametrize("yaw", [0.2, 1.4, 2.9])
def test_a_cylinder_lies_on_the_floor(yaw):
    truth = cylinder(turned(standing(FLOOR, 0.16, 0.1, 0.0, yaw), LYING))
    picks = shown(truth, rim=4, top=3, sides=2)
    assert_same(solved(truth, picks, relations=[Relation("lies_on", "floor")]), truth)


def test_the_shoulder_lies_across_the_trunk():
    trunk = Cylinder("trunk", standing(FLOOR, 0.5), radius=0.06, height=0.5)
    at = turned(Pose(np.eye(3), trunk.world_from_object.apply([0, 0, 0.2])), (np.pi / 2, 0.6, 0))
    relations = [Relation("perpendicular", "trunk.axis"), Relation("centred_on", "trunk.axis")]
    truth = cylinder(_level(at), 0.05, 0.3)
    picks = shown(truth, rim=4, top=3, sides=2)
    assert_same(solved(truth, picks, {"trunk": trunk}, relations=relations), truth)


def _level(at):
    """The same place, its axis level."""
    axis = at.rotation[:, 2] * [1, 1, 0]
    axis = axis / np.linalg.norm(axis)
    side = np.cross([0, 0, 1.0], axis)
    return Pose(np.stack([side, np.cross(axis, side), axis], axis=1), at.translation)


def test_a_cylinder_stands_on_the_side_of_a_crate():
    crate = Box("crate", standing(FLOOR, 0.2, 0.0, 0.0, -0.9), size=[0.2, 0.2, 0.2])
    out = Pose.from_rotation_vector([0, np.pi / 2, 0], [0.1 + 0.05, 0.0, 0.0])
    truth = cylinder(crate.world_from_object @ out, 0.05, 0.1)
    picks = shown(truth, rim=3, top=4)
    assert_same(solved(truth, picks, {"crate": crate}, on="crate.x+"), truth)


def test_a_floating_cylinder_of_known_radius_comes_back():
    at = turned(standing(FLOOR, 0.5), (0.5, 0.3, 0.0))
    truth = cylinder(at)
    picks = shown(truth, rim=4, top=4, sides=2)
    assert_same(solved(truth, picks, known=("radius",)), truth, atol=1e-6)
    with pytest.raises(PickError, match="it: nothing tells how large it is: a cylinder that fl"):
        solved(truth, picks)


@pytest.mark.parametrize("plane", [FLOOR, RAMP], ids=lambda p: p.name)
@pytest.mark.parametrize("top", [0.06, 0.14])
def test_a_frustum_comes_back_from_its_rims(plane, top):
    truth = cone(top, plane)
    picks = shown(truth, rim=4, top=4, sides=2)
    assert_same(solved(truth, picks, on=plane.name), truth, atol=1e-6)


@pytest.mark.parametrize("sides", [0, 2])
def test_a_pointed_cone_is_picked_by_its_apex(sides):
    truth = cone(0.0)
    picks = {**shown(truth, rim=3, sides=sides), "apex": apex(truth)}
    found = solved(truth, picks, on="floor")
    assert_same(found, truth)
    assert found.top_radius == 0
    assert found.size_sigma()[1] == 0


def test_a_cone_lies_on_its_side():
    slope = np.arctan2(0.1 - 0.06, 0.25)
    middle = 0.08 * np.cos(slope)
    at = turned(standing(FLOOR, 2 * middle, yaw=1.0), (np.pi / 2 + slope, 0, 0))
    truth = Cone("it", at, radius=0.1, top_radius=0.06, height=0.25)
    picks = shown(truth, rim=4, top=4, sides=2)
    assert_same(solved(truth, picks, relations=[Relation("lies_on", "floor")]), truth, 1e-6)


@pytest.mark.parametrize("lying", [False, True])
def test_a_tube_comes_back_with_its_wall(lying):
    at = turned(standing(FLOOR, 0.2, yaw=0.3), LYING) if lying else standing(FLOOR, 0.22)
    truth = Tube("it", at, radius=0.1, inner_radius=0.07, height=0.22)
    picks = shown(truth, rim=3, top=3, hole=3, sides=2)
    held = {"relations": [Relation("lies_on", "floor")]} if lying else {"on": "floor"}
    assert_same(solved(truth, picks, **held), truth)


def ball(place, radius=0.07):
    return Sphere("it", Pose(np.eye(3), np.array(place)), radius=radius)


def test_a_floating_ball_of_known_radius_comes_back():
    truth = ball([0.1, 0.0, 0.4])
    assert_same(solved(truth, shown(truth, outline=4), known=("radius",)), truth)


@pytest.mark.parametrize("plane", [FLOOR, RAMP, WALL], ids=lambda p: p.name)
def test_the_plane_that_a_ball_rests_on_tells_its_radius(plane):
    truth = ball(standing(plane, 0.14).translation)
    assert_same(solved(truth, shown(truth, outline=4), on=plane.name), truth)


def test_the_line_that_a_ball_touches_tells_its_radius_or_a_rival():
    side = np.cross(ROPE.direction, [1.0, -1.0, 0.0])
    side = side / np.linalg.norm(side)
    truth = ball(ROPE.point + 0.3 * ROPE.direction + 0.07 * side)
    chosen = solve(
        sketched(truth, shown(truth, outline=5), relations=[Relation("touches", "rope")])
    )
    rival = any("the picks fit two spheres" in w for w in chosen.warnings)
    found = chosen.fitted.thing
    assert rival or abs(found.radius - truth.radius) < 1e-7
    away = np.linalg.norm(
        np.cross(found.world_from_object.translation - ROPE.point, ROPE.direction)
    )
    assert away == pytest.approx(found.radius, abs=1e-9)


def test_two_picks_and_a_known_radius_place_a_ball_on_a_plane():
    truth = ball([0.1, 0.0, 0.07])
    picks = {"outline": shown(truth, outline=5)["outline"][:3]}
    assert_same(solved(truth, picks, on="floor", known=("radius",)), truth)


STANDING = cylinder(standing(FLOOR, 0.22))
GOOD = shown(STANDING, rim=3, top=3, sides=2)
CONE, BALL = cone(0.0), ball([0.1, 0.0, 0.07])
REFUSED = {
    "a ball without size": (BALL, shown(BALL, outline=4), {}, "it: nothing tells how large it is"),
    "a ball of two picks": (
        BALL,
        shown(BALL, outline=2),
        {"on": "floor"},
        "it: 2 outline picks give 2 equations for the 3 numbers of its place, radius; pick 1 more",
    ),
    "no outline": (
        BALL,
        {"outline": [[600.0, 500.0]] * 4},
        {"on": "floor"},
        r"it: outline\[0\] to outline\[3\]: the 4 rays bend away",
    ),
    "apex and top": (
        CONE,
        {**shown(CONE, rim=3), "apex": apex(CONE), "top": GOOD["top"]},
        {"on": "floor"},
        "it: a cone ends in one apex, or in a top circle; 1 apex and 3 top picks say both",
    ),
    "sides alone": (
        STANDING,
        {"sides": GOOD["sides"]},
        {"known": ("radius", "height"), "relations": [Relation("parallel", "rope")]},
        "it: 0 rim, 0 top and 2 side picks give 2 equations for the 3 numbers of its place and",
    ),
    "no height": (STANDING, {"rim": GOOD["rim"]}, {"on": "floor"}, "it: nothing tells its height"),
    "too few lying": (
        STANDING,
        {"rim": GOOD["rim"][:1], "top": GOOD["top"][:2]},
        {"relations": [Relation("lies_on", "floor")]},
        "it: 1 rim, 2 top and 0 side picks give 3 equations for the 5 numbers of its place",
    ),
}


@pytest.mark.parametrize("case", REFUSED)
def test_picks_that_can_mean_no_such_solid_are_refused_by_name(case):
    thing, picks, held, message = REFUSED[case]
    with pytest.raises(PickError, match=message) as refusal:
        solved(thing, picks, **held)
    assert "\n" not in str(refusal.value)


def test_a_rim_pick_behind_the_cylinder_is_warned_of_by_name():
    many = shown(STANDING, rim=6, top=4, sides=2)
    assert solve(sketched(STANDING, many, on="floor")).warnings == ()
    seen = STANDING.world_from_object.inverse().apply(camera().centre_world)
    behind = -0.08 * np.append(seen[:2], 0.0) / np.linalg.norm(seen[:2]) - [0, 0, 0.11]
    pixel = camera().project(STANDING.world_from_object.apply(behind)[None])[0].tolist()
    told = solve(sketched(STANDING, {**many, "rim": [*many["rim"], pixel]}, on="floor")).warnings
    assert "it: rim[6] lies where the solved cylinder hides itself" in told[0]
