# SPDX-License-Identifier: GPL-3.0-or-later
from hypothesis import given
from hypothesis import strategies as st
from monocell.addon.on_picture.beside_cursor import loupe_box, words_box

# a toolbar on the left, a sidebar on the right, a header above
FREE = (60.0, 0.0, 1040.0, 800.0)
SIDE = 184.0
places = st.tuples(st.floats(60, 1040), st.floats(0, 800))


def inside(box):
    left, bottom, right, top = box
    return left >= FREE[0] and bottom >= FREE[1] and right <= FREE[2] and top <= FREE[3]


def apart(one, other):
    return one[2] <= other[0] or other[2] <= one[0] or one[3] <= other[1] or other[3] <= one[1]


@given(places)
def test_the_loupe_lies_beside_the_cursor_and_never_under_a_sidebar(cursor):
    box = loupe_box(SIDE, cursor, FREE, 1.0)
    assert inside(box)
    assert apart(box, (*cursor, *cursor))


@given(places, st.floats(40, 420), st.floats(20, 110))
def test_words_never_lie_under_a_sidebar_nor_on_the_loupe(cursor, width, height):
    loupe = loupe_box(SIDE, cursor, FREE, 1.0)
    box = words_box((width, height), cursor, FREE, 1.0, loupe)
    assert inside(box)
    assert apart(box, loupe)
    assert apart(box, (*cursor, *cursor))


def test_words_lie_below_to_the_right_where_there_is_room():
    assert words_box((200, 40), (300, 400), FREE, 1.0) == (318, 342, 518, 382)


def test_words_too_wide_for_what_is_free_are_read_from_their_beginning():
    left, bottom, _, _ = words_box((2000, 40), (300, 400), FREE, 1.0)
    assert left == FREE[0] + 6
    assert bottom >= 0
