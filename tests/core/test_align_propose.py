# SPDX-License-Identifier: GPL-3.0-or-later
"""Boxes and cylinders are proposed where the picture shows them, and nowhere else."""

import numpy as np
import pytest
from drawn_tabletop import TABLE, box, camera, can, picture
from monocell.core.align.propose import propose
from monocell.core.errors import PictureError

RED, BLUE = (0.7, 0.12, 0.1), (0.1, 0.2, 0.75)


def test_what_stands_alone_is_proposed_as_what_it_is():
    things = [box(), can()]
    proposals = propose(camera(), picture(things, camera(), [RED, BLUE]), TABLE)
    best = proposals[:2]
    assert [p.thing.name for p in best] == ["proposal 1", "proposal 2"]
    assert all(p.believed for p in best)
    for truth in things:
        near = min(
            best,
            key=lambda p: np.linalg.norm(
                p.thing.world_from_object.translation - truth.world_from_object.translation
            ),
        )
        assert near.thing.kind == truth.kind
        off = near.thing.world_from_object.translation - truth.world_from_object.translation
        assert np.linalg.norm(off) < 2e-3
        np.testing.assert_allclose(np.sort(near.thing.sizes), np.sort(truth.sizes), rtol=0.02)
        assert near.thing.on == "table"


def test_an_empty_table_proposes_nothing():
    assert propose(camera(), picture([], camera(), []), TABLE) == ()


def test_what_is_known_already_is_not_proposed_again():
    things = [box(), can()]
    seen = picture(things, camera(), [RED, BLUE])
    proposals = propose(camera(), seen, TABLE, things)
    assert not any(p.believed for p in proposals)


def test_a_picture_of_another_size_is_refused_here_too():
    seen = picture([], camera(), [])
    with pytest.raises(PictureError, match="400 x 300"):
        propose(camera(), seen[:, :-4], TABLE)
