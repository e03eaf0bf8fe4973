# SPDX-License-Identifier: GPL-3.0-or-later
import subprocess
import sys

import pytest

pytestmark = pytest.mark.blender

SCRIPT = """
import bpy, sys
import monocell

def listening():
    # every list of Blender's handlers, and what is in it
    lists = {n: getattr(bpy.app.handlers, n) for n in dir(bpy.app.handlers)}
    return {name: tuple(held) for name, held in lists.items() if isinstance(held, list)}

listening_before = listening()
before = set(sys.modules)
names = set(dir(bpy.types)) | set(dir(bpy.types.Scene)) | set(dir(bpy.types.SpaceView3D))
monocell.register()
brought = {name for name in set(sys.modules) - before if name in ("cv2", "gpu", "pybullet")}
assert not brought, brought
assert hasattr(bpy.types.Scene, "monocell_cell")
assert listening() != listening_before
for _ in range(2):
    monocell.unregister()
    after = set(dir(bpy.types)) | set(dir(bpy.types.Scene)) | set(dir(bpy.types.SpaceView3D))
    assert after == names, after ^ names
    assert listening() == listening_before
    assert not dir(bpy.ops.monocell), dir(bpy.ops.monocell)
    for menu in (bpy.types.TOPBAR_MT_file_import, bpy.types.TOPBAR_MT_file_export):
        drawn = getattr(menu.draw, "_draw_funcs", ())
        assert not [f for f in drawn if "monocell" in f.__module__], drawn
    left = {name for name in dir(bpy.types.WindowManager) if "monocell" in name}
    assert not left, left
    handlers = [c.bl_idname for c in bpy.types.FileHandler.__subclasses__() if c.is_registered]
    assert not [name for name in handlers if name.startswith("MONOCELL")], handlers
    monocell.register()
"""


def test_registering_imports_no_opencv_and_unregistering_leaves_nothing():
    run = subprocess.run(
        [sys.executable, "-W", "error::DeprecationWarning", "-c", SCRIPT],
        capture_output=True,
        text=True,
        check=False,
    )
    assert run.returncode == 0, run.stderr


def test_every_verb_says_what_is_missing(addon):
    for name in ("calibrate", "look_through", "show_picture", "add_box", "save_cell"):
        operator = getattr(addon.ops.monocell, name)
        assert not operator.poll()
        with pytest.raises(RuntimeError, match="open a cell document or a picture first"):
            operator()


def test_calibration_says_how_many_sightings_are_missing(addon, module, tmp_path):
    import bench_cell

    path = bench_cell.write_bench(tmp_path, balls=False)
    text = path.read_text()
    cut = text.index('"sightings"')
    path.write_text(text[:cut] + '"sightings": [], "references": [], "objects": []\n}\n')
    addon.ops.monocell.open_cell(filepath=str(path))
    with pytest.raises(RuntimeError, match="has 0 ball sightings in use; a pose needs 3"):
        addon.ops.monocell.calibrate()
    # a document without references has the floor to stand things on
    assert [row.name for row in addon.context.scene.monocell_cell.references] == ["floor"]


def test_every_operator_has_a_label_and_a_description(extension):
    import bpy

    for name in dir(bpy.ops.monocell):
        kind = getattr(bpy.ops.monocell, name).get_rna_type()
        assert kind.name and kind.description, name
