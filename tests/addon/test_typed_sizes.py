# SPDX-License-Identifier: GPL-3.0-or-later
"""Sizes typed while picking."""

import bench_cell
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from monocell.addon.picking.pick_plans import BOX
from monocell.addon.picking.pick_session import PickSession

CORNERS = bench_cell.CAMERA.project(bench_cell.BOX.corners_world())
BASE = CORNERS[bench_cell.ROUND]
# above the second base corner
TOP = CORNERS[5]


def session(plan, *pixels):
    started = PickSession(plan, bench_cell.CAMERA, bench_cell.FLOOR)
    for pixel in pixels:
        started = started.picked(np.array(pixel))
    return started


def typed(started, text):
    for sign in text:
        started = started.with_key(sign)
    return started


def test_a_number_without_a_unit_is_in_the_users_own():
    inches = PickSession(BOX, bench_cell.CAMERA, bench_cell.FLOOR, unit="in")
    assert typed(inches, "2").known == {"size_x": pytest.approx(0.0508)}
    assert typed(inches, "2cm").known == {"size_x": pytest.approx(0.02)}


def test_a_typed_height_takes_the_place_of_the_click():
    started = typed(session(BOX, *BASE), "150")
    assert started.size_now == "size_z" and started.complete
    assert started.known == {"size_z": 0.15}
    assert "150.0 mm" in started.preview(TOP).words
    assert not started.without_key().without_key().without_key().complete


def test_keys_go_to_the_size_that_the_mouse_sets_and_tab_goes_on():
    assert session(BOX, BASE[0]).size_now == "size_x"
    assert session(BOX, *BASE[:2]).size_now == "size_y"
    assert session(BOX, *BASE).size_now == "size_z"
    assert session(BOX, *BASE).next_size().size_now == "size_x"
    assert typed(session(BOX, *BASE[:2]).next_size(), "80").known == {"size_z": 0.08}


@pytest.mark.parametrize(
    ("text", "metres"),
    [("120", 0.12), ("0.12m", 0.12), ("12cm", 0.12), ("120mm", 0.12), (".5", 5e-4)],
)
def test_sizes_are_typed_in_millimetres_or_with_their_unit(text, metres):
    assert typed(session(BOX, *BASE), text).known == {"size_z": pytest.approx(metres)}


@pytest.mark.parametrize("text", ["0", ".", "m", "5c"])
def test_what_is_no_size_is_not_taken_for_one(text):
    assert typed(session(BOX, *BASE), text).known == {}


@given(st.text(alphabet="0123456789.mc", max_size=9))
def test_whatever_is_typed_is_a_size_or_none(text):
    known = typed(session(BOX, *BASE), text).known
    assert all(value > 0 for value in known.values())


class Key:
    """A key press as Blender tells it."""

    value = "PRESS"
    ctrl = alt = oskey = shift = False

    def __init__(self, name):
        self.type = name


def test_both_rows_of_digits_type_and_no_digit_turns_the_view():
    from monocell.addon.on_picture.on_picture import VIEW_EVENTS
    from monocell.addon.picking.typed_size import KEYS, typed_key

    assert [typed_key(Key(f"NUMPAD_{digit}")) for digit in range(10)] == list("0123456789")
    assert typed_key(Key("SEVEN")) == "7" and typed_key(Key("PERIOD")) == "."
    assert typed_key(Key("LEFTMOUSE")) == ""
    assert not VIEW_EVENTS & set(KEYS)
