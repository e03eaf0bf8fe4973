# SPDX-License-Identifier: GPL-3.0-or-later
"""Curves of all solids: rims where they are, silhouettes where sight touches, true derivatives."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from monocell.core.shape.curves import CURVES, curves

SHAPES = {
    "box": [0.2, 0.12, 0.15],
    "cylinder": [0.1, 0.25],
    "sphere": [0.08],
    "cone": [0.1, 0.04, 0.2],
    "tube": [0.1, 0.07, 0.12],
    "prism": [0.15, -0.1, -0.06, 0.11, -0.05, 0.08, 0.07, -0.02, 0.02, -0.09, 0.08],
}
directions = st.tuples(*[st.floats(-1, 1)] * 3).filter(lambda d: np.linalg.norm(d) > 0.3)


def eye_at(direction, distance=1.5):
    return distance * np.array(direction) / np.linalg.norm(direction)


def samples(found, count=7):
    t = np.linspace(*found.ends.T, count)
    return t, found.points(t), found.tangents(t)


@pytest.mark.parametrize("kind", SHAPES)
@given(direction=directions)
def test_tangents_are_the_derivatives_of_the_points(kind, direction):
    found = curves(kind, np.array(SHAPES[kind]), eye_at(direction))
    t, _, tangents = samples(found)
    step = 1e-6
    slope = (found.points(t + step) - found.points(t - step)) / (2 * step)
    np.testing.assert_allclose(tangents, slope, atol=1e-9)


@pytest.mark.parametrize("kind", SHAPES)
@given(direction=directions)
def test_images_of_curves_move_as_their_derivatives_say(kind, direction):
    """Across the image only: along itself a touching line may slide."""
    parameters, eye = np.array(SHAPES[kind]), eye_at(direction)
    found = curves(kind, parameters, eye)
    t, points, tangents = samples(found, 3)
    by = found.points_by(t)
    sight = np.cross(points - eye, tangents)
    sight /= np.linalg.norm(sight, axis=-1, keepdims=True) + 1e-300
    for j in range(len(parameters)):
        step = np.zeros(len(parameters))
        step[j] = 1e-6
        moved, back = (curves(kind, parameters + s, eye) for s in (step, -step))
        if not moved.names == found.names == back.names:
            continue
        # the moved curve's distance from the old plane of sight, to first order
        lines = ~found.round
        across = (sight * by[..., j]).sum(-1)[:, lines]
        # from both sides: near where a silhouette ends it turns fast
        seen = ((moved.points(t) - back.points(t)) * sight).sum(-1)[:, lines] / 2e-6
        np.testing.assert_allclose(across, seen, atol=2e-4)


@pytest.mark.parametrize("kind", ["cylinder", "cone", "tube"])
@given(direction=directions)
def test_sight_touches_the_side_along_its_silhouettes(kind, direction):
    parameters, eye = np.array(SHAPES[kind]), eye_at(direction)
    found = curves(kind, parameters, eye)
    radius, height = parameters[0], parameters[-1]
    top = parameters[1] if kind == "cone" else radius
    for i, name in enumerate(found.names):
        if not name.startswith("side"):
            continue
        points = found.points(np.linspace(-1, 1, 5)[:, None] * np.ones(len(found)))[:, i]
        out = np.column_stack(
            [points[:, :2] / np.linalg.norm(points[:, :2], axis=1)[:, None], np.zeros(5)]
        )
        out[:, 2] = (radius - top) / height
        np.testing.assert_allclose(((eye - points) * out).sum(1), 0, atol=1e-12)


@given(direction=directions)
def test_a_ball_s_outline_is_where_sight_touches_it(direction):
    eye = eye_at(direction)
    found = curves("sphere", np.array([0.08]), eye)
    _, points, _ = samples(found, 9)
    np.testing.assert_allclose(np.linalg.norm(points, axis=-1), 0.08, atol=1e-12)
    np.testing.assert_allclose(((eye - points) * points).sum(-1), 0, atol=1e-12)


def test_from_inside_a_ball_has_no_outline():
    assert len(curves("sphere", np.array([0.08]), np.array([0.01, 0, 0]))) == 0


def test_a_pointed_cone_has_no_top_rim_and_from_above_no_hidden_curve():
    found = curves("cone", np.array([0.1, 0.0, 0.2]), np.array([0.01, 0, 3.0]))
    assert set(found.names) == {"base rim"}
    assert found.visible.all()


def test_a_tube_shows_its_far_hole_through_the_near_one():
    found = curves("tube", np.array(SHAPES["tube"]), np.array([0.0, 0.05, 2.0]))
    through = [
        (end - start, seen)
        for name, (start, end), seen in zip(found.names, found.ends, found.visible, strict=True)
        if name == "base hole"
    ]
    assert sum(length for length, _ in through) == pytest.approx(2 * np.pi)
    (seen,) = [length for length, visible in through if visible]
    # checked by hand: rays from the eye to the far rim's points cross the near plane in the hole
    angle = np.linspace(-np.pi, np.pi, 20001)
    rim = np.column_stack([0.07 * np.cos(angle), 0.07 * np.sin(angle), np.full(20001, -0.06)])
    eye = np.array([0.0, 0.05, 2.0])
    crossing = eye + (rim - eye) * (2.0 - 0.06) / (2.0 + 0.06)
    share = (np.hypot(crossing[:, 0], crossing[:, 1]) < 0.07).mean()
    assert seen == pytest.approx(2 * np.pi * share, abs=2e-3)


def test_every_kind_of_solid_has_its_curves():
    from monocell.core.primitives import KINDS

    assert set(CURVES) == set(KINDS) == set(SHAPES)
