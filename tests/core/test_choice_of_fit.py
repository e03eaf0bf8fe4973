# SPDX-License-Identifier: GPL-3.0-or-later
"""What is chosen where picks allow more than one answer, and what is never traded for picks."""

import numpy as np
import pytest
from monocell.core import Camera, Cell, Cylinder, Intrinsics, Pose, ReferencePlane, Relation, Sketch
from monocell.core.modelling.solve import model_cell

FLOOR = ReferencePlane("floor", np.zeros(3), np.array([0.0, 0.0, 1.0]))
CAMERA = Camera(
    Intrinsics(1280, 960, 1180.0, 1177.0, 644.0, 472.0),
    Pose.looking_at([2.2, -1.5, 1.5], [0.1, 0.2, 0.4], [0.0, 0.0, 1.0]),
)
TOWARDS_CAMERA = float(np.arctan2(-1.75, 2.1))


def _rim(can: Cylinder, level: float, turns) -> np.ndarray:
    angles = TOWARDS_CAMERA + np.asarray(turns)
    x, y = can.radius * np.cos(angles), can.radius * np.sin(angles)
    z = np.full_like(x, level * can.height / 2)
    return CAMERA.project(can.world_from_object.apply(np.stack([x, y, z], axis=1)))


def _can(name: str, foot: float, radius: float, height: float) -> Cylinder:
    place = np.array([0.1, 0.25, foot + height / 2])
    return Cylinder(name, Pose(np.eye(3), place), radius=radius, height=height)


@pytest.mark.parametrize("seed", range(8))
def test_no_pick_noise_buys_a_micrometre_off_a_relation(seed):
    rng = np.random.default_rng(seed)
    base, trunk = _can("base", 0.0, 0.17, 0.12), _can("trunk", 0.12, 0.095, 0.46)

    def picks(can):
        arc = np.linspace(-1.3, 1.3, 10)
        roles = {"rim": _rim(can, -1.0, arc), "top": _rim(can, 1.0, 2 * arc)}
        return {role: (p + rng.normal(0, 1, p.shape)).tolist() for role, p in roles.items()}

    held = (Relation("stands_on", "base.top"), Relation("centred_on", "base.axis"))
    sketches = (
        Sketch("base", "cylinder", "floor", picks(base)),
        Sketch("trunk", "cylinder", None, picks(trunk), relations=held),
    )
    solved, _ = model_cell(Cell(CAMERA, references=(FLOOR,), sketches=sketches))
    base, trunk = solved.objects
    gap = trunk.world_from_object.translation - base.world_from_object.translation
    assert np.abs(gap[:2]).max() < 1e-6
    assert abs(gap[2] - (base.height + trunk.height) / 2) < 1e-6


@pytest.mark.parametrize("turn", [-0.3, 0.0, 0.3])
def test_a_single_top_pick_is_taken_for_the_side_that_faces_the_camera(turn):
    can = _can("can", 0.0, 0.1, 0.15)
    picks = {"rim": _rim(can, -1.0, [-1.3, 0.0, 1.3]), "top": _rim(can, 1.0, [turn])}
    sketch = Sketch("can", "cylinder", "floor", picks)
    solved, (modelled,) = model_cell(Cell(CAMERA, references=(FLOOR,), sketches=(sketch,)))
    assert solved.objects[0].height == pytest.approx(0.15, abs=1e-6)
    assert any("fit two cylinders" in warning for warning in modelled.warnings)
