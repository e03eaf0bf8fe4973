# SPDX-License-Identifier: GPL-3.0-or-later
"""Margins from covariances: against plain cases and against sampling."""

from __future__ import annotations

import numpy as np
import pytest
from monocell.core import Box, Cone, Cylinder, Pose, Prism, Sphere, Tube
from monocell.core.errors import InvalidValue
from monocell.headless.robot.margins import surface_margin, uncertainty_margins

POSE = Pose.from_rotation_vector([0.2, 0.1, 0.7], [0.5, 0.1, 0.2])


def box(covariance):
    return Box("box", POSE, size=np.array([0.2, 0.1, 0.3]), covariance=covariance)


def drum(covariance):
    return Cylinder("drum", POSE, radius=0.08, height=0.25, covariance=covariance)


def test_an_uncertain_place_alone_is_three_sigma_of_its_worst_direction():
    sigmas = np.array([0, 0, 0, 1e-3, 2e-3, 1e-3, 0, 0, 0])
    assert surface_margin(box(np.diag(sigmas**2))) == pytest.approx(0.006)
    assert surface_margin(box(np.diag(sigmas**2)), sigmas=1) == pytest.approx(0.002)


def test_an_uncertain_radius_alone_is_three_sigma_of_it():
    sigmas = np.array([0, 0, 0, 0, 0, 0, 1e-3, 0])
    assert surface_margin(drum(np.diag(sigmas**2))) == pytest.approx(0.003)


def ball(covariance):
    return Sphere("ball", POSE, radius=0.08, covariance=covariance)


def cone(covariance):
    return Cone("cone", POSE, radius=0.08, top_radius=0.03, height=0.25, covariance=covariance)


def tube(covariance):
    return Tube("tube", POSE, radius=0.08, inner_radius=0.05, height=0.25, covariance=covariance)


def prism(covariance):
    polygon = [[-0.1, -0.1], [0.2, -0.1], [-0.1, 0.2]]
    return Prism("prism", POSE, polygon=polygon, height=0.1, covariance=covariance)


@pytest.mark.parametrize("make", [drum, cone, tube, ball])
def test_a_turn_that_does_not_show_needs_no_margin(make):
    count = 6 + len(make(None).parameters)
    axis = POSE.rotation[:, 2]
    spin = np.zeros((count, count))
    spin[:3, :3] = np.outer(axis, axis) if make is not ball else np.eye(3)
    assert surface_margin(make(spin)) == pytest.approx(0, abs=1e-7)
    assert surface_margin(box(0.01 * np.diag([1.0] * 3 + [0] * 6))) > 0.05


def test_the_radius_of_a_ball_and_the_hole_of_a_tube_have_margins_of_their_own():
    assert surface_margin(ball(np.diag([0] * 6 + [1e-6]))) == pytest.approx(0.003, rel=1e-3)
    assert surface_margin(tube(np.diag([0] * 7 + [4e-6, 0]))) == pytest.approx(0.006)
    assert surface_margin(prism(np.diag([0] * 7 + [9e-6] + [0] * 5))) == pytest.approx(0.009)


@pytest.mark.parametrize("make", [box, drum, cone, tube, prism])
def test_the_margin_is_the_largest_spread_of_any_sampled_edge_point(make):
    random = np.random.default_rng(0)
    size = 6 + len(make(None).parameters)
    mix = random.normal(size=(size, size)) * 1e-3
    thing = make(mix @ mix.T)
    draws = random.multivariate_normal(np.zeros(size), thing.covariance, size=4000)
    moved = np.array([edge_points(thing, draw) for draw in draws])
    spread = max(np.linalg.eigvalsh(np.cov(moved[:, i].T)).max() for i in range(moved.shape[1]))
    assert surface_margin(thing) == pytest.approx(3 * np.sqrt(spread), rel=0.05)


def edge_points(thing, draw):
    spin = 0 if isinstance(thing, Box | Prism) else draw[:3] @ POSE.rotation[:, 2]
    turn = draw[:3] - spin * POSE.rotation[:, 2]
    turned = Pose.from_rotation_vector(turn, [0, 0, 0]).rotation @ POSE.rotation
    return own_points(thing, draw[6:]) @ turned.T + POSE.translation + draw[3:6]


def own_points(thing, change):
    """Edge points in the object's frame, of the object with its parameters changed."""
    sizes = thing.parameters + change
    if isinstance(thing, Box):
        signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
        return signs * sizes / 2
    if isinstance(thing, Prism):
        corners = sizes[1:].reshape(-1, 2)
        return np.vstack(
            [np.column_stack([corners, [z * sizes[0]] * len(corners)]) for z in (-0.5, 0.5)]
        )
    angle = np.arange(48) * 2 * np.pi / 48
    rim = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    up = np.array([0, 0, sizes[-1] / 2])
    radii = {"cylinder": sizes[[0, 0]], "cone": sizes[:2]}.get(thing.kind)
    if radii is None:
        return np.vstack([r * rim + s * up for r in sizes[:2] for s in (-1, 1)])
    return np.vstack([radii[0] * rim - up, radii[1] * rim + up])


def test_an_object_without_covariance_has_no_margin_of_its_own():
    assert uncertainty_margins([box(None)]) == {"box": 0.0}
    with pytest.raises(InvalidValue, match="box: has no covariance"):
        surface_margin(box(None))
