# SPDX-License-Identifier: GPL-3.0-or-later
"""What is stated of an object whose picks fit another as well: an error that reaches to both."""

from dataclasses import replace

import numpy as np
import pytest
from monocell.core import Box, Cell, Cylinder, Pose, Sketch
from monocell.core.modelling.rivals import doubt
from monocell.core.modelling.solve import model, solve_sketch
from picked_scene import FLOOR, box_on, box_picks, camera, cylinder_on, cylinder_picks, noisy

IN_FRONT, BEHIND = (-0.5, 0.4), (np.pi - 0.3, np.pi + 0.4)


def drum_sketch(top, seed=None, sigma=1.0):
    picks = cylinder_picks(cylinder_on(FLOOR), camera(), rim=(-1.1, 0.0, 1.1), top=top)
    if seed is not None:
        picks = noisy(picks, np.random.default_rng(seed), sigma)
    return Sketch("drum", "cylinder", "floor", picks)


@pytest.mark.parametrize("seed", range(12))
def test_two_noisy_picks_of_the_top_in_front_give_the_true_height(seed):
    drum = solve_sketch(camera(), drum_sketch(IN_FRONT, seed), [FLOOR]).object
    assert abs(drum.height - 0.25) < 0.03


@pytest.mark.parametrize("top", [(0.4,), (np.pi,), IN_FRONT, BEHIND])
def test_where_two_heights_fit_the_stated_error_reaches_to_the_true_one(top):
    solved = solve_sketch(camera(), drum_sketch(top), [FLOOR])
    off, sigma = abs(solved.object.height - 0.25), solved.object.size_sigma()[1]
    assert off <= 2.05 * sigma
    assert sigma > 0.02 or off < 1e-6


def test_picks_in_front_and_at_the_back_leave_no_doubt():
    solved = solve_sketch(camera(), drum_sketch((0.0, np.pi), 3), [FLOOR])
    assert abs(solved.object.height - 0.25) < 0.02
    assert solved.object.size_sigma()[1] < 0.01
    assert solved.warnings == ()


def test_the_warning_names_the_pick_that_settles_it():
    (told, *_) = solve_sketch(camera(), drum_sketch((0.4,)), [FLOOR]).warnings
    assert "reaches to both; add a pick to tell them apart: of the top rim, on its far side" in told


@pytest.mark.parametrize("joint", [False, True])
def test_what_stands_on_a_doubtful_height_is_as_doubtful(joint):
    def top_sigma(top):
        drum = cylinder_on(FLOOR)
        level = replace(FLOOR, name="level", point=np.array([0.0, 0.0, drum.height]))
        block = box_on(level, x=-0.1, y=0.1, size=(0.08, 0.06, 0.1))
        picks = box_picks(block, camera(), base=3, top=(0,))
        on = Sketch("block", "box", "drum.top", picks)
        cell = Cell(camera(), references=(FLOOR,), sketches=(drum_sketch(top), on))
        _, block = model(cell, joint=joint).cell.objects
        return float(np.sqrt(block.covariance[5, 5]))

    assert top_sigma((0.4, 2.8)) < 0.01
    assert top_sigma((0.4,)) > 0.02


def test_without_a_rival_there_is_no_doubt():
    assert doubt(cylinder_on(FLOOR), []) is None


def test_the_way_to_a_rival_leads_there_and_an_unseen_turn_is_none():
    one = cylinder_on(FLOOR)
    spun = Pose.from_rotation_vector([0, 0, 1.0], [0.1, 0.2, 0.2])
    other = Cylinder("drum", spun, radius=0.12, height=0.4)
    (way,) = doubt(one, [(other, 0.0)]).T / np.sqrt(0.5)
    moved = spun.translation - one.world_from_object.translation
    np.testing.assert_allclose(way, [0, 0, 0, *moved, 0.02, 0.15], atol=1e-12)


def test_an_unlikely_rival_stays_within_two_sigma():
    one = Box("b", Pose(np.eye(3), np.zeros(3)), size=np.ones(3))
    far = replace(one, world_from_object=Pose(np.eye(3), np.array([1.0, 0, 0])))
    assert doubt(one, [(far, 8.0)])[3, 0] == pytest.approx(0.5)
    assert doubt(one, [(far, -8.0)])[3, 0] == pytest.approx(np.sqrt(1 / (1 + np.exp(-4))))
