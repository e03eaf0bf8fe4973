# SPDX-License-Identifier: GPL-3.0-or-later
"""Edit, sculpt and paint modes: a scene in, its objects in object mode out.

Such a mode locks the mesh, and its own undo would not take back what is done to the cell.
"""

from __future__ import annotations

from typing import Any

import bpy

# a posed robot stays posed; Blender's undo covers it
KEPT = ("OBJECT", "POSE")


def leave_modes(scene: Any) -> None:
    """End every edit, sculpture and painting in the view layer of the window that shows `scene`."""
    layer = bpy.context.view_layer
    if bpy.context.scene != scene:
        return
    busy = [ob for ob in layer.objects if ob.mode not in KEPT]
    before = layer.objects.active
    for ob in busy:
        # the mode is left by the active object, which another may have become meanwhile
        layer.objects.active = ob
        bpy.ops.object.mode_set(mode="OBJECT")
    if busy:
        layer.objects.active = before
