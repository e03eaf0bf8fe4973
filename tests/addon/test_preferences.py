# SPDX-License-Identifier: GPL-3.0-or-later
import pytest
from monocell.addon.lengths import length, lengths

pytestmark = pytest.mark.blender


def test_lengths_are_told_in_the_unit_of_choice():
    assert length(0.1234, "mm", 0.0012) == "123.4 ± 1.2 mm"
    assert length(0.1234, "m") == "0.1234 m"
    assert length(0.0254, "in") == "1.000 in"
    assert lengths([0.1, -0.00001], "mm") == "100.0  0.0 mm"


def test_the_preferences_are_those_of_the_extension(addon, module, extension):
    preferences, settings = module("addon.preferences"), module("addon.settings")
    given = addon.context.preferences.addons[extension].preferences
    before = preferences.settings(addon.context)
    given.unit, given.snap, given.line_width = "in", False, 2.5
    given.object_color = (1, 0, 0, 1)
    now = preferences.settings(addon.context)
    for name in ("unit", "snap", "line_width", "object_color"):
        given.property_unset(name)
    assert (now.unit, now.snap, now.line_width) == ("in", False, 2.5)
    assert now.object_color == (1, 0, 0, 1)
    # what was drawn with other settings is not taken for the same
    assert now != before and preferences.settings(addon.context) == before
    for name in ("unit", "snap", "loupe_zoom"):
        assert getattr(before, name) == getattr(settings.DEFAULTS, name)


def test_every_setting_and_input_says_what_it_is(addon, extension):
    given = addon.context.preferences.addons[extension].preferences
    for group in (given, addon.context.scene.monocell_inputs):
        for name, kind in group.bl_rna.properties.items():
            if name not in ("rna_type", "bl_idname", "name"):
                assert kind.description, name


def test_the_keys_belong_to_verbs_that_are_there(module):
    keymap, operators = module("addon.keymap"), module("addon.operators")
    assert {verb for verb, *_ in keymap.ENTRIES} <= {f"monocell.{v}" for v in operators.VERBS}
    keys = [(key, tuple(held)) for _, key, held in keymap.ENTRIES]
    assert len(set(keys)) == len(keys)


def test_captions_labels_and_places_are_told_in_the_user_s_unit(tmp_path):
    from dataclasses import replace

    import bench_cell
    import numpy as np
    from monocell.addon.picking.pick_plans import plan_of
    from monocell.addon.picking.pick_session import PickSession
    from monocell.core.length_unit import UNITS
    from monocell.core.picture.overlay import caption

    assert caption(bench_cell.BOX, UNITS["in"]) == "7.874 × 5.512 × 4.724 in"
    known = replace(bench_cell.BOX, covariance=np.diag([0.0] * 6 + [1e-6] * 3))
    assert caption(known, UNITS["cm"]) == "20.00 ± 0.10 × 14.00 ± 0.10 × 12.00 ± 0.10 cm"
    session = PickSession(
        plan_of("box", "STANDING"), bench_cell.CAMERA, bench_cell.FLOOR, unit="in"
    )
    place = session.place(bench_cell.CAMERA.project(np.zeros((1, 3)))[0])
    assert place.startswith("x 0.00   y 0.00   z 0.00 in   ± ")
    assert place.endswith(" in")
