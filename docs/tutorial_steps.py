# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender with a window: the tutorial's steps by clicks and keys, a picture each."""

import json
import sys
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "real_blender"))
from window_driver import (
    PAUSE,
    click,
    found,
    handlers,
    in_view,
    job,
    move,
    out,
    run,
    save,
    settle,
    shot,
    show_sidebar,
    view,
)
from window_user import (
    clicked,
    framed,
    large_view,
    made_active,
    renamed,
    reviewed,
    scrolled,
    stored,
    typed,
    worked,
)

# letters large enough to be read in a picture that a page shows at half its size
UI_SCALE = 1.25
CLOSER = 2.2
# from the camera to the side, radians
ASIDE = 0.5


def steps():
    """The whole page, from top to bottom."""
    bpy.context.preferences.view.ui_scale = UI_SCALE
    yield from show_sidebar()
    yield from shot("start")
    yield from camera_found()
    yield from carton_drawn()
    yield from can_put_on_it()
    yield from block_drawn()
    yield from all_aligned()
    yield from seen_from_the_side()
    yield from exported()


def camera_found():
    """Sample and calibration."""
    yield from large_view()
    in_view(bpy.ops.monocell.open_sample, "EXEC_DEFAULT", True)
    yield from shot("sample")
    in_view(bpy.ops.monocell.calibrate, "INVOKE_DEFAULT")
    yield from worked()
    yield from shot("calibrated")
    found["verdict"] = json.loads(stored().report)["verdict"]


def carton_drawn():
    """A box by its corners."""
    yield from begun(bpy.ops.monocell.add_box, job["carton"]["base"][1])
    first, *others = job["carton"]["base"]
    # Ctrl: in the carton's own shadow another corner is near
    yield from click(first, ctrl=True)
    yield from clicked(others)
    move(job["carton"]["top"])
    yield from shot("box")
    yield from click(job["carton"]["top"])
    yield from ended("carton")


def can_put_on_it():
    """A face as the next reference, and a cylinder on it."""
    in_view(bpy.ops.monocell.pick_reference, "INVOKE_DEFAULT")
    yield PAUSE
    move(job["carton_top"])
    yield from shot("face")
    yield from click(job["carton_top"])
    found["active"] = stored().references[stored().reference_index].name
    yield from begun(bpy.ops.monocell.add_cylinder, job["can"]["rim"][1])
    # a rim has no corners to snap to
    yield from clicked(job["can"]["rim"], ctrl=True)
    yield from click(job["can"]["top"][0], shift=True, ctrl=True)
    move(job["can"]["top"][1])
    yield from shot("cylinder")
    yield from click(job["can"]["top"][1], ctrl=True)
    yield from ended("can")
    stored().reference_index = 0


def block_drawn():
    """A box with a typed height."""
    yield from begun(bpy.ops.monocell.add_box, job["block"]["base"][1])
    yield from clicked(job["block"]["base"])
    move(job["block"]["top"])
    yield from typed(("SIX", "ZERO"), job["block"]["top"])
    yield from shot("typed")
    yield from typed(("RET",), job["block"]["top"])
    yield from ended("block")
    in_view(bpy.ops.monocell.look_through)
    yield from made_active("carton")
    yield from scrolled("WHEELDOWNMOUSE")
    yield from shot("drawn")
    save("drawn")


def all_aligned():
    """Onto the edges: what would move is looked at, and taken."""
    yield from framed(job["carton_top"], CLOSER)
    in_view(bpy.ops.monocell.align, "INVOKE_DEFAULT", everything=True)
    yield from reviewed()
    move(job["carton"]["top"])
    yield from shot("review")
    yield from typed(("RET",), job["carton_top"])
    yield from worked()
    in_view(bpy.ops.monocell.look_through)
    yield from made_active("carton")
    yield from shot("aligned")
    save("aligned")


def seen_from_the_side():
    """Textures beside the saved file, and a walk round the cell."""
    bpy.ops.wm.save_as_mainfile(filepath=str(out / "cell.blend"))
    in_view(bpy.ops.monocell.take_textures, "INVOKE_DEFAULT", everything=True)
    yield from worked()
    space = view()[1].spaces.active
    space.shading.type = "MATERIAL"
    space.region_3d.view_perspective = "PERSP"
    in_view(bpy.ops.view3d.view_orbit, angle=ASIDE, type="ORBITLEFT")
    for thing in bpy.context.scene.objects:
        thing.select_set(thing.type == "MESH")
    in_view(bpy.ops.view3d.view_selected)
    in_view(bpy.ops.object.select_all, action="DESELECT")
    yield 3.0
    yield from shot("side")


def exported():
    """For the robot's planner."""
    in_view(bpy.ops.monocell.export_gltf, "EXEC_DEFAULT", filepath=str(out / "environment.glb"))
    yield from worked()
    save("used")


def begun(verb, pixel):
    """A verb of picking begun, the view close to where the picks will be."""
    in_view(bpy.ops.monocell.look_through)
    yield from framed(pixel, CLOSER)
    in_view(verb, "INVOKE_DEFAULT")
    yield PAUSE


def ended(name):
    """The picking is over; the new object gets its name."""
    yield from settle()
    found["left_over"] = found.get("left_over", False) or handlers()
    yield from renamed(name)


run(steps)
