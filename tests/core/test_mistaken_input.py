# SPDX-License-Identifier: GPL-3.0-or-later
"""What users get wrong ends in the right pose with the culprit named, or in a refusal.

Never in a confident wrong pose: many rigs of every mistake are simulated and none may be.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from monocell.core.errors import MonocellError
from monocell.core.sighting import PointSighting
from outline_rig import RADIUS, rig_of

SEEDS = range(2)


def moved(sighting, by):
    return replace(sighting, center_world=sighting.center_world + np.asarray(by))


def exchanged(rig, i, j):
    """The pictures of two sightings exchanged: names, outlines and clicks change places."""
    sightings, outlines = list(rig.sightings), list(rig.outlines)
    places = [s.center_world for s in sightings]
    sightings[i] = replace(sightings[i], center_world=places[j])
    sightings[j] = replace(sightings[j], center_world=places[i])
    return replace(rig, sightings=sightings, outlines=outlines)


def in_millimetres(rig):
    return rig.with_sightings(replace(s, center_world=1e3 * s.center_world) for s in rig.sightings)


def one_outlier(rig):
    return rig.with_sightings([*rig.sightings[:-1], moved(rig.sightings[-1], [0.1, -0.08, 0.05])])


def two_outliers(rig):
    others = rig.sightings[2:]
    first, second = rig.sightings[:2]
    return rig.with_sightings(
        [moved(first, [0.1, -0.08, 0.05]), moved(second, [-0.05, 0.1, 0.1]), *others]
    )


def mirrored(rig):
    return rig.with_sightings(
        replace(s, center_world=s.center_world * [1, -1, 1]) for s in rig.sightings
    )


def scrambled(rig):
    places = [s.center_world for s in rig.sightings]
    turned = [*places[2:], *places[:2]]
    return rig.with_sightings(
        replace(s, center_world=p) for s, p in zip(rig.sightings, turned, strict=True)
    )


MISTAKES = {
    "one outlier": one_outlier,
    "two outliers": two_outliers,
    "two pictures exchanged": lambda rig: exchanged(rig, 0, 2),
    "mirrored": mirrored,
    "shifted by two": scrambled,
    "places in millimetres": in_millimetres,
}


@pytest.mark.parametrize("points", [0, 99], ids=["balls", "points"])
@pytest.mark.parametrize("count", [4, 5, 8])
@pytest.mark.parametrize("mistake", MISTAKES)
def test_no_mistake_ends_in_a_confident_wrong_pose(mistake, count, points):
    for seed in SEEDS:
        rig = MISTAKES[mistake](rig_of(seed, count, points=min(points, count)))
        try:
            calibration = rig.calibrated()
        except MonocellError as error:
            assert "\n" not in str(error)
            continue
        metres, _, sigmas = rig.errors(calibration)
        assert calibration.verdict != "good" or sigmas < 7, (seed, metres, sigmas)


@pytest.mark.parametrize("wrong", [0, 3, 7])
def test_one_outlier_among_eight_is_named(wrong):
    rig = rig_of(3, 8)
    spoilt = [
        moved(s, [0.08, 0.05, -0.06]) if i == wrong else s for i, s in enumerate(rig.sightings)
    ]
    calibration = rig.with_sightings(spoilt).calibrated()
    rejected = [i for i, r in enumerate(calibration.sightings) if r.status == "rejected"]
    assert rejected == [wrong]
    assert rig.errors(calibration)[2] < 5


def test_exchanged_pictures_are_named():
    calibration = exchanged(rig_of(3, 8), 1, 6).calibrated()
    assert "where pose_6.png should have it" in calibration.sightings[1].reason
    assert "where pose_1.png should have it" in calibration.sightings[6].reason
    assert "were the pictures exchanged?" in calibration.warnings[0]


def test_two_exchanged_of_four_are_named_in_the_refusal_or_not_believed():
    told = []
    for seed in SEEDS:
        try:
            calibration = exchanged(rig_of(seed, 4), 1, 2).calibrated()
        except MonocellError as error:
            told.append(str(error))
            continue
        assert calibration.verdict != "good"
    assert all("exchanged" in t or "check" in t or "radius" in t for t in told)


def test_a_radius_in_millimetres_betrays_itself():
    rig = rig_of(2, 6)
    wrong = [replace(s, radius=1e3 * RADIUS) for s in rig.sightings]
    outlines = [
        replace(o, radius=1e3 * RADIUS, centre_camera=1e3 * o.centre_camera) for o in rig.outlines
    ]
    with pytest.raises(MonocellError, match=r"radius of 40 m .* is one of them in millimetres\?"):
        replace(rig, sightings=wrong, outlines=outlines).calibrated()
    with pytest.raises(MonocellError, match=r"positions given .* is one of them in millimetres\?"):
        in_millimetres(rig).calibrated()


def test_the_diameter_for_the_radius_is_not_believed():
    from outline_rig import Errors

    try:
        calibration = rig_of(2, 6, how=Errors(stated_radius=2 * RADIUS)).calibrated()
    except MonocellError as error:
        assert "is the radius about" in str(error)
    else:
        assert calibration.verdict != "good"
        assert any("radius" in w for w in calibration.warnings)


def test_a_sighting_told_twice_counts_once():
    rig = rig_of(2, 6)
    twice = replace(
        rig,
        sightings=[*rig.sightings, rig.sightings[0]],
        outlines=[*rig.outlines, rig.outlines[0]],
    )
    calibration, once = twice.calibrated(), rig.calibrated()
    assert calibration.sightings[6].reason == "it repeats sightings[0], and counts once"
    np.testing.assert_allclose(calibration.fit.covariance, once.fit.covariance)


def test_a_click_outside_the_picture_is_refused_by_its_place():
    rig = rig_of(2, 6, points=3)
    outside = PointSighting("p.png", [0.1, 0.2, 0.3], [1500.0, 20.0])
    with pytest.raises(MonocellError, match=r"sightings\[1\]\.pixel: \[1500\.0, 20\.0\] lies outs"):
        rig.with_sightings([rig.sightings[0], outside, *rig.sightings[2:]]).calibrated()


@pytest.mark.parametrize("count", [60, 200])
def test_many_sightings_with_many_outliers_are_sampled_not_listed(count):
    rig = rig_of(1, count)
    wrong = range(0, count, 5)
    spoilt = [moved(s, [0.1, -0.1, 0.1]) if i in wrong else s for i, s in enumerate(rig.sightings)]
    calibration = rig.with_sightings(spoilt).calibrated()
    assert [i for i, r in enumerate(calibration.sightings) if r.status == "rejected"] == list(wrong)
    assert rig.errors(calibration)[2] < 6
