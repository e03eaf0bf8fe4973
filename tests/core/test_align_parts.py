# SPDX-License-Identifier: GPL-3.0-or-later
"""What alignment is made of: freedoms, outlines, samples of edges, steps of light, orders."""

from dataclasses import replace
from math import erf

import cv2
import numpy as np
import pytest
from drawn_tabletop import TABLE, box, camera, can, picture
from hypothesis import given, settings
from hypothesis import strategies as st
from monocell.core.align.align import _doubts, align
from monocell.core.align.color_models import in_shadow
from monocell.core.align.curve_samples import curve_samples
from monocell.core.align.depth_order import in_front, nearest_first
from monocell.core.align.freedom import Freedom
from monocell.core.align.hypotheses import hull_points, outlines
from monocell.core.align.result import AlignedObject
from monocell.core.align.step_edges import profiles, step_misfits
from monocell.core.modelling.solid import Solid
from monocell.core.pose import Pose
from monocell.core.primitives import Sphere

FREE = {"table": TABLE}


@pytest.mark.parametrize(("thing", "count"), [(box(), 6), (can(), 4)])
def test_what_stands_on_a_table_may_slide_turn_and_grow(thing, count):
    freedom = Freedom.of(thing, [thing], FREE)
    solid = Solid.of(thing)
    basis = freedom.basis(solid)
    assert basis.shape[1] == count
    moved = solid.moved(basis @ np.full(count, 0.01))
    foot = moved.place - moved.rotation[:, 2] * moved.parameters[-1] / 2
    assert abs(foot[2]) < 1e-12


def test_a_typed_size_is_not_free():
    thing = can(known={"radius": 0.05})
    basis = Freedom.of(thing, [thing], FREE).basis(Solid.of(thing))
    assert basis.shape[1] == 3
    assert np.abs(basis[6]).max() < 1e-12


def test_a_solid_off_its_table_is_brought_back():
    thing = can()
    freedom = Freedom.of(thing, [thing], FREE)
    tilted = Solid.of(thing).moved(np.array([0.02, -0.01, 0, 0, 0, 0.004, 0, 0]))
    kept = freedom.kept(tilted)
    assert abs(kept.place[2] - kept.parameters[1] / 2) < 1e-9
    assert abs(kept.rotation[2, 2] - 1) < 1e-12


@given(st.floats(-0.3, 0.3), st.floats(0.6, 1.4))
@settings(max_examples=25, deadline=None)
def test_an_outline_holds_its_hull_s_area(turn, grown):
    solid = Solid.of(box())._replace(parameters=box().sizes * grown)
    hulls = hull_points(solid, np.array([[0, 0, turn, 0, 0, 0, 0, 0, 0.0]]), camera())
    drawn = outlines(hulls, 400)
    # the sums along rows of a map of ones are the columns themselves
    area = drawn.integrals(drawn.pixels[:, :, 0])[0]
    hull = cv2.convexHull(hulls[0].astype(np.float32))
    assert area == pytest.approx(cv2.contourArea(hull), rel=0.01)


@pytest.mark.parametrize("thing", [box(), can(), Sphere("ball", Pose.identity(), radius=0.06)])
def test_samples_move_along_their_normals_as_their_derivatives_say(thing):
    solid, seen_by = Solid.of(thing), camera()
    at = curve_samples(solid, seen_by)
    rng = np.random.default_rng(3)
    step = rng.normal(0, 1e-5, 6 + len(solid.parameters))
    moved = curve_samples(solid.moved(step), seen_by)
    # an edge may slide along itself: only its distance along the old normals counts
    for name in set(at.names):
        one = np.array(at.names)[at.curve] == name
        other = moved.pixels[np.array(moved.names)[moved.curve] == name]
        if not one.any() or len(other) < 2:
            continue
        predicted = at.by_object[one] @ step
        found = [
            _distance(pixel, normal, other)
            for pixel, normal in zip(at.pixels[one], at.normals[one], strict=True)
        ]
        near = np.isfinite(found)
        np.testing.assert_allclose(np.array(found)[near], predicted[near], atol=3e-3)


def _distance(pixel, normal, polyline):
    """How far along its normal a pixel meets a curve that is sampled densely."""
    along = np.array([-normal[1], normal[0]])
    u, v = (polyline - pixel) @ along, (polyline - pixel) @ normal
    u, v = u[np.abs(v) < 4], v[np.abs(v) < 4]
    order = np.argsort(np.abs(u))[:3]
    if len(order) < 2 or u[order].min() > 0 or u[order].max() < 0:
        return np.nan
    return np.polyval(np.polyfit(u[order], v[order], len(order) - 1), 0.0)


@given(st.floats(-1.4, 1.4), st.floats(0.6, 1.2), st.booleans())
@settings(max_examples=40, deadline=None)
def test_a_blurred_step_is_found_where_it_is(place, blur, falling):
    light = _step_picture(place, blur, -1.0 if falling else 1.0)
    across = profiles(light, np.array([[20.0, 20.0]]), np.array([[1.0, 0.0]]), 5.0)
    misfits = step_misfits(across, np.array([False]), 5.0, 2.0, blur, 0.002)
    best = misfits.places[int(misfits.with_step[:, 0].argmin())]
    assert best == pytest.approx(place, abs=0.12)
    assert misfits.without[0] - misfits.with_step.min() > 100


def test_a_corner_that_light_fades_into_is_found_where_the_sides_meet():
    finer = 16
    x = (np.arange(41 * finer) + 0.5) / finer - 20.5
    inside = 0.03 + 0.05 * np.sqrt(np.maximum(-x, 0))
    outside = 0.06 + 0.04 * np.sqrt(np.maximum(x, 0))
    row = cv2.GaussianBlur(np.where(x < 0, inside, outside)[None], (0, 0), 0.65 * finer)
    row = row.reshape(41, finer).mean(axis=1)
    light = np.repeat(np.repeat(row[None], 41, axis=0)[:, :, None], 3, axis=2).astype(np.float32)
    across = profiles(light, np.array([[20.0, 20.0]]), np.array([[1.0, 0.0]]), 4.0)
    places = []
    for fading in (True, False):
        misfits = step_misfits(across, np.array([fading]), 4.0, 1.5, 0.75, 0.001)
        places.append(misfits.places[int(misfits.with_step[:, 0].argmin())])
    assert abs(places[0]) < 0.3
    assert abs(places[0]) < abs(places[1])


def test_what_is_nearer_comes_first_and_hides_what_is_behind():
    back, front = can("back", at=(-0.1, 0.05)), box("front", at=(0.06, -0.04))
    before = in_front([back, front], camera())
    assert before == [{1}, set()]
    assert nearest_first(before, [1.0, 0.8]) == [1, 0]


def test_a_circle_of_hiders_is_cut_at_the_nearest():
    assert nearest_first([{1}, {0}], [1.0, 2.0]) == [0, 1]


def _step_picture(place, blur, side):
    x = np.arange(41) - 20.0 - place
    # a pixel sees the mean of the light on it, and sampling between pixels blurs a little more
    row = np.array([0.4 + 0.2 * side * erf(v / (np.hypot(blur, 0.01) * np.sqrt(2))) for v in x])
    return np.repeat(np.repeat(row[None], 41, axis=0)[:, :, None], 3, axis=2).astype(np.float32)


def test_a_band_beside_a_foot_is_noticed_from_either_side():
    thing, seen_by = can(), camera()
    plain = picture([thing], seen_by, [(0.1, 0.2, 0.75)])
    aligned = align([thing], seen_by, plain, [TABLE])
    assert aligned.objects["can"].believed, aligned.objects["can"].reasons
    # the same can without its lowest two centimetres: its foot is a band's edge
    shorter = can(height=0.10)
    lifted = replace(
        shorter,
        world_from_object=Pose(
            np.eye(3), thing.world_from_object.translation + np.array([0, 0, 0.01])
        ),
    )
    both = picture([lifted, can("low", height=0.02)], seen_by, [(0.1, 0.2, 0.75), (0.5, 0.1, 0.1)])
    banded = align([can(height=0.112)], seen_by, both, [TABLE])
    told = banded.objects["can"]
    assert not told.believed or told.thing.height == pytest.approx(0.12, abs=0.002)


@pytest.mark.filterwarnings("error")
def test_on_black_ground_nothing_counts_as_its_shadow():
    light = np.zeros((50, 3))
    np.testing.assert_array_equal(in_shadow(light, np.ones(50, dtype=bool)), 0.0)


def test_one_believed_among_many_is_doubted_and_most_are_not():
    thing = box()
    told = AlignedObject(thing, thing, True, ())
    strange = AlignedObject(thing, thing, False, ("no edges",))
    few = {"a": told} | {f"b{i}": strange for i in range(6)}
    assert "only a of 7 objects" in _doubts(few)[0]
    assert _doubts({"a": told, "b": strange}) == ()
