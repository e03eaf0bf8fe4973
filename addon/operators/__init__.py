# SPDX-License-Identifier: GPL-3.0-or-later
"""The verbs, one a file: `add_box.py` holds the operator `monocell.add_box`."""

from importlib import import_module

# in the order of the work
VERBS = (
    "open_sample",
    "open_cell",
    "open_gltf",
    "open_picture",
    "estimate_lens",
    "change_camera",
    "drop_picture",
    "look_through",
    "show_picture",
    "find_pictures",
    "add_pictures",
    "paste_sightings",
    "read_sightings",
    "add_sighting",
    "add_point",
    "remove_sighting",
    "drag_window",
    "clear_window",
    "find_all",
    "calibrate",
    "cancel_work",
    "add_box",
    "add_cylinder",
    "add_cone",
    "add_tube",
    "add_sphere",
    "add_prism",
    "pick_reference",
    "add_upright_plane",
    "add_upright_line",
    "add_parallel_plane",
    "remove_reference",
    "move_pick",
    "set_size",
    "add_relation",
    "remove_relation",
    "stand_on",
    "set_motion",
    "solve_again",
    "align",
    "propose",
    "take_colors",
    "take_textures",
    "export_gltf",
    "save_cell",
)


def classes():
    """Every operator, each found in its file by its name."""
    return tuple(_operator(verb) for verb in VERBS)


def _operator(verb):
    held = vars(import_module(f".{verb}", __package__)).values()
    name = f"monocell.{verb}"
    return next(one for one in held if getattr(one, "bl_idname", "") == name)
