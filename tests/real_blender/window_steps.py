# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender with a window: a user's modelling by simulated clicks and keys."""

import sys
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).parent))
from window_driver import (
    PAUSE,
    click,
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


def steps():
    yield from show_sidebar()
    yield from shot("1_empty")
    in_view(bpy.ops.monocell.open_cell, "EXEC_DEFAULT", True, filepath=job["document"])
    yield from shot("2_opened")
    in_view(bpy.ops.monocell.calibrate, "EXEC_DEFAULT", True)
    yield from shot("3_calibrated")

    in_view(bpy.ops.monocell.add_box, "INVOKE_DEFAULT")
    yield PAUSE
    yield from click(job["box"][0])
    x, y = place_of(job["box"][0])
    press("WHEELUPMOUSE", x, y)
    yield from settle()
    yield from click(job["box"][1])
    move(job["drum"][0])
    yield from shot("4_foot")
    yield from click(job["drum"][0])
    press("BACK_SPACE", *place_of(job["box"][1]))
    yield PAUSE
    yield from click(job["box"][2])
    move(job["box"][3])
    yield from shot("5_height")
    press("WHEELDOWNMOUSE", *place_of(job["box"][3]))
    yield from settle()
    yield from click(job["box"][3])
    found["left_over"] = handlers()
    yield from shot("6_box")
    found["corners"] = [place_of((0, 0)), place_of((job["width"], job["height"]))]
    save("box")
    in_view(bpy.ops.ed.undo)
    yield PAUSE
    save("undone")
    in_view(bpy.ops.ed.redo)
    yield PAUSE
    save("redone")

    in_view(bpy.ops.monocell.add_cylinder, "INVOKE_DEFAULT")
    yield PAUSE
    for pixel in job["drum"][:2]:
        yield from click(pixel)
    press("ESC", *place_of(job["drum"][1]))
    yield PAUSE
    found["left_over"] |= handlers()
    save("cancelled")

    # with the toolbar's tool the first click is a pick already
    in_view(bpy.ops.wm.tool_set_by_id, name="monocell.tool_add_cylinder")
    yield PAUSE
    *most, top, last = job["drum"]
    for pixel in most:
        yield from click(pixel)
    # with Shift the height takes more than one point
    yield from click(top, shift=True)
    yield from click(last)
    found["left_over"] |= handlers()
    yield from shot("7_all")
    save("all")
    in_view(bpy.ops.monocell.export_gltf, "EXEC_DEFAULT", filepath=str(out / "cell.glb"))
    view()[1].spaces.active.region_3d.view_perspective = "PERSP"
    yield from shot("8_around")


run(steps)
