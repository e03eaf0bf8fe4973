# SPDX-License-Identifier: GPL-3.0-or-later
"""A random user's moves in a Blender with a window: clicks, keys, operators, other screens.

Each is a generator of pauses. What is done is written down before it is done, so that a crash tells
what led to it.
"""

import random
import sys
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).parent))
from window_driver import NoView, event, found, in_view, job, out, place_of, press, view

PAUSE = 0.03
PICKING = (
    *("box", "cylinder", "cone", "tube", "sphere", "prism"),
    *("upright_plane", "upright_line", "point"),
)
OTHER_MODAL = ("pick_reference", "move_pick", "drag_window")
DIALOGS = ("add_parallel_plane", "add_relation", "set_motion", "add_pictures", "save_cell")
BACKGROUND = ("find_all", "calibrate", "align", "propose", "take_colors", "take_textures")
AT_ONCE = (
    *("solve_again", "look_through", "stand_on", "remove_reference", "remove_sighting"),
    *("clear_window", "cancel_work", "add_sighting", "remove_relation"),
)
KEYS = (
    *("ESC", "RET", "BACK_SPACE", "TAB", "V", "ONE", "TWO", "FIVE", "ZERO", "PERIOD", "MINUS", "M"),
    *("HOME", "G", "A", "H", "DEL", "X", "S", "R", "NUMPAD_0", "NUMPAD_ENTER", "C"),
)
TOOLS = ("builtin.select_box", "builtin.move", "builtin.cursor")
rng = random.Random(job["seed"])
log = (out / "steps.txt").open("w")


def note(said):
    log.write(f"{said}\n")
    log.flush()


def has_view():
    try:
        view()
    except NoView:
        return False
    return True


def call(operator, *arguments, **properties):
    """An operator in the view; a refusal is kept, to be looked at afterwards."""
    note(f"  {operator.idname_py()} {arguments} {properties}")
    try:
        in_view(operator, *arguments, **properties)
    except RuntimeError as refusal:
        found["refusals"].append(f"{operator.idname_py()}: {refusal}")


def somewhere():
    """A window place: often a corner of something on the picture, else anywhere in the view."""
    chance, (_, area, region) = rng.random(), view()
    camera = bpy.context.scene.camera
    through = area.spaces.active.region_3d.view_perspective == "CAMERA"
    if chance < 0.6 and through and camera is not None and camera.type == "CAMERA":
        u, v = rng.choice(job["pixels"])
        x, y = place_of((u + rng.gauss(0, 1), v + rng.gauss(0, 1)))
        return min(max(x, 0), job["window"][0] - 1), min(max(y, 0), job["window"][1] - 1)
    if chance > 0.9:
        region = next(r for r in area.regions if r.type == "UI")
    x, y = rng.random() * region.width, rng.random() * region.height
    return int(region.x + x), int(region.y + y)


def click():
    x, y = somewhere()
    event("MOUSEMOVE", "NOTHING", x, y)
    yield PAUSE
    keys = {"ctrl": rng.random() < 0.3, "shift": rng.random() < 0.1}
    note(f"  click {x} {y} {keys}")
    press("LEFTMOUSE", x, y, **keys)


def drag(button="LEFTMOUSE"):
    x, y = somewhere()
    event("MOUSEMOVE", "NOTHING", x, y)
    yield PAUSE
    event(button, "PRESS", x, y)
    yield PAUSE
    x, y = somewhere()
    event("MOUSEMOVE", "NOTHING", x, y)
    yield PAUSE
    event(button, "RELEASE", x, y)


def pan():
    yield from drag("MIDDLEMOUSE")


def move():
    event("MOUSEMOVE", "NOTHING", *somewhere())
    yield PAUSE


def wheel():
    press(rng.choice(["WHEELUPMOUSE", "WHEELDOWNMOUSE"]), *somewhere())
    yield PAUSE


def key():
    name = rng.choice(KEYS)
    note(f"  {name}")
    press(name, *somewhere())
    yield PAUSE


def undo_key():
    press("Z", *somewhere(), ctrl=True, shift=rng.random() < 0.4)
    yield PAUSE


def undo():
    call(rng.choice([bpy.ops.ed.undo, bpy.ops.ed.undo, bpy.ops.ed.redo]))
    yield PAUSE


def pick():
    verb = rng.choice([*(f"add_{name}" for name in PICKING), *OTHER_MODAL])
    if rng.random() < 0.7:
        call(bpy.ops.monocell.look_through, "EXEC_DEFAULT", True)
    call(getattr(bpy.ops.monocell, verb), "INVOKE_DEFAULT", True)
    for _ in range(rng.randint(0, 5)):
        yield from rng.choice([click, click, click, move])()


def draw_box():
    """A box whose corners are clicked as they are."""
    call(bpy.ops.monocell.look_through, "EXEC_DEFAULT", True)
    call(bpy.ops.monocell.add_box, "INVOKE_DEFAULT", True)
    yield PAUSE
    for pixel in job["box"]:
        x, y = place_of(pixel)
        event("MOUSEMOVE", "NOTHING", x, y)
        yield PAUSE
        press("LEFTMOUSE", x, y, ctrl=True)
        yield PAUSE


def dialog():
    call(getattr(bpy.ops.monocell, rng.choice(DIALOGS)), "INVOKE_DEFAULT", True)
    yield 2 * PAUSE
    press(rng.choice(["ESC", "RET"]), *somewhere())
    yield PAUSE


def background():
    call(getattr(bpy.ops.monocell, rng.choice(BACKGROUND)), "INVOKE_DEFAULT", True)
    yield PAUSE


def at_once():
    call(getattr(bpy.ops.monocell, rng.choice(AT_ONCE)), "EXEC_DEFAULT", True)
    yield PAUSE


def tool():
    names = [*TOOLS, *(f"monocell.tool_{verb}" for verb in ("add_box", "add_sphere", "move_pick"))]
    call(bpy.ops.wm.tool_set_by_id, name=rng.choice(names))
    yield PAUSE


def sidebar():
    space = view()[1].spaces.active
    space.show_region_ui = not space.show_region_ui or rng.random() < 0.5
    yield PAUSE


def leave_view():
    kind = rng.choice(["persp", "camera", "quad", "local", "hide"])
    note(f"  view {kind}")
    if kind == "persp":
        view()[1].spaces.active.region_3d.view_perspective = "PERSP"
    elif kind == "camera":
        view()[1].spaces.active.region_3d.view_perspective = "CAMERA"
    elif kind == "quad":
        call(bpy.ops.screen.region_quadview)
    elif kind == "local":
        call(bpy.ops.view3d.localview)
    else:
        view()[1].spaces.active.overlay.show_overlays ^= True
    yield PAUSE


def maximise():
    call(bpy.ops.screen.screen_full_area, use_hide_panels=rng.random() < 0.3)
    yield PAUSE


def another_editor():
    """The area shows something else for a while."""
    area = view()[1]
    area.type = "IMAGE_EDITOR"
    yield 2 * PAUSE
    press("A", *somewhere_in(area))
    yield PAUSE
    area.type = "VIEW_3D"
    yield PAUSE


def somewhere_in(area):
    return area.x + area.width // 2, area.y + area.height // 2


def workspace():
    window = bpy.context.window_manager.windows[0]
    window.workspace = rng.choice(list(bpy.data.workspaces))
    note(f"  workspace {window.workspace.name}")
    yield 2 * PAUSE


def scene():
    bpy.context.window_manager.windows[0].scene = rng.choice(list(bpy.data.scenes))
    yield PAUSE


def change_object():
    obs = [ob for ob in bpy.context.scene.objects if ob.type == "MESH"]
    if obs:
        ob, kind = rng.choice(obs), rng.choice(["rename", "remove", "activate", "move"])
        note(f"  {kind} {ob.name}")
        if kind == "rename":
            ob.name = f"thing {rng.randint(0, 9)}"
        elif kind == "remove" and bpy.context.mode == "OBJECT":
            bpy.data.objects.remove(ob)
        elif kind == "move":
            ob.location.x += 0.02
        elif ob.name in bpy.context.view_layer.objects:
            bpy.context.view_layer.objects.active = ob
            ob.select_set(True)
        bpy.ops.ed.undo_push(message=kind)
    yield PAUSE


def save_and_open():
    """The file is loaded whatever is going on, as by a script or a recovery."""
    path = str(out / "session.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path, copy=True)
    bpy.ops.wm.open_mainfile(filepath=path)
    yield 4 * PAUSE


def open_document():
    call(bpy.ops.monocell.open_cell, "EXEC_DEFAULT", True, filepath=job["document"])
    yield 2 * PAUSE


def blender_is_busy():
    """Whether a modal operator of Blender's own runs: a user then can't change the screen."""
    running = bpy.context.window_manager.windows[0].modal_operators
    return any(not operator.bl_idname.startswith("MONOCELL_") for operator in running)


# what no click or key of a user does while Blender itself is modal, and Blender does not survive
BY_SCRIPT = (
    *(another_editor, workspace, scene, maximise, leave_view, save_and_open, open_document),
    *(undo, change_object),
)
MOVES = {
    click: 26,
    move: 8,
    drag: 5,
    pan: 2,
    wheel: 5,
    key: 14,
    undo_key: 6,
    undo: 4,
    pick: 20,
    draw_box: 5,
    dialog: 3,
    background: 5,
    at_once: 4,
    tool: 3,
    sidebar: 2,
    leave_view: 4,
    maximise: 2,
    another_editor: 1,
    workspace: 1,
    scene: 1,
    change_object: 5,
    save_and_open: 1,
    open_document: 1,
}
