# SPDX-License-Identifier: GPL-3.0-or-later
"""Pixels mapped onto references: errors of pick, camera and reference together, and doubts."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from drawn import differences
from hypothesis import given, settings
from hypothesis import strategies as st
from monocell.core import Pose, ReferenceLine, ReferencePlane
from monocell.core.covariance import bound_of_sum, remainder
from monocell.core.errors import PickError
from monocell.core.modelling.map_pixels import map_pixels
from monocell.core.modelling.reverse_mapping import (
    point_derivatives_by_line,
    point_derivatives_by_plane,
    points_on_line,
    points_on_plane,
)
from monocell.core.references.resolve import resolve_references
from monocell.core.rotation import rotation_from_vector
from referenced_cell import CAMERA, POSE, SOURCES, TWIST_COVARIANCE, referenced_cell

EDGE = ReferenceLine("edge", [0.1, -0.2, 0.05], [0.4, 1.0, 0.2])
RAMP = ReferencePlane("ramp", [0.1, 0.0, 0.05], [0.2, -0.1, 1.0])
# of chi squared with three degrees of freedom
WITHIN_95 = 7.815


def moved(reference, step):
    point, turn = reference.point + step[3:], rotation_from_vector(step[:3])
    if isinstance(reference, ReferencePlane):
        return replace(reference, point=point, normal=turn @ reference.normal)
    return replace(reference, point=point, direction=turn @ reference.direction)


@pytest.mark.parametrize("reference", [RAMP, EDGE], ids=lambda r: r.name)
def test_points_follow_the_reference_as_they_say_even_beside_a_line(reference):
    pixels = CAMERA.project(EDGE.point + np.outer([-0.2, 0.1, 0.3], EDGE.direction))
    pixels += [[3.0, -8.0], [40.0, 25.0], [0.0, 0.0]]
    plane = isinstance(reference, ReferencePlane)
    mapped = points_on_plane if plane else points_on_line
    stated = point_derivatives_by_plane if plane else point_derivatives_by_line
    shown = differences(lambda s: mapped(CAMERA, moved(reference, s), pixels), np.zeros(6), 1e-5)
    np.testing.assert_allclose(stated(CAMERA, reference, pixels), shown, atol=1e-8)


@settings(max_examples=40, deadline=None)
@given(u=st.floats(200, 1000), v=st.floats(300, 800))
def test_the_point_of_a_line_is_the_nearest_to_the_ray(u, v):
    """The paper's reference line: nothing else on the line is nearer to the pixel's ray."""
    point = points_on_line(CAMERA, EDGE, [[u, v]])[0]
    origin, rays = CAMERA.rays_world([[u, v]])

    def distance(p):
        return np.linalg.norm(np.cross(p - origin, rays[0]))

    assert distance(point) <= distance(point + 1e-4 * EDGE.direction)
    assert distance(point) <= distance(point - 1e-4 * EDGE.direction)


def test_what_the_reference_adds_is_its_covariance_through_the_derivatives():
    pixels = [[640.0, 480.0], [500.0, 600.0]]
    spread = np.diag([1e-5, 2e-5, 0, 0, 0, 1e-6])
    plain = map_pixels(CAMERA, RAMP, pixels)
    stated = map_pixels(CAMERA, replace(RAMP, covariance=spread), pixels)
    by = point_derivatives_by_plane(CAMERA, RAMP, pixels)
    np.testing.assert_allclose(
        stated.covariances - plain.covariances, by @ spread @ by.transpose(0, 2, 1), atol=1e-15
    )
    assert (stated.sigmas > plain.sigmas).all()


# points of references that were picked through the camera
SEEN = {
    "board": np.array([0.1, 0.15, 0.32]),
    "wall": np.array([-0.3, 0.0, 0.25]),
    "post": np.array([0.3, 0.35, 0.2]),
    "crease": np.array([-0.3, 0.1, 0.44]),
}


def seen_cell(camera=CAMERA, rng=None):
    """The cell with those references, on a floor that is known for certain."""
    sources = {name: SOURCES[name] for name in SEEN}
    for name, (kind, source) in sources.items():
        if rng is not None and name != "crease":
            pixels = source.pixels + rng.normal(0, 1.0, source.pixels.shape)
            sources[name] = (kind, replace(source, pixels=pixels))
    floor = ReferencePlane("floor", [0, 0, 0], [0, 0, 1])
    return resolve_references(referenced_cell(camera, sources, floor))[0]


@cache
def held_95(draws=220):
    """How often stated 95 % ellipsoids hold the truth, by name, over camera and pick noise."""
    rng, held = np.random.default_rng(7), dict.fromkeys(SEEN, 0.0)
    spread = 9 * TWIST_COVARIANCE
    for _ in range(draws):
        twist = rng.multivariate_normal(np.zeros(6), spread)
        camera = CAMERA.placed(POSE.perturbed(twist), spread)
        cell = seen_cell(camera, rng)
        for name, point in SEEN.items():
            pixel = CAMERA.project(point[None]) + rng.normal(0, 1.0, (1, 2))
            mapped = map_pixels(camera, cell.reference(name), pixel)
            off = mapped.points[0] - point
            held[name] += off @ np.linalg.solve(mapped.covariances[0], off) < WITHIN_95
    return {name: count / draws for name, count in held.items()}


@pytest.mark.parametrize("name", SEEN)
def test_95_percent_ellipsoids_hold_95_percent_on_references_picked_through_the_camera(name):
    assert 0.91 <= held_95()[name] <= 0.985


@pytest.mark.parametrize("name", ["board", "wall", "post"])
def test_taken_for_independent_the_same_errors_would_be_misjudged(name):
    """Why what a reference shares with the camera is added before it is squared."""
    reference, pixel = seen_cell().reference(name), CAMERA.project(SEEN[name][None])
    alone = replace(reference, by_camera=np.zeros((6, 6)))
    parts = [map_pixels(CAMERA, r, pixel).covariances[0] for r in (alone, reference)]
    ratios = np.linalg.eigvals(np.linalg.solve(*parts)).real
    assert max(ratios) > 1.5
    assert min(ratios) < 0.5


def test_an_unknown_share_is_bounded_whatever_it_is():
    rng, pixels = np.random.default_rng(3), [[640.0, 480.0]]
    source = SOURCES["lid"][1]
    for _ in range(40):
        by_camera = rng.normal(size=(6, 6))
        by_camera[[2, 3, 4]] = 0
        plane = ReferencePlane(
            "lid",
            [0, 0, 0.2],
            [0, 0, 1],
            covariance=by_camera @ TWIST_COVARIANCE @ by_camera.T,
            by_camera=by_camera,
            source=source,
        )
        known = map_pixels(CAMERA, plane, pixels).covariances[0]
        bound = map_pixels(CAMERA, replace(plane, by_camera=None), pixels).covariances[0]
        assert np.linalg.eigvalsh(bound - known).min() > -1e-12 * np.trace(bound)


@settings(max_examples=50, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), count=st.integers(1, 4))
def test_the_bound_of_a_sum_holds_for_every_correlation_of_its_terms(seed, count):
    rng = np.random.default_rng(seed)
    roots = rng.normal(size=(count, 3, 5)) * 10 ** rng.uniform(-3, 1, (count, 1, 1))
    parts = roots @ roots.transpose(0, 2, 1)
    whole = roots.sum(axis=0)
    gap = bound_of_sum(list(parts)) - whole @ whole.T
    assert np.linalg.eigvalsh(gap).min() > -1e-9 * np.trace(parts.sum(axis=0))


def test_a_remainder_is_what_is_left_and_never_negative():
    one, share = np.diag([4.0, 1e-6, 0.0]), np.diag([1.0, 0.0, 0.0])
    np.testing.assert_allclose(remainder(one, share), np.diag([3.0, 1e-6, 0.0]))
    np.testing.assert_allclose(remainder(share, one), np.zeros((3, 3)), atol=1e-15)


def test_a_pixel_beside_the_line_s_image_is_told_with_its_distance():
    on_it = CAMERA.project(EDGE.point[None])
    across = CAMERA.project((EDGE.point + 0.01 * EDGE.direction)[None]) - on_it
    across = np.array([[-across[0, 1], across[0, 0]]]) / np.linalg.norm(across)
    assert map_pixels(CAMERA, EDGE, on_it).warnings == ()
    (told,) = map_pixels(CAMERA, EDGE, on_it + 25 * across).warnings
    assert told.startswith("pixel 0 lies 2")
    assert "px beside the image of edge" in told


def test_a_ray_nearly_along_the_line_is_told_with_its_angle():
    origin, rays = CAMERA.rays_world([[700.0, 300.0], [720.0, 300.0]])
    away = ReferenceLine("away", origin + 2 * rays[0], rays[1])
    told = map_pixels(CAMERA, away, [[700.0, 300.0]]).warnings
    assert any("pixel 0 looks along away at 1." in line for line in told)
    assert any("its point is known to" in line for line in told)


def test_pixels_outside_the_picture_are_told_and_far_ones_refused():
    level = CAMERA.placed(Pose.looking_at([0, 0, 2.0], [0.5, 0, 0], [0, 0, 1]))
    (told,) = map_pixels(level, RAMP, [[640.0, 970.0]]).warnings
    assert told == "pixel 0 at (640.0, 970.0) lies 10.5 px outside the 1280 x 960 px picture"
    with pytest.raises(PickError, match=r"corner at .* lies more than half a picture outside"):
        map_pixels(level, RAMP, [[640.0, 1970.0]], labels=["corner"])
