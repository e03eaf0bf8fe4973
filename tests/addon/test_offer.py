# SPDX-License-Identifier: GPL-3.0-or-later
"""What Align and Propose offer: the believed is taken, a click turns it, the rest stays."""

from dataclasses import replace

import bench_cell
import numpy as np
import pytest
from monocell.addon.review.aligning import with_taken
from monocell.addon.review.offer import offer_of_aligned, offer_of_proposals
from monocell.addon.review.offer_drawing import OfferFrames, color_of, rows_of
from monocell.addon.settings import DEFAULTS
from monocell.core.align.propose import Proposal
from monocell.core.align.result import AlignedObject
from monocell.core.cell import Cell
from monocell.core.pose import Pose
from monocell.core.reference import ReferencePlane

BOX, DRUM = bench_cell.BOX, bench_cell.DRUM
CELL = Cell(bench_cell.CAMERA, references=(ReferencePlane("floor", [0.0, 0, 0], [0.0, 0, 1]),))


def moved(thing, far=0.002):
    pose = thing.world_from_object
    there = Pose(pose.rotation, pose.translation + np.array([far, 0, 0]))
    return replace(thing, world_from_object=there)


@pytest.fixture
def offer():
    """The box would move by 2 mm; the drum is not believed."""
    found = {
        BOX.name: AlignedObject(moved(BOX), moved(BOX), True, (), moved_pixels=1.5),
        DRUM.name: AlignedObject(DRUM, moved(DRUM), False, ("edges elsewhere",), moved_pixels=9.0),
    }
    return offer_of_aligned([BOX, DRUM], found, "mm")


def test_what_is_believed_is_taken_and_the_rest_stays(offer):
    assert [thing.name for thing in offer.taken] == [BOX.name]
    cell = with_taken(CELL.with_objects((BOX, DRUM)), offer.taken)
    away = cell.objects[0].world_from_object.translation - BOX.world_from_object.translation
    assert np.allclose(away, [0.002, 0, 0])
    assert cell.objects[1] is DRUM


def test_a_click_leaves_what_was_taken_and_a_second_takes_it_again(offer):
    assert offer.toggled(0).taken == ()
    assert offer.toggled(0).toggled(0).taken == offer.taken


def test_what_alignment_does_not_believe_can_not_be_taken(offer):
    assert offer.toggled(1).taken == offer.taken


@pytest.mark.parametrize("index", [0, 1])
def test_a_click_in_the_middle_of_an_object_means_it(offer, index):
    thing = (BOX, DRUM)[index]
    pixel = bench_cell.CAMERA.project([thing.world_from_object.translation])[0]
    assert offer.at(bench_cell.CAMERA, pixel) == index
    assert offer.at(bench_cell.CAMERA, np.array([2.0, 2.0])) is None


def test_a_doubtful_proposal_waits_for_a_click():
    sure, doubtful = (
        Proposal(thing, 0.8, believed, "edges", () if believed else ("open",))
        for thing, believed in ((BOX, True), (DRUM, False))
    )
    offer = offer_of_proposals([sure, doubtful], False, "mm")
    assert [thing.name for thing in offer.taken] == [BOX.name]
    assert [t.name for t in offer.toggled(1).taken] == [BOX.name, DRUM.name]
    assert len(offer_of_proposals([sure, doubtful], True, "mm").taken) == 2
    cell = with_taken(CELL, offer.taken)
    assert [thing.name for thing in cell.objects] == [BOX.name]


def test_the_picture_shows_both_places_and_the_words_the_change(offer):
    frames = OfferFrames.of(offer, bench_cell.CAMERA)
    both = list(frames.strokes(offer, DEFAULTS, only_before=False))
    only = list(frames.strokes(offer, DEFAULTS, only_before=True))
    assert len(both) == 3 * len(only) == 6
    assert color_of(offer.candidates[0], DEFAULTS) == DEFAULTS.good_color
    assert color_of(offer.candidates[1], DEFAULTS) == DEFAULTS.doubtful_color
    assert [label.text for label in frames.labels(offer, DEFAULTS)] == [
        f"{BOX.name}  1.5 px",
        f"{DRUM.name}  stays",
    ]
    told = [row for row, _ in rows_of(offer.candidates[0], "mm")]
    assert told[0] == f"{BOX.name}: 1.5 px, centre 2.0 mm"
    assert told[-1] == "click to leave it"
