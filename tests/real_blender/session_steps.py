# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender with a window: a whole session, from the sample to an exported cell."""

import json
import sys
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).parent))
from window_driver import PAUSE, click, found, handlers, in_view, job, move, out, run, shot
from window_user import (
    clicked,
    framed,
    held,
    kept,
    large_view,
    made_active,
    renamed,
    reviewed,
    scrolled,
    stored,
    typed,
    worked,
)


def steps():
    """The four steps, from top to bottom."""
    yield from camera_found()
    yield from carton_drawn()
    yield from can_put_on_it()
    yield from block_drawn()
    yield from block_undone_and_redone()
    yield from all_aligned()
    yield from all_textured()
    yield from exported()


def camera_found():
    """The sample opened and calibrated."""
    yield from large_view()
    in_view(bpy.ops.monocell.open_sample, "EXEC_DEFAULT", True)
    yield from shot("1_sample")
    in_view(bpy.ops.monocell.calibrate, "INVOKE_DEFAULT")
    yield from worked()
    yield from shot("2_calibrated")
    found["verdict"] = json.loads(stored().report)["verdict"]


def carton_drawn():
    """A box by three corners of its foot and one of its top."""
    yield from begun(bpy.ops.monocell.add_box, job["carton"]["base"][1])
    first, *others = job["carton"]["base"]
    # Ctrl: in the carton's own shadow another corner is near
    yield from click(first, ctrl=True)
    yield from clicked(others)
    move(job["carton"]["top"])
    yield from shot("3_carton")
    yield from click(job["carton"]["top"])
    yield from ended("carton")


def can_put_on_it():
    """The top of the carton clicked, and a cylinder drawn on it."""
    in_view(bpy.ops.monocell.pick_reference, "INVOKE_DEFAULT")
    yield PAUSE
    move(job["carton_top"])
    yield from shot("4_face")
    yield from click(job["carton_top"])
    found["active"] = stored().references[stored().reference_index].name
    yield from begun(bpy.ops.monocell.add_cylinder, job["can"]["rim"][1])
    # Ctrl: a rim has no corner to snap to; Shift: more than one point of the top
    yield from clicked(job["can"]["rim"], ctrl=True)
    yield from click(job["can"]["top"][0], shift=True, ctrl=True)
    move(job["can"]["top"][1])
    yield from shot("5_can")
    yield from click(job["can"]["top"][1], ctrl=True)
    yield from ended("can")
    stored().reference_index = 0


def block_drawn():
    """A second box on the table."""
    found["before"] = kept("before")
    yield from begun(bpy.ops.monocell.add_box, job["block"]["base"][1])
    yield from clicked(job["block"]["base"])
    yield from click(job["block"]["top"])
    yield from ended("block")
    in_view(bpy.ops.monocell.look_through)
    yield from shot("6_drawn")


def block_undone_and_redone():
    """The block's name, and then the block itself, taken back and given again by keys."""
    found["drawn"] = kept("drawn")
    found["undone"] = []
    for _ in range(2):
        yield from held("Z", ctrl=True)
        found["undone"].append(kept("undone"))
    for _ in range(2):
        yield from held("Z", ctrl=True, shift=True)
    found["redone"] = kept("redone")


def all_aligned():
    """All three onto the picture's edges: what would move is shown, then taken by Enter."""
    in_view(bpy.ops.monocell.align, "INVOKE_DEFAULT", everything=True)
    yield from reviewed()
    move(job["carton"]["top"])
    yield from shot("7_review")
    yield from typed(("RET",), job["carton_top"])
    yield from worked()
    found["left_in_review"] = bpy.context.window_manager.monocell_work.reviewing
    yield from made_active("carton")
    yield from scrolled("WHEELDOWNMOUSE")
    yield from shot("8_aligned")
    kept("aligned")


def all_textured():
    """The .blend saved, and textures beside it."""
    bpy.ops.wm.save_as_mainfile(filepath=str(out / "cell.blend"))
    in_view(bpy.ops.monocell.take_textures, "INVOKE_DEFAULT", everything=True)
    yield from worked()
    space = view_space()
    space.shading.type = "MATERIAL"
    yield 2.0
    yield from shot("9_textured")


def exported():
    """The glTF and the document, then a look from the side."""
    in_view(bpy.ops.monocell.export_gltf, "EXEC_DEFAULT", filepath=str(out / "cell.glb"))
    yield from worked()
    kept("saved")
    found["left_over"] = handlers()
    view_space().region_3d.view_perspective = "PERSP"
    yield from shot("9_used")


def begun(verb, pixel):
    """A verb of picking begun, the view close to where the picks will be."""
    in_view(bpy.ops.monocell.look_through)
    yield from framed(pixel, job["closer"])
    in_view(verb, "INVOKE_DEFAULT")
    yield PAUSE


def ended(name):
    """The picking is over; the new object gets its name."""
    yield PAUSE
    found.setdefault("picking_over", []).append(not handlers())
    found.setdefault("named", []).append(bpy.context.view_layer.objects.active.name)
    yield from renamed(name)
    found["named"].append(bpy.context.view_layer.objects.active.name)


def view_space():
    """The large view's own settings."""
    window = bpy.context.window_manager.windows[0]
    return next(a for a in window.screen.areas if a.type == "VIEW_3D").spaces.active


run(steps)
