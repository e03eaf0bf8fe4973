# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender with a window: a seed in, a random session out, looked at now and then."""

import importlib
import sys
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).parent))
from random_moves import (
    BY_SCRIPT,
    MOVES,
    PAUSE,
    blender_is_busy,
    call,
    has_view,
    note,
    open_document,
    rng,
)
from random_reach import BY_SCRIPT_TOO, REACHING
from window_driver import NoView, found, handlers, job, out, press, run, shot, show_sidebar

CALM_EVERY = 30
MOST_ESCAPES = 400
CHOICES = MOVES | REACHING
MIDDLE = (job["window"][0] // 2, job["window"][1] // 2)
added = {}


def count_handlers():
    """Keep count of what draws in the view, from now on."""
    space = bpy.types.SpaceView3D
    add, remove = space.draw_handler_add, space.draw_handler_remove

    def adding(*arguments):
        handle = add(*arguments)
        added[id(handle)] = handle
        return handle

    def removing(handle, region):
        remove(handle, region)
        added.pop(id(handle), None)

    space.draw_handler_add, space.draw_handler_remove = adding, removing


def calm():
    """End whatever runs, then see what is left over, and that undo and redo agree."""
    manager = bpy.context.window_manager
    window = manager.windows[0]
    # work that runs takes Esc as its own until it has ended, and picking may wait under it
    for i in range(MOST_ESCAPES):
        if i > 1 and not window.modal_operators:
            break
        press("ESC", 2, 2)
        yield 2 * PAUSE
    if not has_view():
        window.workspace = bpy.data.workspaces["Layout"]
        yield 4 * PAUSE
    if bpy.context.mode != "OBJECT":
        call(bpy.ops.object.mode_set, mode="OBJECT")
    if not bpy.context.scene.monocell_cell.text:
        yield from open_document()
    yield 2 * PAUSE
    number = len(found["checks"])
    call(bpy.ops.ed.undo_push, message="calm")
    seen = {
        "status": handlers(),
        "picking": manager.monocell_work.picking,
        "title": manager.monocell_work.title,
        "handlers": len(added),
        "document": document(number),
    }
    call(bpy.ops.ed.undo)
    yield 2 * PAUSE
    call(bpy.ops.ed.redo)
    yield 2 * PAUSE
    seen["redone"] = document(f"{number}_redone")
    found["checks"].append(seen)
    note(f"calm {number}: {seen}")


def document(name):
    """Where the document was written to, or why it was not; the scene's own file stays its own."""
    path = out / f"check_{name}.cell.json"
    try:
        module("core.document.cell_file").write_cell(
            module("addon.cell.document").read_scene(bpy.context.scene), path
        )
    except module("core.errors").MonocellError as refusal:
        return str(refusal)
    return path.name


def module(name):
    return importlib.import_module(f"bl_ext.user_default.monocell.{name}")


def steps():
    found["checks"], found["refusals"] = [], []
    bpy.context.preferences.view.filebrowser_display_type = "SCREEN"
    count_handlers()
    # Blender draws the panels of the tab that is chosen
    yield from show_sidebar()
    yield from open_document()
    for i in range(job["steps"]):
        if i == job["steps"] // 2:
            yield from shot("1_halfway")
        if not has_view():
            press("ESC", *MIDDLE)
            yield 3 * PAUSE
            if not has_view():
                bpy.context.window_manager.windows[0].workspace = bpy.data.workspaces["Layout"]
                yield 3 * PAUSE
            continue
        chosen = rng.choices(list(CHOICES), list(CHOICES.values()))[0]
        if chosen in (*BY_SCRIPT, *BY_SCRIPT_TOO) and blender_is_busy():
            press("ESC", *MIDDLE)
            yield 2 * PAUSE
            continue
        note(f"{i} {chosen.__name__}")
        try:
            yield from chosen()
        except NoView:
            note("  the view is gone")
        if i % CALM_EVERY == CALM_EVERY - 1:
            yield from calm()
    yield from calm()
    yield from shot("2_end")


run(steps)
