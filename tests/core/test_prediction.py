# SPDX-License-Identifier: GPL-3.0-or-later
"""A nearly known pose says where the ball shows; the paper's vote finds it there."""

from __future__ import annotations

import numpy as np
import pytest
from ball_rig import LENS, PLACES, POSE, QUIET, RADIUS, picture_of
from monocell.core.ball.find import find_sphere
from monocell.core.ball.hints import FindHints
from monocell.core.ball.prediction import predicted
from monocell.core.ball.sphere import outline_pixels
from monocell.core.ball.three_parameter_vote import vote_for_sphere
from monocell.core.camera import Camera
from monocell.core.errors import InvalidValue, NoPose, PictureError, SphereNotFound

SIGMAS = np.array([0.004, 0.004, 0.004, 0.005, 0.005, 0.005])


def test_a_pose_drawn_from_its_covariance_predicts_windows_that_hold_the_ball():
    rng = np.random.default_rng(2)
    held = []
    for _ in range(60):
        near = Camera(LENS, POSE.perturbed(rng.normal(size=6) * SIGMAS), np.diag(SIGMAS**2))
        for place in PLACES:
            x, y, width, height = predicted(near, place, RADIUS, 0.0).window
            seen = outline_pixels(LENS, POSE.apply(place), RADIUS)
            inside = (seen > [x, y]) & (seen < [x + width, y + height])
            held.append(inside.all())
            assert width < 200
    assert np.mean(held) > 0.98


def test_a_wider_uncertainty_makes_a_wider_window():
    sure, unsure = (predicted(Camera(LENS, POSE), PLACES[0], RADIUS, w) for w in (0.01, 0.05))
    wider = (unsure.window[2] - sure.window[2]) / 2
    assert wider == pytest.approx(0.04 * LENS.fx / POSE.apply(PLACES[0])[2], rel=0.1)


def test_a_predicted_window_and_size_find_the_ball():
    near = Camera(LENS, POSE.perturbed([0.01, -0.01, 0.008, 0.01, 0.0, -0.02]))
    for place in PLACES:
        hope = predicted(near, place, RADIUS, 0.04)
        hints = FindHints(rough_radius_pixels=hope.radius_pixels)
        outline = find_sphere(picture_of(place, QUIET), LENS, RADIUS, hope.window, hints=hints)
        assert np.linalg.norm(outline.centre_camera - POSE.apply(place)) < 0.01
        assert hope.doubts(outline.centre_camera) == ()


def test_a_ball_farther_off_than_said_is_doubted():
    hope = predicted(Camera(LENS, POSE), PLACES[0], RADIUS, 0.02)
    aside = np.cross(hope.centre_camera, [0, 1, 0])
    elsewhere = hope.centre_camera + 0.03 * aside / np.linalg.norm(aside)
    assert hope.aside(elsewhere) == pytest.approx(0.03)
    assert "30 mm aside of where the pose puts it, 20 mm" in hope.doubts(elsewhere)[0]


def test_what_can_t_be_predicted_is_refused_with_its_numbers():
    camera = Camera(LENS, POSE)
    with pytest.raises(SphereNotFound, match="z = -"):
        predicted(camera, [5.0, 0.0, 1.0], RADIUS, 0.01)
    with pytest.raises(SphereNotFound, match="outside the 480 x 360 picture"):
        predicted(camera, [0.1, 1.5, 0.25], RADIUS, 0.01)
    with pytest.raises(InvalidValue, match="within: must not be below zero"):
        predicted(camera, PLACES[0], RADIUS, -1.0)
    with pytest.raises(NoPose):
        predicted(Camera(LENS), PLACES[0], RADIUS, 0.01)


@pytest.mark.parametrize("place", range(3))
def test_the_vote_finds_the_ball_to_half_a_pixel_and_two_percent(place):
    centre = POSE.apply(PLACES[place])
    picture = picture_of(PLACES[place], QUIET)
    found = vote_for_sphere(picture, LENS, RADIUS, centre + np.array([0.02, -0.015, 0.03]), 0.05)
    one, other = LENS.project(np.stack([found, centre]))
    assert np.linalg.norm(one - other) < 0.5
    assert np.linalg.norm(found) == pytest.approx(np.linalg.norm(centre), rel=0.02)


def test_a_vote_without_edges_or_outside_the_picture_is_refused():
    centre = POSE.apply(PLACES[0])
    blank = np.full((LENS.height, LENS.width, 3), 90, np.uint8)
    with pytest.raises(SphereNotFound, match="only 0 edge points"):
        vote_for_sphere(blank, LENS, RADIUS, centre, 0.05)
    box = blank.copy()
    box[100:140, 150:260] = 200
    with pytest.raises(SphereNotFound, match="of an outline"):
        vote_for_sphere(box, LENS, RADIUS, LENS.rays([[205.0, 120.0]])[0] * 1.5, 0.05)
    with pytest.raises(SphereNotFound, match="outside the picture"):
        vote_for_sphere(blank, LENS, RADIUS, [3.0, 0.0, 1.5], 0.05)
    with pytest.raises(InvalidValue, match="reach"):
        vote_for_sphere(blank, LENS, RADIUS, centre, 0.0)
    with pytest.raises(PictureError):
        vote_for_sphere(blank[:100], LENS, RADIUS, centre, 0.05)
