# SPDX-License-Identifier: GPL-3.0-or-later
"""What each sighting says adds up to what the fit states."""

from __future__ import annotations

import numpy as np
from ball_rig import PLACES, POSE, OutlineNoise, exact_outlines
from monocell.core.calibration.joint_pose import fit_pose


def test_the_sightings_informations_and_the_prior_make_the_covariance():
    observations = exact_outlines(PLACES, OutlineNoise(0.3), np.random.default_rng(3))
    fit = fit_pose(observations, POSE)
    count = len(fit.unknowns)
    assert len(fit.says) == len(PLACES)
    assert all(say.information.shape == (count, count) for say in fit.says)
    information = sum((say.information for say in fit.says), fit.prior_information)
    covariance = np.linalg.inv(information)[:6, :6] * fit.misfit**2
    np.testing.assert_allclose(covariance, fit.covariance, rtol=1e-6)
