# SPDX-License-Identifier: GPL-3.0-or-later
"""What a person knows of the ball ranks what is found, and impossible hints are refused by name."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest
from ball_rig import LENS, PLACES, POSE, QUIET, RADIUS, picture_of
from hypothesis import given, settings
from hypothesis import strategies as st
from monocell.core.ball.change import background_of, changed_mask
from monocell.core.ball.circle_votes import Circle
from monocell.core.ball.color import color_shares
from monocell.core.ball.find import find_sphere, find_spheres
from monocell.core.ball.hints import COLORS, FindHints, color_named
from monocell.core.errors import InvalidValue, PictureError, SphereNotFound
from monocell.core.picture.pictures import encoded_light, linear_light, read_picture
from monocell.core.picture.synthetic import Ball, Photographer, photograph

RED, BLUE = (0.6, 0.05, 0.04), (0.04, 0.1, 0.55)


def centre_of(place):
    return POSE.apply(PLACES[place])


def aside(outline, centre):
    one, other = LENS.project(np.stack([outline.centre_camera, centre]))
    return np.linalg.norm(one - other)


def two_balls(how=QUIET, first=RED, second=BLUE):
    balls = tuple(
        Ball(tuple(centre_of(place)), RADIUS, color) for place, color in ((0, first), (1, second))
    )
    return photograph(LENS, balls, how)


@pytest.mark.parametrize(("name", "place"), [("red", 0), ("blue", 1)])
@pytest.mark.parametrize("light", [(-0.5, -0.8, -0.6), (0.9, 0.3, -0.3)])
def test_the_colour_chooses_among_balls_in_any_light(name, place, light):
    picture = two_balls(replace(QUIET, light=light, background=(0.02, 0.5)))
    hints = FindHints(color=color_named([name]))
    best = find_spheres(picture, LENS, RADIUS, hints=hints)[0]
    assert aside(best, centre_of(place)) < 0.3
    assert best.warnings == ()


def test_a_ball_of_another_colour_is_found_still_with_a_warning():
    picture = picture_of(PLACES[2], QUIET)
    outline = find_sphere(picture, LENS, RADIUS, hints=FindHints(color=COLORS["blue"]))
    assert aside(outline, centre_of(2)) < 0.3
    assert any("of its inside has the colour given" in told for told in outline.warnings)


@pytest.mark.parametrize(
    ("name", "color"),
    [
        ("white", (0.85, 0.85, 0.85)),
        ("black", (0.015, 0.015, 0.015)),
        ("orange", (0.75, 0.2, 0.02)),
        ("yellow", (0.8, 0.65, 0.05)),
        ("green", (0.05, 0.4, 0.08)),
    ],
)
def test_every_colour_is_known_again_on_a_shaded_ball(name, color):
    picture = picture_with(color)
    u, v = LENS.project(centre_of(0)[None])[0]
    circle = Circle(u, v, LENS.fx * RADIUS / centre_of(0)[2], 0.0)
    shares = {other: color_shares(picture, [circle], COLORS[other])[0] for other in COLORS}
    assert shares[name] > 0.6
    apart = {"white": "black", "black": "white"}.get(name, "blue")
    assert shares[apart] < 0.3


def picture_with(color):
    return photograph(LENS, (Ball(tuple(centre_of(0)), RADIUS, color),), QUIET)


@pytest.mark.parametrize("factor", [0.7, 1.0, 1.4])
def test_a_rough_radius_may_be_off_by_half_but_not_by_three(factor):
    size = LENS.fx * RADIUS / centre_of(3)[2]
    picture = picture_of(PLACES[3], QUIET)
    found = find_sphere(picture, LENS, RADIUS, hints=FindHints(rough_radius_pixels=factor * size))
    assert aside(found, centre_of(3)) < 0.3
    with pytest.raises(SphereNotFound):
        find_sphere(picture, LENS, RADIUS, hints=FindHints(rough_radius_pixels=3 * factor * size))


@pytest.mark.parametrize("gain", [0.6, 1.0, 1.3])
def test_what_changed_tells_the_ball_from_one_that_stays(gain):
    stays = Ball(tuple(centre_of(3)), RADIUS)
    comes = Ball(tuple(centre_of(4)), RADIUS)
    wall = replace(QUIET, texture=0.15, seed=4)
    light = gain * linear_light(photograph(LENS, (stays,), wall))
    before = encoded_light(np.rint(np.clip(light, 0, 1) * 65535).astype(np.uint16))
    now = photograph(LENS, (stays, comes), wall)
    assert aside(find_sphere(now, LENS, RADIUS), centre_of(3)) < 0.3
    found = find_sphere(now, LENS, RADIUS, hints=FindHints(background=before))
    assert aside(found, centre_of(4)) < 0.3
    assert found.warnings == ()


def test_the_median_of_pictures_is_their_background_though_the_ball_is_in_all():
    pictures = [picture_of(place, replace(QUIET, texture=0.1, seed=7)) for place in PLACES]
    empty = photograph(LENS, (), replace(QUIET, texture=0.1, seed=7))
    difference = background_of(pictures).astype(float) - empty
    assert np.abs(difference).max() < 8
    changed = changed_mask(pictures[0], background_of(pictures))
    u, v = LENS.project(centre_of(0)[None])[0]
    assert changed[round(v / 2), round(u / 2)]
    assert changed.mean() < 0.03


def test_a_background_that_tells_nothing_is_refused():
    picture = picture_of(PLACES[0], QUIET)
    with pytest.raises(InvalidValue, match="does not differ from it"):
        find_sphere(picture, LENS, RADIUS, hints=FindHints(background=picture))
    with pytest.raises(PictureError, match="the background is 100 x 90 px, the picture 480 x 360"):
        changed_mask(picture, np.zeros((90, 100, 3), np.uint8))
    moved = cv2.flip(photograph(LENS, (), Photographer(texture=0.9)), 1)
    with pytest.raises(InvalidValue, match="did the camera move"):
        changed_mask(photograph(LENS, (), Photographer(texture=0.9, seed=3)), moved)
    with pytest.raises(PictureError, match="two or more pictures of one size, got 1"):
        background_of([picture])


@pytest.mark.parametrize(
    ("hints", "told"),
    [
        ({"rough_radius_pixels": 0}, "rough_radius_pixels: must be above zero"),
        ({"rough_radius_pixels": 3.5}, "3.5 px is too small"),
        ({"rough_radius_pixels": np.nan}, "must be finite"),
        ({"color": (0, 0, 256)}, "color: 0 0 256 is none"),
        ({"color": (0, 0)}, "color: expected shape"),
    ],
)
def test_impossible_hints_are_refused(hints, told):
    with pytest.raises(InvalidValue, match=told):
        FindHints(**hints)


def test_an_unknown_colour_s_refusal_lists_the_known_ones():
    with pytest.raises(InvalidValue, match=r"'mauve' is unknown.*orange"):
        color_named(["mauve"])
    assert color_named(["12", "13", "14"]) == (12, 13, 14)


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
def test_encoding_linear_light_is_undone_by_decoding(dtype):
    top = np.iinfo(dtype).max
    light = np.arange(0, top + 1, max(1, top // 5000)).astype(dtype).reshape(1, -1, 1)
    np.testing.assert_allclose(linear_light(encoded_light(light)), light / top, atol=2e-5)


def test_a_raw_picture_gives_the_ball_that_its_encoded_one_gives(tmp_path):
    picture = picture_of(PLACES[1], replace(QUIET, noise_grey_levels=0.5))
    raw = np.rint(linear_light(picture) * 0.2 * 65535).astype(np.uint16)
    cv2.imwrite(str(tmp_path / "raw.png"), raw)
    read = read_picture(tmp_path / "raw.png", LENS, linear=True)
    outline = find_sphere(read, LENS, RADIUS)
    assert aside(outline, centre_of(1)) < 0.2
    assert np.linalg.norm(outline.centre_camera) == pytest.approx(
        np.linalg.norm(centre_of(1)), rel=0.006
    )


def test_as_many_balls_as_are_there_are_listed():
    balls = tuple(Ball(tuple(POSE.apply(place)), RADIUS) for place in PLACES)
    picture = photograph(LENS, balls, QUIET)
    found = find_spheres(picture, LENS, RADIUS, most=10)
    assert len(found) == len(PLACES)
    for place in range(len(PLACES)):
        assert any(aside(outline, centre_of(place)) < 0.3 for outline in found)


@settings(max_examples=25, deadline=None)
@given(st.floats(0.85, 0.94), st.floats(0, np.pi), st.integers(0, 1000))
def test_a_disc_seen_aslant_is_never_a_ball_without_a_warning(ratio, turn, seed):
    picture = photograph(LENS, (), replace(QUIET, seed=seed))
    axes = ((16 * 40), int(16 * 40 * ratio))
    cv2.ellipse(
        picture,
        (16 * 240, 16 * 180),
        axes,
        np.degrees(turn),
        0,
        360,
        (40, 160, 220),
        -1,
        cv2.LINE_AA,
        4,
    )
    try:
        outline = find_sphere(cv2.GaussianBlur(picture, (0, 0), 0.6), LENS, RADIUS)
    except SphereNotFound:
        return
    assert outline.warnings != ()
