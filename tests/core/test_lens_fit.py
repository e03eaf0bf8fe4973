# SPDX-License-Identifier: GPL-3.0-or-later
"""Corners of known lenses: found again within honest sigmas, liars outvoted, models told apart."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest
from board_views import BOARD, LENSES, NOISE, SIZE, views_through
from monocell.core import Intrinsics
from monocell.core.errors import InvalidValue, NotConverged
from monocell.core.lens.bundle import LensFit, fit_lens, fit_pose, subset
from monocell.core.lens.model_choice import best_model, score
from monocell.core.lens.outvoting import outvoted
from monocell.core.lens.parameters import (
    parameter_names,
    parameters_of,
    pixels_by_parameters,
    with_parameters,
)
from monocell.core.lens.quality import LensQuality
from monocell.core.lens.starts import first_fit, without_k3
from monocell.core.lens.verdict import verdict_of

WELL_POSED = ("none", "plumb_bob", "equidistant")


@pytest.fixture(scope="module")
def brown_fit():
    return first_fit(views_through(LENSES["plumb_bob"], 10, 3), SIZE, "plumb_bob")


@pytest.mark.parametrize("model", LENSES)
def test_the_derivative_by_the_lens_is_its_slope(model):
    lens = LENSES[model]
    points = np.random.default_rng(0).uniform([-0.4, -0.4, 1], [0.4, 0.4, 1.5], (9, 3))
    analytic, at = pixels_by_parameters(lens, points), parameters_of(lens)
    assert analytic.shape == (9, 2, len(parameter_names(model)))
    for i, value in enumerate(at):
        step = np.zeros(len(at))
        step[i] = 1e-6 * max(1.0, abs(value))
        high, low = (with_parameters(lens, at + sign * step).project(points) for sign in (1, -1))
        np.testing.assert_allclose(analytic[:, :, i], (high - low) / (2 * step[i]), atol=1e-4)


@pytest.mark.parametrize("model", LENSES)
def test_exact_corners_give_the_exact_lens(model):
    truth = LENSES[model]
    fit = first_fit(views_through(truth, 6, 1, noise=0.0), SIZE, model)
    assert fit.rms_pixels < (1e-2 if model == "rational_polynomial" else 1e-4)
    # eight coefficients can say the same in many ways: what counts is where pixels look
    pixels = np.random.default_rng(0).uniform([60, 60], [580, 420], (50, 2))
    np.testing.assert_allclose(fit.lens.rays(pixels), truth.rays(pixels), atol=2e-4)


@pytest.mark.parametrize("model", WELL_POSED)
def test_stated_sigmas_are_honest(model):
    truth, z = parameters_of(LENSES[model]), []
    for seed in range(6):
        fit = first_fit(views_through(LENSES[model], 8, seed), SIZE, model)
        np.testing.assert_allclose(fit.noise_pixels, NOISE, rtol=0.2)
        z.append((parameters_of(fit.lens) - truth) / np.sqrt(np.diag(fit.covariance)))
    # 6 sets of 4 to 9 numbers: a factor of two either way would show
    assert 0.6 < np.sqrt(np.mean(np.square(z))) < 1.4
    assert np.abs(z).max() < 4.5


def test_the_fit_is_opencv_s_least_sum(brown_fit):
    points = [view.points.astype(np.float32) for view in brown_fit.views]
    pixels = [view.pixels.astype(np.float32) for view in brown_fit.views]
    rms, k, found, _, _ = cv2.calibrateCamera(points, pixels, SIZE, np.eye(3), np.zeros(5))
    assert brown_fit.rms_pixels <= rms + 1e-6
    lens = brown_fit.lens
    np.testing.assert_allclose(
        [lens.fx, lens.fy, lens.cx, lens.cy], k[[0, 1, 0, 1], [0, 1, 2, 2]], atol=0.02
    )
    np.testing.assert_allclose(lens.distortion.coefficients, found.ravel(), atol=5e-3)


def test_errors_that_the_corners_of_a_picture_share_widen_the_sigmas():
    truth = LENSES["plumb_bob"]
    rng = np.random.default_rng(0)
    honest, z = [], []
    for seed in range(6):
        views = []
        for view in views_through(truth, 10, seed, noise=0.01):
            # each picture is stretched a little about its own board, as a bent board would be
            stretch = 1 + 4e-3 * rng.normal(size=2)
            middle = view.pixels.mean(axis=0)
            views.append(replace(view, pixels=middle + (view.pixels - middle) * stretch))
        fit = first_fit(views, SIZE, "plumb_bob")
        sigma = np.sqrt(np.diag(fit.covariance))[:4]
        reduced = fit.normal.reduced(0.0)[0]
        plain = fit.noise_pixels * np.sqrt(np.diag(np.linalg.inv(reduced)))[:4]
        honest.append(sigma / plain)
        z.append((parameters_of(fit.lens)[:4] - parameters_of(truth)[:4]) / sigma)
    assert np.mean(honest) > 1.5
    assert np.sqrt(np.mean(np.square(z))) < 2.0


def test_a_held_parameter_stays_and_has_no_error(brown_fit):
    held = without_k3(brown_fit)
    assert held.lens.distortion.coefficients[4] == 0
    assert not held.covariance[8].any()
    assert np.sqrt(np.diag(held.covariance))[:8].min() > 0
    assert held.covariance[0, 0] <= brown_fit.covariance[0, 0] * 1.2


def test_the_pose_of_one_board_is_found_under_a_known_lens(brown_fit):
    start = brown_fit.poses[0].perturbed([0.05, -0.03, 0.02, 0.01, 0.01, -0.02])
    found = fit_pose(brown_fit.lens, brown_fit.views[0], start)
    np.testing.assert_allclose(found.matrix(), brown_fit.poses[0].matrix(), atol=1e-4)


def test_a_lens_that_images_nothing_there_is_refused(brown_fit):
    folded = with_parameters(brown_fit.lens, [520, 520, 325, 236, -2.0, 0, 0, 0, 0])
    with pytest.raises(InvalidValue, match="does not image every corner"):
        fit_lens(replace(brown_fit, lens=folded))


def test_a_picture_of_another_zoom_is_outvoted():
    truth = LENSES["plumb_bob"]
    zoomed = Intrinsics(640, 480, 780, 782, 325, 236, truth.distortion)
    views = views_through(truth, 7, 1)
    views.insert(3, views_through(zoomed, 1, 2)[0])
    fit, off = outvoted(first_fit(views, SIZE, "plumb_bob"))
    assert list(off) == [3]
    assert off[3] > 5 * fit.rms_pixels
    assert abs(fit.lens.fx - truth.fx) < 2


def test_two_of_five_pictures_with_wrong_corners_are_outvoted():
    truth = LENSES["none"]
    views = views_through(truth, 5, 4)
    for i in (1, 4):
        wrong = views[i].pixels.copy()
        wrong[:27] += [14.0, -9.0]
        views[i] = replace(views[i], pixels=wrong)
    fit, off = outvoted(first_fit(views, SIZE, "none"))
    assert set(off) == {1, 4}
    assert abs(fit.lens.fx - truth.fx) < 5


def test_clean_pictures_outvote_nobody(brown_fit):
    fit, off = outvoted(brown_fit)
    assert off == {}
    assert fit is brown_fit


@pytest.mark.parametrize("model", WELL_POSED)
def test_unseen_corners_tell_the_model(model):
    views = views_through(LENSES[model], 10, 5)
    fits = []
    for tried in ("none", "plumb_bob", "equidistant"):
        try:
            fits.append(first_fit(views, SIZE, tried))
        except NotConverged:
            assert tried != model
    scores = [score(fit) for fit in fits]
    assert best_model(scores).model == model
    best = next(one for one in scores if one.model == model)
    assert 0.9 * NOISE < best.unseen_rms_pixels / np.sqrt(2) < 1.5 * NOISE


def judged(fit, outvoted_names=()):
    return verdict_of(fit, LensQuality.of(fit), outvoted_names)


def test_many_tilted_boards_all_over_the_picture_are_good():
    views = views_through(LENSES["plumb_bob"], 16, 2, fill=0.7)
    assert judged(first_fit(views, SIZE, "plumb_bob")) == ("good", ())


def test_boards_parallel_to_the_picture_leave_the_focal_length_open():
    views = views_through(LENSES["none"], 8, 2, tilt_degrees=0.3)
    # facing the camera off its axis is a tilt against the picture: only the middle is none
    near = [v for v in views if np.linalg.norm(v.pixels.mean(axis=0) - [320, 240]) < 150]
    fit = first_fit(near, SIZE, "none")
    verdict, told = judged(fit)
    assert verdict in ("weak", "failed")
    assert any("tilt" in line for line in told)


def test_too_few_pictures_and_a_bare_rim_are_told(brown_fit):
    verdict, told = judged(subset(brown_fit, [0, 1, 2, 3]))
    assert verdict == "weak"
    assert any("only 4 pictures" in line for line in told)
    assert any("of the picture; hold the board in its" in line for line in told)


def test_a_model_that_does_not_fit_leaves_rings_of_residuals():
    fit = first_fit(views_through(LENSES["plumb_bob"], 12, 7), SIZE, "none")
    quality = LensQuality.of(fit)
    assert max(abs(ring.outward) for ring in quality.rings) > 0.5
    verdict, told = judged(fit)
    assert verdict != "good"
    assert any("model none" in line for line in told)


def test_the_rings_of_the_right_model_hold_noise_alone(brown_fit):
    for ring in LensQuality.of(brown_fit).rings:
        assert abs(ring.outward) < 4.5 * ring.sigma
        assert abs(ring.outward) < 0.02


def test_the_error_told_in_the_corner_is_that_of_the_corner():
    truth, off, told = LENSES["none"], [], []
    corner = np.array([[639.0, 479.0]])
    for seed in range(8):
        fit = first_fit(views_through(truth, 8, seed), SIZE, "none")
        off.append(2 * np.linalg.norm(fit.lens.rays(corner) - truth.rays(corner)))
        told.append(LensQuality.of(fit).corner_error(2.0))
    assert 0.4 < np.sqrt(np.mean(np.square(off)) / np.mean(np.square(told))) < 1.5


@pytest.mark.parametrize(("zoom", "judgement"), [(1.02, "weak"), (1.15, "failed")])
def test_a_zoom_that_moved_half_way_through_is_seen_though_every_picture_fits(zoom, judgement):
    truth = LENSES["plumb_bob"]
    zoomed = Intrinsics(640, 480, zoom * 520, zoom * 521, 325, 236, truth.distortion)
    views = views_through(truth, 6, 1, fill=0.7) + views_through(zoomed, 6, 51, fill=0.7)
    fit, _ = outvoted(first_fit(views, SIZE, "plumb_bob"))
    assert fit.rms_pixels < 0.5
    verdict, told = judged(fit)
    assert verdict == judgement
    assert any("are all from one lens, zoom and focus" in line for line in told)


def test_pictures_of_one_lens_pull_no_more_than_their_noise():
    pulls = [
        first_fit(views_through(LENSES["none"], count, seed), SIZE, "none").disagreement
        for count in (4, 10)
        for seed in range(4)
    ]
    assert min(pulls) > 0.4
    assert max(pulls) < 1.8


def test_a_stretched_picture_is_suspected():
    views = [replace(v, pixels=v.pixels * [1.0, 0.9]) for v in views_through(LENSES["none"], 10, 3)]
    _, told = judged(first_fit(views, SIZE, "none"))
    assert any("stretched" in line for line in told)


def test_a_fit_knows_its_views(brown_fit):
    assert isinstance(brown_fit, LensFit)
    assert len(brown_fit.rms_of_views) == 10
    assert sum(len(r) for r in brown_fit.residuals) == 10 * len(BOARD.corners)
