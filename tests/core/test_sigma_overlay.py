# SPDX-License-Identifier: GPL-3.0-or-later
"""Lines of equal value lie where the value is; the map is coloured where the surface is seen."""

from __future__ import annotations

import numpy as np
import pytest
from monocell.core import Camera, Intrinsics, Pose, ReferencePlane
from monocell.core.calibration.sigma_map import sigma_field, surface_sigma
from monocell.core.errors import PictureError
from monocell.core.picture.iso_lines import iso_segments
from monocell.core.picture.overlay import BallOutline
from monocell.core.picture.sigma_overlay import draw_sigma_map

COVARIANCE = np.diag([4e-8, 4e-8, 1e-8, 1e-7, 1e-7, 4e-7])
LENS = Intrinsics(480, 360, 500.0, 500.0, 240.0, 180.0)
TABLE = ReferencePlane("table", [0, 0, 0], [0, 0, 1])
# the horizon lies a quarter down the picture
CAMERA = Camera(LENS, Pose.looking_at([2.0, 0, 0.6], [0, 0, 0.3], [0, 0, 1]), COVARIANCE)


def grey():
    return np.full((360, 480, 3), 140, np.uint8)


def drawn(camera=CAMERA, balls=(), frame=None, caption="1 sigma of a point"):
    return draw_sigma_map(grey(), camera, sigma_field(camera, TABLE), caption, balls, frame)


def test_the_line_of_a_cone_is_a_circle():
    columns, rows = np.linspace(-3, 3, 61), np.linspace(-3, 3, 61)
    u, v = np.meshgrid(columns, rows)
    segments = iso_segments(np.hypot(u, v), 2.0, columns, rows)
    np.testing.assert_allclose(np.hypot(*segments.reshape(-1, 2).T), 2.0, atol=2e-3)
    lengths = np.linalg.norm(segments[:, 1] - segments[:, 0], axis=1)
    assert lengths.sum() == pytest.approx(4 * np.pi, rel=2e-3)


def test_what_is_not_known_is_not_crossed():
    columns = rows = np.arange(6.0)
    field = np.broadcast_to(columns, (6, 6)).copy()
    field[3:, 3:] = np.nan
    segments = iso_segments(field, 2.5, columns, rows)
    np.testing.assert_allclose(segments[:, :, 0], 2.5)
    assert segments[:, :, 1].max() == 2.0
    assert len(iso_segments(field, 99.0, columns, rows)) == 0


def test_above_the_horizon_the_photograph_keeps_its_grey():
    picture = drawn()[:360]
    colourful = np.ptp(picture.astype(int), axis=2) > 25
    assert not colourful[:40].any()
    assert colourful[200:].mean() > 0.9


def test_where_the_error_is_larger_the_colour_is_lighter():
    picture = drawn()[:360].astype(float)
    bands = [(150, 200), (210, 260), (270, 310), (320, 356)]
    # the median over a band passes the lines by
    light = [np.median(picture[a:b, 10:60].mean(axis=2)) for a, b in bands]
    middle = np.array([[35.0, (a + b) / 2] for a, b in bands])
    assert (np.diff(surface_sigma(CAMERA, TABLE, middle)) < 0).all()
    assert (np.diff(light) < -2).all()


def test_the_footer_holds_the_scale_below_the_picture():
    picture = drawn()
    assert picture.shape[1] == 480
    assert 360 < picture.shape[0] < 460
    bar = picture[360:][np.ptp(picture[360:].astype(int), axis=2).argmax(axis=0).max()]
    assert (bar != bar[0]).any()


def test_balls_and_the_frame_are_drawn_in_their_colours():
    ring = 200 + 30 * np.stack([np.cos(np.arange(60) / 9.5), np.sin(np.arange(60) / 9.5)], axis=1)
    frame = np.array([[300.0, 250.0], [400.0, 250.0], [400.0, 300.0], [300.0, 300.0]])
    changed = drawn(balls=[BallOutline(ring, (255, 255, 255))], frame=frame) != drawn()
    assert changed[195:205, 228:233].any()
    assert changed[248:253, 320:380].any(axis=(0, 2)).all()


def test_a_caption_too_wide_is_cut_and_one_in_another_script_drawn():
    assert drawn(caption="x" * 500).shape == drawn(caption="Tisch über 深").shape


def test_a_surface_that_is_not_seen_leaves_grey():
    away = Camera(LENS, Pose.looking_at([0, 0, 1], [1, 0, 1.6], [0, 0, 1]), COVARIANCE)
    assert (np.ptp(drawn(away)[:360].astype(int), axis=2) == 0).all()


def test_another_picture_is_refused():
    with pytest.raises(PictureError, match="8-bit colour"):
        draw_sigma_map(grey()[:-1], CAMERA, sigma_field(CAMERA, TABLE), "")
