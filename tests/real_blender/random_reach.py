# SPDX-License-Identifier: GPL-3.0-or-later
"""Moves of several steps, to states that single clicks and keys hardly ever lead to.

Calibrated anew, with points, with another camera; an alignment or proposals taken or left; a lens
estimated; several scenes; exported and opened.
"""

import sys
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).parent))
from random_moves import (
    PAUSE,
    blender_is_busy,
    call,
    click,
    draw_box,
    move,
    note,
    open_document,
    rng,
    somewhere,
)
from window_driver import found, job, out, press

BOARDS = Path(__file__).resolve().parents[2] / "samples" / "02_cameras" / "board"
found["reached"] = {}


def reach(state):
    """Count that a state was reached."""
    note(f"  reached {state}")
    found["reached"][state] = found["reached"].get(state, 0) + 1


def finished(verb, state, **properties):
    """An operator by a script; the state counts as reached if it was not refused."""
    before = len(found["refusals"])
    call(getattr(bpy.ops.monocell, verb), "EXEC_DEFAULT", True, **properties)
    if len(found["refusals"]) == before:
        reach(state)


def waited(seconds=30.0):
    """Until the work in the background has ended; what takes longer is cancelled."""
    work = bpy.context.window_manager.monocell_work
    yield PAUSE
    while work.title:
        seconds -= 0.1
        work.cancel = work.cancel or seconds < 0
        yield 0.1
    yield PAUSE


def review():
    """What was aligned or proposed is looked at, and taken or left."""
    verb = rng.choice(["align", "align", "align", "propose"])
    if rng.random() < 0.5 and not blender_is_busy():
        # another camera has no pose, and without one nothing can be shown
        yield from open_document()
    if verb == "align":
        yield from draw_box()
    call(bpy.ops.monocell.look_through, "EXEC_DEFAULT", True)
    call(getattr(bpy.ops.monocell, verb), "INVOKE_DEFAULT", True)
    yield from waited()
    if bpy.context.window_manager.monocell_work.reviewing:
        reach(f"{verb} shown")
        for _ in range(rng.randint(0, 3)):
            yield from rng.choice([click, move])()
        key = rng.choice(["RET", "RET", "NUMPAD_ENTER", "ESC"])
        press(key, *somewhere())
        yield 2 * PAUSE
        reach(f"{verb} {'left' if key == 'ESC' else 'taken'}")


def calibrate_with_points():
    """Corners of the box by their true places, with the balls or without them."""
    scene = bpy.context.scene
    inputs = scene.monocell_inputs
    inputs.place_source, inputs.position_unit = "TYPED", "m"
    for place, pixel in job["points"]:
        inputs.place = place
        call(bpy.ops.monocell.add_point, "EXEC_DEFAULT", True, pixel_at=pixel)
    if rng.random() < 0.5:
        for row in scene.monocell_cell.sightings:
            row.use = row.radius == 0
    yield from calibrate()


def calibrate():
    call(bpy.ops.monocell.calibrate, "INVOKE_DEFAULT", True)
    yield from waited()
    if bpy.context.scene.monocell_cell.report:
        reach("calibrated")


def change_camera():
    inputs = bpy.context.scene.monocell_inputs
    inputs.camera_source = rng.choice(["ANGLE", "ANGLE", "PIXELS", "BOARD"])
    inputs.field_degrees, inputs.coefficients = rng.choice([50.0, 60.0]), ""
    inputs.focal_x = inputs.focal_y = rng.choice([750.0, 900.0])
    finished("change_camera", "another camera")
    yield PAUSE
    if rng.random() < 0.5:
        yield from calibrate()


def estimate_lens():
    """Pictures that were dropped: the board is asked for, then they are worked on."""
    lens = bpy.context.scene.monocell_lens
    lens.model, lens.estimate = "plumb_bob", ""
    files = [{"name": f"board_{number:02d}.jpg"} for number in (0, 3, 5)]
    call(bpy.ops.monocell.estimate_lens, "INVOKE_DEFAULT", True, directory=str(BOARDS), files=files)
    yield 4 * PAUSE
    press("RET", *somewhere())
    yield 2 * PAUSE
    yield from waited()
    if bpy.context.scene.monocell_lens.estimate:
        reach("lens estimated")


def scenes():
    """One more, or one less."""
    if len(bpy.data.scenes) < 4 and rng.random() < 0.7:
        call(bpy.ops.scene.new, type=rng.choice(["NEW", "EMPTY", "LINK_COPY", "FULL_COPY"]))
    else:
        call(bpy.ops.scene.delete)
    if len(bpy.data.scenes) > 1:
        reach("several scenes")
    yield 2 * PAUSE


def export_and_open():
    path = str(out / "random.glb")
    finished("export_gltf", "exported", filepath=path, format="GLB")
    yield PAUSE
    if rng.random() < 0.5 and Path(path).is_file():
        finished("open_gltf", "glTF opened", filepath=path)
    yield 2 * PAUSE


# like a file that is loaded, these are no click of a user while Blender itself is modal
BY_SCRIPT_TOO = (scenes, export_and_open)
REACHING = {
    review: 6,
    calibrate: 2,
    calibrate_with_points: 2,
    change_camera: 2,
    estimate_lens: 1,
    scenes: 2,
    export_and_open: 2,
}
