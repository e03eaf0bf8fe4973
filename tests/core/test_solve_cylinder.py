# SPDX-License-Identifier: GPL-3.0-or-later
"""A cylinder projected and picked comes back, from many picks or few; doubt and slips are named."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from monocell.core import Pose, Sketch
from monocell.core.errors import PickError
from monocell.core.modelling.pick_equations import observe_picks
from monocell.core.modelling.pick_plan import PickPlan
from monocell.core.modelling.solid import Solid
from monocell.core.modelling.solve import solve_sketch
from picked_scene import (
    FLOOR,
    LENSES,
    PLANES,
    POSE,
    TWIST_COVARIANCE,
    camera,
    cylinder_on,
    cylinder_picks,
    deviation,
    limb,
    noisy,
    rim_points,
)

BOTH_SIDES = ((1, -0.5), (-1, 0.2), (1, 0.6))


def solve_cylinder(camera, sketch, plane, pick_sigma_pixels=1.0):
    return solve_sketch(camera, sketch, [plane], (), pick_sigma_pixels)


NAMES = {"rim": ("base rim",), "top": ("top rim",), "sides": ("side-", "side+")}


def observed(picks, cam, solid):
    """What the equations say of picks on a cylinder, role by role."""
    pixels = np.array([pixel for role in NAMES for pixel in picks.get(role, ())])
    on = tuple(NAMES[role] for role in NAMES for _ in picks.get(role, ()))
    return observe_picks({"drum": PickPlan(on_curves=pixels, curves=on)}, {"drum": solid}, cam)[
        "drum"
    ]


def sketch(picks, known=None, on="floor"):
    return Sketch("drum", "cylinder", on, picks, known or {})


def solve(picks, known=None, sigma=1.0, cam=None):
    return solve_cylinder(cam or camera(), sketch(picks, known), FLOOR, sigma)


@pytest.mark.parametrize("model", LENSES)
@pytest.mark.parametrize("plane", PLANES, ids=lambda p: p.name)
def test_a_cylinder_comes_back_from_its_exact_picks_on_any_plane(model, plane):
    drum, cam = cylinder_on(plane), camera(model)
    picks = cylinder_picks(drum, cam, sides=BOTH_SIDES)
    solved = solve_cylinder(cam, sketch(picks, on=plane.name), plane)
    np.testing.assert_allclose(deviation(solved.object, drum), 0, atol=1e-9)
    assert solved.rms_pixels < 1e-8
    assert solved.warnings == ()


@pytest.mark.slow
@settings(max_examples=40, deadline=None)
@given(
    x=st.floats(-0.3, 0.3),
    y=st.floats(-0.3, 0.3),
    radius=st.floats(0.03, 0.2),
    height=st.floats(0.05, 0.5),
    model=st.sampled_from(sorted(LENSES)),
)
def test_any_cylinder_comes_back_from_its_exact_picks(x, y, radius, height, model):
    drum, cam = cylinder_on(FLOOR, x, y, radius, height), camera(model)
    solved = solve(cylinder_picks(drum, cam), cam=cam)
    np.testing.assert_allclose(deviation(solved.object, drum), 0, atol=1e-9)


FEW = {
    "rim and sides, known height": ({"top": (), "rim": (-0.3, 0.4)}, ("height",)),
    "two rim points, both sizes known": (
        {"top": (), "rim": (-0.9, 0.7), "sides": ()},
        ("radius", "height"),
    ),
    "one rim point, three on top": ({"rim": (0.2,), "sides": ()}, ()),
    "top and sides, known height": ({"rim": (), "top": (-1.0, 2.0)}, ("height",)),
    "top and sides, known radius": ({"rim": (), "top": (-1.0, 1.0, 3.0)}, ("radius",)),
    "two rim points, one side, three on top": ({"rim": (-0.3, 0.5), "sides": ((1, 0.1),)}, ()),
}


@pytest.mark.parametrize("case", FEW)
def test_few_picks_are_enough_when_they_are_the_right_ones(case):
    chosen, known = FEW[case]
    drum, cam = cylinder_on(FLOOR), camera()
    picks = cylinder_picks(drum, cam, **{"sides": BOTH_SIDES, **chosen})
    solved = solve(picks, {name: getattr(drum, name) for name in known})
    np.testing.assert_allclose(deviation(solved.object, drum), 0, atol=1e-9)
    assert not any("two cylinders" in warning for warning in solved.warnings)


def test_one_top_pick_fits_two_heights_and_says_so():
    drum, cam = cylinder_on(FLOOR), camera()
    solved = solve(cylinder_picks(drum, cam, top=(0.4,), sides=BOTH_SIDES))
    # the near side is taken, which is where it was picked
    np.testing.assert_allclose(deviation(solved.object, drum), 0, atol=1e-9)
    assert "fit two cylinders" in solved.warnings[0]
    assert "height 250.0 mm (taken)" in solved.warnings[0]


def test_a_second_top_pick_settles_the_height():
    drum, cam = cylinder_on(FLOOR), camera()
    solved = solve(cylinder_picks(drum, cam, top=(0.4, 2.8), sides=BOTH_SIDES))
    np.testing.assert_allclose(deviation(solved.object, drum), 0, atol=1e-9)
    assert solved.warnings == ()


def test_picks_can_only_lie_on_what_is_seen():
    # seen from below its top, a pick of the top rim is on the near side for certain
    low = camera(pose=Pose.looking_at([1.5, -1.0, 0.2], [0, 0, 0.15], [0, 0, 1]))
    drum = cylinder_on(FLOOR)
    facing = [np.arctan2(-1.0 - 0.1, 1.5 + 0.1)]
    points = drum.world_from_object.apply(
        [[0.1 * np.cos(a + d), 0.1 * np.sin(a + d), 0.125] for a in facing for d in (0.3,)]
    )
    rim = drum.world_from_object.apply(
        [[0.1 * np.cos(a + d), 0.1 * np.sin(a + d), -0.125] for a in facing for d in (-1, 0, 1)]
    )
    picks = {"rim": low.project(rim).tolist(), "top": low.project(points).tolist()}
    solved = solve(picks, cam=low)
    np.testing.assert_allclose(deviation(solved.object, drum), 0, atol=1e-8)
    assert not any("two cylinders" in warning for warning in solved.warnings)


@pytest.mark.parametrize("model", LENSES)
def test_the_residuals_are_pixel_distances_to_the_imaged_outline(model):
    drum, cam = cylinder_on(FLOOR), camera(model)
    dense = np.linspace(-np.pi, np.pi, 40_001)
    circles = [cam.project(rim_points(drum, dense, level)) for level in (-1.0, 1.0)]
    picks = noisy(cylinder_picks(drum, cam), np.random.default_rng(2), 3.0)
    equations = observed(picks, cam, Solid.of(drum))
    for curve, pixels, found in (
        (circles[0], picks["rim"], equations.residuals[:4]),
        (circles[1], picks["top"], equations.residuals[4:]),
    ):
        nearest = [np.linalg.norm(curve - pixel, axis=1).min() for pixel in pixels]
        np.testing.assert_allclose(np.abs(found), nearest, atol=1e-3)


@pytest.mark.parametrize("model", LENSES)
def test_the_derivatives_of_the_residuals_match_differences(model):
    drum, cam = cylinder_on(FLOOR), camera(model)
    picks = noisy(cylinder_picks(drum, cam, sides=BOTH_SIDES), np.random.default_rng(2), 2.0)
    at = Solid.of(drum)
    found, step = observed(picks, cam, at), 1e-5
    for i in range(8):
        moved = step * np.eye(8)[i]
        ahead, behind = (observed(picks, cam, at.moved(s)).residuals for s in (moved, -moved))
        np.testing.assert_allclose(found.by_object[:, i], (ahead - behind) / (2 * step), atol=3e-3)
    for i in range(6):
        twist = step * np.eye(6)[i]
        ahead, behind = (
            observed(picks, camera(model, cam.pose.perturbed(t)), at).residuals
            for t in (twist, -twist)
        )
        np.testing.assert_allclose(found.by_camera[:, i], (ahead - behind) / (2 * step), atol=2e-3)


@pytest.mark.slow
def test_the_stated_covariance_matches_many_draws_of_picks_and_pose():
    rng = np.random.default_rng(6)
    drum, cam = cylinder_on(FLOOR), camera(covariance=TWIST_COVARIANCE)
    picks = cylinder_picks(drum, cam, top=(-2.5, -1.0, 0.4, 2.5), sides=BOTH_SIDES)
    stated = solve(picks, sigma=0.5, cam=cam).object.covariance
    draws = []
    for twist in rng.multivariate_normal(np.zeros(6), TWIST_COVARIANCE, 250):
        moved = camera(pose=POSE.perturbed(twist))
        draws.append(deviation(solve(noisy(picks, rng, 0.5), cam=moved).object, drum))
    sample = np.cov(np.array(draws).T)
    scale = np.sqrt(np.diag(stated))
    free = scale > 0
    assert free.tolist() == [False] * 3 + [True] * 5
    np.testing.assert_allclose(np.sqrt(np.diag(sample))[free] / scale[free], 1, atol=0.2)
    outer = np.outer(scale[free], scale[free])
    np.testing.assert_allclose(
        sample[np.ix_(free, free)] / outer, stated[np.ix_(free, free)] / outer, atol=0.3
    )


def test_known_sizes_stay_as_typed_and_have_no_error():
    drum, cam = cylinder_on(FLOOR), camera()
    picks = noisy(cylinder_picks(drum, cam), np.random.default_rng(0), 1.0)
    solved = solve(picks, {"radius": 0.1}).object
    assert solved.radius == 0.1
    assert solved.size_sigma()[0] == 0
    assert solved.size_sigma()[1] > 0


def test_a_slipped_pick_is_named_and_widens_the_covariance():
    drum, cam = cylinder_on(FLOOR), camera()
    picks = cylinder_picks(drum, cam, rim=np.linspace(-1.2, 1.2, 8), sides=BOTH_SIDES)
    calm = solve(picks)
    picks["rim"][3] = np.add(picks["rim"][3], [0.0, 12.0]).tolist()
    loud = solve(picks)
    assert "drum: rim[3]" in loud.warnings[0]
    assert loud.object.size_sigma()[0] > 1.5 * calm.object.size_sigma()[0]


def test_a_weak_size_is_warned_of():
    drum, cam = cylinder_on(FLOOR), camera()
    solved = solve(cylinder_picks(drum, cam, rim=(-0.2, 0.0, 0.2), top=()), {"height": 0.25})
    assert any("drum: radius 100.0 mm is only known to" in warning for warning in solved.warnings)


SCENE = cylinder_on(FLOOR)
GOOD = cylinder_picks(SCENE, camera(), sides=BOTH_SIDES)
BAD_PICKS = {
    "no height": ({"rim": GOOD["rim"]}, {}, "drum: nothing tells its height"),
    "too few": ({"rim": GOOD["rim"][:1], "top": GOOD["top"][:1]}, {}, "pick 2 more"),
    "no scale": (
        {"top": GOOD["top"], "sides": GOOD["sides"]},
        {},
        "drum: the picks do not determine radius, height, its place",
    ),
    "one side alone": (
        {"rim": GOOD["rim"][:1], "sides": [GOOD["sides"][0], GOOD["sides"][2]]},
        {"height": 0.25},
        "drum: the picks do not determine",
    ),
    "unknown role": ({**GOOD, "base": []}, {}, "'base' is none of them"),
    "null": ({**GOOD, "rim": [None]}, {}, r"drum: rim\[0\]"),
    "NaN": ({**GOOD, "sides": [[1.0, float("inf")]]}, {}, r"drum: sides\[0\]"),
    "far outside": ({**GOOD, "top": [[400.0, -900.0]]}, {}, r"drum: top\[0\] at \(400\.0, -900"),
    "upside down": ({"rim": GOOD["top"], "top": GOOD["rim"]}, {}, "drum: .* height"),
}


@pytest.mark.parametrize("case", BAD_PICKS)
def test_bad_picks_are_refused_by_name(case):
    picks, known, message = BAD_PICKS[case]
    with pytest.raises(PickError, match=message) as refusal:
        solve(picks, known)
    assert "\n" not in str(refusal.value)


def test_a_rim_pick_above_the_horizon_is_refused():
    level = camera("none", Pose.looking_at([1.5, 0, 0.5], [0, 0, 0.5], [0, 0, 1]))
    picks = {**GOOD, "rim": [*GOOD["rim"], [640.0, 458.5]]}
    with pytest.raises(PickError, match=r"drum: rim\[4\] .* lies 12\.3 px .* horizon of floor"):
        solve(picks, cam=level)


def test_the_limb_is_where_sight_touches():
    # the test scene's own geometry: at the limb the outward normal is square to the line of sight
    angle = limb(SCENE)
    for side in (-1, 1):
        point = rim_points(SCENE, [side * angle], 0.0)[0]
        outward = (point - SCENE.world_from_object.translation) / SCENE.radius
        assert outward @ (POSE.inverse().translation - point) == pytest.approx(0, abs=1e-12)
