# SPDX-License-Identifier: GPL-3.0-or-later
"""Margins from covariances: against plain cases and against sampling."""

from __future__ import annotations

import numpy as np
import pytest
from monocell.core import Box, Cylinder, Pose
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


@pytest.mark.parametrize("make", [box, drum])
def test_the_margin_is_the_largest_spread_of_any_sampled_edge_point(make):
    random = np.random.default_rng(0)
    size = 6 + len(make(None).size_names)
    mix = random.normal(size=(size, size)) * 1e-3
    thing = make(mix @ mix.T)
    draws = random.multivariate_normal(np.zeros(size), thing.covariance, size=4000)
    moved = np.array([edge_points(thing, draw) for draw in draws])
    spread = max(np.linalg.eigvalsh(np.cov(moved[:, i].T)).max() for i in range(moved.shape[1]))
    assert surface_margin(thing) == pytest.approx(3 * np.sqrt(spread), rel=0.05)


def edge_points(thing, draw):
    turned = Pose.from_rotation_vector(draw[:3], [0, 0, 0]).rotation @ POSE.rotation
    sizes = thing.sizes + draw[6:]
    if isinstance(thing, Box):
        signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
        own = signs * sizes / 2
    else:
        angle = np.arange(48) * 2 * np.pi / 48
        rim = np.stack([np.cos(angle) * sizes[0], np.sin(angle) * sizes[0], 0 * angle], axis=1)
        up = np.array([0, 0, sizes[1] / 2])
        own = np.vstack([rim + up, rim - up])
    return own @ turned.T + POSE.translation + draw[3:6]


def test_an_object_without_covariance_has_no_margin_of_its_own():
    assert uncertainty_margins([box(None)]) == {"box": 0.0}
    with pytest.raises(InvalidValue, match="box: has no covariance"):
        surface_margin(box(None))
