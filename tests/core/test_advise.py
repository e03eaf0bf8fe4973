# SPDX-License-Identifier: GPL-3.0-or-later
"""The position advised lowers the error of many fits as it promises, and more than others do."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from ball_rig import LENS, PLACES, POSE, RADIUS, exact_outlines, pose_twist
from monocell.core import Camera, Cell, ReferencePlane
from monocell.core.ball.sphere import OutlineRays, outline_pixels, tangency
from monocell.core.calibration.advise import (
    TypicalOutline,
    advise,
    positions_in_box,
    reachable_box,
)
from monocell.core.calibration.common_error import common_covariance
from monocell.core.calibration.joint_pose import BIAS_SIGMA_PIXELS, fit_pose
from monocell.core.calibration.work_surface import work_area
from monocell.core.errors import InvalidValue

POINTS, NOISE, TRIALS = 100, 0.2, 45
USED = PLACES[:4]
TABLE = ReferencePlane("table", [0, 0, 0], [0, 0, 1])


def sighted(places, rng):
    """Outlines with all the errors that the fit allows for: noise, bias, each ball's own."""
    bias, observations = rng.normal(0, BIAS_SIGMA_PIXELS), []
    for observation in exact_outlines(places, count=POINTS):
        centre = POSE.apply(observation.place.offset)
        held = tangency(OutlineRays.around(LENS, centre, RADIUS, POINTS), centre, RADIUS)
        own = rng.multivariate_normal(centre, common_covariance(held, centre, RADIUS))
        pixels = outline_pixels(LENS, own, RADIUS, POINTS)
        normals = tangency(OutlineRays.of(LENS, pixels), own, RADIUS).normals
        noisy = pixels + normals * (bias + rng.normal(0, NOISE, POINTS))[:, None]
        outline = OutlineRays.of(LENS, noisy)
        sigma = np.full(POINTS, NOISE)
        observations.append(replace(observation, outline=outline, sigma_pixels=sigma))
    return observations


def typical():
    """What a pixel of such outlines weighs."""
    sizes = []
    for place in USED:
        pixels = outline_pixels(LENS, POSE.apply(place), RADIUS, POINTS)
        sizes.append(np.linalg.norm(pixels - pixels.mean(axis=0), axis=1).mean())
    return TypicalOutline(RADIUS, POINTS / NOISE**2 / (2 * np.pi * np.median(sizes)))


@pytest.fixture(scope="module")
def calibrated():
    fit = fit_pose(sighted(USED, np.random.default_rng(3)), POSE)
    assert fit.misfit == 1.0
    camera = Camera(LENS, POSE, fit.covariance)
    return camera, fit, work_area(Cell(camera), camera, TABLE)


def asked(calibrated, candidates, used=USED):
    camera, fit, area = calibrated
    return advise(camera, fit, area, typical(), candidates, used)


@pytest.fixture(scope="module")
def advice(calibrated):
    return asked(calibrated, positions_in_box(reachable_box(USED)))


def rms_error(area, places, seed):
    """Of points worked at, over many fits of simulated sightings."""
    rng = np.random.default_rng(seed)
    twists = np.array(
        [pose_twist(fit_pose(sighted(places, rng), POSE).camera_from_base) for _ in range(TRIALS)]
    )
    return float(area.sigmas((twists.T @ twists / TRIALS)[None])[0])


def test_the_error_falls_as_promised_and_more_than_elsewhere(calibrated, advice):
    area = calibrated[2]
    first = advice.steps[0]
    assert rms_error(area, USED, 1) == pytest.approx(advice.sigma, rel=0.25)
    after = rms_error(area, np.vstack([USED, first.position_world]), 2)
    assert after == pytest.approx(first.sigma, rel=0.25)
    assert first.sigma < 0.85 * advice.sigma
    rng, others = np.random.default_rng(4), []
    box = positions_in_box(reachable_box(USED))
    while len(others) < 2:
        place = box[rng.integers(len(box))]
        try:
            # a position by itself is advised if the camera sees it well
            asked(calibrated, place[None])
        except InvalidValue:
            continue
        others.append(rms_error(area, np.vstack([USED, place]), 5 + len(others)))
    assert after < min(others)


def test_three_positions_together_do_what_they_promise(calibrated, advice):
    places = np.vstack([USED, *(step.position_world for step in advice.steps)])
    last = advice.steps[-1]
    assert rms_error(calibrated[2], places, 3) == pytest.approx(last.sigma, rel=0.25)
    sigmas = [advice.sigma, *(step.sigma for step in advice.steps)]
    assert (np.diff(sigmas) < 0).all()


def test_no_other_candidate_promises_more(calibrated, advice):
    box = positions_in_box(reachable_box(USED))
    for place in box[::40]:
        try:
            (only,) = asked(calibrated, place[None]).steps
        except InvalidValue:
            continue
        assert only.sigma >= advice.steps[0].sigma - 1e-12


def test_advised_balls_are_wholly_in_the_picture_and_large_enough(advice):
    assert advice.tried == 9 * 9 * 7
    assert 0 < advice.usable < advice.tried
    for step in advice.steps:
        pixels = outline_pixels(LENS, POSE.apply(step.position_world), RADIUS)
        assert (pixels > 7).all()
        assert (pixels < [472, 352]).all()
        assert step.radius_pixels >= 8
        np.testing.assert_allclose(step.pixel, pixels.mean(axis=0), atol=0.1)
        assert np.linalg.norm(USED - step.position_world, axis=1).min() >= 2 * RADIUS


EYE = POSE.inverse().translation
AHEAD = POSE.rotation[2]


@pytest.mark.parametrize(
    ("place", "why"),
    [
        (EYE - AHEAD, "1 behind the camera"),
        (EYE + 4 * AHEAD, "1 smaller than 8 px"),
        (EYE + 1.0 * AHEAD + 0.5 * POSE.rotation[0], "1 outside the picture"),
        (USED[0] + 0.01, "1 at a place already used"),
    ],
)
def test_what_the_camera_would_not_see_well_is_refused_with_the_reason(calibrated, place, why):
    with pytest.raises(InvalidValue, match=f"none of the 1 positions.*{why}"):
        asked(calibrated, place[None])


def test_a_carried_camera_takes_no_advice(calibrated):
    with pytest.raises(InvalidValue, match="one is carried"):
        asked(calibrated, PLACES[4:5], USED + np.array([0.1, 0, 0]))


def test_the_box_in_reach_is_half_as_large_again_and_no_lower():
    low, high = reachable_box([[0, 0, 1], [2, 4, 2]])
    np.testing.assert_allclose(low, [-0.5, -1, 1])
    np.testing.assert_allclose(high, [2.5, 5, 2.25])


def test_a_box_given_by_any_two_corners_is_the_same():
    one = positions_in_box([[0, 1, 0], [1, 0, 2]])
    assert len(one) == 9 * 9 * 7
    np.testing.assert_array_equal(one, positions_in_box([[1, 0, 2], [0, 1, 0]]))
    assert len(positions_in_box([[0, 0, 1], [1, 1, 1]])) == 81
    with pytest.raises(InvalidValue, match="both corners are the same"):
        positions_in_box([[1, 1, 1], [1, 1, 1]])
