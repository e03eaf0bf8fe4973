# SPDX-License-Identifier: GPL-3.0-or-later
import pytest
from monocell.core.length_unit import UNITS


@pytest.mark.parametrize(
    ("sign", "told"), [("mm", "123.4"), ("cm", "12.34"), ("m", "0.1234"), ("in", "4.858")]
)
def test_a_length_has_the_digits_of_a_tenth_of_a_millimetre(sign, told):
    assert UNITS[sign].number(0.1234) == told


def test_digits_are_added_and_taken_away_but_never_more_than_there_are():
    assert UNITS["mm"].number(0.1234, finer=1) == "123.40"
    assert UNITS["mm"].number(0.1234, finer=-3) == "123"


def test_nothing_is_below_nought():
    assert UNITS["mm"].number(-1e-6) == "0.0"
