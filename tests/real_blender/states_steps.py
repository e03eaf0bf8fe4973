# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender with a window: quad and local view, hidden things, and views that are left
while something is picked."""

import sys
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).parent))
from window_driver import (
    PAUSE,
    click,
    event,
    found,
    handlers,
    in_view,
    job,
    move,
    out,
    place_of,
    press,
    run,
    save,
    settle,
    shot,
    show_sidebar,
    view,
)


def refused(operator, *arguments, **properties):
    """What an operator says when it refuses."""
    try:
        in_view(operator, *arguments, **properties)
    except RuntimeError as error:
        return str(error)
    return ""


def active(name):
    for ob in bpy.context.scene.objects:
        ob.select_set(ob.name == name)
    bpy.context.view_layer.objects.active = bpy.context.scene.objects[name]


def corners():
    return [place_of((0, 0)), place_of((job["width"], job["height"]))]


def quad():
    in_view(bpy.ops.screen.region_quadview)
    yield from settle()
    in_view(bpy.ops.monocell.look_through, "EXEC_DEFAULT", True)
    yield from settle()
    in_view(bpy.ops.monocell.add_box, "INVOKE_DEFAULT")
    yield PAUSE
    # a click in another part of the quad view is no pick
    _, area, _ = view()
    press("LEFTMOUSE", area.x + area.width // 3, area.y + area.height // 4)
    yield PAUSE
    for pixel in job["box"][:2]:
        yield from click(pixel, ctrl=True)
    press("WHEELUPMOUSE", *place_of(job["box"][2]))
    yield from settle()
    yield from click(job["box"][2], ctrl=True)
    move(job["box"][3])
    yield from shot("1_quad")
    yield from click(job["box"][3], ctrl=True)
    found["quad_left_over"] = handlers()
    yield from shot("2_quad_box")
    found["quad_corners"] = corners()
    save("quad")
    in_view(bpy.ops.screen.region_quadview)
    yield from settle()
    in_view(bpy.ops.monocell.look_through, "EXEC_DEFAULT", True)
    yield from settle()


def local():
    active("box")
    in_view(bpy.ops.view3d.localview)
    yield from settle()
    found["local_refusal"] = refused(bpy.ops.monocell.add_cylinder, "INVOKE_DEFAULT")
    in_view(bpy.ops.monocell.look_through, "EXEC_DEFAULT", True)
    yield from settle()
    in_view(bpy.ops.monocell.add_cylinder, "INVOKE_DEFAULT")
    yield PAUSE
    for pixel in job["drum"]:
        yield from click(pixel, ctrl=True)
    yield from shot("3_local")
    drum = bpy.context.scene.objects["cylinder"]
    found["local_seen"] = drum.visible_get(viewport=view()[1].spaces.active)
    in_view(bpy.ops.view3d.localview)
    yield from settle()
    in_view(bpy.ops.monocell.look_through, "EXEC_DEFAULT", True)
    save("local")


def hidden():
    bpy.context.scene.objects["box"].hide_set(True)
    yield from shot("4_hidden")
    found["corners"] = corners()
    # what is hidden is looked through
    in_view(bpy.ops.monocell.pick_reference, "INVOKE_DEFAULT")
    yield PAUSE
    yield from click(job["on_box"])
    stored = bpy.context.scene.monocell_cell
    found["through_hidden"] = stored.references[stored.reference_index].name
    bpy.context.scene.objects["box"].hide_set(False)
    bpy.context.scene.camera.hide_set(True)
    found["camera_refusal"] = refused(bpy.ops.monocell.add_box, "INVOKE_DEFAULT")
    in_view(bpy.ops.monocell.look_through, "EXEC_DEFAULT", True)
    yield from shot("5_shown")
    found["shown_corners"] = corners()


def picking():
    """A box of which one corner is picked."""
    in_view(bpy.ops.monocell.add_box, "INVOKE_DEFAULT")
    yield PAUSE
    yield from click(job["box"][0], ctrl=True)


def left(name):
    """Notice that the view was left."""
    yield PAUSE
    event("MOUSEMOVE", "NOTHING", 700, 500)
    yield PAUSE
    event("MOUSEMOVE", "NOTHING", 720, 520)
    yield from settle()
    found[f"left_{name}"] = handlers()
    found[f"picking_{name}"] = bpy.context.window_manager.monocell_work.picking


def other_area():
    yield from picking()
    _, area, _ = view()
    area.type = "IMAGE_EDITOR"
    yield PAUSE
    event("MOUSEMOVE", "NOTHING", 700, 500)
    yield PAUSE
    area.type = "VIEW_3D"
    yield from left("area")


def full_screen():
    yield from picking()
    in_view(bpy.ops.screen.screen_full_area)
    yield from left("full")
    bpy.ops.screen.back_to_previous()
    yield from settle()


def other_workspace():
    yield from picking()
    window = view()[0]
    before = window.workspace
    window.workspace = next(w for w in bpy.data.workspaces if w != before)
    yield from left("workspace")
    window.workspace = before
    yield from settle()


def other_scene():
    yield from picking()
    window = view()[0]
    before = window.scene
    window.scene = bpy.data.scenes.new("another")
    yield from left("scene")
    window.scene = before
    # Blender itself leaves the camera for a scene without one
    in_view(bpy.ops.monocell.look_through, "EXEC_DEFAULT", True)
    yield from settle()


def undone_meanwhile():
    """Undo from elsewhere while picking: the picks are kept, and make the box."""
    save("before")
    in_view(bpy.ops.ed.undo_push, message="before")
    bpy.context.scene.objects["cylinder"].location.x += 0.1
    in_view(bpy.ops.ed.undo_push, message="moved")
    yield from picking()
    in_view(bpy.ops.ed.undo)
    yield from settle()
    for pixel in job["box"][1:]:
        yield from click(pixel, ctrl=True)
    found["undone_left_over"] = handlers()
    save("picked")
    in_view(bpy.ops.ed.undo)
    yield PAUSE
    save("after")


def second_window():
    """A second window on another scene; then one in which something is picked is closed."""
    yield from picking()
    first = view()[0]
    with bpy.context.temp_override(window=first):
        bpy.ops.wm.window_new_main()
    yield 1.0
    second = next(w for w in bpy.context.window_manager.windows if w != first)
    second.scene = bpy.data.scenes["another"]
    yield from settle()
    for pixel in job["box"][1:]:
        yield from click(pixel, ctrl=True)
    found["two_windows"] = [ob.name for ob in first.scene.objects if ob.name.startswith("box")]
    with bpy.context.temp_override(window=second):
        bpy.ops.wm.window_close()
    yield from settle()
    yield from left("window")


def closed_window():
    """A window is closed in which something is picked, and one in which something works."""
    for name, verb, options in (
        ("closed", bpy.ops.monocell.add_box, {}),
        ("working", bpy.ops.monocell.align, {"everything": True}),
    ):
        first = view()[0]
        with bpy.context.temp_override(window=first):
            bpy.ops.wm.window_new_main()
        yield 1.0
        second = next(w for w in bpy.context.window_manager.windows if w != first)
        area = next(area for area in second.screen.areas if area.type == "VIEW_3D")
        region = next(region for region in area.regions if region.type == "WINDOW")
        with bpy.context.temp_override(window=second, area=area, region=region):
            bpy.ops.monocell.look_through("EXEC_DEFAULT", True)
            verb("INVOKE_DEFAULT", **options)
        yield 0.1
        work = bpy.context.window_manager.monocell_work
        found[f"was_{name}"] = work.picking or bool(work.title)
        with bpy.context.temp_override(window=second):
            bpy.ops.wm.window_close()
        yield from settle()
        yield from left(name)
        found[f"title_{name}"] = bpy.context.window_manager.monocell_work.title


def in_edit_mode():
    """An action in edit mode is one undo step, which leads back into it."""
    active("box")
    save("edit_before")
    in_view(bpy.ops.object.mode_set, "EXEC_DEFAULT", True, mode="EDIT")
    yield PAUSE
    in_view(bpy.ops.monocell.set_size, "EXEC_DEFAULT", True, name="box", size="size_z", metres=0.2)
    yield PAUSE
    found["edit_mode"] = [bpy.context.scene.objects["box"].mode]
    save("edit_sized")
    in_view(bpy.ops.ed.undo)
    yield PAUSE
    found["edit_mode"].append(bpy.context.scene.objects["box"].mode)
    save("edit_undone")
    if bpy.context.scene.objects["box"].mode == "EDIT":
        in_view(bpy.ops.object.mode_set, "EXEC_DEFAULT", True, mode="OBJECT")


def loaded():
    path = str(out / "kept.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    save("kept")
    yield from picking()
    bpy.ops.wm.open_mainfile(filepath=path)
    yield 1.0
    yield from left("file")
    yield from shot("6_loaded")
    save("loaded")


def modelled():
    """Box and drum, without a click."""
    for verb, picks in ((bpy.ops.monocell.add_box, "box"), (bpy.ops.monocell.add_cylinder, "drum")):
        in_view(verb, "EXEC_DEFAULT", True, picks=job["picks"][picks])
    yield from settle()


RUNS = {
    "views": (quad, local, hidden, in_edit_mode, loaded),
    "left": (modelled, other_area, full_screen, other_workspace, other_scene, undone_meanwhile),
    "windows": (modelled, other_scene, second_window, closed_window),
}


def steps():
    yield from show_sidebar()
    in_view(bpy.ops.monocell.open_cell, "EXEC_DEFAULT", True, filepath=job["document"])
    yield from settle()
    for part in RUNS[job["run"]]:
        yield from part()


run(steps)
