# SPDX-License-Identifier: GPL-3.0-or-later
"""Balls in ray-traced pictures are found where they are, or refused for the right reason."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from ball_rig import LENS, PLACES, POSE, QUIET, RADIUS, picture_of, sigmas_off, window_around
from monocell.core import Distortion, Intrinsics
from monocell.core.ball.find import find_sphere, find_spheres, measure_sphere
from monocell.core.ball.sphere import outline_pixels
from monocell.core.errors import InvalidValue, PictureError, SphereCut, SphereNotFound
from monocell.core.picture.synthetic import Ball, Photographer, photograph

SHADED = replace(QUIET, texture=0.15)


def off(outline, centre):
    """Error across the line of sight in pixels, along it as a share of the distance."""
    distance = np.linalg.norm(centre)
    axis = centre / distance
    error = outline.centre_camera - centre
    across = np.linalg.norm(error - (error @ axis) * axis) / distance * LENS.fx
    return across, abs(error @ axis) / distance


def is_right(outline, centre, across=0.15, deep=0.006):
    assert outline.warnings == ()
    seen_across, seen_deep = off(outline, centre)
    assert seen_across < across
    assert seen_deep < deep
    assert sigmas_off(outline.centre_camera - centre, outline.covariance) < 6


@pytest.mark.parametrize("place", range(len(PLACES)))
@pytest.mark.parametrize("in_window", [True, False], ids=["window", "whole picture"])
def test_a_ball_is_found_within_its_stated_error(place, in_window):
    picture = picture_of(PLACES[place], replace(SHADED, seed=place))
    window = window_around(PLACES[place]) if in_window else None
    outline = find_sphere(picture, LENS, RADIUS, window)
    is_right(outline, POSE.apply(PLACES[place]))
    assert outline.coverage > 0.9
    assert outline.cut == 0
    assert outline.blur_pixels == pytest.approx(QUIET.blur_pixels, abs=0.25)


@pytest.mark.parametrize(
    ("model", "coefficients"),
    [
        ("none", []),
        ("rational_polynomial", [0.3, -0.2, 5e-4, -3e-4, 0.02, 0.5, -0.1, 0.01]),
        ("equidistant", [-0.02, 0.004, -0.001, 2e-4]),
    ],
)
def test_a_ball_is_found_through_every_lens(model, coefficients):
    lens = Intrinsics(480, 360, 400.0, 398.0, 243.2, 177.4, Distortion(model, coefficients))
    centre = np.array([0.2, -0.15, 0.6])
    picture = photograph(lens, (Ball(tuple(centre), RADIUS),), SHADED)
    is_right(find_sphere(picture, lens, RADIUS), centre)


WORSE = {
    "noise": replace(SHADED, noise_grey_levels=4.0),
    "blur": replace(SHADED, blur_pixels=1.2),
    "jpeg": replace(SHADED, jpeg_quality=85),
    "light from the side": replace(SHADED, light=(0.9, 0.2, -0.4)),
    "bright wall": replace(SHADED, background=(0.5, 0.9)),
}


@pytest.mark.parametrize("worse", WORSE)
def test_a_worse_picture_still_gives_the_ball_and_an_error_of_the_right_size(worse):
    squares = []
    for place in PLACES:
        centre = POSE.apply(place)
        outline = find_sphere(picture_of(place, WORSE[worse]), LENS, RADIUS)
        across, deep = off(outline, centre)
        assert across < 0.4
        assert deep < 0.015
        squares.append(sigmas_off(outline.centre_camera - centre, outline.covariance) ** 2)
    # three numbers a ball: the errors may be a few times what one ball alone states, not ten times
    assert np.sqrt(np.mean(squares) / 3) < 3.5


@pytest.mark.parametrize("radius_pixels", [9, 14, 45, 120])
def test_balls_of_any_size_are_found(radius_pixels):
    depth = LENS.fx * RADIUS / radius_pixels
    centre = LENS.rays(np.array([[260.0, 170.0]]))[0] * depth
    picture = photograph(LENS, (Ball(tuple(centre), RADIUS),), replace(QUIET, texture=0.1))
    across, deep = off(find_sphere(picture, LENS, RADIUS), centre)
    assert across < 0.2
    # an outline that is so many pixels too large or small
    assert deep * radius_pixels < 0.25


def test_sixteen_bits_give_the_same_ball_as_eight():
    picture = picture_of(PLACES[1], SHADED)
    eight = find_sphere(picture, LENS, RADIUS)
    sixteen = find_sphere(picture.astype(np.uint16) * 257, LENS, RADIUS)
    np.testing.assert_allclose(sixteen.centre_camera, eight.centre_camera, rtol=1e-4)


def test_fingers_over_a_third_of_the_outline_do_not_move_the_ball():
    centre = POSE.apply(PLACES[3])
    u, v = LENS.project(centre[None])[0]
    size = LENS.fx * RADIUS / centre[2]
    # two bars from above over the left and right of the ball
    bars = tuple((u + at * size, v - 2 * size, 0.5 * size, 2.6 * size) for at in (-0.98, 0.48))
    rim = outline_pixels(LENS, centre, RADIUS, 360)
    hidden = np.zeros(360, dtype=bool)
    for x, y, width, height in bars:
        hidden |= (abs(rim - [x + width / 2, y + height / 2]) < [width / 2, height / 2]).all(axis=1)
    assert hidden.mean() > 0.3
    outline = find_sphere(picture_of(PLACES[3], replace(SHADED, hidden=bars)), LENS, RADIUS)
    across, deep = off(outline, centre)
    assert across < 0.3
    assert deep < 0.015
    assert outline.coverage < 0.8


@pytest.mark.parametrize("share", [0.08, 0.15])
def test_a_ball_cut_a_little_by_the_border_is_used_with_a_warning(share):
    centre, size = _beside_the_left_border(share)
    picture = photograph(LENS, (Ball(tuple(centre), RADIUS),), SHADED)
    outline = find_sphere(picture, LENS, RADIUS, (0, 120, 2 * size + 20, 120))
    assert 0.05 < outline.cut < 0.3
    assert any("the border cuts" in warning for warning in outline.warnings)
    across, deep = off(outline, centre)
    assert across < 0.4
    assert deep < 0.02


def test_a_ball_half_out_of_the_picture_is_refused_as_cut():
    centre, size = _beside_the_left_border(0.5)
    picture = photograph(LENS, (Ball(tuple(centre), RADIUS),), SHADED)
    with pytest.raises(SphereCut, match="% of its outline lies outside the picture"):
        measure_sphere(picture, LENS, RADIUS, centre)
    with pytest.raises(SphereNotFound):
        find_sphere(picture, LENS, RADIUS, (0, 120, 2 * size + 20, 120))


def test_the_other_balls_are_found_too_and_the_best_comes_first():
    centres = [POSE.apply(place) for place in PLACES[:3]]
    picture = photograph(LENS, tuple(Ball(tuple(c), RADIUS) for c in centres), QUIET)
    found = find_spheres(picture, LENS, RADIUS)
    for centre in centres:
        assert any(off(outline, centre)[0] < 0.3 for outline in found)
    evidence = [outline.evidence for outline in found]
    assert evidence == sorted(evidence, reverse=True)


def test_a_window_chooses_among_balls():
    centres = [POSE.apply(place) for place in PLACES[:3]]
    picture = photograph(LENS, tuple(Ball(tuple(c), RADIUS) for c in centres), QUIET)
    for place, centre in zip(PLACES[:3], centres, strict=True):
        is_right(find_sphere(picture, LENS, RADIUS, window_around(place)), centre)


def test_a_known_place_a_few_pixels_off_is_enough():
    centre = POSE.apply(PLACES[4])
    outline = measure_sphere(picture_of(PLACES[4]), LENS, RADIUS, centre * 1.02 + [0.002, 0, 0])
    is_right(outline, centre)


@pytest.mark.parametrize("level", [0, 90, 255])
@pytest.mark.parametrize("window", [None, (100, 100, 120, 120)])
def test_a_blank_picture_holds_no_ball(level, window):
    blank = np.full((LENS.height, LENS.width, 3), level, np.uint8)
    with pytest.raises(SphereNotFound, match="no ball found in the"):
        find_sphere(blank, LENS, RADIUS, window)


@pytest.mark.parametrize("seed", range(5))
def test_noise_alone_holds_no_ball(seed):
    rng = np.random.default_rng(seed)
    noise = np.clip(rng.normal(128, 40, (LENS.height, LENS.width, 3)), 0, 255).astype(np.uint8)
    with pytest.raises(SphereNotFound):
        find_sphere(noise, LENS, RADIUS)


@pytest.mark.parametrize("seed", range(5))
def test_a_blotchy_wall_holds_no_ball(seed):
    wall = photograph(LENS, (), Photographer(texture=0.4, seed=seed))
    with pytest.raises(SphereNotFound):
        find_sphere(wall, LENS, RADIUS)


def test_a_box_s_picture_holds_no_ball():
    picture = np.full((LENS.height, LENS.width, 3), 60, np.uint8)
    picture[140:190, 200:260] = 200
    with pytest.raises(SphereNotFound):
        find_sphere(picture, LENS, RADIUS)


def test_a_window_beside_the_picture_is_refused_with_its_numbers():
    with pytest.raises(SphereNotFound, match=r"window \[500, 10, 60, 60\] leaves 0 x 60 px"):
        find_sphere(picture_of(PLACES[0]), LENS, RADIUS, (500, 10, 60, 60))


def test_the_camera_s_size_and_a_positive_radius_are_asked_for():
    with pytest.raises(PictureError, match="480 x 360"):
        find_sphere(np.zeros((100, 100, 3), np.uint8), LENS, RADIUS)
    for radius in (0.0, -1.0, np.nan):
        with pytest.raises(InvalidValue, match="radius"):
            find_sphere(picture_of(PLACES[0]), LENS, radius)


def test_the_same_picture_gives_the_same_answer_twice():
    picture = picture_of(PLACES[2], SHADED)
    one, two = (find_sphere(picture, LENS, RADIUS) for _ in range(2))
    np.testing.assert_array_equal(one.centre_camera, two.centre_camera)
    np.testing.assert_array_equal(one.covariance, two.covariance)


def _beside_the_left_border(share_cut):
    """A ball with about that share of its outline left of the picture, and its size in pixels."""
    depth = 1.2
    size = LENS.fx * RADIUS / depth
    # of a circle, the share of the outline beyond a chord at distance d is acos(d / r) / pi
    u = size * np.cos(np.pi * share_cut) - 0.5
    ray = LENS.rays(np.array([[u, 180.0]]))[0]
    return ray * depth, size


def test_a_guess_that_leads_nowhere_is_refused_and_never_breaks():
    lens = Intrinsics(120, 120, 1200.0, 1200.0, 60.0, 60.0)
    rng = np.random.default_rng(5)
    for _ in range(40):
        picture = rng.integers(0, 255, (120, 120, 3)).astype(np.uint8)
        rough = np.array([0.0, 0.0, 0.04 * 1200 / rng.uniform(2.0, 14.0)])
        try:
            measure_sphere(picture, lens, 0.04, rough)
        except SphereNotFound as refusal:
            assert "\n" not in str(refusal)
