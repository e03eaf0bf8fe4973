# SPDX-License-Identifier: GPL-3.0-or-later
"""How fast the add-on is, measured inside a Blender that has it installed and shows a window.

    blender --python benchmarks/addon_speed.py

Registering with all modules imported anew, drawing the overlay of a hundred objects, a pick with
snapping and preview, and finding and calibrating the eight sightings of the sample. Beside the time
on the wall stands that which the processor was busy, which other programs do not lengthen. With
`--background` the overlay, which needs a window, is left out. Any error ends Blender with 1.
"""

from __future__ import annotations

import importlib
import os
import sys
import traceback
from dataclasses import dataclass
from time import perf_counter, thread_time

import addon_utils
import bpy
import numpy as np


@dataclass(frozen=True)
class Clock:
    """Milliseconds on the wall and of the processor; started, then read."""

    wall: float
    busy: float

    @staticmethod
    def started():
        return Clock(1e3 * perf_counter(), 1e3 * thread_time())

    def read(self):
        now = Clock.started()
        return Clock(now.wall - self.wall, now.busy - self.busy)


EXTENSION = "bl_ext.user_default.monocell"
ROUNDS = 60
SETTLED = 0.4
told: list[tuple[str, Clock, float]] = []
timed: dict[str, list[Clock]] = {}


def part(name):
    """A module of the installed extension."""
    return importlib.import_module(f"{EXTENSION}.{name}")


def note(name, spent, wanted):
    told.append((name, spent, wanted))


def median(spent):
    return Clock(*(float(np.median([getattr(s, n) for s in spent])) for n in ("wall", "busy")))


def register_anew():
    addon_utils.disable(EXTENSION)
    for name in [name for name in sys.modules if name.startswith(EXTENSION)]:
        del sys.modules[name]
    start = Clock.started()
    addon_utils.enable(EXTENSION)
    note("register", start.read(), 200)
    assert "cv2" not in sys.modules


def calibrate():
    bpy.ops.monocell.open_sample(sample="TABLE")
    bpy.ops.monocell.calibrate()
    start = Clock.started()
    bpy.ops.monocell.calibrate()
    note("find and calibrate 8 sightings of 1280 x 960", start.read(), 1500)


def hundred_objects():
    """Boxes and drums all over the sample's table."""
    primitives, document = part("core.primitives"), part("addon.cell.document")
    pose = part("core.pose").Pose
    scene = bpy.context.scene
    things = []
    for i in range(100):
        place = [0.1 + 0.07 * (i % 10), -0.5 + 0.1 * (i // 10), 0.03]
        stands = pose.from_rotation_vector([0, 0, 0.3 * i], place)
        if i % 2:
            things.append(primitives.Box(f"b{i}", stands, size=[0.05, 0.04, 0.06], on="table"))
        else:
            things.append(
                primitives.Cylinder(f"c{i}", stands, radius=0.02, height=0.06, on="table")
            )
    document.show_objects(scene, document.read_scene(scene).with_objects(things))


class Timed:
    """The overlay, drawn a second time with the clock running."""

    def __init__(self):
        changes = part("addon.overlay.scene_changes").SceneChanges()
        changes.listen()
        self.overlay, self.name = part("addon.overlay.overlay").Overlay(changes), ""

    def draw(self):
        if not self.name:
            return
        start = Clock.started()
        self.overlay.draw()
        timed.setdefault(self.name, []).append(start.read())


def viewport():
    """The largest 3D viewport."""
    areas = bpy.context.window_manager.windows[0].screen.areas
    return max((a for a in areas if a.type == "VIEW_3D"), key=lambda a: a.width * a.height)


def redrawn(clock, name, between=lambda i: None):
    clock.name = name
    area = viewport()
    for i in range(ROUNDS):
        between(i)
        area.tag_redraw()
        yield 0.02
    clock.name = ""


def pick():
    """Aim, snap and preview at every place of the cursor, as between two redraws."""
    scene = bpy.context.scene
    aiming, sessions = part("addon.on_picture.aiming"), part("addon.picking.pick_session")
    plans, document = part("addon.picking.pick_plans"), part("addon.cell.document")
    sketch = next(s for s in document.bare_cell(scene).sketches if s.kind == "box")
    camera, plane = document.bare_cell(scene).camera, document.active_plane(scene)
    aims = aiming.Aiming.of(scene, viewport().spaces.active)
    session = sessions.PickSession(plans.BOX, camera, plane)
    for pixel in sketch.picks["base"][:3]:
        session = session.picked(np.array(pixel))
    spent = []
    rng = np.random.default_rng(1)
    for _ in range(ROUNDS):
        start = Clock.started()
        aim = aims.aimed(np.array(sketch.picks["top"][1]) + rng.uniform(-3, 3, 2), 12.0)
        session.preview(aim.pixel)
        spent.append(start.read())
    note("a pick: snap, solve and preview a box", median(spent), 50)


def steps():
    register_anew()
    calibrate()
    pick()
    if bpy.app.background:
        return
    hundred_objects()
    clock = Timed()
    bpy.types.SpaceView3D.draw_handler_add(clock.draw, (), "WINDOW", "POST_PIXEL")
    yield SETTLED
    yield from redrawn(clock, "overlay of 100 objects")
    first = next(ob for ob in bpy.context.scene.objects if ob.name.startswith("b"))

    def move(i):
        first.location.x += 1e-4

    yield from redrawn(clock, "the same while one of them is moved", move)
    for name, spent in timed.items():
        note(name, median(spent), 8)


def tell():
    print(f"\nBlender {bpy.app.version_string}, {os.cpu_count()} cores")
    print(f"{'milliseconds':<46}{'wall':>8}{'busy':>8}{'at most':>9}")
    for name, spent, wanted in told:
        print(f"{name:<46}{spent.wall:8.1f}{spent.busy:8.1f}{wanted:9}")


def next_wait():
    """Seconds until the next step, None after the last; an error would leave Blender standing."""
    try:
        return next(running, None)
    except Exception:
        traceback.print_exc()
        sys.stderr.flush()
        os._exit(1)


def tick():
    wait = next_wait()
    if wait is None:
        tell()
        bpy.ops.wm.quit_blender()
    return wait


running = steps()
if bpy.app.background:
    while tick() is not None:
        pass
else:
    bpy.context.preferences.view.show_splash = False
    bpy.app.timers.register(tick, first_interval=2.0)
