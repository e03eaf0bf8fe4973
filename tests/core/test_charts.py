# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from monocell.core.errors import InvalidValue
from monocell.core.pose import Pose
from monocell.core.primitives import Box, Cone, Cylinder, Prism, Sphere, Tube, polygon_centre
from monocell.core.shape.charts import chart_of
from monocell.core.shape.hits import face_names, hits

HERE = Pose.identity()
WEDGE = np.array([[0.3, 0], [0.1, 0.2], [-0.2, 0.1], [-0.1, -0.2]])
SOLIDS = (
    Box("box", HERE, size=[0.4, 0.3, 0.5]),
    Cylinder("cylinder", HERE, radius=0.2, height=0.5),
    Sphere("sphere", HERE, radius=0.25),
    Cone("pointed", HERE, radius=0.25, height=0.4),
    Cone("bucket", HERE, radius=0.1, top_radius=0.25, height=0.4),
    Tube("tube", HERE, radius=0.25, inner_radius=0.2, height=0.4),
    Prism("wedge", HERE, polygon=WEDGE - polygon_centre(WEDGE), height=0.3),
)
EACH_FACE = pytest.mark.parametrize(
    ("thing", "face"),
    [(thing, face) for thing in SOLIDS for face in face_names(thing)],
    ids=lambda value: value if isinstance(value, str) else value.name,
)
INNER = st.tuples(st.floats(0.02, 0.98), st.floats(0.02, 0.98)).map(lambda st: np.array([st]))


@EACH_FACE
@settings(max_examples=12, deadline=None)
@given(INNER)
def test_a_chart_and_back_is_where_one_was(thing, face, st):
    chart = chart_of(thing, face)
    assert np.allclose(chart.coordinates(chart.points(st)), st, atol=1e-9)
    # near another turn of the same place, s goes on past the seam
    near = st + np.array([[1.0, 0.0]])
    along = chart.coordinates(chart.points(st), near)
    assert np.allclose(chart.points(along), chart.points(st), atol=1e-9)


@EACH_FACE
@settings(max_examples=12, deadline=None)
@given(INNER)
def test_a_ray_against_the_normal_meets_that_face_there(thing, face, st):
    chart = chart_of(thing, face)
    point, normal = chart.points(st)[0], chart.normals(st)[0]
    met = hits(thing, point + 1e-3 * normal, -normal[None])
    if chart.covers(st)[0]:
        assert face_names(thing)[met.face[0]] == face
        assert np.isclose(met.depth[0], 1e-3, atol=1e-12)
    else:
        assert met.face[0] == -1 or face_names(thing)[met.face[0]] != face


@EACH_FACE
@settings(max_examples=12, deadline=None)
@given(INNER)
def test_a_chart_is_seen_from_outside_with_s_to_the_right_and_t_down(thing, face, st):
    chart, step = chart_of(thing, face), 1e-6
    s, t = np.array([[[step, 0]], [[0, step]]])
    right, down = (chart.points(st + by) - chart.points(st - by) for by in (s, t))
    towards_the_eye = np.cross(down, right)[0]
    unit = towards_the_eye / np.linalg.norm(towards_the_eye)
    assert np.allclose(unit, chart.normals(st)[0], atol=1e-6)
    # up is the object's z, or y where the face looks along z
    up = [0, 1, 0] if face in ("base", "top") else [0, 0, 1]
    assert (down @ up)[0] < 0


def test_the_ends_of_round_solids_are_discs_and_rings_in_their_squares():
    cylinder, tube = SOLIDS[1], SOLIDS[5]
    middle, corner, rim = np.array([[[0.5, 0.5]], [[0.02, 0.02]], [[0.5, 0.02]]])
    assert chart_of(cylinder, "top").covers(middle)[0]
    assert not chart_of(cylinder, "top").covers(corner)[0]
    assert not chart_of(tube, "top").covers(middle)[0]
    assert chart_of(tube, "top").covers(rim)[0]


def test_a_corner_on_the_axis_takes_the_turn_of_its_neighbours():
    chart = chart_of(SOLIDS[3], "side")
    st = chart.coordinates([[0, 0, 0.2]], [[0.7, 0.5]])
    assert np.allclose(st, [[0.7, 0.0]])


def test_a_face_that_the_solid_has_not_is_refused_with_those_it_has():
    with pytest.raises(InvalidValue, match=r"no face 'top'; it has side, base"):
        chart_of(SOLIDS[3], "top")
