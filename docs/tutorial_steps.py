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
    event,
    found,
    handlers,
    in_view,
    job,
    move,
    out,
    place_of,
    press,
    run,
    save,
    settle,
    shot,
    show_sidebar,
    view,
)

# letters large enough to be read in a picture that a page shows at half its size
UI_SCALE = 1.25
ROOT_TWO = 2**0.5


def stored():
    """The cell of the scene."""
    return bpy.context.scene.monocell_cell


def worked():
    """Wait until the work in the background has ended."""
    yield PAUSE
    while bpy.context.window_manager.monocell_work.title:
        yield PAUSE
    yield from settle()


def typed(digits, pixel):
    """Keys pressed one after another."""
    for digit in digits:
        press(digit, *place_of(pixel))
        yield PAUSE


def scrolled(wheel, turns=40):
    """The sidebar at its end, or back at its beginning."""
    _, area, _ = view()
    sidebar = next(region for region in area.regions if region.type == "UI")
    x, y = sidebar.x + sidebar.width // 2, sidebar.y + sidebar.height // 2
    event("MOUSEMOVE", "NOTHING", x, y)
    yield PAUSE
    for _ in range(turns):
        press(wheel, x, y)
        yield 0.03
    yield from settle()


def made_active(name):
    """One object selected, as by a click in the list."""
    for thing in bpy.context.scene.objects:
        thing.select_set(thing.name == name)
    bpy.context.view_layer.objects.active = bpy.context.scene.objects[name]
    yield from settle()


def steps():
    """The whole page, from top to bottom."""
    bpy.context.preferences.view.ui_scale = UI_SCALE
    yield from show_sidebar()
    yield from shot("start")
    yield from camera_found()
    yield from two_drawn()
    yield from all_solved()
    yield from aligned_and_used()


def camera_found():
    """Sample and calibration."""
    in_view(bpy.ops.screen.screen_full_area)
    yield 1.0
    yield from show_sidebar()
    in_view(bpy.ops.monocell.open_sample, "EXEC_DEFAULT", True)
    yield from shot("sample")
    in_view(bpy.ops.monocell.calibrate, "INVOKE_DEFAULT")
    yield from worked()
    yield from shot("calibrated")
    found["verdict"] = json.loads(stored().report)["verdict"]


def framed(pixel, closer):
    """The view zoomed and panned, as by hand, until a pixel stands in its middle."""
    _, area, region = view()
    eye = area.spaces.active.region_3d
    # Blender's own law of the camera view's zoom
    root = (ROOT_TWO + eye.view_camera_zoom / 50) * closer**0.5
    eye.view_camera_zoom = 50 * (root - ROOT_TWO)
    step, seen = 0.1, []
    for offset in (0.0, step):
        eye.view_camera_offset = (offset, offset)
        yield from settle()
        seen.append(place_of(pixel))
    middle = (region.x + 0.45 * region.width, region.y + 0.4 * region.height)
    eye.view_camera_offset = [
        step * (to - first) / (second - first)
        for to, first, second in zip(middle, *seen, strict=True)
    ]
    yield from settle()


def two_drawn():
    """A box by its corners, a cylinder with a typed height."""
    in_view(bpy.ops.monocell.add_box, "INVOKE_DEFAULT")
    yield PAUSE
    yield from framed(job["zoom_at"], 2.2)
    for pixel in job["box"][:3]:
        yield from click(pixel)
    move(job["box"][3])
    yield from shot("box")
    yield from click(job["box"][3])
    in_view(bpy.ops.monocell.add_cylinder, "INVOKE_DEFAULT")
    yield PAUSE
    # a rim has no corners to snap to
    for pixel in job["cylinder"]:
        yield from click(pixel, ctrl=True)
    # where the loupe leaves the drum to be seen
    move(job["aside"])
    yield from typed(("ONE", "FIVE", "ZERO"), job["aside"])
    yield from shot("cylinder")
    yield from typed(("RET",), job["aside"])
    found["left_over"] = handlers()
    in_view(bpy.ops.monocell.look_through)
    yield from settle()
    save("drawn")


def all_solved():
    """The picks that the sample brings, and a face as the next reference."""
    in_view(bpy.ops.monocell.solve_again, "EXEC_DEFAULT", True)
    yield from worked()
    for twin in ("crate", "drum"):
        yield from made_active(twin)
        in_view(bpy.ops.object.delete, "EXEC_DEFAULT", True)
    yield from made_active("box")
    yield from scrolled("WHEELDOWNMOUSE")
    yield from shot("solved")
    save("solved")
    in_view(bpy.ops.monocell.pick_reference, "INVOKE_DEFAULT")
    yield PAUSE
    move(job["face"])
    yield from shot("face")
    yield from click(job["face"])
    found["active"] = stored().references[stored().reference_index].name
    yield from shot("on_face")
    stored().reference_index = 0
    yield from scrolled("WHEELUPMOUSE")


def aligned_and_used():
    """Onto the edges, textures, from the side, export."""
    in_view(bpy.ops.monocell.align, "INVOKE_DEFAULT", everything=True)
    yield from worked()
    yield from made_active("box")
    yield from scrolled("WHEELDOWNMOUSE")
    yield from shot("aligned")
    save("aligned")
    # textures are files beside it
    bpy.ops.wm.save_as_mainfile(filepath=str(out / "cell.blend"))
    in_view(bpy.ops.monocell.take_textures, "INVOKE_DEFAULT", everything=True)
    yield from worked()
    space = view()[1].spaces.active
    space.shading.type = "MATERIAL"
    space.region_3d.view_perspective = "PERSP"
    in_view(bpy.ops.view3d.view_orbit, angle=0.5, type="ORBITLEFT")
    for thing in bpy.context.scene.objects:
        thing.select_set(thing.type == "MESH")
    in_view(bpy.ops.view3d.view_selected)
    in_view(bpy.ops.object.select_all, action="DESELECT")
    yield 3.0
    yield from shot("side")
    in_view(bpy.ops.monocell.export_gltf, "EXEC_DEFAULT", filepath=str(out / "environment.glb"))
    yield from worked()
    save("used")


run(steps)
