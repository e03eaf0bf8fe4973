# SPDX-License-Identifier: GPL-3.0-or-later
from pathlib import Path

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from monocell.core.document.cell_file import read_cell
from monocell.core.errors import InvalidValue
from monocell.core.picture.pictures import read_picture
from monocell.core.picture.snapping import snapped

STACK = Path(__file__).resolve().parents[2] / "samples" / "03_stack"
FINE = 8
SIZE = 72
DARK, MIDDLE, BRIGHT = 0.08, 0.35, 0.7


def photographed(light, noise=0.0, seed=1):
    """Light on a fine grid to an encoded picture of 8 bits: area means, a lens's blur, noise."""
    coarse = light.reshape(SIZE, FINE, SIZE, FINE).mean(axis=(1, 3))
    blurred = cv2.GaussianBlur(coarse, (0, 0), 0.7)
    encoded = 255 * np.where(
        blurred <= 0.0031308, 12.92 * blurred, 1.055 * blurred ** (1 / 2.4) - 0.055
    )
    encoded = encoded + np.random.default_rng(seed).normal(0, noise, encoded.shape)
    return np.repeat(np.clip(np.round(encoded), 0, 255).astype(np.uint8)[:, :, None], 3, axis=2)


def grid():
    """Pixel coordinates of the fine grid's points."""
    v, u = (np.mgrid[: SIZE * FINE, : SIZE * FINE] + 0.5) / FINE - 0.5
    return u, v


def wedge(corner, start, opening, noise=0.0):
    """A dark corner of `opening` radians on bright ground, its first side at angle `start`."""
    u, v = grid()
    angle = np.mod(np.arctan2(v - corner[1], u - corner[0]) - start, 2 * np.pi)
    return photographed(np.where(angle < opening, DARK, BRIGHT), noise)


def box_corner(corner, start, noise=0.0):
    """Where three faces of a box meet, each with its own light."""
    u, v = grid()
    angle = np.mod(np.arctan2(v - corner[1], u - corner[0]) - start, 2 * np.pi)
    return photographed(np.choose((angle // 2.0944).astype(int), [DARK, MIDDLE, BRIGHT]), noise)


def half_plane(point, angle, noise=0.0):
    u, v = grid()
    side = (u - point[0]) * np.cos(angle) + (v - point[1]) * np.sin(angle)
    return photographed(np.where(side > 0, BRIGHT, DARK), noise)


@settings(max_examples=15, deadline=None)
@given(st.floats(-0.5, 0.5), st.floats(-0.5, 0.5), st.floats(0, 6.28), st.floats(1.3, 2.1))
def test_a_corner_is_found_to_a_fraction_of_a_pixel(du, dv, start, opening):
    corner = np.array([35 + du, 36 + dv])
    found = snapped(wedge(corner, start, opening), corner + np.array([2.5, -3.0]), 8.0)
    assert found.kind == "corner"
    # a sharper corner is rounded more by the lens
    assert np.linalg.norm(found.pixel - corner) < 0.35


@settings(max_examples=12, deadline=None)
@given(st.floats(-0.5, 0.5), st.floats(-0.5, 0.5), st.floats(0, 6.28))
def test_a_corner_of_three_faces_is_found_in_noise(du, dv, start):
    corner = np.array([36 + du, 35 + dv])
    found = snapped(box_corner(corner, start, noise=2.0), corner + np.array([-3.0, 2.0]), 8.0)
    assert found.kind == "corner"
    assert np.linalg.norm(found.pixel - corner) < 0.4


@settings(max_examples=15, deadline=None)
@given(st.floats(-0.5, 0.5), st.floats(0, 6.28), st.floats(-5, 5))
def test_an_edge_is_found_on_its_line_where_blur_does_not_move_it(offset, angle, along):
    point = np.array([36 + offset, 36.0])
    normal = np.array([np.cos(angle), np.sin(angle)])
    click = point + 3.0 * normal + along * np.array([-normal[1], normal[0]])
    found = snapped(half_plane(point, angle), click, 8.0)
    assert found.kind == "edge"
    assert abs((found.pixel - point) @ normal) < 0.06
    # straight on from the click
    assert abs((found.pixel - click) @ [-normal[1], normal[0]]) < 0.6


def shadowed_foot(corner, apart):
    """A dark corner on bright ground, and a shadow's edge that passes it `apart` pixels off."""
    u, v = grid()
    angle = np.mod(np.arctan2(v - corner[1], u - corner[0]) - 0.4, 2 * np.pi)
    ground = np.where(v - corner[1] + 0.3 * (u - corner[0]) > apart, MIDDLE, BRIGHT)
    return photographed(np.where(angle < 1.4, DARK, ground), 1.0)


@pytest.mark.parametrize("apart", [-5.0, -4.0, -3.0, 3.0, 4.0, 5.0])
@pytest.mark.parametrize("seed", range(4))
def test_beside_a_shadow_s_edge_a_pick_is_not_taken_away_from_its_corner(apart, seed):
    corner = np.array([36.2, 35.7])
    click = corner + np.random.default_rng(seed).normal(0, 0.7, 2)
    found = snapped(shadowed_foot(corner, apart), click, 4.0)
    assert found is None or np.linalg.norm(found.pixel - corner) < 1.5


def test_the_carton_s_foot_of_the_sample_is_not_snapped_into_its_shadow():
    cell = read_cell(STACK / "truth.cell.json")
    (carton,) = [thing for thing in cell.objects if thing.name == "carton"]
    picture = read_picture(STACK / "cell.jpg")
    foot = carton.corners_world()[:4]
    away = np.linalg.norm(foot - cell.camera.centre_world, axis=1)
    # the farthest is behind the carton
    for corner in cell.camera.project(foot[np.argsort(away)[:3]]):
        found = snapped(picture, corner, 4.0)
        assert found is None or np.linalg.norm(found.pixel - corner) < 1.2


def test_beyond_the_radius_nothing_is_found():
    picture = wedge((36, 36), 0.3, 1.6)
    assert snapped(picture, np.array([36.0, 15.0]), 6.0) is None
    # the corner is out of reach, its side is not
    on_side = np.array([36.0, 36.0]) + 14 * np.array([np.cos(0.3), np.sin(0.3)])
    assert snapped(picture, on_side, 5.0).kind == "edge"


@pytest.mark.parametrize("noise", [0.0, 2.0, 6.0])
@pytest.mark.parametrize("seed", range(5))
def test_nothing_is_found_on_a_plain_wall(noise, seed):
    wall = photographed(np.full((SIZE * FINE, SIZE * FINE), MIDDLE), noise, seed)
    assert snapped(wall, np.array([36.0, 36.0]), 10.0) is None


def test_a_shaded_wall_has_no_edge():
    u, _ = grid()
    assert snapped(photographed(0.2 + 0.006 * u, 1.0), np.array([36.0, 36.0]), 10.0) is None


def test_the_grain_of_wood_is_no_edge():
    u, v = grid()
    wood = 0.4 + 0.02 * np.sign(np.sin(0.5 * u + 0.9 * v))
    assert snapped(photographed(wood, 1.0), np.array([36.0, 36.0]), 10.0) is None


def test_at_the_picture_s_rim_and_beside_it_nothing_breaks():
    picture = wedge((3, 4), 0.2, 1.5)
    assert np.linalg.norm(snapped(picture, np.array([4.0, 5.0]), 8.0).pixel - [3, 4]) < 1.0
    assert snapped(picture, np.array([-40.0, 10.0]), 8.0) is None
    assert snapped(picture, np.array([np.nan, 10.0]), 8.0) is None


def test_sixteen_bits_give_what_eight_bits_give():
    picture = wedge((36.2, 35.7), 0.4, 1.6)
    one = snapped(picture, np.array([38.0, 33.0]), 8.0)
    other = snapped(picture.astype(np.uint16) * 257, np.array([38.0, 33.0]), 8.0)
    assert other.pixel == pytest.approx(one.pixel, abs=0.01)


def test_a_radius_must_be_one():
    with pytest.raises(InvalidValue, match="snapping radius"):
        snapped(wedge((36, 36), 0, 1.5), np.array([36.0, 36.0]), 0.0)
