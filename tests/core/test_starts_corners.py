# SPDX-License-Identifier: GPL-3.0-or-later
"""Boxes and prisms come back from any corners that show, however they are held; slips are named."""

from __future__ import annotations

import numpy as np
import pytest
from held_scene import assert_same, corners, sketched, solve, standing, turned
from hypothesis import given, settings
from hypothesis import strategies as st
from monocell.core import Pose, ReferencePlane
from monocell.core.errors import PickError
from monocell.core.modelling.candidates import choose
from monocell.core.primitives import Box, Prism, polygon_centre
from monocell.core.relation import Relation
from picked_scene import FLOOR, RAMP, WALL, camera

ROUND = ("x-y-", "x+y-", "x+y+", "x-y+")
POLYGON = np.array([[-0.1, -0.08], [0.12, -0.06], [0.1, 0.07], [0.0, 0.12], [-0.12, 0.05]])


def box_picks(box, base=range(4), top=range(4), seen_only=False):
    picks = {}
    for role, places in (("base", base), ("top", top)):
        pixels = corners(box, [f"{c}{role}" for c in ROUND], seen_only=seen_only)
        picks[role] = [p if i in places else None for i, p in enumerate(pixels)]
    return picks


def block(plane=FLOOR, yaw=0.3, size=(0.2, 0.1, 0.15)):
    return Box("it", standing(plane, size[2], 0.05, 0.02, yaw), size=np.array(size))


def solved(thing, picks, **held):
    return solve(sketched(thing, picks, **held)).fitted.thing


@pytest.mark.parametrize("plane", [FLOOR, RAMP, WALL], ids=lambda p: p.name)
def test_the_top_and_one_corner_of_the_base_are_enough(plane):
    box = block(plane)
    found = solved(box, box_picks(box, base=(1,)), on=plane.name)
    assert_same(found, box)
    np.testing.assert_allclose(
        found.world_from_object.rotation, box.world_from_object.rotation, atol=1e-6
    )


@settings(max_examples=25, deadline=None)
@given(
    yaw=st.floats(-3.1, 3.1),
    size=st.tuples(*[st.floats(0.05, 0.3)] * 3),
    base=st.sets(st.integers(0, 3), min_size=1, max_size=2),
    top=st.sets(st.integers(0, 3), min_size=3, max_size=4),
)
def test_any_corners_that_suffice_give_the_box_back(yaw, size, base, top):
    box = block(FLOOR, yaw, size)
    assert_same(solved(box, box_picks(box, base, top), on="floor"), box, atol=1e-6)


def test_corners_picked_clockwise_give_the_same_solid():
    box = block()
    picks = {role: pixels[::-1] for role, pixels in box_picks(box, base=(1, 2)).items()}
    found = solved(box, picks, on="floor")
    ours, theirs = (sorted(map(tuple, b.corners_world().round(6).tolist())) for b in (found, box))
    assert ours == theirs


@pytest.mark.parametrize("missing", range(4))
def test_any_one_base_corner_may_be_hidden(missing):
    box = block()
    base = [i for i in range(4) if i != missing]
    assert_same(solved(box, box_picks(box, base, (0,)), on="floor"), box)


def test_a_face_that_leans_on_a_wall_holds_a_box():
    at = turned(standing(WALL, 0.1, 0.05, 0.1), (-np.pi / 2, 0, 0))
    box = Box("it", at, size=np.array([0.2, 0.1, 0.15]))
    picks = box_picks(box, seen_only=True)
    assert_same(solved(box, picks, relations=[Relation("leans_on", "wall", "y+")]), box)


def test_a_floating_box_needs_six_corners_and_one_size():
    box = Box("it", turned(block().world_from_object, (0.3, -0.5, 0.2)), size=[0.2, 0.1, 0.15])
    picks = box_picks(box, seen_only=True)
    assert_same(solved(box, picks, known=("size_x",)), box)
    with pytest.raises(PickError, match="it: nothing tells how large it is: a box that stands"):
        solved(box, picks)


def test_a_box_hangs_by_its_top_from_a_ceiling():
    at = turned(block().world_from_object, (np.pi, 0, 0))
    box = Box("it", at, size=block().size)
    held = [Relation("stands_on", "floor", "top")]
    assert_same(solved(box, box_picks(box, top=(0, 1, 3)), relations=held), box)


@pytest.mark.parametrize("clockwise", [False, True])
def test_one_corner_is_enough_for_the_mirror_image_of_a_solved_box(clockwise):
    box = block()
    sides = np.array([-1.0, 1.0, 1.0])
    middle = WALL.point + 0.3 * WALL.normal
    about = ReferencePlane("middle", middle, WALL.normal)
    mirror = np.eye(3) - 2 * np.outer(about.normal, about.normal)
    rotation = mirror @ box.world_from_object.rotation @ np.diag(sides)
    place = middle + mirror @ (box.world_from_object.translation - middle)
    image = Box("it", Pose(rotation, place), size=box.size)
    first = Box("first", box.world_from_object, size=box.size)
    picks = box_picks(image, base=(), top=(0, 1))
    if clockwise:
        picks = {"base": [], "top": picks["top"][1::-1]}
    sketch = sketched(image, picks, relations=[Relation("symmetric", "first", about="middle")])
    chosen = choose(camera(), sketch, {"middle": about}, {"first": first}, 1.0)
    assert_same(chosen.fitted.thing, image)
    assert chosen.fitted.observed.residuals == pytest.approx(0, abs=1e-6)


def prism(plane=FLOOR, height=0.2):
    polygon = POLYGON - polygon_centre(POLYGON)
    return Prism("it", standing(plane, height, 0.05, 0.0, 0.0), polygon=polygon, height=height)


def prism_picks(thing, seen_only=True):
    return {
        role: corners(thing, [f"{role}{i}" for i in range(5)], seen_only=seen_only)
        for role in ("base", "top")
    }


def test_a_prism_comes_back_from_the_corners_that_show():
    for plane in (FLOOR, RAMP):
        truth = prism(plane)
        picks = prism_picks(truth)
        assert None in picks["base"]
        found = solved(truth, picks, on=plane.name)
        assert_same(found, truth)
        np.testing.assert_allclose(found.polygon, truth.polygon, atol=1e-7)


def test_a_prism_picked_clockwise_keeps_its_shape():
    truth = prism()
    picks = {role: pixels[::-1] for role, pixels in prism_picks(truth).items()}
    found = solved(truth, picks, on="floor")
    ours, theirs = (sorted(map(tuple, p.polygon.round(6))) for p in (found, truth))
    assert ours == theirs


def test_a_prism_lies_on_one_of_its_sides():
    truth = prism()
    out = truth.polygon[1] - truth.polygon[0]
    normal = np.array([out[1], -out[0]]) / np.linalg.norm(out)
    at = standing(FLOOR, 2 * float(truth.polygon[0] @ normal))
    turn = -np.pi / 2 - np.arctan2(normal[1], normal[0])
    lying = turned(turned(at, (np.pi / 2, 0, 0)), (0, 0, turn))
    truth = Prism("it", lying, polygon=truth.polygon, height=truth.height)
    found = solved(
        truth, prism_picks(truth, False), relations=[Relation("stands_on", "floor", "side0")]
    )
    np.testing.assert_allclose(found.height, truth.height, atol=1e-6)
    edges = [np.linalg.norm(np.roll(p.polygon, -1, 0) - p.polygon, axis=1) for p in (found, truth)]
    np.testing.assert_allclose(edges[0], edges[1], atol=1e-6)


CROSSED = {"base": [None] * 4, "top": [box_picks(block())["top"][i] for i in (0, 2, 1, 3)]}
CROSSED["base"][0] = box_picks(block())["base"][0]
UPSIDE = {
    "base": [None, *box_picks(block())["top"][1:2], None, None],
    "top": box_picks(block())["base"],
}
REFUSED = {
    "too few corners": (
        box_picks(block(), (0,), (0,)),
        r"it: 1 base and 1 top picks give 4 equations for the 6 numbers of its .*size_z; pick 1",
    ),
    "a fifth corner": (
        {**box_picks(block()), "base": [*box_picks(block())["base"], [1.0, 2.0]]},
        r"it: base\[4\] is a fifth corner",
    ),
    "the top alone": (box_picks(block(), ()), "it: no corner of its base is picked"),
    "crossing": (CROSSED, "it: the top corners cross; pick them in order round the top"),
    "top below base": (UPSIDE, r"it: the picks fit best with a size_z of -[\d.]+ mm"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_corners_that_make_no_box_are_refused_by_name(case):
    picks, message = REFUSED[case]
    with pytest.raises(PickError, match=message) as refusal:
        solved(block(), picks, on="floor")
    assert "\n" not in str(refusal.value)


PRISM = prism_picks(prism(), False)
REFUSED_PRISMS = {
    "two corners": ({"base": PRISM["base"][:2]}, "it: 2 corners make no prism"),
    "unseen": (
        {"base": [*PRISM["base"][:2], None, *PRISM["base"][3:]]},
        r"it: neither base\[2\] nor top\[2\] is picked",
    ),
    "no height": ({"base": PRISM["base"]}, "it: nothing tells its height"),
    "crossing": (
        {"base": [PRISM["base"][i] for i in (0, 2, 1, 3, 4)], "top": PRISM["top"][:1]},
        "it: the side from corner .* crosses that from",
    ),
    "line": (
        {
            "base": camera().project([[0, 0, 0], [0.1, 0, 0], [0.2, 0, 0]]).tolist(),
            "top": PRISM["top"][:1],
        },
        r"it: base\[0\], base\[1\] and base\[2\] lie on one line",
    ),
}


@pytest.mark.parametrize("case", REFUSED_PRISMS)
def test_corners_that_make_no_prism_are_refused_by_name(case):
    picks, message = REFUSED_PRISMS[case]
    with pytest.raises(PickError, match=message):
        solved(prism(), picks, on="floor")


def test_a_corner_that_the_box_hides_is_warned_of_by_name():
    box = block()
    assert solve(sketched(box, box_picks(box, seen_only=True), on="floor")).warnings == ()
    hidden = [i for i, p in enumerate(box_picks(box, seen_only=True)["base"]) if p is None]
    told = solve(sketched(box, box_picks(box), on="floor")).warnings
    assert f"it: base[{hidden[0]}] lies where the solved box hides itself" in told[0]
