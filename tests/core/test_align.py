# SPDX-License-Identifier: GPL-3.0-or-later
"""A rough model is aligned on the picture's edges, keeps what holds it, and knows when it fails."""

from dataclasses import replace

import numpy as np
import pytest
from drawn_tabletop import TABLE, box, camera, can, picture, rough
from monocell.core.align.align import align
from monocell.core.errors import InvalidValue, PictureError

RED, BLUE = (0.7, 0.12, 0.1), (0.1, 0.2, 0.75)


@pytest.fixture(scope="module")
def aligned_pair():
    things = [box(), can()]
    seen = picture(things, camera(), [RED, BLUE])
    starts = [rough(things[0]), rough(things[1], shift=(-0.006, 0.008))]
    return things, starts, align(starts, camera(), seen, [TABLE])


def test_a_rough_model_ends_on_the_edges_of_the_picture(aligned_pair):
    things, _, aligned = aligned_pair
    for truth, thing in zip(things, aligned.things, strict=True):
        assert aligned.objects[thing.name].believed, aligned.objects[thing.name].reasons
        np.testing.assert_allclose(thing.sizes, truth.sizes, rtol=0.01)
        off = thing.world_from_object.translation - truth.world_from_object.translation
        assert np.linalg.norm(off) < 1e-3


def test_what_is_told_of_an_aligned_object_is_what_happened(aligned_pair):
    _, _, aligned = aligned_pair
    for told in aligned.objects.values():
        assert 1.0 < told.moved_pixels < 12.0
        assert told.rms_pixels < 0.4 < told.before_pixels
        assert told.median_pixels < told.before_pixels
        assert told.supported > 0.8


def test_the_covariance_holds_the_truth(aligned_pair):
    things, _, aligned = aligned_pair
    for truth, thing in zip(things, aligned.things, strict=True):
        assert thing.covariance is not None
        assert (np.abs(thing.sizes - truth.sizes) < 5 * thing.size_sigma()).all()
        assert (thing.size_sigma() < 0.01 * truth.sizes).all()


def test_an_aligned_object_still_stands_on_its_table(aligned_pair):
    _, _, aligned = aligned_pair
    for thing in aligned.things:
        foot = thing.world_from_object.apply([0, 0, -thing.half_extent[2]])
        assert abs(foot[2]) < 1e-9
        assert abs(thing.world_from_object.rotation[2, 2] - 1) < 1e-12


def test_a_typed_size_is_kept():
    truth = can()
    seen = picture([truth], camera(), [BLUE])
    start = rough(replace(truth, known={"height": 0.12}), shares=(1.1, 1.0))
    aligned = align([start], camera(), seen, [TABLE])
    assert aligned.things[0].sizes[1] == pytest.approx(0.12, abs=1e-12)
    assert aligned.things[0].sizes[0] == pytest.approx(0.05, rel=0.01)


def test_an_object_that_is_not_in_the_picture_stays_as_it_was_and_says_so():
    seen = picture([can()], camera(), [BLUE])
    ghost = box(at=(-0.05, -0.2))
    aligned = align([ghost, rough(can())], camera(), seen, [TABLE])
    told = aligned.objects["crate"]
    assert not told.believed
    assert told.reasons
    assert aligned.things[0] is ghost


@pytest.mark.parametrize(("sigma", "believed"), [(0.05, True), (0.002, False)])
def test_edges_far_from_where_the_picks_put_an_object_are_not_believed(sigma, believed):
    seen = picture([box()], camera(), [RED])
    start = rough(box())
    # radians of turn, and a fifth of it in metres
    each = sigma * np.array([1, 1, 1, *[0.2] * (3 + len(start.sizes))])
    known = replace(start, covariance=np.diag(each**2))
    told = align([known], camera(), seen, [TABLE]).objects[known.name]
    assert told.believed == believed
    assert any("sigmas from where it was" in reason for reason in told.reasons) != believed


def test_only_the_objects_named_are_aligned(aligned_pair):
    things, starts, _ = aligned_pair
    seen = picture(things, camera(), [RED, BLUE])
    aligned = align(starts, camera(), seen, [TABLE], names=["can"])
    assert aligned.things[0] is starts[0]
    assert list(aligned.objects) == ["can"]


def test_an_object_whose_foot_is_hidden_is_not_believed():
    hidden, front = (
        can(at=(-0.06, 0.05), height=0.16),
        box(at=(0.08, -0.03), size=(0.05, 0.3, 0.09)),
    )
    seen = picture([hidden, front], camera(), [BLUE, RED])
    aligned = align([rough(hidden), front], camera(), seen, [TABLE], names=["can"])
    assert not aligned.objects["can"].believed
    assert any("stands" in reason or "open" in reason for reason in aligned.objects["can"].reasons)


def test_a_picture_of_another_size_is_refused():
    seen = picture([can()], camera(), [BLUE])
    with pytest.raises(PictureError, match="400 x 300"):
        align([can()], camera(), seen[:-2], [TABLE])


def test_a_name_that_is_not_there_is_refused():
    seen = picture([can()], camera(), [BLUE])
    with pytest.raises(InvalidValue, match="no object is called 'cane'; there is can"):
        align([can()], camera(), seen, [TABLE], names=["cane"])
