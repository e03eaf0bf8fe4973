# SPDX-License-Identifier: GPL-3.0-or-later
"""Known places, unknown offsets, a camera on the arm, balls and clicks: one fit for all of them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from drawn import differences
from monocell.core import Pose
from monocell.core.calibration.measured import Measured
from monocell.core.calibration.places import places_of
from monocell.core.calibration.seen import seen_targets
from monocell.core.calibration.unknowns import State, Unknowns
from monocell.core.errors import AmbiguousPose, DegeneratePositions, TooFewSightings
from outline_rig import KINDS, LENS, Errors, rig_of

QUIET = Errors(noise=0.01, click=0.01)
ELSEWHERE = np.array([0.06, -0.05, 0.04])


@pytest.mark.parametrize("points", [0, 4, 9], ids=["balls", "mixed", "points"])
@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_of_cell_gives_pose_and_offset(kind, points):
    rig = rig_of(5, 9, kind, points, QUIET)
    calibration = rig.calibrated()
    metres, degrees, _ = rig.errors(calibration)
    assert metres < (2e-3 if points == 9 else 6e-4)
    assert degrees < 0.05
    assert calibration.verdict == "good"
    if kind != "known":
        assert np.linalg.norm(calibration.fit.offsets[0] - rig.offset) < 2e-3


@pytest.mark.parametrize("points", [0, 5, 10], ids=["balls", "mixed", "points"])
@pytest.mark.parametrize("kind", KINDS)
def test_the_errors_stated_are_those_made(kind, points):
    sigmas = []
    for seed in range(6):
        rig = rig_of(seed, 10, kind, points)
        sigmas.append(rig.errors(rig.calibrated())[2])
    # six numbers: one sigma in each makes the root of six, and few rigs are many sigmas off
    assert 1.0 < np.sqrt(np.mean(np.square(sigmas))) < 3.3
    assert max(sigmas) < 6.0


@pytest.mark.parametrize("refine", [(), ("focal",), ("radius",), ("focal", "radius")], ids=str)
@pytest.mark.parametrize("kind", KINDS)
def test_the_derivatives_are_those_of_the_residuals(kind, refine):
    rig = rig_of(2, 6, kind, 2, QUIET)
    places = places_of(rig.sightings, rig.mount)
    seen = seen_targets(rig.sightings, rig.outlines, places, LENS)
    measured = Measured.of([one.observation for one in seen])
    unknowns = Unknowns.of_places(places, refine)
    offsets = np.zeros((0, 3)) if rig.offset is None else rig.offset[None]
    state = State(rig.pose, offsets)

    def residuals(step):
        there = unknowns.moved(state, step)
        centres = there.camera_from_base.apply(unknowns.places_base(there))
        return measured.columns(centres, there).residual_pixels

    centres = state.camera_from_base.apply(unknowns.places_base(state))
    columns = measured.columns(centres, state)
    rows = unknowns.rows(columns, measured.owner, state)
    expected = differences(residuals, np.zeros(unknowns.count), 1e-6)
    # residuals are to first order, and so are their derivatives: exact where there are none
    np.testing.assert_allclose(rows, expected, atol=2e-4 * np.abs(expected).max())
    chained = np.concatenate([columns.by_centre, columns.shared], axis=1)
    chain = unknowns.chain(state)[:, :, : unknowns.count][measured.owner]
    np.testing.assert_allclose(np.einsum("ni,nip->np", chained, chain), rows, atol=1e-9)


def test_a_flange_that_keeps_one_orientation_can_not_tell_the_offset():
    rig = rig_of(1, 8, "flange", turn=0.0)
    with pytest.raises(DegeneratePositions, match=r"turned by only 0\.0 deg about a second axis"):
        rig.calibrated()


def test_a_flange_that_turns_about_one_axis_alone_can_not_either():
    rig, rng = rig_of(1, 8, "flange"), np.random.default_rng(0)
    turned = [
        replace(
            s,
            world_from_flange=Pose.from_rotation_vector(
                [0, 0, rng.uniform(-2, 2)], s.world_from_flange.translation
            ),
        )
        for s in rig.sightings
    ]
    with pytest.raises(DegeneratePositions, match="second axis"):
        rig.with_sightings(turned).calibrated()


def test_one_known_target_beside_them_tells_the_offset_apart():
    rig = rig_of(1, 8, "flange", turn=0.0, how=QUIET)
    known = [
        replace(s, center_world=s.world_from_flange.apply(rig.offset), world_from_flange=None)
        for s in rig.sightings[:4]
    ]
    calibration = rig.with_sightings([*known, *rig.sightings[4:]]).calibrated()
    assert rig.errors(calibration)[0] < 1e-3


def test_two_balls_on_one_flange_have_an_offset_each():
    one, other = rig_of(3, 6, "flange", how=QUIET), rig_of(3, 6, "flange", how=QUIET)
    names = ["left", "right"]
    sightings = [
        replace(s, target=names[i % 2], picture=f"{names[i % 2]}_{s.picture}")
        for i, s in enumerate([*one.sightings, *other.sightings])
    ]
    rig = replace(one, sightings=sightings, outlines=[*one.outlines, *other.outlines])
    fit = rig.calibrated().fit
    assert fit.targets == ("left", "right")
    np.testing.assert_allclose(fit.offsets, [one.offset, one.offset], atol=3e-3)
    assert fit.unknowns[7] == "x of the offset of left"


@pytest.mark.parametrize(("kind", "points", "needed"), [("flange", 0, 4), ("mounted", 4, 5)])
def test_too_few_for_an_offset_says_how_many_it_takes(kind, points, needed):
    rig = rig_of(0, needed - 1, kind, points)
    with pytest.raises(TooFewSightings, match=f"need {needed} sightings or more"):
        rig.calibrated()


def test_three_points_have_several_poses_which_are_listed_and_none_is_told():
    with pytest.raises(AmbiguousPose, match=r"poses fit the 3 sightings equally well, .* and \("):
        rig_of(4, 3, points=3).calibrated()


def test_a_mounted_camera_stands_where_it_stood_for_the_cell_s_picture():
    rig = rig_of(6, 8, "mounted", how=QUIET)
    calibration = rig.calibrated()
    mount, first = calibration.mount, rig.sightings[0].world_from_flange
    assert mount.world_from_flange is None
    expected = rig.pose @ first.inverse()
    off = calibration.camera.pose @ expected.inverse()
    assert np.linalg.norm(off.translation) < 1e-3
    np.testing.assert_allclose(calibration.sightings[3].center_world, rig.offset, atol=1e-3)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("points", [0, 10], ids=["balls", "points"])
def test_one_wrong_sighting_among_ten_is_named_and_the_pose_is_right(kind, points):
    rig = rig_of(8, 10, kind, points)
    wrong = rig.sightings[4]
    if wrong.center_world is not None:
        wrong = replace(wrong, center_world=wrong.center_world + ELSEWHERE)
    else:
        flange = wrong.world_from_flange
        moved = Pose(flange.rotation, flange.translation + ELSEWHERE)
        wrong = replace(wrong, world_from_flange=moved)
    spoilt = [*rig.sightings[:4], wrong, *rig.sightings[5:]]
    calibration = rig.with_sightings(spoilt).calibrated()
    assert [r.picture for r in calibration.sightings if r.status == "rejected"] == ["pose_4.png"]
    assert "from where the others put it" in calibration.sightings[4].reason
    assert rig.errors(calibration)[2] < 6


@pytest.mark.parametrize("method", ["frames", "p3p", "pnp"])
def test_baselines_need_known_places(method):
    from monocell.core.errors import InvalidValue

    with pytest.raises(InvalidValue, match="an offset is unknown"):
        rig_of(5, 8, "flange").calibrated(method=method)
    with pytest.raises(InvalidValue, match=r"three balls, there are 1"):
        rig_of(5, 8, points=7).calibrated(method="frames")
