# SPDX-License-Identifier: GPL-3.0-or-later
"""Wire-frames lie on the projected object, bend with the lens, and end where the picture ends."""

from __future__ import annotations

import numpy as np
import pytest
from monocell.core import Box, Camera, Cylinder, Distortion, Intrinsics, Pose
from monocell.core.errors import InvalidValue
from monocell.core.picture.wireframe import wireframe
from monocell.core.primitives import Primitive
from picked_scene import FLOOR, LENSES, POSE, WALL, box_on, camera, cylinder_on


def distance_to(pixels, lines):
    """From each pixel to the nearest chord of any line."""
    starts = np.concatenate([line.pixels[:-1] for line in lines])
    ends = np.concatenate([line.pixels[1:] for line in lines])
    along = ends - starts
    lengths = np.maximum((along**2).sum(1), 1e-12)
    t = ((pixels[:, None] - starts) * along).sum(-1) / lengths
    nearest = starts + np.clip(t, 0, 1)[..., None] * along
    return np.linalg.norm(pixels[:, None] - nearest, axis=-1).min(axis=1)


@pytest.mark.parametrize("model", LENSES)
def test_every_edge_of_a_box_is_drawn_where_the_lens_images_it(model):
    box, cam = box_on(FLOOR), camera(model)
    lines = wireframe(box, cam)
    corners = box.corners_world()
    t = np.linspace(0, 1, 301)[:, None]
    for i in range(8):
        for j in (i ^ 1, i ^ 2, i ^ 4):
            edge = cam.project(corners[i] + t * (corners[j] - corners[i]))
            assert distance_to(edge, lines).max() < 0.1


def test_a_box_seen_from_a_corner_hides_the_three_edges_behind():
    box = box_on(FLOOR)
    lines = wireframe(box, camera("none"))
    assert sum(not line.visible for line in lines) == 3
    assert len(lines) == 12
    # they meet in the corner farthest from the camera
    pixels = camera("none").project(box.corners_world())
    eye = POSE.inverse().translation
    farthest = np.argmax(np.linalg.norm(box.corners_world() - eye, axis=1))
    hidden = [line for line in lines if not line.visible]
    for line in hidden:
        ends = line.pixels[[0, -1]]
        assert np.linalg.norm(ends - pixels[farthest], axis=1).min() < 1e-9


def test_a_box_seen_straight_on_hides_all_but_its_front():
    cam = camera("none", Pose.looking_at([2.0, 0, 0], [0, 0, 0], [0, 0, 1]))
    lines = wireframe(Box("b", Pose.identity(), size=[0.2, 0.2, 0.2]), cam)
    assert sum(line.visible for line in lines) == 4


def test_edges_bend_with_the_lens_and_only_with_it():
    box = Box("b", Pose.identity(), size=[1.2, 0.8, 0.1])
    bends = {}
    for model in ("none", "plumb_bob"):
        bends[model] = []
        for line in wireframe(box, camera(model)):
            start, end = line.pixels[[0, -1]]
            along = (end - start) / np.linalg.norm(end - start)
            bends[model].append(np.abs((line.pixels - start) @ [-along[1], along[0]]).max())
    assert max(bends["plumb_bob"]) > 3.0
    assert max(bends["none"]) < 1e-9


@pytest.mark.parametrize("model", LENSES)
@pytest.mark.parametrize("plane", [FLOOR, WALL], ids=lambda p: p.name)
def test_the_outline_of_a_cylinder_is_the_rim_of_all_it_covers(model, plane):
    drum, cam = cylinder_on(plane), camera(model)
    lines = wireframe(drum, cam)
    phi, level = np.meshgrid(np.linspace(0, 2 * np.pi, 721), np.linspace(-1, 1, 41))
    surface = np.stack([0.1 * np.cos(phi), 0.1 * np.sin(phi), 0.125 * level], -1).reshape(-1, 3)
    covered = cam.project(drum.world_from_object.apply(surface))
    outline = np.concatenate([line.pixels for line in lines if line.visible])
    # in every direction the outline reaches exactly as far as the surface does
    for angle in np.linspace(0, 2 * np.pi, 36, endpoint=False):
        out = np.array([np.cos(angle), np.sin(angle)])
        assert (outline @ out).max() == pytest.approx((covered @ out).max(), abs=0.1)


def test_the_hidden_half_of_the_base_rim_is_apart():
    lines = wireframe(cylinder_on(FLOOR), camera("none"))
    # of the base and of the top rim an arc before the side and one beside it, and two sides
    assert len(lines) == 6
    (hidden,) = [line for line in lines if not line.visible]
    inside = [line for line in lines if line.visible and len(line.pixels) > 20]
    # its ends are where the visible arc ends too
    ends = hidden.pixels[[0, -1]]
    assert (
        min(np.linalg.norm(np.sort(ends, 0) - np.sort(line.pixels[[0, -1]], 0)) for line in inside)
        < 1e-6
    )


def test_the_sides_of_a_cylinder_touch_it_without_cutting_in():
    drum, cam = cylinder_on(FLOOR), camera("plumb_bob")
    straight = [line for line in wireframe(drum, cam) if len(line.pixels) < 20]
    assert len(straight) == 2
    origin, _ = cam.rays_world([[0.0, 0.0]])
    axis = drum.world_from_object.rotation[:, 2]
    for line in straight:
        _, rays = cam.rays_world(line.pixels)
        across = np.cross(rays, axis)
        across /= np.linalg.norm(across, axis=1)[:, None]
        gap = np.abs(across @ (drum.world_from_object.translation - origin))
        np.testing.assert_allclose(gap, drum.radius, atol=1e-10)


def test_seen_from_above_a_cylinder_has_no_sides():
    cam = camera("none", Pose.looking_at([-0.1, 0.1, 2.0], [-0.1, 0.1, 0], [0, 1, 0]))
    lines = wireframe(cylinder_on(FLOOR), cam)
    assert [line.visible for line in lines] == [False, True]


def test_what_is_behind_the_camera_is_cut_and_not_drawn():
    long = Box("long", Pose.identity(), size=[8.0, 0.2, 0.2])
    cam = camera("none", Pose.looking_at([1.0, 0.6, 0.5], [0.0, 0.0, 0.0], [0, 0, 1]))
    lines = wireframe(long, cam)
    assert lines
    for line in lines:
        assert np.isfinite(line.pixels).all()
        assert np.abs(line.pixels).max() < 10.5 * 1280
    # the edges along x pass the camera: they are drawn far beyond the picture, not across it
    assert max(np.abs(line.pixels).max() for line in lines) > 5 * 1280


def test_nothing_is_drawn_of_an_object_behind_the_camera():
    behind = Box("behind", Pose(np.eye(3), np.array([2.4, -2.0, 2.2])), size=[0.2, 0.2, 0.2])
    assert wireframe(behind, camera("none")) == ()


def test_lines_end_where_the_lens_ends():
    lens = Distortion("plumb_bob", np.array([-0.5, 0.0, 0.0, 0.0, 0.0]))
    cam = Camera(Intrinsics(1280, 960, 700.0, 700.0, 640.0, 480.0, lens), POSE)
    wide = Box("wide", Pose.identity(), size=[4.0, 3.0, 0.02])
    pixels = np.concatenate([line.pixels for line in wireframe(wide, cam)])
    # the lens folds back at a radius of sqrt(2 / 3), which it images at 2 / 3 of that
    reach = 700.0 * np.sqrt(2 / 3) * 2 / 3
    radii = np.linalg.norm(pixels - [640.0, 480.0], axis=1)
    assert radii.max() == pytest.approx(reach, abs=0.05)


def test_another_kind_of_object_is_refused():
    class Blob(Primitive):
        kind = "blob"
        size_names = ()

    with pytest.raises(InvalidValue, match="a blob has no wire-frame"):
        wireframe(Blob("b", Pose.identity()), camera())


def test_a_lying_cylinder_is_drawn_like_a_standing_one():
    lying = Cylinder(
        "pipe", Pose.from_rotation_vector([0, np.pi / 2, 0], [0, 0, 0.05]), radius=0.05, height=0.3
    )
    assert len(wireframe(lying, camera())) == 6
