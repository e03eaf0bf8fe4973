# SPDX-License-Identifier: GPL-3.0-or-later
import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from monocell.core.document.sighting_entries import sighting_entry
from monocell.core.document.sighting_text import Unsaid, sightings_from_text
from monocell.core.errors import DocumentError
from monocell.core.sighting import PointSighting, SphereSighting

PLACES = [[0.62, -0.42, 0.18], [0.7, 0.02, 0.12], [0.52, 0.45, 0.22]]
THREE = Unsaid(("a.png", "b.png", "c.png"), 0.04)


def places(text, unsaid=THREE):
    return [s.center_world.tolist() for s in sightings_from_text(text, unsaid)]


@pytest.mark.parametrize("between", [" ", "\t", ",", ", ", ";", "  "])
def test_rows_of_numbers_are_positions_whatever_parts_them(between):
    text = "\n".join(between.join(str(v) for v in place) for place in PLACES)
    assert places(text) == PLACES


def test_decimal_commas_brackets_comments_and_empty_lines_are_read():
    text = "# from the pendant\n0,62; -0,42; 0,18\n\n(0.7, 0.02, 0.12)\n// last\n0.52\t0.45\t0.22,"
    with pytest.raises(DocumentError, match="row 6"):
        places(text)
    assert places(text.rstrip(",")) == PLACES


def test_pictures_go_to_positions_in_their_order():
    found = sightings_from_text("\n".join("{} {} {}".format(*p) for p in PLACES), THREE)
    assert [s.picture for s in found] == ["a.png", "b.png", "c.png"]
    assert {s.radius for s in found} == {0.04}


def test_one_picture_may_show_all_balls():
    text = "\n".join("{} {} {}".format(*p) for p in PLACES)
    found = sightings_from_text(text, Unsaid(("all.png",), 0.03))
    assert {s.picture for s in found} == {"all.png"}


def test_a_number_of_pictures_that_does_not_fit_is_refused():
    with pytest.raises(DocumentError, match="2 positions name no picture, and 3 pictures"):
        places("0.1 0.2 0.3\n0.4 0.5 0.6")


def test_a_picture_may_stand_before_or_after_its_numbers():
    found = sightings_from_text("p1.jpg, 0.6, 0.1, 0.2\n0.7, 0.3, 0.1, p2.jpg", THREE)
    assert [s.picture for s in found] == ["p1.jpg", "p2.jpg"]


def test_a_heading_names_columns_in_any_order_and_their_unit():
    text = "picture,z_mm,x_mm,y_mm,radius\np.jpg,180,620,-420,40\nq.jpg,120,700,20,40"
    found = sightings_from_text(text, THREE)
    assert np.allclose([s.center_world for s in found], PLACES[:2])
    assert [s.radius for s in found] == [0.04, 0.04]


def test_pixels_make_points():
    (point,) = sightings_from_text("x,y,z,u,v\n0.1,0.2,0.3,310.5,220.25", Unsaid(("p.png",), 0.04))
    assert isinstance(point, PointSighting)
    assert point.pixel.tolist() == [310.5, 220.25]


def test_the_unit_of_bare_rows_is_the_one_chosen():
    assert np.allclose(
        places("620 -420 180\n700 20 120\n520 450 220", Unsaid(THREE.pictures, 0.04, "mm")), PLACES
    )


@pytest.mark.parametrize(
    ("text", "unit", "told"),
    [
        ("620 -420 180\n700 20 120\n520 450 220", "m", "are these millimetres"),
        ("0.62 -0.42 0.18\n0.7 0.02 0.12\n0.52 0.45 0.22", "mm", "are these metres"),
    ],
)
def test_a_unit_that_can_not_be_meant_is_refused(text, unit, told):
    with pytest.raises(DocumentError, match=told):
        places(text, Unsaid(THREE.pictures, 0.04, unit))


def test_json_lists_and_objects_are_read():
    assert places(json.dumps(PLACES)) == PLACES
    assert places(json.dumps(PLACES[0]), Unsaid(("a.png",), 0.04)) == PLACES[:1]
    listed = [{"center": place, "picture": f"{i}.png"} for i, place in enumerate(PLACES)]
    assert [s.picture for s in sightings_from_text(json.dumps(listed), THREE)][2] == "2.png"


def test_a_cell_document_s_sightings_come_whole():
    given_ones = [SphereSighting("x.png", PLACES[0], 0.04, (10, 20, 90, 80), use=False)]
    text = json.dumps({"monocell": 1, "sightings": [sighting_entry(s) for s in given_ones]})
    (back,) = sightings_from_text(text, THREE)
    assert sighting_entry(back) == sighting_entry(given_ones[0])
    assert not back.use


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("", "no text"),
        ("# nothing", "only comments"),
        ("0.1 0.2", "row 1: expected x y z, got '0.1 0.2'"),
        ("0.1 0.2 0.3\nabc", "row 2"),
        ("0.1 0.2 nan", "row 1"),
        ("x,y,z\n1,2", "row 2: has 2 columns, the heading 3"),
        ("x,y,z\n1,2,oh", "row 2: expected a number, got 'oh'"),
        ("x_mm,y_m,z\n1,2,3", "different units"),
        ("[[1, 2]]", r"\[0\]: expected 3 numbers, got 2"),
        ("[1, 2", "the text: is not JSON"),
        ('{"a": 1}', "no sightings"),
    ],
)
def test_what_can_not_be_read_is_named(text, told):
    with pytest.raises(DocumentError, match=told):
        places(text)


@given(
    st.lists(
        st.tuples(*[st.floats(-3, 3, allow_nan=False) for _ in range(3)]), min_size=1, max_size=5
    ),
    st.sampled_from([" ", ",", ";", "\t"]),
)
def test_every_digit_survives(rows, between):
    spread = np.ptp(np.array(rows), axis=0).max()
    if len(rows) > 1 and spread < 0.01:
        return
    text = "\n".join(between.join(repr(v) for v in row) for row in rows)
    assert places(text, Unsaid(("p.png",), 0.04)) == [list(row) for row in rows]
