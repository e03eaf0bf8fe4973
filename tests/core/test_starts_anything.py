# SPDX-License-Identifier: GPL-3.0-or-later
"""Whatever is picked and however it is held: an answer with its error, or a refusal in one line."""

from __future__ import annotations

import numpy as np
import pytest
from held_scene import solve, standing
from monocell.core import Pose, Sketch
from monocell.core.errors import MonocellError, PickError
from monocell.core.modelling.starts.roles import ROLES
from monocell.core.primitives import KINDS, Box, Cylinder
from monocell.core.relation import Relation
from picked_scene import FLOOR, camera

TRUNK = Cylinder("trunk", standing(FLOOR, 0.5), radius=0.06, height=0.5)
CRATE = Box("crate", standing(FLOOR, 0.2), size=[0.2, 0.2, 0.2])
HOLDS = (
    ("floor", ()),
    ("crate.top", ()),
    (None, ()),
    (None, (Relation("lies_on", "floor"),)),
    (None, (Relation("leans_on", "wall"),)),
    (None, (Relation("leans_on", "wall", "y+"),)),
    (None, (Relation("touches", "rope"),)),
    (None, (Relation("perpendicular", "trunk.axis"), Relation("centred_on", "trunk.axis"))),
    (None, (Relation("parallel", "rope"), Relation("touches", "floor"))),
    (None, (Relation("centred_on", "crate.centre"),)),
    (None, (Relation("stands_on", "floor", "side1"),)),
    (None, (Relation("stands_on", "floor", "top"),)),
    (None, (Relation("symmetric", "crate", about="wall"),)),
    ("floor", (Relation("same_size", "trunk"),)),
)


def anything(rng):
    """A sketch of random pixels: all over the picture, on a heap, or all on one spot."""
    kind = str(rng.choice(list(ROLES)))
    on, relations = HOLDS[rng.integers(len(HOLDS))]
    spread = ([300.0, 250.0], [60.0, 50.0], [0.01, 0.01])[rng.integers(3)]
    picks = {}
    for role in ROLES[kind]:
        pixels = rng.normal([640.0, 500.0], spread, (rng.integers(0, 5), 2)).tolist()
        hides = kind in ("box", "prism")
        picks[role] = [None if hides and rng.random() < 0.2 else p for p in pixels]
    known = {
        name: float(rng.uniform(0.03, 0.4))
        for name in KINDS[kind].size_names
        if rng.random() < 0.25
    }
    return Sketch("it", kind, on, picks, known, relations=relations)


@pytest.mark.parametrize("seed", range(40))
def test_random_picks_end_in_an_answer_or_in_one_line(seed):
    sketch = anything(np.random.default_rng(seed))
    try:
        found = solve(sketch, {"trunk": TRUNK, "crate": CRATE}).fitted.thing
    except MonocellError as refusal:
        assert str(refusal).startswith("it: ")
        assert "\n" not in str(refusal)
    else:
        assert np.isfinite(found.covariance).all()
        assert (found.sizes[np.array(found.size_names) != "top_radius"] > 0).all()


@pytest.mark.parametrize(
    ("kind", "role"), [("prism", "base"), ("cone", "rim"), ("tube", "rim"), ("cylinder", "rim")]
)
def test_a_pick_above_the_horizon_of_what_it_stands_on_is_refused(kind, role):
    level = camera("none", Pose.looking_at([1.5, 0, 0.5], [0, 0, 0.5], [0, 0, 1]))
    picks = {
        role: [[600.0, 700.0], [700.0, 700.0], [640.0, 458.5], [650.0, 650.0]],
        "top": [[600.0, 600.0], [700.0, 600.0], [650.0, 580.0]],
    }
    if kind == "tube":
        picks["hole"] = [[640.0, 590.0]]
    with pytest.raises(PickError, match=rf"it: {role}\[2\] at .* above the horizon of floor"):
        solve(Sketch("it", kind, "floor", picks), cam=level)
