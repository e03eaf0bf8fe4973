# SPDX-License-Identifier: GPL-3.0-or-later
"""How far off an object may be that its source tells the errors of."""

import numpy as np
from drawn_tabletop import TABLE, camera
from monocell.core import Pose
from monocell.core.align.freedom import Freedom
from monocell.core.align.prior import prior_root
from monocell.core.modelling.solid import Solid
from monocell.core.primitives import Cylinder, Tube

PLACE = Pose(np.eye(3), [0.35, 0.0, 0.05])
SOURCE = np.diag([1e-4] * 3 + [4e-6] * 3 + [1e-6, 9e-6, 1e-6])


def sigmas(thing, stated):
    """One sigma (9,) of every motion and size of a standing thing."""
    freedom = Freedom.of(thing, [thing], {"table": TABLE})
    solid = Solid.of(thing)
    basis = freedom.basis(solid)
    root = basis @ prior_root(solid, basis, camera(), 8.0, stated)
    return np.sqrt(np.diag(root @ root.T))


def test_a_bore_that_no_outline_shows_may_be_as_far_off_as_without_a_source():
    tube = Tube("tube", PLACE, radius=0.05, inner_radius=0.03, height=0.1, on="table")
    with_source, without = sigmas(tube, SOURCE), sigmas(tube, None)
    assert np.isfinite(with_source).all()
    np.testing.assert_allclose(with_source[7], without[7], rtol=1e-3)
    assert with_source[6] < without[6]


def test_a_source_is_believed_but_for_a_few_sigmas_and_a_pixel():
    can = Cylinder("can", PLACE, radius=0.05, height=0.1, on="table")
    stated = SOURCE[np.ix_([0, 1, 2, 3, 4, 5, 6, 8], [0, 1, 2, 3, 4, 5, 6, 8])]
    loose, tight = sigmas(can, 100 * stated), sigmas(can, stated)
    free = [3, 4, 6, 7]
    assert (tight[free] < loose[free]).all()
    assert (loose[free] < sigmas(can, None)[free]).all()
