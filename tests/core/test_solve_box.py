# SPDX-License-Identifier: GPL-3.0-or-later
"""A box projected and picked comes back; noisy picks scatter as stated; bad picks are named."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from monocell.core import Pose, ReferencePlane, Sketch
from monocell.core.errors import PickError
from monocell.core.modelling.solve import solve_sketch
from picked_scene import (
    FLOOR,
    LENSES,
    PLANES,
    POSE,
    TWIST_COVARIANCE,
    box_on,
    box_picks,
    camera,
    deviation,
    noisy,
)


def solve_box(camera, sketch, plane, pick_sigma_pixels=1.0):
    return solve_sketch(camera, sketch, [plane], (), pick_sigma_pixels)


def sketch(picks, known=None, on="floor"):
    return Sketch("block", "box", on, picks, known or {})


@pytest.mark.parametrize("model", LENSES)
@pytest.mark.parametrize("plane", PLANES, ids=lambda p: p.name)
def test_a_box_comes_back_from_its_exact_picks_on_any_plane(model, plane):
    box, cam = box_on(plane), camera(model)
    solved = solve_box(cam, sketch(box_picks(box, cam), on=plane.name), plane)
    np.testing.assert_allclose(deviation(solved.object, box), 0, atol=1e-9)
    assert solved.rms_pixels < 1e-8
    # three corners in order round the base may hold one that the box itself hides
    assert all("hides itself" in warning for warning in solved.warnings)


@settings(max_examples=60, deadline=None)
@given(
    x=st.floats(-0.3, 0.3),
    y=st.floats(-0.3, 0.3),
    yaw=st.floats(-3.1, 3.1),
    size=st.tuples(*[st.floats(0.03, 0.3)] * 3),
    model=st.sampled_from(sorted(LENSES)),
    base=st.sampled_from([3, 4]),
)
def test_any_box_comes_back_from_its_exact_picks(x, y, yaw, size, model, base):
    box, cam = box_on(FLOOR, x, y, yaw, size), camera(model)
    solved = solve_box(cam, sketch(box_picks(box, cam, base, top=(1,))), FLOOR)
    np.testing.assert_allclose(deviation(solved.object, box), 0, atol=1e-9)


def test_corners_picked_clockwise_give_the_same_solid():
    box, cam = box_on(FLOOR), camera()
    picks = box_picks(box, cam, 4, top=(0, 1, 2, 3))
    turned = {role: pixels[::-1] for role, pixels in picks.items()}
    solved = solve_box(cam, sketch(turned), FLOOR).object
    ours = sorted(map(tuple, solved.corners_world().round(8).tolist()))
    assert ours == sorted(map(tuple, box.corners_world().round(8).tolist()))
    assert np.linalg.det(solved.world_from_object.rotation) == pytest.approx(1.0)


def test_the_corner_above_the_unseen_fourth_may_be_picked():
    box, cam = box_on(FLOOR), camera()
    solved = solve_box(cam, sketch(box_picks(box, cam, 3, top=(3,))), FLOOR)
    np.testing.assert_allclose(deviation(solved.object, box), 0, atol=1e-9)


def test_a_known_height_needs_no_top_and_has_no_error():
    box, cam = box_on(FLOOR), camera()
    picks = {"base": box_picks(box, cam)["base"]}
    solved = solve_box(cam, sketch(picks, {"size_z": 0.15}), FLOOR).object
    np.testing.assert_allclose(deviation(solved, box), 0, atol=1e-9)
    assert solved.size_sigma()[2] == 0
    assert (solved.size_sigma()[:2] > 0).all()


def test_three_corners_of_a_parallelogram_give_the_rectangle_nearest_to_them():
    box, cam = box_on(FLOOR), camera()
    picks = box_picks(box, cam)
    picks["base"][0][0] += 6.0
    solved = solve_box(cam, sketch(picks), FLOOR)
    edges = np.diff(solved.object.corners_world()[[0, 1, 3]], axis=0)
    assert edges[0] @ edges[1] == pytest.approx(0, abs=1e-12)
    assert 1.0 < solved.rms_pixels < 6.0
    # no nearby box is nearer to the picks
    pixels = np.array(picks["base"] + [p for p in picks["top"] if p])
    for i in range(3):
        for change in (-1e-4, 1e-4):
            size = solved.object.size + change * np.eye(3)[i]
            other = type(solved.object)("other", solved.object.world_from_object, size=size)
            corners = cam.project(other.corners_world())[[0, 1, 3, 4, 7]]
            worse = np.sum((corners - pixels) ** 2)
            assert worse > np.sum(solved.residual_pixels**2)


def test_the_stated_covariance_matches_many_draws_of_picks_and_pose():
    rng = np.random.default_rng(5)
    box, cam = box_on(FLOOR), camera(covariance=TWIST_COVARIANCE)
    picks = box_picks(box, cam, 3, top=(0, 1, 2))
    stated = solve_box(cam, sketch(picks), FLOOR, 0.5).object.covariance
    draws = []
    for twist in rng.multivariate_normal(np.zeros(6), TWIST_COVARIANCE, 400):
        moved = camera(pose=POSE.perturbed(twist))
        draws.append(deviation(solve_box(moved, sketch(noisy(picks, rng, 0.5)), FLOOR).object, box))
    sample = np.cov(np.array(draws).T)
    scale = np.sqrt(np.diag(stated))
    free = scale > 0
    np.testing.assert_allclose(np.sqrt(np.diag(sample))[free] / scale[free], 1, atol=0.15)
    # heading, centre and sizes go together as stated too
    outer = np.outer(scale[free], scale[free])
    np.testing.assert_allclose(
        sample[np.ix_(free, free)] / outer, stated[np.ix_(free, free)] / outer, atol=0.25
    )
    # the box cannot tilt off its plane
    assert (scale[:2] == 0).all()
    np.testing.assert_allclose(np.diag(sample)[:2], 0, atol=1e-20)


def test_residuals_beyond_the_stated_noise_widen_the_covariance_and_name_the_worst_pick():
    box, cam = box_on(FLOOR), camera()
    picks = box_picks(box, cam, 4, top=(0, 1, 2, 3))
    calm = solve_box(cam, sketch(picks), FLOOR, 1.0)
    picks["base"][2] = np.add(picks["base"][2], [9.0, -7.0]).tolist()
    loud = solve_box(cam, sketch(picks), FLOOR, 1.0)
    assert all("hides itself" in warning for warning in calm.warnings)
    assert any("the worst is block: base[2]" in warning for warning in loud.warnings)
    assert (loud.object.size_sigma() > 1.5 * calm.object.size_sigma()).all()


def test_small_residuals_never_narrow_the_covariance():
    box, cam = box_on(FLOOR), camera()
    picks = box_picks(box, cam, 4, top=(0, 1, 2, 3))
    one = solve_box(cam, sketch(picks), FLOOR, 1.0).object.size_sigma()
    np.testing.assert_allclose(
        solve_box(cam, sketch(picks), FLOOR, 3.0).object.size_sigma(), 3 * one
    )


def _picks(**changes):
    return {**box_picks(box_on(FLOOR), camera()), **changes}


def _base(i, pixel):
    base = list(_picks()["base"])
    base[i] = pixel
    return base


LINE = camera().project([[0.0, 0.0, 0.0], [0.1, 0.1, 0.0], [0.2, 0.2, 0.0]]).tolist()
SQUARE = camera().project([[0, 0, 0], [0.1, 0, 0], [0.1, 0.1, 0], [0, 0.1, 0]]).tolist()
BAD_PICKS = {
    "too many": (_picks(base=[*SQUARE, SQUARE[0]]), r"block: base\[4\] is a fifth corner"),
    "collinear": (_picks(base=LINE), r"base\[0\], base\[1\] and base\[2\] lie on one line"),
    "twice the same": (_picks(base=_base(1, _picks()["base"][0])), r"lie on one line"),
    "crossing": (_picks(base=[SQUARE[i] for i in (0, 2, 1, 3)]), r"block: the base corners cross"),
    "NaN": (_picks(base=_base(1, [float("nan"), 3.0])), r"block: base\[1\]: the number at"),
    "no pair": (
        _picks(base=_base(1, [3.0])),
        r"block: base\[1\]: expected shape \(2\), got \(1,\)",
    ),
    "no numbers": (_picks(base=_base(1, "here")), r"block: base\[1\]: expected numbers"),
    "null in base": (_picks(base=_base(1, None)), r"do not determine size_x, size_y, its turn"),
    "no list": (_picks(base=7), r"block: base: expected a list of pixels"),
    "far outside": (_picks(base=_base(2, [2500.0, 400.0])), r"base\[2\] at \(2500\.0, 400\.0\)"),
    "unknown role": (_picks(bottom=[]), r"'bottom' is none of them"),
    "no height": (_picks(top=[None, None]), r"block: nothing tells its height"),
    "five tops": (_picks(top=[None] * 4 + [[1.0, 2.0]]), r"top\[4\] is a fifth corner"),
    "below the base": (
        _picks(top=[[_picks()["base"][0][0], _picks()["base"][0][1] + 40.0]]),
        r"block: top\[0\] at .* lies [\d.]+ mm below floor",
    ),
}


@pytest.mark.parametrize("case", BAD_PICKS)
def test_bad_picks_are_refused_by_name(case):
    picks, message = BAD_PICKS[case]
    with pytest.raises(PickError, match=message) as refusal:
        solve_box(camera(), sketch(picks), FLOOR)
    assert "\n" not in str(refusal.value)
    assert str(refusal.value).startswith("block: ")


def test_a_corner_above_the_horizon_is_refused_with_object_pick_and_distance():
    level = camera("none", Pose.looking_at([1.5, 0, 0.5], [0, 0, 0.5], [0, 0, 1]))
    picks = {"base": [[600.0, 700.0], [700.0, 700.0], [640.0, 458.5]], "top": [[600.0, 500.0]]}
    words = r"^block: base\[2\] at \(640\.0, 458\.5\) lies 12\.3 px .* above the horizon of floor"
    with pytest.raises(PickError, match=words):
        solve_box(level, sketch(picks), FLOOR)


def test_a_grazing_base_corner_is_warned_of():
    low = camera("none", Pose.looking_at([3.0, 0, 0.08], [0, 0, 0.08], [0, 0, 1]))
    box = box_on(FLOOR, yaw=0.7)
    solved = solve_box(low, sketch(box_picks(box, low)), FLOOR)
    np.testing.assert_allclose(deviation(solved.object, box), 0, atol=1e-8)
    assert any("grazes floor at 1." in warning for warning in solved.warnings)


def test_a_plane_turned_upside_down_puts_the_top_below_it():
    box, cam = box_on(FLOOR), camera()
    under = ReferencePlane("floor", np.zeros(3), np.array([0.0, 0.0, -1.0]))
    with pytest.raises(PickError, match="normal"):
        solve_box(cam, sketch(box_picks(box, cam)), under)
