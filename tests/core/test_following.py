# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects that nobody picked, and what holds them."""

from dataclasses import replace

import numpy as np
import pytest
from monocell.core import Box, Camera, Cell, Cylinder, Intrinsics, Pose, ReferencePlane
from monocell.core.errors import NotConverged
from monocell.core.modelling.solve import model
from monocell.core.reference import PendingReference
from monocell.core.references.resolve import resolve_references
from monocell.core.references.sources import FeatureOf
from monocell.core.relation import Relation

CAMERA = Camera(
    Intrinsics(800, 600, 760, 757, 411, 292),
    Pose.looking_at([1.1, -0.8, 0.8], [0.3, 0, 0], [0, 0, 1]),
)
FLOOR = ReferencePlane("floor", [0, 0, 0], [0, 0, 1])
BOX = Box("box", Pose.from_rotation_vector([0, 0, 0.3], [0.3, 0, 0.06]), size=[0.2, 0.14, 0.12])
TILTED = Pose.from_rotation_vector([0.1, 0.05, 0], [0.6, 0.1, 0.3])
CAN = Cylinder("can", TILTED, radius=0.03, height=0.1)


def cell_of(can, *references, box=BOX):
    return Cell(CAMERA, references=(FLOOR, *references), objects=(box, can))


def can_of(cell, held=("can",)):
    return next(thing for thing in model(cell, held=held).cell.objects if thing.name == "can")


@pytest.mark.parametrize(
    ("relation", "height"), [(("stands_on", "floor"), 0.05), (("stands_on", "box.top"), 0.17)]
)
def test_it_moves_to_what_it_stands_on_and_no_farther(relation, height):
    can = can_of(cell_of(replace(CAN, relations=(Relation(*relation),))))
    assert can.world_from_object.translation == pytest.approx([0.6, 0.1, height], abs=1e-7)
    assert can.world_from_object.rotation[:, 2] == pytest.approx([0, 0, 1], abs=1e-7)
    assert can.sizes == pytest.approx(CAN.sizes, abs=1e-9)


def test_held_by_references_alone_it_stays_where_it_was_put():
    can = can_of(cell_of(replace(CAN, on="floor")), held=())
    assert can.world_from_object.translation.tolist() == TILTED.translation.tolist()


def test_a_reference_that_is_an_object_s_face_holds_as_the_object_does():
    lid = PendingReference("lid", "plane", FeatureOf("box.top"))
    cell = resolve_references(cell_of(replace(CAN, on="lid"), lid))[0]
    higher = replace(BOX, size=[0.2, 0.14, 0.2])
    moved = can_of(replace(cell, objects=(higher, cell.objects[1])), held=())
    # the box grew round its centre
    assert moved.world_from_object.translation[2] == pytest.approx(0.16 + 0.05, abs=1e-7)
    # it still says so by the reference's name
    assert moved.on == "lid"


def test_a_direction_turns_it_and_leaves_its_place():
    can = can_of(cell_of(replace(CAN, relations=(Relation("parallel", "floor"),))))
    assert np.abs(can.world_from_object.rotation[:, 2]) == pytest.approx([0, 0, 1], abs=1e-7)
    assert can.world_from_object.translation == pytest.approx(TILTED.translation, abs=1e-7)


def test_relations_that_contradict_each_other_are_refused():
    both = (Relation("stands_on", "floor"), Relation("stands_on", "box.top"))
    with pytest.raises(NotConverged, match="can"):
        can_of(cell_of(replace(CAN, relations=both)))
