# SPDX-License-Identifier: GPL-3.0-or-later
"""Radius and focal length: refined where they can be told, asked about where nobody wished it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from monocell.core import Distortion
from monocell.core.errors import InvalidValue, NotObservable
from outline_rig import LENS, RADIUS, Errors, rig_of

SHORTER = replace(LENS, fx=LENS.fx / 1.01, fy=LENS.fy / 1.01)
BENT = replace(LENS, distortion=Distortion("plumb_bob", [-0.17, 0.04, 5e-4, -3e-4, 0]))


def suspected(calibration):
    """What is said to be wrong: words that only one thing has."""
    words = {"radius": "radius seems", "focal": "focal length", "lens": "the distortion right"}
    told = " ".join(calibration.warnings)
    return {name for name, word in words.items() if word in told}


@pytest.mark.parametrize("kind", ["known", "flange", "mounted"])
def test_a_focal_length_is_refined_and_its_error_is_in_the_pose(kind):
    rig = rig_of(3, 12, kind, how=Errors(stated_lens=SHORTER))
    calibration = rig.calibrated(refine=("focal",))
    (focal,) = calibration.refined
    assert focal.factor == pytest.approx(1.01, abs=4 * focal.sigma)
    assert focal.sigma < 0.003
    assert calibration.camera.intrinsics.fx == pytest.approx(LENS.fx, rel=4 * focal.sigma)
    assert calibration.camera.intrinsics.fy / calibration.camera.intrinsics.fx == pytest.approx(
        LENS.fy / LENS.fx
    )
    assert rig.errors(calibration)[2] < 5
    known = rig_of(3, 12, kind).calibrated()
    wider = np.diag(calibration.fit.covariance)[3:] > np.diag(known.fit.covariance)[3:]
    assert wider.any()


def test_a_radius_is_refined():
    rig = rig_of(3, 10, how=Errors(stated_radius=1.05 * RADIUS))
    calibration = rig.calibrated(refine=("radius",))
    (radius,) = calibration.refined
    assert 1.05 * RADIUS * radius.factor == pytest.approx(RADIUS, rel=4 * radius.sigma)
    assert rig.errors(calibration)[2] < 5
    assert calibration.fit.unknowns[-1] == "radius"


def test_both_are_refined_at_once():
    how = Errors(stated_radius=1.03 * RADIUS, stated_lens=SHORTER)
    calibration = rig_of(3, 16, how=how).calibrated(refine=("radius", "focal"))
    factors = {refined.name: refined for refined in calibration.refined}
    assert factors["focal"].factor == pytest.approx(1.01, abs=4 * factors["focal"].sigma)
    assert factors["radius"].factor == pytest.approx(1 / 1.03, abs=4 * factors["radius"].sigma)


def test_what_can_not_be_told_is_refused_with_how_well_it_would_be_known():
    far_away = rig_of(1, 4)
    with pytest.raises(NotObservable, match=r"focal length would be known to ± .* % only .*add"):
        far_away.calibrated(refine=("focal",))
    with pytest.raises(InvalidValue, match="state 0 different radii"):
        rig_of(1, 6, points=6).calibrated(refine=("radius",))
    with pytest.raises(InvalidValue, match="refine: 'lens' is none of focal, radius"):
        far_away.calibrated(refine=("lens",))
    with pytest.raises(InvalidValue, match="the baseline pnp refines nothing"):
        far_away.calibrated(method="pnp", refine=("focal",))


def test_good_rigs_are_accused_of_nothing():
    accused = [suspected(rig_of(seed, 4 + seed % 6).calibrated()) for seed in range(24)]
    assert accused == [set()] * 24


@pytest.mark.parametrize(
    ("how", "guilty"),
    [
        (Errors(stated_radius=1.02 * RADIUS), "radius"),
        (Errors(stated_radius=RADIUS / 1.02), "radius"),
        (Errors(stated_lens=SHORTER), "focal"),
        (Errors(stated_lens=BENT), "lens"),
    ],
    ids=["radius too large", "radius too small", "focal length", "distortion"],
)
def test_what_is_stated_wrongly_is_found_out(how, guilty):
    found = [suspected(rig_of(seed, 10, how=how).calibrated()) for seed in range(6)]
    assert sum(guilty in names for names in found) >= 5
    assert sum(names == {guilty} for names in found) >= 4


def test_a_wrong_radius_is_told_with_the_right_one():
    rig = rig_of(2, 10, how=Errors(stated_radius=1.05 * RADIUS))
    calibration = rig.calibrated()
    (told,) = [w for w in calibration.warnings if "radius seems" in w]
    seems, spread = told.split("to be ")[1].split(" mm")[0].split(" ± ")
    assert float(seems) == pytest.approx(1e3 * RADIUS, abs=4 * float(spread))
    assert "not 42" in told
    assert calibration.verdict == "weak"


def test_places_that_are_off_are_told_in_millimetres():
    rig = rig_of(2, 12, how=Errors(robot=1e-3))
    calibration = rig.calibrated()
    assert calibration.fit.place_sigma == pytest.approx(1e-3, rel=0.5)
    assert any("as if each place were off by 1" in w for w in calibration.warnings)
    assert rig.errors(calibration)[2] < 6
