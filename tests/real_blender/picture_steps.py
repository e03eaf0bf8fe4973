# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender with a window: a lens from a board, a dropped picture, another camera."""

import json
import sys
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).parent))
from window_driver import PAUSE, event, found, in_view, job, press, run, settle, shot, show_sidebar

ops = bpy.ops.monocell


def scene():
    return bpy.context.scene


def working():
    return bpy.context.window_manager.monocell_work.title


def browser():
    """The window and area of Blender's file browser."""
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "FILE_BROWSER":
                return window, area
    return None


def choose_boards():
    """Open the file browser, go to the board's pictures, take all of them."""
    in_view(ops.estimate_lens, "INVOKE_DEFAULT")
    yield 1.0
    window, area = browser()
    area.spaces.active.params.directory = job["boards"].encode()
    yield 1.5
    region = next(r for r in area.regions if r.type == "WINDOW")
    with bpy.context.temp_override(window=window, area=area, region=region):
        bpy.ops.file.select_all(action="SELECT")
        bpy.ops.file.execute()
    yield PAUSE


def worked(seconds=60.0):
    while working() and seconds > 0:
        yield PAUSE
        seconds -= PAUSE
    yield from settle()


def agreed(operator, **properties):
    """Call an operator that asks in a dialog, and agree."""
    event("MOUSEMOVE", "NOTHING", 500, 500)
    yield PAUSE
    in_view(operator, "INVOKE_DEFAULT", **properties)
    yield 2 * PAUSE
    found.setdefault("shots", []).append(operator.idname_py())
    yield from shot(f"{len(found['shots']) + 2}_dialog")
    press("RET", 500, 500)
    yield 2 * PAUSE


def handlers_here():
    """What of ours would take a file of an ending that is dropped here."""
    from bpy.types import FileHandler

    ours = [cls for cls in FileHandler.__subclasses__() if cls.bl_idname.startswith("MONOCELL")]

    def of(ending):
        takes = [cls for cls in ours if ending in cls.bl_file_extensions.split(";")]
        return sorted(cls.bl_import_operator for cls in takes if cls.poll_drop(bpy.context))

    return {ending: in_view(lambda ending=ending: of(ending)) for ending in (".png", ".json")}


def steps():
    yield from show_sidebar()
    scene().monocell_inputs.camera_source = "BOARD"
    found["empty"] = handlers_here()
    yield from choose_boards()
    found["was_working"] = working()
    press("ESC")
    yield from worked()
    found["cancelled"] = scene().monocell_lens.estimate
    yield from choose_boards()
    yield from worked()
    found["estimate"] = json.loads(scene().monocell_lens.estimate)
    yield from shot("1_lens")

    # two pictures at once: the first by name starts the cell
    names = [{"name": name} for name in ("second.png", "first.png")]
    yield from agreed(ops.drop_picture, directory=job["folder"], files=names)
    yield from worked()
    found["started"] = scene().monocell_cell.shown_picture
    found["open"] = handlers_here()
    yield from shot("2_opened")
    bpy.context.window_manager.clipboard = "0.1 0.2 0.3\n0.2 0.3 0.4"
    yield from agreed(ops.add_pictures, directory=job["folder"], files=names)
    rows = scene().monocell_cell.sightings
    found["sightings"] = [[row.picture, list(row.center)] for row in rows]

    before = scene().monocell_cell.text
    scene().monocell_inputs.camera_source = "ANGLE"
    in_view(ops.change_camera, "EXEC_DEFAULT", True)
    yield from shot("6_changed")
    found["changed"] = json.loads(scene().monocell_cell.text)["camera"]
    in_view(bpy.ops.ed.undo)
    yield PAUSE
    found["undone"] = scene().monocell_cell.text == before

    in_view(
        bpy.ops.wm.drop_import_file,
        "INVOKE_DEFAULT",
        directory=job["folder"],
        files=[{"name": "cell.cell.json"}],
    )
    yield from worked()
    found["dropped"] = scene().name


run(steps)
