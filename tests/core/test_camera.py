# SPDX-License-Identifier: GPL-3.0-or-later
"""A camera in the world: projection, rays, its centre, and the spread its covariance states."""

from __future__ import annotations

import numpy as np
import pytest
from drawn import imaged_rays, lenses, poses
from hypothesis import given, settings
from hypothesis import strategies as st
from monocell.core import Camera, Intrinsics, Pose
from monocell.core.errors import InvalidValue, NoPose

LAWS = settings(max_examples=30, deadline=None)
LENS = Intrinsics(640, 480, 500.0, 500.0, 320.0, 240.0)
POSE = Pose.looking_at([1.0, -2.0, 1.5], [0.1, 0.0, 0.2], [0, 0, 1])


@LAWS
@given(lenses(), poses(), st.integers(0, 2**32 - 1))
def test_world_points_lie_on_the_rays_of_their_pixels(intrinsics, pose, seed):
    camera = Camera(intrinsics, pose)
    rng = np.random.default_rng(seed)
    rays = imaged_rays(intrinsics, rng, 10, 0.9)
    depths = rng.uniform(0.2, 9.0, (10, 1))
    points = pose.inverse().apply(rays * depths)
    origin, directions = camera.rays_world(camera.project(points))
    np.testing.assert_allclose(origin, camera.centre_world)
    np.testing.assert_allclose(origin + depths * directions, points, atol=1e-7)


def test_the_centre_is_where_the_camera_was_put():
    np.testing.assert_allclose(Camera(LENS, POSE).centre_world, [1.0, -2.0, 1.5])


def test_without_a_pose_a_camera_has_no_place():
    camera = Camera(LENS)
    for asked in (
        lambda: camera.pose,
        lambda: camera.centre_world,
        lambda: camera.project([[0, 0, 1]]),
    ):
        with pytest.raises(NoPose, match="calibrate it"):
            asked()


def test_the_stated_sigmas_are_those_of_perturbed_poses():
    rng = np.random.default_rng(5)
    root = rng.normal(size=(6, 6)) * np.array([1e-3] * 3 + [2e-3] * 3)[:, None]
    camera = Camera(LENS, POSE, root @ root.T)
    twists = rng.multivariate_normal(np.zeros(6), root @ root.T, 4000)
    moved = [POSE.perturbed(twist) for twist in twists]
    centres = np.array([pose.inverse().translation for pose in moved])
    turns = np.array([(pose @ POSE.inverse()).rotation_vector() for pose in moved])
    np.testing.assert_allclose(centres.std(axis=0), camera.centre_sigma(), rtol=0.06)
    np.testing.assert_allclose(turns.std(axis=0), camera.rotation_sigma(), rtol=0.06)


def test_a_camera_without_covariance_states_no_sigma():
    camera = Camera(LENS, POSE)
    assert camera.centre_sigma() is None
    assert camera.rotation_sigma() is None


def test_placing_a_camera_elsewhere_forgets_the_old_error():
    camera = Camera(LENS, POSE, np.eye(6)).placed(Pose.identity())
    assert camera.covariance is None
    assert camera.intrinsics is LENS


@pytest.mark.parametrize("covariance", [np.eye(5), -np.eye(6), np.triu(np.ones((6, 6)))])
def test_what_is_no_covariance_is_refused(covariance):
    with pytest.raises(InvalidValue, match=r"camera\.covariance"):
        Camera(LENS, POSE, covariance)
