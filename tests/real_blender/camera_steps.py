# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender with a window: the way from the sample to a calibrated camera."""

import sys
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).parent))
from window_driver import (
    PAUSE,
    click,
    drag,
    found,
    handlers,
    in_view,
    job,
    press,
    release,
    run,
    save,
    settle,
    shot,
    show_sidebar,
    view,
)


def stored():
    return bpy.context.scene.monocell_cell


def working():
    return bpy.context.window_manager.monocell_work.title


def worked(seconds=60.0):
    """Wait until the work in the background has ended."""
    while working() and seconds > 0:
        yield PAUSE
        seconds -= PAUSE
    yield from settle()


def steps():
    yield from show_sidebar()
    yield from shot("1_start")
    in_view(bpy.ops.monocell.open_sample, "EXEC_DEFAULT", True, sample="TABLE")
    yield from shot("2_sample")

    # started, then cancelled with Esc: nothing may have changed
    before = stored().text
    in_view(bpy.ops.monocell.calibrate, "INVOKE_DEFAULT")
    yield 0.1
    found["was_working"] = working()
    press("ESC")
    yield from worked()
    found["unchanged"] = stored().text == before and stored().report == ""

    in_view(bpy.ops.monocell.find_all, "INVOKE_DEFAULT")
    shares = []
    while working() and len(shares) < 600:
        shares.append(bpy.context.window_manager.monocell_work.share)
        if len(shares) == 4:
            yield from shot("3_working")
        yield 0.1
    found["shares"] = shares
    yield from settle()
    found["found"] = [row.status for row in stored().sightings]
    yield from shot("4_found")

    stored().sighting_index = 2
    in_view(bpy.ops.monocell.drag_window, "INVOKE_DEFAULT")
    yield from worked()
    left, top, right, below = job["window"]
    yield from drag((left, top), (right, below))
    yield from shot("5_window")
    yield from release((right, below))
    found["left_over"] = handlers()
    save("window")
    in_view(bpy.ops.ed.undo)
    yield PAUSE
    save("undone")
    in_view(bpy.ops.ed.redo)
    yield PAUSE

    in_view(bpy.ops.monocell.calibrate, "INVOKE_DEFAULT")
    yield from worked()
    found["calibrated"] = [row.status for row in stored().sightings]
    in_view(bpy.ops.monocell.show_picture, "EXEC_DEFAULT", picture="cell.jpg")
    yield from shot("6_calibrated")
    save("calibrated")
    found["report"] = stored().report

    bpy.context.scene.monocell_inputs.place = job["point"]
    in_view(bpy.ops.monocell.add_point, "INVOKE_DEFAULT")
    yield PAUSE
    # Ctrl keeps the click where it is: beside the point there may be the grain of the wood
    yield from click(job["point_at"], ctrl=True)
    found["left_over"] |= handlers()
    save("point")
    in_view(bpy.ops.monocell.add_point, "INVOKE_DEFAULT")
    yield PAUSE
    press("ESC")
    yield PAUSE
    found["left_over"] |= handlers()
    save("cancelled")
    stored().sightings[1].use = False
    view()[1].tag_redraw()
    yield from shot("7_edited")

    files = [{"name": "table.cell.json"}]
    drop = bpy.ops.wm.drop_import_file
    in_view(drop, "INVOKE_DEFAULT", directory=job["sample"], files=files)
    yield from settle()
    found["dropped"] = view()[0].scene.name


run(steps)
