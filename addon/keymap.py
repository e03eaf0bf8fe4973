# SPDX-License-Identifier: GPL-3.0-or-later
"""Keys of the add-on in the 3D view: a table in, entries that a user can change out."""

import bpy

KEYMAP = "Object Mode"
# verb, key, and the keys held with it
ENTRIES = (
    ("monocell.look_through", "NUMPAD_0", {"shift": True, "alt": True}),
    ("monocell.calibrate", "K", {"shift": True, "alt": True}),
    ("monocell.add_box", "B", {"shift": True, "alt": True}),
    ("monocell.add_cylinder", "Y", {"shift": True, "alt": True}),
    ("monocell.pick_reference", "F", {"shift": True, "alt": True}),
    ("monocell.move_pick", "M", {"shift": True, "alt": True}),
    ("monocell.solve_again", "U", {"shift": True, "alt": True}),
)


def register():
    """Add the entries to the add-ons' key configuration; there is none without a window."""
    config = bpy.context.window_manager.keyconfigs.addon
    if config is None:
        return
    keymap = config.keymaps.new(KEYMAP, space_type="EMPTY")
    for verb, key, held in ENTRIES:
        keymap.keymap_items.new(verb, key, "PRESS", **held)


def unregister():
    """Take them away again."""
    config = bpy.context.window_manager.keyconfigs.addon
    keymap = config.keymaps.get(KEYMAP) if config is not None else None
    if keymap is None:
        return
    ours = {verb for verb, *_ in ENTRIES}
    for item in [item for item in keymap.keymap_items if item.idname in ours]:
        keymap.keymap_items.remove(item)
