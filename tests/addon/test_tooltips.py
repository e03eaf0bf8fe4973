# SPDX-License-Identifier: GPL-3.0-or-later
"""What a user reads when the mouse rests on a field or a button."""

import re

import pytest

pytestmark = pytest.mark.blender

# words that say what a number counts
UNIT = re.compile(
    r"pixels?\b|degrees|radians|metres|kg|frames|without (a )?unit|letters|number|"
    r"from 0|how many|corners|squares|per pixel",
    re.IGNORECASE,
)
# what Blender itself gives to every group, operator and tool
OF_BLENDER = {"rna_type", "bl_idname", "name"}
# from Blender's own import and export helpers
OF_HELPERS = {"filepath", "check_existing"}


def owners(addon, extension):
    """Every operator, group of properties and the preferences, by name."""
    import bpy

    found = {
        f"monocell.{n}": getattr(bpy.ops.monocell, n).get_rna_type() for n in dir(bpy.ops.monocell)
    }
    scene = addon.context.scene
    for name in ("cell", "inputs", "lens", "object"):
        found[name] = getattr(scene, f"monocell_{name}").bl_rna
    found["work"] = addon.context.window_manager.monocell_work.bl_rna
    for row in ("sightings", "references"):
        found[row] = found["cell"].properties[row].fixed_type
    found["preferences"] = addon.context.preferences.addons[extension].preferences.bl_rna
    return found


def fields(addon, extension):
    """Every property of ours, with its owner's name."""
    for owner, rna in owners(addon, extension).items():
        for name, field in rna.properties.items():
            ours = name not in OF_HELPERS and (name != "name" or owner.startswith("monocell."))
            if ours and name not in OF_BLENDER - {"name"}:
                yield f"{owner}.{name}", field


def test_every_field_and_button_says_what_it_is(addon, extension):
    empty = [name for name, field in fields(addon, extension) if not field.description]
    empty += [name for name, rna in owners(addon, extension).items() if not rna.name]
    assert empty == []


def test_no_tooltip_ends_with_a_full_stop(addon, extension):
    told = {name: field.description for name, field in fields(addon, extension)}
    told |= {name: rna.description for name, rna in owners(addon, extension).items() if "." in name}
    assert [name for name, text in told.items() if text.endswith((".", " "))] == []
    # a tooltip is read in passing
    assert [name for name, text in told.items() if len(text) > 190] == []


def test_every_number_names_its_unit_or_has_one_of_blender_s(addon, extension):
    bare = [
        name
        for name, field in fields(addon, extension)
        if field.type in ("FLOAT", "INT")
        and field.unit == "NONE"
        and field.subtype not in ("COLOR_GAMMA", "FACTOR", "PERCENTAGE")
        and not UNIT.search(field.description)
    ]
    assert bare == []


def test_every_length_names_metres_though_blender_shows_the_scene_s_unit(addon, extension):
    lengths = [
        (n, f) for n, f in fields(addon, extension) if f.type == "FLOAT" and f.unit == "LENGTH"
    ]
    assert len(lengths) > 10
    assert [name for name, field in lengths if "metres" not in field.description] == []


def test_every_choice_says_what_it_means(addon, extension):
    bare = [
        f"{name}.{item.identifier}"
        for name, field in fields(addon, extension)
        if field.type == "ENUM"
        for item in field.enum_items
        if not item.description or item.description.endswith(".")
    ]
    assert bare == []
