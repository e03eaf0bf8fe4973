# SPDX-License-Identifier: GPL-3.0-or-later
"""A can on a crate is aligned with it, whatever name the crate's top has, and never leaves it."""

from dataclasses import replace

import numpy as np
import pytest
from drawn_tabletop import TABLE, box, camera, can, picture, rough
from monocell.core.align.align_cell import align_cell
from monocell.core.cell import Cell
from monocell.core.pose import Pose
from monocell.core.reference import PendingReference
from monocell.core.references.resolve import resolve_references
from monocell.core.references.sources import FeatureOf

RED, BLUE = (0.7, 0.12, 0.1), (0.1, 0.2, 0.75)
CRATE = box(size=(0.16, 0.20, 0.08), at=(0.0, 0.0))
CAN_HEIGHT = 0.07


@pytest.fixture(scope="module")
def seen():
    stacked = lifted(can(radius=0.035, height=CAN_HEIGHT, at=(0.01, 0.02)), 0.08)
    return picture([CRATE, stacked], camera(), [RED, BLUE])


def lifted(thing, height):
    pose = thing.world_from_object
    up = np.array([0.0, 0.0, height])
    return replace(thing, world_from_object=Pose(pose.rotation, pose.translation + up), on="lid")


def stack():
    """A crate 5 mm too high, a can on it, and the crate's top by a name of its own."""
    crate = rough(CRATE)
    standing = lifted(rough(can(radius=0.035, height=CAN_HEIGHT, at=(0.01, 0.02))), top_of(crate))
    lid = PendingReference("lid", "plane", FeatureOf("crate.top"))
    cell = Cell(camera(), references=(TABLE, lid), objects=(crate, standing))
    return resolve_references(cell)[0]


def top_of(crate):
    return crate.world_from_object.translation[2] + crate.half_extent[2]


def foot_of(thing):
    return thing.world_from_object.translation[2] - thing.half_extent[2]


def test_what_stands_on_a_named_face_stands_on_it_where_the_face_is_now(seen):
    cell = stack()
    moved, aligned = align_cell(cell, seen)
    assert all(one.believed for one in aligned.objects.values()), aligned.objects
    crate, standing = moved.objects
    assert top_of(cell.objects[0]) > 0.084
    assert top_of(crate) == pytest.approx(0.08, abs=1e-3)
    assert foot_of(standing) == pytest.approx(top_of(crate), abs=1e-9)
    assert standing.on == aligned.objects["can"].tried.on == "lid"
    # the crate's error before it was aligned is no longer the can's
    assert standing.position_sigma()[2] < 1e-3


def test_what_is_not_aligned_itself_follows_what_it_stands_on(seen):
    cell = stack()
    moved, aligned = align_cell(cell, seen, ["crate"])
    crate, standing = moved.objects
    assert list(aligned.objects) == ["crate"]
    assert foot_of(standing) == pytest.approx(top_of(crate), abs=1e-8)
    assert np.allclose(standing.sizes, cell.objects[1].sizes, atol=1e-6)
    assert standing.on == "lid"


def test_what_nothing_moved_is_the_same_object(seen):
    cell = stack()
    moved, _ = align_cell(cell, 0 * seen)
    assert all(now is given for now, given in zip(moved.objects, cell.objects, strict=True))
