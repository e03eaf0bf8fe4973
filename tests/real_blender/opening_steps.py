# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender with a window: a large picture opened, cancelled, opened and undone."""

import sys
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).parent))
from window_driver import (
    PAUSE,
    drag,
    found,
    in_view,
    job,
    press,
    release,
    run,
    save,
    shot,
    show_sidebar,
)
from window_user import stored, worked

ops = bpy.ops.monocell


def working():
    return bpy.context.window_manager.monocell_work.title


def all_there():
    """The names of what opening a cell makes."""
    kinds = (bpy.data.scenes, bpy.data.cameras, bpy.data.images, bpy.data.objects)
    return [sorted(thing.name for thing in kind) for kind in kinds]


def opened(step):
    """The picture opened as by the button, a screenshot taken meanwhile."""
    in_view(ops.open_picture, "INVOKE_DEFAULT", True, picture=job["picture"], camera=job["camera"])
    found[step] = working()
    yield from shot(f"{len(found)}_{step}")


def steps():
    yield from show_sidebar()
    before = all_there()
    yield from opened("cancelled_while")
    press("ESC")
    yield from worked()
    found["untouched"] = all_there() == before and not stored().text

    yield from opened("opened_while")
    yield from worked()
    (plate,) = bpy.context.scene.camera.data.background_images
    found["size"] = list(plate.image.size)
    found["shown"] = stored().shown_picture
    yield from shot("8_opened")
    in_view(bpy.ops.ed.undo)
    yield PAUSE
    found["undone"] = all_there() == before
    in_view(bpy.ops.ed.redo)
    yield PAUSE

    # the window of a sighting is dragged on its own picture, which is read first
    in_view(ops.open_cell, "INVOKE_DEFAULT", filepath=job["document"])
    yield from worked()
    in_view(ops.drag_window, "INVOKE_DEFAULT")
    found["dragging_while"] = working()
    yield from worked()
    found["dragged_on"] = stored().shown_picture
    start, end = job["corners"]
    yield from drag(start, end)
    yield from shot("9_dragging")
    yield from release(end)
    save("dragged")


run(steps)
