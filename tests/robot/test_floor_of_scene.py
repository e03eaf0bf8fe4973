# SPDX-License-Identifier: GPL-3.0-or-later
import pytest
from monocell.core.errors import DocumentError
from monocell.headless.robot.floors import floor_of

WALL = {"name": "wall", "kind": "plane", "point": [1, 0, 0], "normal": [1, 0, 0]}
TABLE = {"name": "table", "kind": "plane", "point": [0.3, 0.1, 0.2], "normal": [0, 0, 1]}


def test_the_first_level_plane_becomes_a_slab_below_it():
    floor = floor_of({"references": [WALL, TABLE]})
    assert floor.name == "table"
    assert floor.corners_world()[:, 2].max() == pytest.approx(0.2)


def test_walls_fill_no_room():
    assert floor_of({"references": [WALL]}) is None
    assert floor_of({}) is None


def test_a_broken_reference_is_named():
    with pytest.raises(DocumentError, match=r"references\[0\]\.normal"):
        floor_of({"references": [{**TABLE, "normal": "up"}]})
