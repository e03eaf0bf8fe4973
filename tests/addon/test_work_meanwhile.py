# SPDX-License-Identifier: GPL-3.0-or-later
"""What a user changes while work is done in the background is not overwritten by its result."""

import json
from types import SimpleNamespace

import bench_cell
import pytest

pytestmark = pytest.mark.blender


@pytest.fixture
def work(addon, module, bench):
    """A review of a box whose work is done, its reports kept, and what it would do counted."""
    addon.ops.monocell.open_cell(filepath=str(bench))
    addon.ops.monocell.add_box(picks=json.dumps(bench_cell.box_picks()))
    reviewed = module("addon.review.reviewing").Reviewed
    background = module("addon.background_job").WorksInBackground

    class Work(reviewed, background):
        def __init__(self):
            self.told, self.arrivals = [], 0
            self._job = SimpleNamespace(result=lambda: None, watch=SimpleNamespace(stopped=False))
            self._begun_with = self.state_of(addon.context.scene)

        def report(self, level, text):
            self.told.append(text)

        def arrived(self, context, event, result):
            self.arrivals += 1
            return {"FINISHED"}

    return Work()


def test_the_result_is_taken_when_all_is_as_it_was(addon, work):
    assert work._ended(addon.context, None) == {"FINISHED"}
    assert (work.told, work.arrivals) == ([], 1)


@pytest.mark.parametrize("change", ["moved", "renamed", "deleted"])
def test_an_object_that_changed_meanwhile_stays_as_the_user_left_it(addon, work, change):
    box = addon.context.scene.objects["box"]
    if change == "moved":
        box.location.x += 0.1
    elif change == "renamed":
        box.name = "crate"
    else:
        addon.data.objects.remove(box)
    assert work._ended(addon.context, None) == {"CANCELLED"}
    assert work.told == ["The cell was changed meanwhile: start again for it as it is"]
    assert work.arrivals == 0


def test_an_object_that_was_edited_out_of_its_kind_meanwhile_is_told_in_one_line(addon, work):
    addon.context.scene.objects["box"].scale.x = 0.0
    assert work._ended(addon.context, None) == {"CANCELLED"}
    (told,) = work.told
    assert told.startswith("box: a scale of zero")
