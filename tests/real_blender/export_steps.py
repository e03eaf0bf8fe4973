# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender with a window: every format by script, one through the file browser."""

import sys
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).parent))
from window_driver import PAUSE, found, in_view, job, out, press, run, shot, show_sidebar, view


def browser():
    """The file browser that is open, as area and operator; None while there is none."""
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "FILE_BROWSER" and area.spaces.active.active_operator:
                return window, area, area.spaces.active.active_operator
    return None


def steps():
    bpy.context.preferences.view.filebrowser_display_type = "SCREEN"
    bpy.ops.monocell.open_cell(filepath=job["cell"])
    yield 1.0
    yield from show_sidebar()
    found["refused"] = {}
    for ending in job["endings"]:
        path = str(out / f"cell{ending}")
        try:
            in_view(bpy.ops.monocell.export_gltf, "EXEC_DEFAULT", filepath=path)
        except RuntimeError as error:
            found["refused"][ending] = str(error)
    found["scene"] = bpy.context.scene.name
    yield PAUSE
    window, area, _ = view()
    sidebar = next(region for region in area.regions if region.type == "UI")
    with bpy.context.temp_override(window=window, area=area, region=sidebar):
        for _ in range(40):
            bpy.ops.view2d.scroll_down()
    yield from shot("0_sidebar")
    in_view(bpy.ops.wm.call_menu, name="MONOCELL_MT_export")
    yield from shot("1_menu")
    press("ESC")
    yield PAUSE
    in_view(bpy.ops.monocell.export_gltf, "INVOKE_DEFAULT", format="URDF")
    while browser() is None:
        yield PAUSE
    yield 1.0
    window, area, operator = browser()
    found["offered"] = Path(operator.filepath).suffix
    with bpy.context.temp_override(window=window, area=area):
        operator.format = "SDF"
    yield 1.0
    screenshot(out / "2_browser.png")
    with bpy.context.temp_override(window=window, area=area):
        area.spaces.active.params.directory = str(out).encode()
        bpy.ops.file.execute()
    yield 1.0
    found["written"] = sorted(path.name for path in out.glob("*.sdf"))
    found["areas"] = view()[1].type


def screenshot(path):
    import shutil
    import subprocess

    if shutil.which("import"):
        subprocess.run(["import", "-window", "root", path], check=True)


run(steps)
