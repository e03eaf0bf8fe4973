# SPDX-License-Identifier: GPL-3.0-or-later
"""Inside a Blender with a window: a generator of steps in, clicks, keys and screenshots out.

Steps yield how long Blender may take to draw before the next. Pixels become window places through
Blender's own projection of the camera frame, not through the add-on's.
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
found = {"version": bpy.app.version_string, "reports": []}
PAUSE = 0.25
drawn = []


class NoView(Exception):
    """No 3D viewport is on the screen, as while a file is chosen."""


def view():
    window = bpy.context.window_manager.windows[0]
    areas = [area for area in window.screen.areas if area.type == "VIEW_3D"]
    if not areas:
        raise NoView
    area = max(areas, key=lambda area: area.width * area.height)
    # in a quad view the last one turns freely
    region = [r for r in area.regions if r.type == "WINDOW"][-1]
    return window, area, region


def in_view(operator, *arguments, **properties):
    window, area, region = view()
    with bpy.context.temp_override(window=window, area=area, region=region):
        return operator(*arguments, **properties)


def show_sidebar():
    _, area, _ = view()
    area.spaces.active.show_region_ui = True
    yield 1.0
    next(r for r in area.regions if r.type == "UI").active_panel_category = "monocell"
    yield PAUSE


def place_of(pixel):
    """Where an undistorted pixel lies in the window."""
    window, area, region = view()
    scene = window.scene
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
    bpy.context.window_manager.windows[0].event_simulate(type=kind, value=value, x=x, y=y, **more)


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


def drag(start, end):
    x, y = place_of(start)
    event("MOUSEMOVE", "NOTHING", x, y)
    yield PAUSE
    event("LEFTMOUSE", "PRESS", x, y)
    yield PAUSE
    x, y = place_of(end)
    event("MOUSEMOVE", "NOTHING", x, y)
    yield PAUSE


def release(pixel):
    x, y = place_of(pixel)
    event("LEFTMOUSE", "RELEASE", x, y)
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


def run(steps):
    """Go through the steps, write what was found, and quit."""
    running = steps()

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
    bpy.types.SpaceView3D.draw_handler_add(lambda: drawn.append(True), (), "WINDOW", "POST_PIXEL")
    # a file that is loaded on the way does not end it
    bpy.app.timers.register(tick, first_interval=2.0, persistent=True)
