# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender with a window: solids picked, stacked, typed and dragged."""

import sys
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).parent))
from window_driver import (
    PAUSE,
    click,
    drag,
    event,
    found,
    handlers,
    in_view,
    job,
    move,
    place_of,
    press,
    release,
    run,
    save,
    settle,
    shot,
    show_sidebar,
    view,
)


def clicked(pixels, **keys):
    for pixel in pixels:
        yield from click(pixel, **keys)


def key(name, pixel):
    press(name, *place_of(pixel))
    yield PAUSE


def active(name):
    for ob in bpy.context.scene.objects:
        ob.select_set(ob.name == name)
    bpy.context.view_layer.objects.active = bpy.context.scene.objects[name]


def scrolled_down():
    """The sidebar at its end, where the active object is."""
    _, area, _ = view()
    sidebar = next(region for region in area.regions if region.type == "UI")
    x, y = sidebar.x + sidebar.width // 2, sidebar.y + sidebar.height // 2
    event("MOUSEMOVE", "NOTHING", x, y)
    yield PAUSE
    for _ in range(30):
        press("WHEELDOWNMOUSE", x, y)
        yield 0.03
    yield from settle()


def worked():
    while bpy.context.window_manager.monocell_work.title:
        yield PAUSE
    yield from settle()


def steps():
    yield from show_sidebar()
    in_view(bpy.ops.monocell.open_cell, "EXEC_DEFAULT", True, filepath=job["document"])
    yield from settle()

    in_view(bpy.ops.monocell.add_sphere, "INVOKE_DEFAULT")
    yield PAUSE
    yield from clicked(job["ball"][:2])
    move(job["ball"][2])
    yield from shot("1_ball")
    yield from click(job["ball"][2])

    in_view(bpy.ops.monocell.add_prism, "INVOKE_DEFAULT")
    yield PAUSE
    # Ctrl: hidden corners are guessed, not snapped to what is in front
    yield from clicked(job["wedge"][:3], ctrl=True)
    yield from key("RET", job["wedge"][2])
    move(job["wedge"][3])
    yield from shot("2_wedge")
    yield from click(job["wedge"][3], ctrl=True)

    # the tool's own first click is the first pick
    in_view(bpy.ops.wm.tool_set_by_id, name="monocell.tool_add_box")
    yield PAUSE
    yield from click(job["crate"][0])
    in_view(bpy.ops.wm.tool_set_by_id, name="builtin.select_box")
    yield from clicked(job["crate"][1:], ctrl=True)
    for digit in ("ONE", "TWO", "THREE", "BACK_SPACE", "ZERO"):
        yield from key(digit, job["crate"][2])
    yield from shot("3_typed")
    yield from key("RET", job["crate"][2])
    found["left_over"] = handlers()
    save("typed")

    in_view(bpy.ops.monocell.pick_reference, "INVOKE_DEFAULT")
    yield PAUSE
    move(job["crate_top"][0])
    yield from shot("4_face")
    yield from click(job["crate_top"][0])
    stored = bpy.context.scene.monocell_cell
    found["active"] = stored.references[stored.reference_index].name

    in_view(bpy.ops.monocell.add_cylinder, "INVOKE_DEFAULT")
    yield PAUSE
    yield from clicked(job["can"][:3], ctrl=True)
    move(job["can"][3])
    yield from shot("5_can")
    yield from click(job["can"][3], ctrl=True)
    yield from settle()
    save("stacked")

    u, v = job["can"][3]
    in_view(bpy.ops.monocell.move_pick, "INVOKE_DEFAULT")
    yield PAUSE
    yield from drag((u, v), (u, v - 25))
    yield from shot("6_drag")
    press("ESC", *place_of((u, v - 25)))
    yield PAUSE
    yield from release((u, v - 25))
    save("escaped")
    in_view(bpy.ops.monocell.move_pick, "INVOKE_DEFAULT")
    yield PAUSE
    yield from drag((u, v), (u, v - 25))
    yield from release((u, v - 25))
    found["left_over"] |= handlers()
    yield from settle()
    save("dragged")
    in_view(bpy.ops.ed.undo)
    yield PAUSE
    save("undone")
    in_view(bpy.ops.ed.redo)
    yield PAUSE
    save("redone")
    in_view(bpy.ops.ed.undo)
    yield PAUSE

    in_view(bpy.ops.monocell.take_colors, "INVOKE_DEFAULT", everything=True)
    yield from worked()
    active("box")
    save("coloured")
    yield from scrolled_down()
    bpy.context.scene.monocell_object.size_0 = 0.2
    bpy.context.scene.monocell_object.size_2 = -0.1
    yield from shot("7_object")
    save("sized")
    view()[1].spaces.active.region_3d.view_perspective = "PERSP"
    yield from shot("8_around")


run(steps)
