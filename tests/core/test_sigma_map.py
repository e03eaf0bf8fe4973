# SPDX-License-Identifier: GPL-3.0-or-later
"""Sigma over a surface is that of reverse mapping, smooth up to where rays graze the plane."""

from __future__ import annotations

import numpy as np
import pytest
from ball_rig import LENS, POSE
from monocell.core import Camera, Cell, Pose, ReferenceLine, ReferencePlane, Sketch
from monocell.core.calibration.sigma_map import sigma_field, surface_sigma
from monocell.core.calibration.work_surface import surface_of, work_area
from monocell.core.errors import InvalidValue, NoPose
from monocell.core.modelling.mapped_covariance import point_covariance_on_plane
from monocell.core.modelling.reverse_mapping import (
    points_on_plane_or_nan,
)

ROOT = np.random.default_rng(1).normal(size=(6, 6))
COVARIANCE = ROOT @ ROOT.T * 1e-8
CAMERA = Camera(LENS, POSE, COVARIANCE)
TABLE = ReferencePlane("table", [0, 0, 0], [0, 0, 1])
TILTED = ReferencePlane("ramp", [0.1, 0, 0.1], [0.2, -0.3, -1])
# nearly level: the horizon of the table crosses the picture
LEVEL = Camera(LENS, Pose.looking_at([1.5, 0, 0.5], [0, 0, 0.45], [0, 0, 1]), COVARIANCE)
PIXELS = np.random.default_rng(2).uniform([0, 0], [479, 359], (60, 2))


@pytest.mark.parametrize("plane", [TABLE, TILTED])
def test_it_is_the_root_of_the_trace_of_reverse_mapping_s_covariance(plane):
    sigma = surface_sigma(CAMERA, plane, PIXELS)
    seen = np.isfinite(sigma)
    assert seen.sum() > 20
    covariance = point_covariance_on_plane(CAMERA, plane, PIXELS[seen], pixel_sigma=0.0)
    np.testing.assert_allclose(sigma[seen] ** 2, np.trace(covariance, axis1=1, axis2=2), rtol=1e-9)


def test_it_is_how_far_points_scatter_when_the_pose_is_drawn_from_its_covariance():
    rng = np.random.default_rng(3)
    twists = rng.multivariate_normal(np.zeros(6), COVARIANCE, 3000)
    at = PIXELS[:3]
    points = np.array(
        [points_on_plane_or_nan(Camera(LENS, POSE.perturbed(t)), TABLE, at) for t in twists]
    )
    scatter = np.sqrt(points.var(axis=0).sum(axis=1))
    np.testing.assert_allclose(scatter, surface_sigma(CAMERA, TABLE, at), rtol=0.06)


def test_above_the_horizon_and_at_grazing_rays_there_is_none():
    column = np.stack([np.full(360, 240.0), np.arange(360.0)], axis=1)
    sigma = surface_sigma(LEVEL, TABLE, column)
    seen = np.isfinite(sigma)
    slope = np.degrees(np.arcsin(-(LENS.rays(column) @ LEVEL.pose.rotate(TABLE.normal))))
    np.testing.assert_array_equal(seen, slope > 2.0)
    assert 0 < seen.sum() < 360
    assert (np.diff(sigma[seen]) < 0).all()


def test_from_below_a_plane_is_seen_as_well():
    below = Camera(LENS, Pose.looking_at([1, 0, -1], [0, 0, 0], [0, 0, 1]), COVARIANCE)
    assert np.isfinite(surface_sigma(below, TABLE, PIXELS)).all()


@pytest.mark.parametrize("camera", [CAMERA, LEVEL])
def test_between_its_nodes_the_field_is_interpolated_well(camera):
    field = sigma_field(camera, TABLE)
    middle_u = 0.5 * (field.columns[:-1] + field.columns[1:])
    middle_v = 0.5 * (field.rows[:-1] + field.rows[1:])
    u, v = np.meshgrid(middle_u, middle_v)
    exact = surface_sigma(camera, TABLE, np.stack([u.ravel(), v.ravel()], axis=1))

    def between(nodes):
        return 0.25 * (nodes[:-1, :-1] + nodes[1:, :-1] + nodes[:-1, 1:] + nodes[1:, 1:])

    guess = (between(field.scaled) / between(field.sines) ** 2).ravel()
    seen = np.isfinite(exact)
    np.testing.assert_allclose(guess[seen], exact[seen], rtol=2e-3)


def test_the_field_covers_the_whole_picture():
    field = sigma_field(CAMERA, TABLE)
    assert (field.columns[0], field.columns[-1]) == (-0.5, 479.5)
    assert (field.rows[0], field.rows[-1]) == (-0.5, 359.5)
    assert field.sigma.shape == (len(field.rows), len(field.columns))


def test_a_pose_without_covariance_has_no_sigma():
    with pytest.raises(NoPose, match="no covariance"):
        surface_sigma(Camera(LENS, POSE), TABLE, PIXELS)


def test_a_camera_in_the_plane_sees_nothing_of_it():
    plane = ReferencePlane("own", CAMERA.centre_world, [0, 0, 1])
    assert np.isnan(surface_sigma(CAMERA, plane, PIXELS)).all()
    assert work_area(Cell(CAMERA), CAMERA, plane) is None


def test_the_surface_is_the_one_named_or_the_first_plane_or_the_ground():
    line = ReferenceLine("edge", [0, 0, 0], [1, 0, 0])
    cell = Cell(CAMERA, references=(line, TABLE, TILTED))
    assert surface_of(cell).name == "table"
    assert surface_of(cell, "ramp") is TILTED
    assert surface_of(cell, "z=0.25").point.tolist() == [0, 0, 0.25]
    assert surface_of(Cell(CAMERA)).point.tolist() == [0, 0, 0]


@pytest.mark.parametrize(
    ("asked", "why"),
    [("edge", "no plane is called 'edge'; there is table, ramp"), ("z=a", "has no number")],
)
def test_a_surface_that_is_not_there_is_refused(asked, why):
    line = ReferenceLine("edge", [0, 0, 0], [1, 0, 0])
    with pytest.raises(InvalidValue, match=why):
        surface_of(Cell(CAMERA, references=(line, TABLE, TILTED)), asked)


def test_things_on_the_surface_say_where_it_counts():
    corners = np.array([[0.0, -0.1, 0], [0.2, -0.1, 0], [0.2, 0.15, 0]])
    pixels = CAMERA.project(corners).tolist()
    on_it = Sketch("a", "box", "table", {"base": [*pixels, None], "top": [[0.0, 0.0]]})
    other = Sketch("b", "box", "ramp", {"base": [[1.0, 1.0], [2.0, 1.0], [2.0, 2.0]]})
    cell = Cell(CAMERA, references=(TABLE, TILTED), sketches=(on_it, other))
    area = work_area(cell, CAMERA, TABLE)
    assert area.told == "where things stand (0.20 x 0.25 m)"
    np.testing.assert_allclose(area.points_world.min(axis=0), [0, -0.1, 0], atol=1e-6)
    np.testing.assert_allclose(area.points_world.max(axis=0), [0.2, 0.15, 0], atol=1e-6)
    expected = np.median(surface_sigma(CAMERA, TABLE, CAMERA.project(area.points_world)))
    assert area.sigmas(COVARIANCE[None])[0] == pytest.approx(expected, rel=1e-9)
    assert area.frame_pixels(CAMERA).shape == (96, 2)


def test_without_things_all_that_is_seen_counts():
    area = work_area(Cell(LEVEL), LEVEL, TABLE)
    assert area.told == "over all that is seen"
    assert 0 < len(area.points_world) < 49
    assert area.frame_pixels(LEVEL) is None
