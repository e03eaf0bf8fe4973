# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from monocell.core.calibration.three_depths import depths_of_three

COORDINATE = st.floats(-0.5, 0.5)
POINTS = st.lists(st.tuples(COORDINATE, COORDINATE, st.floats(1.0, 3.0)), min_size=3, max_size=3)


def spread(points):
    a, b, c = points
    return np.linalg.norm(np.cross(b - a, c - a))


@given(POINTS)
@example([(0.125, -0.375, 2.0), (0.0, -0.076171875, 2.087890625), (-0.001953125, 0.5, 2.28515625)])
def test_the_true_depths_are_among_the_answers_and_all_answers_keep_the_distances(points):
    camera = np.array(points)
    if spread(camera) < 0.05:
        return
    depths = np.linalg.norm(camera, axis=1)
    rays = camera / depths[:, None]
    found = depths_of_three(rays, camera)
    assert 1 <= len(found) <= 4
    # where two answers meet, the quartic's double root keeps half the digits
    assert np.abs(found - depths).max(axis=1).min() < 1e-3
    for answer in found:
        placed = rays * answer[:, None]
        for i, j in ((0, 1), (0, 2), (1, 2)):
            apart = np.linalg.norm(placed[i] - placed[j])
            assert apart == pytest.approx(np.linalg.norm(camera[i] - camera[j]), abs=1e-4)


def test_a_symmetric_pyramid_has_four_answers():
    # Fischler and Bolles' example: three rays as steep as each other, an equilateral base
    phi = np.radians([90, 210, 330])
    points = np.stack([2 * np.cos(phi), 2 * np.sin(phi), np.full(3, np.sqrt(12))], axis=1)
    rays = points / np.linalg.norm(points, axis=1)[:, None]
    found = depths_of_three(rays, points)
    assert len(found) == 4
    assert len({tuple(answer.round(6)) for answer in found}) == 4


def test_pixels_that_are_too_wrong_have_no_answer():
    rays = np.array([[0.0, 0, 1], [0.6, 0, 0.8], [-0.6, 0, 0.8]])
    # half a metre between the outer two keeps both near the camera, and the first near them: none
    # of them can be a metre from it
    points = np.array([[0.0, 0, 0], [1.0, 0, 0], [0.5, 0.01, 0]])
    assert len(depths_of_three(rays, points)) == 0
