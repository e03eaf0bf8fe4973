# SPDX-License-Identifier: GPL-3.0-or-later
"""Change the camera of the open cell: what is stated goes in, the picture undistorted anew out."""

from typing import ClassVar

import bpy

from ..background_job import OpensInBackground
from ..camera.camera_inputs import camera_for
from ..cell.cell_scene import PLATE_STEPS
from ..cell.document import read_scene
from ..polls import NeedsCell
from ..waiting import waiting


class ChangeCamera(OpensInBackground, NeedsCell, bpy.types.Operator):
    """Give the open cell the camera that is stated above; it has to be calibrated again"""

    bl_idname = "monocell.change_camera"
    bl_label = "Use This Camera"
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    def prepare(self, context):
        """What is done in the background: the shown picture undistorted anew."""
        from ...core.picture.plate import read_plate
        from ..camera.camera_change import with_other_camera

        scene = context.scene
        cell, shown = read_scene(scene), scene.monocell_cell.shown_picture
        inner = cell.camera.intrinsics
        camera = camera_for(scene.monocell_inputs)(lambda: (inner.width, inner.height))
        changed = with_other_camera(cell, camera)

        def work(watch):
            if changed is None:
                return None
            return camera, read_plate(changed, shown, watch) if shown else None

        return "Undistorting", PLATE_STEPS, work

    def finish(self, context, result):
        """Let go of what the old camera told."""
        from ..camera.camera_change import change_camera

        if result is None:
            self.report({"INFO"}, "The cell has this camera already: nothing was changed")
            return {"CANCELLED"}
        with waiting(context):
            told = change_camera(context.scene, *result)
        self.report({"INFO"}, told)
        return {"FINISHED"}
