# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces, edges and axes of every solid lie where its corners say, and move as its tangent says."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from drawn import differences
from hypothesis import given, settings
from hypothesis import strategies as st
from monocell.core import Box, Cone, Cylinder, Pose, Prism, Sphere, Tube
from monocell.core.errors import InvalidValue
from monocell.core.rotation import rotation_from_vector
from monocell.core.shape.features import feature, feature_names

POSE = Pose.from_rotation_vector([0.3, -0.7, 1.1], [0.4, -0.2, 0.6])
# an L, about its own centre of area
ELL = np.array([[0, 0], [0.3, 0], [0.3, 0.1], [0.1, 0.1], [0.1, 0.25], [0, 0.25]])
THINGS = {
    "box": Box("crate", POSE, size=[0.3, 0.2, 0.1]),
    "cylinder": Cylinder("drum", POSE, radius=0.1, height=0.3),
    "sphere": Sphere("ball", POSE, radius=0.1),
    "cone": Cone("spike", POSE, radius=0.1, height=0.3),
    "frustum": Cone("pot", POSE, radius=0.1, top_radius=0.15, height=0.3),
    "tube": Tube("pipe", POSE, radius=0.1, inner_radius=0.08, height=0.3),
    "prism": Prism("ell", POSE, polygon=[[-0.1, -0.1], [0.2, -0.1], [-0.1, 0.2]], height=0.2),
}
EVERY = [(kind, name) for kind, thing in THINGS.items() for name in feature_names(thing)]
every_feature = pytest.mark.parametrize(("kind", "name"), EVERY)


def moved(thing, tangent):
    """The object after a step on its tangent; a prism's frame is held."""
    pose = Pose(
        rotation_from_vector(tangent[:3]) @ thing.world_from_object.rotation,
        thing.world_from_object.translation + tangent[3:6],
    )
    parameters = thing.parameters + tangent[6:]
    if isinstance(thing, Prism):
        free = Prism.__new__(Prism)
        for name, value in vars(thing).items():
            object.__setattr__(free, name, value)
        object.__setattr__(free, "world_from_object", pose)
        object.__setattr__(free, "height", parameters[0])
        object.__setattr__(free, "polygon", parameters[1:].reshape(-1, 2))
        return free
    return replace(thing.with_parameters(parameters), world_from_object=pose)


@every_feature
def test_derivatives_match_differences(kind, name):
    thing = THINGS[kind]
    found = feature(thing, name)
    if kind == "cone":
        # one side of a tip at radius 0 is no cone; no feature of a cone depends on it
        thing = replace(thing, top_radius=0.01)
    zero = np.zeros(6 + len(thing.parameters))
    for stated, what in ((found.by_point, "point"), (found.by_direction, "direction")):
        shown = differences(
            lambda t, w=what: getattr(feature(moved(thing, t), name), w), zero, 1e-5
        )
        np.testing.assert_allclose(stated, shown, atol=1e-9)


@every_feature
def test_directions_are_unit(kind, name):
    assert np.linalg.norm(feature(THINGS[kind], name).direction) == pytest.approx(1.0, abs=1e-14)


@settings(max_examples=50, deadline=None)
@given(size=st.tuples(*[st.floats(0.01, 2.0)] * 3), seed=st.integers(0, 2**16))
def test_all_corners_of_a_box_lie_within_its_faces_and_four_on_each(size, seed):
    pose = Pose.from_rotation_vector(*np.random.default_rng(seed).uniform(-2, 2, (2, 3)))
    box = Box("box", pose, size=size)
    for name in ("base", "top", "x-", "x+", "y-", "y+"):
        face = feature(box, name)
        heights = (box.corners_world() - face.point) @ face.direction
        assert (heights < 1e-9).all()
        assert (np.abs(heights) < 1e-9).sum() == 4
        on_it = box.corners_world()[np.abs(heights) < 1e-9]
        np.testing.assert_allclose(on_it.mean(axis=0), face.point, atol=1e-9)


@pytest.mark.parametrize("name", [n for k, n in EVERY if k == "box" and len(n) in (4, 5, 6)])
def test_an_edge_of_a_box_lies_on_both_its_faces_and_joins_two_corners(name):
    box = THINGS["box"]
    line = feature(box, name)
    if line.kind != "line" or name.startswith("axis"):
        return
    for face in (feature(box, name[:2]), feature(box, name[2:])):
        assert abs((line.point - face.point) @ face.direction) < 1e-12
        assert abs(line.direction @ face.direction) < 1e-12
    away = np.linalg.norm(np.cross(box.corners_world() - line.point, line.direction), axis=1)
    assert (away < 1e-12).sum() == 2


def test_a_box_has_six_faces_twelve_edges_three_axes_and_a_centre():
    kinds = [feature(THINGS["box"], name).kind for name in feature_names(THINGS["box"])]
    assert [kinds.count(kind) for kind in ("plane", "line", "point")] == [6, 15, 1]


def test_sides_of_a_prism_look_outward_and_hold_their_two_edges():
    prism = Prism("ell", POSE, polygon=ELL - polygon_middle(), height=0.2)
    for i in range(6):
        side = feature(prism, f"side{i}")
        for corner in (i, (i + 1) % 6):
            edge = feature(prism, f"edge{corner}")
            assert abs((edge.point - side.point) @ side.direction) < 1e-12
            assert abs(edge.direction @ side.direction) < 1e-12
        # a step inward from the middle of a side is inside the L, which no other side denies
        local = prism.world_from_object.inverse().apply(side.point - 1e-3 * side.direction)
        assert inside_ell(local[:2] + polygon_middle())


def polygon_middle():
    parts = [(0.3 * 0.1, [0.15, 0.05]), (0.1 * 0.15, [0.05, 0.175])]
    return sum(a * np.array(c) for a, c in parts) / sum(a for a, _ in parts)


def inside_ell(p):
    return bool((p > 0).all() and ((p < [0.3, 0.1]).all() or (p < [0.1, 0.25]).all()))


@pytest.mark.parametrize("kind", ["cylinder", "frustum", "tube", "prism"])
def test_base_and_top_are_a_height_apart_and_look_away_from_each_other(kind):
    thing = THINGS[kind]
    base, top = feature(thing, "base"), feature(thing, "top")
    np.testing.assert_allclose(top.point - base.point, thing.height * top.direction, atol=1e-12)
    np.testing.assert_allclose(base.direction, -top.direction)
    np.testing.assert_allclose(feature(thing, "axis").direction, top.direction)


def test_a_cone_that_ends_in_a_point_has_no_top():
    with pytest.raises(InvalidValue, match="spike: a cone has no feature 'top'; it has base, axis"):
        feature(THINGS["cone"], "top")


def test_an_unknown_feature_is_refused_with_what_there_is():
    with pytest.raises(InvalidValue, match=r"ball: a sphere has no feature 'base'; it has centre$"):
        feature(THINGS["sphere"], "base")
