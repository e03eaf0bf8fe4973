# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender without a window: a document is opened, modelled, undone and exported.

What it finds goes into a JSON file; the test outside compares it with the truth.
"""

import json
import sys
from pathlib import Path

import addon_utils
import bpy

EXTENSION = "bl_ext.user_default.monocell"
job = json.loads(Path(sys.argv[sys.argv.index("--") + 1]).read_text())
out = Path(job["out"])
ops = bpy.ops.monocell
found = {"version": bpy.app.version_string, "enabled": addon_utils.check(EXTENSION)[1]}
found["heavy"] = [name for name in ("cv2", "gpu") if name in sys.modules and name == "cv2"]


def save(name):
    ops.save_cell(filepath=str(out / f"{name}.cell.json"))


ops.open_cell(filepath=job["document"])
bpy.ops.ed.undo_push(message="opened")
ops.calibrate("EXEC_DEFAULT", True)
save("calibrated")
ops.add_box("EXEC_DEFAULT", True, picks=json.dumps(job["box"]))
ops.add_cylinder("EXEC_DEFAULT", True, picks=json.dumps(job["drum"]), name="drum")
save("modelled")
ops.export_gltf(filepath=str(out / "cell.glb"))
bpy.ops.ed.undo()
save("undone")
bpy.ops.ed.redo()
save("redone")
try:
    ops.add_box(picks="{}")
except RuntimeError as refusal:
    found["refusal"] = str(refusal)
ops.open_picture(picture=job["picture"], camera=job["camera"])
save("from_picture")

scene_attributes = {"monocell_cell", "monocell_inputs", "monocell_object", "monocell_lens"}
handlers = {
    name: held
    for name in dir(bpy.app.handlers)
    if isinstance(held := getattr(bpy.app.handlers, name), list)
}
addon_utils.disable(EXTENSION)
found["left"] = [
    *(name for name in dir(bpy.types) if "monocell" in name.lower()),
    *(name for name in dir(bpy.ops.monocell)),
    *(name for name in scene_attributes if hasattr(bpy.types.Scene, name)),
    *(name for name in dir(bpy.types.SpaceView3D) if "monocell" in name),
    *(name for name in dir(bpy.types.WindowManager) if "monocell" in name),
    *(
        name
        for name, held in handlers.items()
        if any("monocell" in str(h.__module__) for h in held)
    ),
]
addon_utils.enable(EXTENSION)
found["again"] = hasattr(bpy.types.Scene, "monocell_cell")
(out / "found.json").write_text(json.dumps(found))
