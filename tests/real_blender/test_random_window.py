# SPDX-License-Identifier: GPL-3.0-or-later
"""A random session by simulated events in a real window: nothing breaks and nothing is left over.

MONOCELL_SEEDS (as 10-20) and MONOCELL_STEPS make it another or longer.
"""

import os

import bench_cell
import pytest
from model_scene import clicks, draw_scene
from monocell.core.document.cell_file import read_cell
from window_run import in_window

pytestmark = [pytest.mark.real_blender, pytest.mark.slow]

FIRST, LAST = map(int, os.environ.get("MONOCELL_SEEDS", "1-1").split("-"))
STEPS = int(os.environ.get("MONOCELL_STEPS", "150"))
# a software driver draws for most of the time, and a smaller window is drawn faster
WINDOW = (1100, 760)


@pytest.fixture(scope="module", params=range(FIRST, LAST + 1))
def session(request, window_blender, tmp_path_factory):
    """The folder, what was found, and the process of one seed's session."""
    folder = tmp_path_factory.mktemp("random")
    document = bench_cell.write_bench(folder)
    # chequered, the floor has a thousand outlines, and proposals take a minute
    draw_scene(folder / "bench.png", chequered=False)
    places, corners = clicks(), bench_cell.BOX.corners_world()[:5]
    job = {
        "document": str(document),
        "pixels": [pixel for pixels in places.values() for pixel in pixels],
        "box": [*places["crate"], places["can"][0]],
        "points": list(
            zip(corners.tolist(), bench_cell.CAMERA.project(corners).tolist(), strict=True)
        ),
        "window": WINDOW,
        "width": bench_cell.INTRINSICS.width,
        "height": bench_cell.INTRINSICS.height,
        "seed": request.param,
        "steps": STEPS,
    }
    return in_window(
        window_blender, folder, "random_steps.py", job, timeout=240 + 2 * STEPS, size=WINDOW
    )


def test_no_step_ends_in_a_traceback(session):
    folder, found, run = session
    last = (folder / "steps.txt").read_text()[-3000:]
    assert "error" not in found, last + found.get("error", "")
    assert "Traceback" not in run.stdout + run.stderr, last + run.stdout + run.stderr


def test_refusals_are_one_line(session):
    _, found, _ = session
    for told in found["refusals"]:
        assert "Traceback" not in told
        if "monocell" in told:
            assert "poll() failed" not in told, told
            assert len(told.strip().splitlines()) == 1, told


def test_nothing_is_left_over_once_all_has_ended(session):
    _, found, _ = session
    for seen in found["checks"]:
        assert not seen["status"], seen
        assert not seen["picking"], seen
        assert seen["title"] == "", seen
        assert seen["handlers"] == 0, seen


def test_the_document_stays_valid_and_is_redone_as_it_was(session):
    folder, found, _ = session
    valid = 0
    for seen in found["checks"]:
        if not seen["document"].endswith(".json"):
            assert seen["redone"] == seen["document"]
            continue
        read_cell(folder / seen["document"])
        assert (folder / seen["redone"]).read_text() == (folder / seen["document"]).read_text()
        valid += 1
    assert valid > len(found["checks"]) / 2


def test_the_hand_comes_to_reviews_cameras_and_scenes(session):
    _, found, _ = session
    if STEPS < 300:
        pytest.skip("too short a walk to come to everything")
    reached = found["reached"]
    for states in (
        ("align taken", "propose taken"),
        ("calibrated",),
        ("another camera", "lens estimated"),
        ("several scenes",),
        ("exported",),
    ):
        assert any(state in reached for state in states), (states, reached)
