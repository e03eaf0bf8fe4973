# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from monocell.core.camera import Camera
from monocell.core.distortion import Distortion
from monocell.core.errors import InvalidValue, NoPose
from monocell.core.intrinsics import Intrinsics
from monocell.core.pose import Pose
from monocell.core.primitives import Box, Cone, Cylinder, Prism, Sphere, Tube, polygon_centre
from monocell.core.shape.hits import bounds, face_names, hits, occluded, seen_map

STAR = np.array([[0.3, 0], [0.08, 0.09], [0, 0.3], [-0.2, 0.1], [-0.25, -0.2], [0, -0.05]])
PLACE = Pose.from_rotation_vector([0.4, -0.3, 0.9], [0.2, -0.1, 0.4])
SOLIDS = (
    Box("box", PLACE, size=[0.4, 0.3, 0.5]),
    Cylinder("cylinder", PLACE, radius=0.2, height=0.5),
    Sphere("sphere", PLACE, radius=0.25),
    Cone("pointed", PLACE, radius=0.25, height=0.4),
    Cone("bucket", PLACE, radius=0.1, top_radius=0.25, height=0.4),
    Tube("tube", PLACE, radius=0.25, inner_radius=0.2, height=0.4),
    Prism("star", PLACE, polygon=STAR - polygon_centre(STAR), height=0.3),
)
EACH_SOLID = pytest.mark.parametrize("thing", SOLIDS, ids=lambda thing: thing.name)


def depth_inside(thing, points_world):
    """How deep points lie below each face of a solid, (N, faces): an independent definition."""
    p = thing.world_from_object.inverse().apply(points_world)
    across, z = np.hypot(p[:, 0], p[:, 1]), p[:, 2]
    if isinstance(thing, Sphere):
        return (thing.radius - np.linalg.norm(p, axis=1))[:, None]
    ends = [thing.half_extent[2] + z, thing.half_extent[2] - z]
    if isinstance(thing, Box):
        h = thing.half_extent
        return np.stack([h[0] + p[:, 0], h[0] - p[:, 0], h[1] + p[:, 1], h[1] - p[:, 1], *ends], 1)
    if isinstance(thing, Prism):
        a, b = thing.polygon, np.roll(thing.polygon, -1, axis=0)
        return np.stack([*signed_distances(p[:, :2], a, b), *ends], 1)
    if isinstance(thing, Cone):
        share = z / thing.height + 0.5
        side = thing.radius * (1 - share) + thing.top_radius * share - across
        return np.stack([side, *ends], 1)
    hollow = [across - thing.inner_radius] if isinstance(thing, Tube) else []
    return np.stack([thing.radius - across, *ends, *hollow], 1)


def signed_distances(points, a, b):
    """To each side of a polygon, with the sign of the whole polygon: inside by winding number."""
    to_a, to_b = a[:, None] - points, b[:, None] - points
    turn = np.arctan2(
        to_a[..., 0] * to_b[..., 1] - to_a[..., 1] * to_b[..., 0], (to_a * to_b).sum(-1)
    )
    inside = turn.sum(axis=0) > np.pi
    edge = (b - a)[:, None]
    share = np.clip((-to_a * edge).sum(-1) / (edge**2).sum(-1), 0, 1)
    away = np.linalg.norm(to_a + share[..., None] * edge, axis=-1)
    return np.where(inside, away, -away)


def is_inside(thing, points_world):
    return (depth_inside(thing, points_world) > 0).all(axis=1)


@EACH_SOLID
@settings(max_examples=25, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_a_ray_meets_the_solid_where_it_first_comes_to_its_inside(thing, seed):
    rng = np.random.default_rng(seed)
    origin = PLACE.translation + rng.normal(0, 0.5, 3)
    targets = PLACE.apply(rng.uniform(-0.35, 0.35, (40, 3)))
    rays = targets - origin
    met = hits(thing, origin, rays)
    steps = np.linspace(0, 4, 2001)
    points = origin + rays[:, None] * steps[:, None]
    inside = is_inside(thing, points.reshape(-1, 3)).reshape(len(rays), -1)
    changed = inside != inside[:, :1]
    first = np.where(changed.any(axis=1), steps[changed.argmax(axis=1)], np.inf)
    # no sample lies inside before; what is met earlier is an edge thinner than a step, and is real
    assert (met.depth <= first + 1e-9).all()
    there = np.isfinite(met.depth)
    before, after = (
        is_inside(thing, origin + rays[there] * (met.depth[there, None] + step))
        for step in (-1e-9, 1e-9)
    )
    assert (before != after).all()
    assert (before == inside[there, 0]).all()


@EACH_SOLID
@settings(max_examples=25, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_the_point_that_is_met_lies_on_the_face_that_is_named(thing, seed):
    rng = np.random.default_rng(seed)
    origin = PLACE.translation + rng.normal(0, 0.8, 3)
    rays = PLACE.apply(rng.uniform(-0.3, 0.3, (100, 3))) - origin
    met = hits(thing, origin, rays)
    there = np.isfinite(met.depth)
    assert (met.face[~there] == -1).all()
    points = (origin + rays * np.where(there, met.depth, 0)[:, None])[there]
    deep = depth_inside(thing, points)
    assert deep.shape[1] == len(face_names(thing)) or thing.name == "pointed"
    assert np.abs(deep[np.arange(len(points)), met.face[there]]).max(initial=0.0) < 1e-12


def test_every_face_of_every_solid_can_be_seen():
    rng = np.random.default_rng(1)
    for thing in SOLIDS:
        seen = set()
        for _ in range(30):
            origin = PLACE.translation + 0.7 * rng.normal(0, 1, 3)
            rays = PLACE.apply(rng.uniform(-0.3, 0.3, (200, 3))) - origin
            seen |= {face_names(thing)[i] for i in hits(thing, origin, rays).face if i >= 0}
        assert seen == set(face_names(thing))


def test_one_looks_into_a_tube_and_through_it():
    tube = Tube("tube", Pose.identity(), radius=0.05, inner_radius=0.04, height=0.2)
    down = np.array([[0, 0, -1.0]])
    assert hits(tube, [0.01, 0, 1], down).depth[0] == np.inf
    aslant = hits(tube, [0, 0, 0.2], [[0.04, 0, -0.15]])
    assert face_names(tube)[aslant.face[0]] == "inside"
    assert np.isclose(aslant.depth[0], 1.0)
    on_the_rim = hits(tube, [0.045, 0, 1], down)
    assert face_names(tube)[on_the_rim.face[0]] == "top"
    assert np.isclose(on_the_rim.depth[0], 0.9)


def test_rays_along_the_axis_and_along_the_faces_are_met_exactly():
    cylinder = Cylinder("can", Pose.identity(), radius=0.05, height=0.2)
    assert hits(cylinder, [0.02, 0, 1], [[0, 0, -2.0]]).depth[0] == 0.45
    assert hits(cylinder, [0.06, 0, 1], [[0, 0, -2.0]]).depth[0] == np.inf
    square = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1.0]])
    prism = Prism("prism", Pose.identity(), polygon=square, height=2.0)
    assert hits(prism, [0.5, 0.5, 3], [[0, 0, -1.0]]).depth[0] == 2.0
    assert hits(prism, [1.5, 0.5, 3], [[0, 0, -1.0]]).depth[0] == np.inf
    box = Box("box", Pose.identity(), size=[2, 2, 2])
    # an edge and a corner let nothing through
    assert np.isclose(hits(box, [3, 0, 3], [[-1, 0, -1.0]]).depth[0], 2.0)
    assert np.isclose(hits(box, [3, 3, 3], [[-1, -1, -1.0]]).depth[0], 2.0)
    assert hits(box, [3, 0, 1], [[-1, 0, 0.0]]).depth[0] == 2.0


def test_what_lies_behind_the_eye_and_a_ray_of_nan_meet_nothing():
    for thing in SOLIDS:
        away = PLACE.translation + np.array([2.0, 0, 0])
        rays = np.array([[1.0, 0, 0], [np.nan] * 3])
        assert np.isinf(hits(thing, away, rays).depth).all()


def distorted_camera(width=320, height=240):
    lens = Distortion("plumb_bob", np.array([-0.25, 0.08, 0.001, -0.0007, 0.0]))
    inner = Intrinsics(width, height, 300.0, 298.0, 0.51 * width, 0.48 * height, lens)
    return Camera(inner, Pose.looking_at([1.5, -0.9, 1.2], PLACE.translation, [0, 0, 1]))


def scattered(count, seed):
    rng = np.random.default_rng(seed)
    kinds = [SOLIDS[i % len(SOLIDS)] for i in range(count)]
    return [
        type(thing)(
            f"{thing.name}{i}",
            Pose.from_rotation_vector(rng.normal(0, 1, 3), rng.uniform(-0.6, 0.6, 3)),
            **{
                n: getattr(thing, n)
                for n in ("size", "radius", "inner_radius", "top_radius", "height", "polygon")
                if hasattr(thing, n)
            },
        )
        for i, thing in enumerate(kinds)
    ]


def test_the_map_of_a_picture_is_each_pixel_s_ray_against_each_thing():
    camera, things = distorted_camera(), scattered(9, 4)
    seen = seen_map(things, camera)
    v, u = np.mgrid[:240, :320]
    origin, rays = camera.rays_world(np.stack([u.ravel(), v.ravel()], 1))
    all_hits = [hits(thing, origin, rays) for thing in things]
    depth = np.array([met.depth for met in all_hits])
    nearest = depth.argmin(axis=0)
    there = np.isfinite(depth.min(axis=0))
    assert np.array_equal(seen.owner.ravel(), np.where(there, nearest, -1))
    assert np.array_equal(seen.depth.ravel(), depth.min(axis=0))
    face = np.array([met.face for met in all_hits])[nearest, np.arange(len(nearest))]
    assert np.array_equal(seen.face.ravel(), face)
    assert 0.1 < there.mean() < 0.9


def test_a_window_in_steps_is_a_part_of_the_whole_map():
    camera, things = distorted_camera(), scattered(9, 5)
    whole, part = seen_map(things, camera), seen_map(things, camera, (40, 30, 201, 100), step=3)
    assert np.array_equal(part.owner, whole.owner[30:130:3, 40:241:3])
    assert np.array_equal(part.depth, whole.depth[30:130:3, 40:241:3])


def test_a_thing_round_the_camera_or_half_behind_it_is_seen_all_over():
    camera = distorted_camera()
    room = Box("room", Pose.identity(), size=[8, 8, 8])
    assert (seen_map([room], camera).owner == 0).all()
    assert bounds(room, camera) == (0, 0, 320, 240)


def test_what_is_wholly_behind_the_camera_is_not_looked_at():
    behind = Sphere("behind", Pose(np.eye(3), np.array([4.0, -3, 2.5])), radius=0.1)
    assert bounds(behind, distorted_camera()) == (0, 0, 0, 0)


def test_a_window_outside_the_picture_is_refused_with_its_numbers():
    with pytest.raises(InvalidValue, match=r"\[300, 0, 40, 40\].*320 x 240"):
        seen_map(SOLIDS, distorted_camera(), (300, 0, 40, 40))
    with pytest.raises(NoPose):
        seen_map(SOLIDS, Camera(distorted_camera().intrinsics))


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_a_point_is_hidden_where_another_thing_s_ray_ends_before_it(seed):
    rng = np.random.default_rng(seed)
    things, eye = scattered(8, seed), np.array([2.0, -1.0, 1.5])
    points, owner = rng.uniform(-1, 1, (200, 3)), rng.integers(-1, 8, 200)
    rays = points - eye
    depth = np.array([hits(thing, eye, rays).depth for thing in things])
    depth[owner[owner >= 0], np.flatnonzero(owner >= 0)] = np.inf
    away = (depth - 1) * np.linalg.norm(rays, axis=1)
    expected = (away < -0.01).any(axis=0)
    assert np.array_equal(occluded(things, eye, points, owner, 0.01), expected)


def test_a_thing_does_not_hide_its_own_points_but_its_neighbour_does():
    front = Box("front", Pose(np.eye(3), np.array([1.0, 0, 0])), size=[0.2, 0.2, 0.2])
    rear = Box("rear", Pose.identity(), size=[0.2, 0.2, 0.2])
    corners, eye = rear.corners_world(), [5.0, 0, 0]
    assert not occluded([rear], eye, corners, 0).any()
    assert occluded([rear], eye, corners, -1, 1e-3).sum() == 4
    assert occluded([rear, front], eye, corners, 0).all()
    assert not occluded([rear, front], eye, front.corners_world(), 1).any()
