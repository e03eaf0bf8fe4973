# SPDX-License-Identifier: GPL-3.0-or-later
"""A thousand random steps, seeded: whatever is done, the document stays valid, and no traceback.

MONOCELL_SEEDS (as 10-20) and MONOCELL_STEPS make the walk another or longer; MONOCELL_REPLAY names
a log, whose steps are done instead.
"""

import os
import shutil
import sys
from itertools import count
from pathlib import Path

import pytest
from random_hand import Hand, Step, read_steps, shortest, walked
from random_picks import KINDS

pytestmark = [pytest.mark.blender, pytest.mark.slow]

FIRST, LAST = map(int, os.environ.get("MONOCELL_SEEDS", "1-5").split("-"))
STEPS = int(os.environ.get("MONOCELL_STEPS", "210"))
REPLAY = os.environ.get("MONOCELL_REPLAY", "")


@pytest.fixture(scope="session")
def painted_bench(bench):
    """The bench, its picture showing solids to be aligned and looked at."""
    sys.path.append(str(Path(__file__).resolve().parents[1] / "real_blender"))
    from model_scene import draw_scene

    # chequered, the floor has a thousand outlines, and proposals take a minute
    draw_scene(bench.parent / "bench.png", chequered=False)
    return bench


@pytest.fixture
def new_hand(addon, module, painted_bench, tmp_path, capfd):
    """A hand in a folder of its own, as often as it is called."""
    numbers = count()

    def told():
        return "".join(capfd.readouterr())

    def made():
        folder = tmp_path / str(next(numbers))
        shutil.copytree(painted_bench.parent, folder / "bench")
        return Hand(addon, module, folder / "bench", folder, told)

    return made


def go(new_hand, steps):
    """Make the steps; a failure tells the fewest that lead there, as a log to be replayed."""
    hand, failure = walked(new_hand, steps)
    if failure is not None:
        fewest = shortest(new_hand, steps[: hand.made], failure)
        log = hand.folder / "fewest.txt"
        log.write_text("".join(f"{step}\n" for step in fewest))
        told = walked(new_hand, fewest)[1] or failure
        pytest.fail(
            f"{log.read_text()}MONOCELL_REPLAY={log} does this again:\n{told}", pytrace=False
        )
    return hand


@pytest.mark.parametrize("seed", range(FIRST, LAST + 1))
def test_whatever_is_done_the_document_stays_valid(new_hand, seed):
    if REPLAY:
        go(new_hand, read_steps(REPLAY))
        return
    hand = go(new_hand, [Step.drawn(seed, i) for i in range(STEPS)])
    # a session that is mostly refused proves little
    assert hand.checked > STEPS / 3
    assert hand.refusals


def test_the_hand_knows_every_operator(module):
    source = "".join(path.read_text() for path in Path(__file__).parent.glob("random_*.py"))
    known = {f"add_{kind}" for kind in KINDS}
    unknown = [
        verb
        for verb in module("addon.operators").VERBS
        if verb not in known and f'"{verb}"' not in source
    ]
    assert not unknown, f"{unknown}: add a move for each to random_verbs.py"
