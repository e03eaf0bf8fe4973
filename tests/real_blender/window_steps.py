# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender with a window: a user's work by simulated clicks and keys.

A generator yields how long Blender may take to draw before the next step. Pixels become window
places through Blender's own projection of the camera frame, not through the add-on's.
"""

import json
import shutil
import subprocess
import sys
import traceback
from pathlib import Path

import bpy
from bpy_extras import view3d_utils

job = json.loads(Path(sys.argv[sys.argv.index("--") + 1]).read_text())
out = Path(job["out"])
found = {"version": bpy.app.version_string, "events": []}
PAUSE = 0.25


def view():
    window = bpy.context.window_manager.windows[0]
    area = max(
        (a for a in window.screen.areas if a.type == "VIEW_3D"), key=lambda a: a.width * a.height
    )
    region = next(r for r in area.regions if r.type == "WINDOW")
    return window, area, region


def in_view(operator, *arguments, **properties):
    window, area, region = view()
    with bpy.context.temp_override(window=window, area=area, region=region):
        return operator(*arguments, **properties)


def place_of(pixel):
    """Where an undistorted pixel lies in the window."""
    _, area, region = view()
    scene = bpy.context.scene
    camera = scene.camera
    corners = [
        view3d_utils.location_3d_to_region_2d(
            region, area.spaces.active.region_3d, camera.matrix_world @ corner
        )
        for corner in camera.data.view_frame(scene=scene)
    ]
    left, right = min(p.x for p in corners), max(p.x for p in corners)
    low, high = min(p.y for p in corners), max(p.y for p in corners)
    x = left + (pixel[0] + 0.5) / job["width"] * (right - left)
    y = high - (pixel[1] + 0.5) / job["height"] * (high - low)
    # an event names the screen pixel; the add-on takes that pixel's middle
    return int(x) + region.x, int(y) + region.y


def event(kind, value, x, y, **more):
    view()[0].event_simulate(type=kind, value=value, x=x, y=y, **more)


def press(kind, x=300, y=300, **more):
    event(kind, "PRESS", x, y, **more)
    event(kind, "RELEASE", x, y, **more)


def move(pixel):
    x, y = place_of(pixel)
    event("MOUSEMOVE", "NOTHING", x, y)


def click(pixel, **keys):
    x, y = place_of(pixel)
    event("MOUSEMOVE", "NOTHING", x, y)
    yield PAUSE
    press("LEFTMOUSE", x, y, **keys)
    yield PAUSE


def settle():
    """Wait until all that was asked for is drawn: only then are Blender's view matrices new."""
    yield PAUSE
    drawn.clear()
    view()[1].tag_redraw()
    while not drawn:
        yield PAUSE
    yield PAUSE


def shot(name):
    """A screenshot, of the screen itself: some software drivers leave Blender's own one black."""
    yield from settle()
    yield PAUSE
    if shutil.which("import"):
        subprocess.run(["import", "-window", "root", out / f"{name}.png"], check=True)
    else:
        bpy.ops.screen.screenshot(filepath=str(out / f"{name}.png"))


def save(name):
    in_view(bpy.ops.monocell.save_cell, "EXEC_DEFAULT", filepath=str(out / f"{name}.cell.json"))


def handlers():
    """What the status bar shows tells whether picking has ended."""
    from bl_ui.space_statusbar import STATUSBAR_HT_header as header

    return header.draw is not getattr(header, "_draw_orig", header.draw)


def steps():
    _, area, _ = view()
    area.spaces.active.show_region_ui = True
    yield 1.0
    sidebar = next(r for r in area.regions if r.type == "UI")
    sidebar.active_panel_category = "monocell"
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

    in_view(bpy.ops.monocell.add_cylinder, "INVOKE_DEFAULT")
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


def finish():
    (out / "found.json").write_text(json.dumps(found))
    bpy.ops.wm.quit_blender()


def tick():
    try:
        return next(running)
    except StopIteration:
        finish()
    except Exception:
        found["error"] = traceback.format_exc()
        finish()
    return None


bpy.context.preferences.view.show_splash = False
drawn = []
bpy.types.SpaceView3D.draw_handler_add(lambda: drawn.append(True), (), "WINDOW", "POST_PIXEL")
running = steps()
bpy.app.timers.register(tick, first_interval=2.0)
