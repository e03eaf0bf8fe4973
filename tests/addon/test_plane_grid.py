# SPDX-License-Identifier: GPL-3.0-or-later
from dataclasses import replace

import bench_cell
import numpy as np
from monocell.addon.on_picture.loupe import ACROSS, enlarged
from monocell.addon.overlay.plane_grid import plane_grid
from monocell.core import ReferencePlane
from monocell.core.modelling.reverse_mapping import points_on_plane_or_nan

PINHOLE = replace(bench_cell.CAMERA, intrinsics=bench_cell.INTRINSICS.undistorted())


def test_the_grid_lies_on_the_plane_at_whole_cells():
    grid = plane_grid(bench_cell.CAMERA, bench_cell.FLOOR)
    assert grid.cell in (0.02, 0.05, 0.1)
    for line in (*grid.fine, *grid.major):
        places = points_on_plane_or_nan(PINHOLE, bench_cell.FLOOR, line)[:, :2] / grid.cell
        # one of the two coordinates is the same whole number all along
        off = [np.abs(places[:, i] - np.round(places[0, i])).max() for i in (0, 1)]
        assert min(off) < 1e-6


def test_every_fifth_line_is_a_strong_one():
    grid = plane_grid(bench_cell.CAMERA, bench_cell.FLOOR)
    assert 3 * len(grid.major) < len(grid.fine) < 6 * len(grid.major)
    assert 10 < len(grid.fine) + len(grid.major) < 250


def test_a_tilted_plane_has_the_grid_of_its_own_frame():
    wall = ReferencePlane("wall", [0.3, 0.4, 0.0], [0.1, -1, 0.2])
    grid = plane_grid(bench_cell.CAMERA, wall)
    line = grid.fine[0]
    points = points_on_plane_or_nan(PINHOLE, wall, line)
    own = wall.world_from_plane.inverse().apply(points)[:, :2] / grid.cell
    assert min(np.ptp(own, axis=0)) < 1e-6


def test_a_plane_that_is_not_seen_has_no_grid():
    forward = bench_cell.POSE.inverse().rotate(np.array([0.0, 0.0, 1.0]))
    behind = ReferencePlane("behind", bench_cell.CAMERA.centre_world - forward, forward)
    assert plane_grid(bench_cell.CAMERA, behind) is None


def test_the_loupe_shows_the_pixels_where_they_belong():
    picture = np.random.default_rng(1).uniform(size=(60, 80, 3))
    centre, middle = np.array([40.3, 29.8]), np.array([500.0, 400.0])
    corners, colors = enlarged(picture, centre, middle, 8.0)
    # the pixel that holds the centre is drawn over the loupe's middle
    around = (corners.min(axis=1) <= middle).all(1) & (corners.max(axis=1) >= middle).all(1)
    assert np.allclose(colors[around], picture[30, 40])
    assert np.allclose([corners.min(), corners[..., 0].max()], [400 - ACROSS * 4, 500 + ACROSS * 4])


def test_the_loupe_ends_at_the_picture_s_rim():
    picture = np.zeros((60, 80, 3))
    corners, _ = enlarged(picture, np.array([0.0, 0.0]), np.array([500.0, 400.0]), 8.0)
    assert np.isclose(corners[..., 0].min(), 496) and np.isclose(corners[..., 1].max(), 404)
    assert len(enlarged(picture, np.array([-90.0, 0.0]), np.zeros(2), 8.0)[0]) == 0
