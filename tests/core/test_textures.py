# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from monocell.core.camera import Camera
from monocell.core.errors import InvalidValue
from monocell.core.look.sure_pixels import Sight, edge_sigma_pixels
from monocell.core.look.textures import FacePicture, NotSeen, face_picture
from monocell.core.picture.pictures import linear_light
from monocell.core.pose import Pose
from monocell.core.primitives import Box, Tube
from monocell.core.shape.charts import chart_of
from monocell.core.shape.hits import face_names
from painted_cell import BACKGROUND, CAMERA, INNER, ball, crate, drum, face_size, photograph, waves

GREY = np.full(3, 0.5)


def printed(thing, face, st):
    if face == "surface":
        # even all over, the poles included
        return 0.45 + 0.3 * np.sin(9 * chart_of(thing, face).normals(st))
    return waves(st, face_size(thing, face))


@cache
def picture_of(make):
    return photograph([make()], printed)


BLANK = np.zeros((INNER.height, INNER.width, 3), np.uint8)


def texture(things, face, index=0, picture=BLANK, camera=CAMERA, hidden=None):
    sight = Sight.of(things, camera, hidden)
    return face_picture(sight, index, face, linear_light(picture), GREY)


def texels_of(found):
    rows, columns = found.pixels.shape[:2]
    s, t = np.meshgrid((np.arange(columns) + 0.5) / columns, (np.arange(rows) + 0.5) / rows)
    return np.stack([s.ravel(), t.ravel()], axis=1)


def errors(found, thing):
    """Of the seen texels, in linear light: (N, 3)."""
    seen = found.pixels[..., 3].ravel() == 255
    light = linear_light(np.ascontiguousarray(found.pixels[..., :3])).reshape(-1, 3)[:, ::-1]
    return light[seen] - printed(thing, found.face, texels_of(found)[seen])


@pytest.mark.parametrize(
    ("make", "face", "most"),
    [(crate, "top", 0.006), (crate, "x+", 0.006), (crate, "y-", 0.006), (drum, "side", 0.006),
     (drum, "top", 0.006), (ball, "surface", 0.006)],
)  # fmt: skip
def test_a_texture_is_the_print_of_the_face_without_bias(make, face, most):
    thing = make()
    found = texture([thing], face, picture=picture_of(make))
    assert isinstance(found, FacePicture)
    away = errors(found, thing)
    assert np.abs(away).mean() < most
    assert np.abs(away.mean(axis=0)).max() < most / 5
    # half a texel off, the print would differ by more than this
    seen = found.pixels[..., 3].ravel() == 255
    st = texels_of(found)[seen]
    shifted = printed(thing, face, st + 0.5 / np.array(found.pixels.shape[1::-1]))
    assert np.abs(away).mean() < 0.5 * np.abs(shifted - printed(thing, face, st)).mean()


def test_a_texel_is_no_larger_than_a_pixel_where_the_face_is_largest():
    box = crate()
    found = texture([box], "y-")
    rows, columns = found.pixels.shape[:2]
    chart = chart_of(box, "y-")
    st = texels_of(found)
    for step, count in (([1.0 / columns, 0], columns), ([0, 1.0 / rows], rows)):
        ends = [
            CAMERA.project(box.world_from_object.apply(chart.points(st + sign * np.array([step]))))
            for sign in (-0.5, 0.5)
        ]
        pixels = np.linalg.norm(ends[1] - ends[0], axis=1)
        assert pixels.max() <= 1.0 + 1e-3
        assert pixels.max() * count / (count - 1) > 0.99


def test_faces_turned_away_or_hidden_or_aslant_have_none_and_say_why():
    box = crate()
    assert texture([box], "x-").why == "it is turned away from the camera"
    wall = Box("wall", CAMERA.pose.inverse() @ Pose(np.eye(3), np.array([0, 0, 0.3])),
               size=[1, 1, 0.01])  # fmt: skip
    assert "in front" in texture([box, wall], "top").why
    low = Camera(INNER, Pose.looking_at([1.5, 0.0, 0.3], [0.0, 0.0, 0.2], [0, 0, 1]))
    assert "less than 10 degrees" in texture([box], "top", camera=low).why
    away = Camera(INNER, Pose.looking_at([1.5, 0.0, 0.6], [1.5, 3.0, 0.2], [0, 0, 1]))
    assert isinstance(texture([box], "top", camera=away), NotSeen)
    with pytest.raises(InvalidValue, match="no face 'lid'"):
        texture([box], "lid")


def test_what_another_thing_hides_is_marked_and_never_painted_with_it():
    box = crate()
    towards = CAMERA.centre_world - box.world_from_object.translation
    place = box.world_from_object.translation + 0.5 * towards
    post = Box("post", Pose(np.eye(3), place), size=[0.03, 0.03, 0.5])
    green = np.array([0.0, 0.8, 0.0])

    def paint(thing, face, st):
        return np.tile(green, (len(st), 1)) if thing is post else printed(thing, face, st)

    found = texture([box, post], "y-", picture=photograph([box, post], paint))
    alone = texture([box], "y-")
    assert found.seen < alone.seen - 0.05
    light = linear_light(np.ascontiguousarray(found.pixels[..., :3]))[..., ::-1]
    # nowhere, seen or made up, does the post's green show
    assert (light[..., 1] < 3 * light[..., 0] + 0.05).all()
    assert np.abs(errors(found, box)).mean() < 0.006


def test_an_arm_that_is_not_modelled_is_left_out_by_its_mask():
    box = crate()
    picture = picture_of(crate).copy()
    hidden = np.zeros(picture.shape[:2], dtype=bool)
    hidden[:, 255:275] = True
    picture[hidden] = 0
    found = texture([box], "y-", picture=picture, hidden=hidden)
    assert np.abs(errors(found, box)).mean() < 0.006
    assert np.abs(errors(texture([box], "y-", picture=picture), box)).mean() > 0.02
    with pytest.raises(InvalidValue, match="10 x 10 px, the picture 480 x 360"):
        texture([box], "y-", hidden=np.zeros((10, 10), dtype=bool))


def test_the_background_bleeds_into_no_edge():
    box = crate()
    found = texture([box], "top", picture=picture_of(crate))
    light = linear_light(np.ascontiguousarray(found.pixels[..., :3]))[..., ::-1]
    # the background is cyan, and nothing on the box is
    assert BACKGROUND[0] < 0.1
    assert light[..., 0].min() > 0.15
    assert 0.8 < found.seen < 1.0


def test_a_badly_known_box_is_called_seen_only_far_from_its_edges():
    box, sigma = crate(), 0.004
    unsure = replace(box, covariance=np.diag([0, 0, 0, *[sigma**2] * 3, 0, 0, 0.0]))
    expected = (
        sigma
        * np.sqrt(3)
        * INNER.fx
        / np.linalg.norm(CAMERA.centre_world - box.world_from_object.translation)
    )
    assert np.isclose(edge_sigma_pixels(unsure, CAMERA), expected)
    assert edge_sigma_pixels(box, CAMERA) == 0
    assert texture([unsure], "top").seen < texture([box], "top").seen - 0.1


def test_one_sees_the_far_wall_of_a_tube_over_its_near_rim():
    tube = Tube("tube", Pose(np.eye(3), np.array([0, 0, 0.06])), radius=0.14, inner_radius=0.13,
                height=0.12)  # fmt: skip
    found = texture([tube], "inside", picture=photograph([tube], printed))
    assert isinstance(found, FacePicture)
    assert np.abs(errors(found, tube)).mean() < 0.008
    assert "inside" in face_names(tube)
