# SPDX-License-Identifier: GPL-3.0-or-later
"""What a user does in the window, one habit a function: pixels and words in, steps out."""

import bpy
from window_driver import (
    PAUSE,
    click,
    event,
    in_view,
    out,
    place_of,
    press,
    save,
    settle,
    show_sidebar,
    view,
)

MIDDLE = (0.45, 0.4)
ROOT_TWO = 2**0.5


def stored():
    """The cell of the scene."""
    return bpy.context.scene.monocell_cell


def worked(seconds=120.0):
    """Wait until the work in the background has ended."""
    yield PAUSE
    while bpy.context.window_manager.monocell_work.title:
        if seconds < 0:
            raise TimeoutError(f"{bpy.context.window_manager.monocell_work.title} did not end")
        seconds -= PAUSE
        yield PAUSE
    yield from settle()


def reviewed(seconds=120.0):
    """Wait until what was found is shown, to be taken or left."""
    yield from worked(seconds)
    while not bpy.context.window_manager.monocell_work.reviewing:
        if seconds < 0:
            raise TimeoutError("no review was shown: nothing was found, or nothing believed")
        seconds -= PAUSE
        yield PAUSE
    yield from settle()


def large_view():
    """The view as large as the window, as by Ctrl Space, with its sidebar."""
    in_view(bpy.ops.screen.screen_full_area)
    yield 1.0
    yield from show_sidebar()


def clicked(pixels, **keys):
    """One click after another."""
    for pixel in pixels:
        yield from click(pixel, **keys)


def typed(keys, pixel):
    """Keys pressed one after another while the mouse is at a pixel."""
    for key in keys:
        press(key, *place_of(pixel))
        yield PAUSE


def held(key, **modifiers):
    """A key with Ctrl or Shift, over the middle of the view."""
    x, y = middle()
    event("MOUSEMOVE", "NOTHING", x, y)
    yield PAUSE
    press(key, x, y, **modifiers)
    yield PAUSE
    yield from settle()


def renamed(name):
    """The active object by another name, as by F2, its letters and Enter."""
    yield from held("F2")
    x, y = middle()
    for letter in name:
        event(letter.upper(), "PRESS", x, y, unicode=letter)
        event(letter.upper(), "RELEASE", x, y)
        yield 0.1
    press("RET", x, y)
    yield PAUSE
    yield from settle()


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
    wanted = (region.x + MIDDLE[0] * region.width, region.y + MIDDLE[1] * region.height)
    eye.view_camera_offset = [
        step * (to - first) / (second - first)
        for to, first, second in zip(wanted, *seen, strict=True)
    ]
    yield from settle()


def made_active(name):
    """One object selected, as by a click in the list."""
    for thing in bpy.context.scene.objects:
        thing.select_set(thing.name == name)
    bpy.context.view_layer.objects.active = bpy.context.scene.objects[name]
    yield from settle()


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


def kept(name):
    """What the scene holds now: its document as a file, and the names in Blender."""
    save(name)
    text = (out / f"{name}.cell.json").read_text()
    return {"text": text, "objects": sorted(ob.name for ob in stored().collection.objects)}


def middle():
    """A place in the view that nothing lies over."""
    _, _, region = view()
    return int(region.x + MIDDLE[0] * region.width), int(region.y + MIDDLE[1] * region.height)
