# SPDX-License-Identifier: GPL-3.0-or-later
"""All objects in one least-squares model: exact without noise, honest with it, held as related."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from monocell.core import Box, Cylinder, Pose, Relation, Sphere
from monocell.core.errors import InvalidValue, NotConverged, PickError
from monocell.core.modelling.model_fit import fit_model
from monocell.core.modelling.pick_equations import pick_observer
from monocell.core.modelling.pick_plan import PickPlan
from monocell.core.modelling.solid import Solid
from picked_scene import FLOOR, POSE, TWIST_COVARIANCE, camera, deviation
from planned_picks import BOX_CORNERS, corner_plan, curve_plan

REFERENCES = {"floor": FLOOR}
CRATE = Box(
    "crate",
    Pose.from_rotation_vector([0, 0, 0.3], [0.0, 0.0, 0.06]),
    on="floor",
    size=[0.25, 0.2, 0.12],
)
BLOCK = Box(
    "block",
    Pose.from_rotation_vector([0, 0, -0.4], [0.02, 0.01, 0.16]),
    on="crate.top",
    size=[0.1, 0.07, 0.08],
)
TRUNK = Cylinder("trunk", Pose(np.eye(3), [-0.2, 0.25, 0.15]), on="floor", radius=0.06, height=0.3)
SHOULDER = Cylinder(
    "shoulder",
    Pose.from_rotation_vector([np.pi / 2, 0, 0], [-0.2, 0.25, 0.34]),
    relations=(Relation("perpendicular", "trunk.axis"), Relation("touches", "trunk.top")),
    radius=0.04,
    height=0.2,
)


def nudged(thing, rng, size=0.01):
    """The object a little elsewhere and of a little other size: where a fit may start."""
    step = rng.normal(0, size, 6 + len(thing.parameters))
    for name in thing.known:
        step[6 + thing.size_names.index(name)] = 0.0
    return Solid.of(thing).moved(step).applied(thing)


def seen_corners(thing, count=7):
    eye = POSE.inverse().translation
    away = np.linalg.norm(thing.corners_world() - eye, axis=1)
    order = np.argsort(away)
    return [BOX_CORNERS[i] for i in order[:count]]


def stack_plans(cam, rng=None):
    return {
        "crate": corner_plan(CRATE, cam, seen_corners(CRATE), rng),
        "block": corner_plan(BLOCK, cam, seen_corners(BLOCK), rng),
        "trunk": curve_plan(TRUNK, cam, ["base rim", "top rim", "side-", "side+"], 5, rng),
        "shoulder": curve_plan(SHOULDER, cam, ["base rim", "top rim", "side-", "side+"], 5, rng),
    }


THINGS = (CRATE, BLOCK, TRUNK, SHOULDER)


def solved(cam, plans, start, joint=False, estimate=None):
    return fit_model(
        estimate or cam, REFERENCES, start, pick_observer(plans), list(plans), joint=joint
    )


@pytest.mark.parametrize("joint", [False, True])
@pytest.mark.parametrize("model", ["none", "plumb_bob"])
def test_exact_picks_give_the_exact_objects_back(joint, model):
    cam, rng = camera(model), np.random.default_rng(3)
    start = [nudged(thing, rng) for thing in THINGS]
    fit = solved(cam, stack_plans(cam), start, joint)
    for thing in THINGS:
        away = deviation(fit.objects[thing.name].thing, thing)
        # a cylinder's turn about its own axis is free
        assert np.abs(away[3:]).max() < 1e-7


def test_relations_hold_exactly_whatever_the_picks_say():
    cam, rng = camera(), np.random.default_rng(4)
    fit = solved(cam, stack_plans(cam, rng), THINGS)
    crate, block, trunk, shoulder = (fit.objects[t.name].thing for t in THINGS)
    foot = block.world_from_object.apply([0, 0, -block.size[2] / 2])
    lid = crate.world_from_object.apply([0, 0, crate.size[2] / 2])
    up = crate.world_from_object.rotation[:, 2]
    assert abs((foot - lid) @ up) < 1e-9
    assert block.world_from_object.rotation[:, 2] @ up == pytest.approx(1, abs=1e-12)
    across = shoulder.world_from_object.rotation[:, 2] @ trunk.world_from_object.rotation[:, 2]
    assert abs(across) < 1e-9


@pytest.mark.parametrize("joint", [False, True])
def test_the_truth_lies_in_the_stated_ellipsoid_as_often_as_it_says(joint):
    """With picks and camera off by what they state; the stacked block inherits the crate's."""
    true_camera = camera("plumb_bob", covariance=TWIST_COVARIANCE)
    rng, inside, rounds = np.random.default_rng(5), dict.fromkeys((t.name for t in THINGS), 0), 60
    for _ in range(rounds):
        plans = stack_plans(true_camera, rng)
        twist = rng.multivariate_normal(np.zeros(6), TWIST_COVARIANCE)
        estimate = true_camera.placed(true_camera.pose.perturbed(twist), TWIST_COVARIANCE)
        fit = solved(true_camera, plans, THINGS, joint, estimate)
        for thing in THINGS:
            found = fit.objects[thing.name].thing
            away = deviation(found, thing)[3:]
            covariance = found.covariance[3:, 3:]
            # a size on a plane follows from the place: only independent directions count
            values, vectors = np.linalg.eigh(covariance)
            kept = values > 1e-9 * values.max()
            part = vectors[:, kept].T @ away
            squared = float((part**2 / values[kept]).sum())
            inside[thing.name] += squared < QUANTILE_95[int(kept.sum())]
    for name, count in inside.items():
        assert 0.83 * rounds <= count, name


# chi squared with so many degrees of freedom is below this in 95 %
QUANTILE_95 = {3: 7.81, 4: 9.49, 5: 11.07, 6: 12.59, 7: 14.07, 8: 15.51}


def test_a_typed_size_of_one_object_improves_its_neighbour_when_solved_together():
    cam = camera("plumb_bob", covariance=TWIST_COVARIANCE * 100)
    plans = stack_plans(cam, np.random.default_rng(6))
    known = replace(CRATE, known={"size_x": 0.25, "size_y": 0.2, "size_z": 0.12})
    loose = solved(cam, plans, THINGS, joint=True)
    tight = solved(cam, plans, (known, *THINGS[1:]), joint=True)

    def spread(fit, name):
        return float(np.trace(fit.objects[name].thing.covariance[3:6, 3:6]) ** 0.5)

    assert spread(tight, "trunk") < 0.8 * spread(loose, "trunk")
    assert np.trace(tight.camera.covariance) < np.trace(loose.camera.covariance)


def test_a_ball_of_known_radius_floats_where_its_outline_says():
    cam = camera()
    ball = Sphere("ball", Pose(np.eye(3), [0.1, 0.1, 0.4]), radius=0.05, known={"radius": 0.05})
    plans = {"ball": curve_plan(ball, cam, ["outline"], 8)}
    start = nudged(ball, np.random.default_rng(7), 0.02)
    found = solved(cam, plans, [start]).objects["ball"].thing
    assert np.abs(deviation(found, ball)[3:]).max() < 1e-8


def test_mirror_images_and_equal_sizes_are_kept():
    cam = camera()
    twin = replace(
        CRATE,
        name="twin",
        on=None,
        world_from_object=Pose(CRATE.world_from_object.rotation, [0.01, 0.3, 0.06]),
        relations=(Relation("same_size", "crate"), Relation("stands_on", "floor")),
    )
    rng = np.random.default_rng(8)
    plans = {
        "crate": corner_plan(CRATE, cam, seen_corners(CRATE), rng),
        "twin": corner_plan(twin, cam, seen_corners(twin, 4), rng),
    }
    fit = solved(cam, plans, (CRATE, twin), joint=True)
    np.testing.assert_allclose(
        fit.objects["twin"].thing.sizes, fit.objects["crate"].thing.sizes, atol=1e-9
    )


def test_what_picks_leave_open_is_named():
    cam = camera()
    plan = corner_plan(CRATE, cam, [n for n in BOX_CORNERS if n.endswith("base")][:3])
    with pytest.raises(PickError, match="crate: the picks do not determine size_z"):
        solved(cam, {"crate": plan}, [CRATE])


def test_relations_that_contradict_each_other_are_named():
    cam = camera()
    both = replace(
        TRUNK,
        on=None,
        relations=(Relation("stands_on", "floor"), Relation("stands_on", "crate.x+")),
    )
    plans = {"trunk": stack_plans(cam)["trunk"]}
    with pytest.raises(NotConverged, match=r"trunk: stands_on .* can't be kept together"):
        solved(cam, plans, [CRATE, both])


def test_a_relation_to_nothing_is_named():
    cam = camera()
    lost = replace(TRUNK, on=None, relations=(Relation("stands_on", "shelf"),))
    plans = {"trunk": stack_plans(cam)["trunk"]}
    with pytest.raises(InvalidValue, match="held by 'shelf', which is not there; there is floor"):
        solved(cam, plans, [lost])
    itself = replace(TRUNK, on=None, relations=(Relation("stands_on", "trunk.top"),))
    with pytest.raises(InvalidValue, match="which is itself"):
        solved(cam, plans, [itself])


def test_picks_on_a_curve_that_is_not_seen_refuse_the_fit():
    above = camera("none", Pose.looking_at([-0.2, 0.2499, 2.0], [-0.2, 0.25, 0], [0, 1, 0]))
    plan = PickPlan(on_curves=np.array([[600.0, 400.0]]), curves=(("side-", "side+"),))
    with pytest.raises(PickError, match="trunk: as picked, it can't be seen"):
        solved(above, {"trunk": plan}, [TRUNK])
