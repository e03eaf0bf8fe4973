# SPDX-License-Identifier: GPL-3.0-or-later
"""Change the camera of the open cell: what is stated goes in, the picture undistorted anew out."""

from typing import ClassVar

import bpy

from ..camera.camera_inputs import camera_for
from ..cell.document import bare_cell
from ..polls import NeedsCell
from ..refusals import refuses


class ChangeCamera(NeedsCell, bpy.types.Operator):
    """Give the open cell the camera that is stated above; it has to be calibrated again"""

    bl_idname = "monocell.change_camera"
    bl_label = "Use This Camera"
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    @refuses
    def execute(self, context):
        """Undistort anew, and let go of what the old camera told."""
        from ..camera.camera_change import change_camera

        scene = context.scene
        inner = bare_cell(scene).camera.intrinsics
        camera = camera_for(scene.monocell_inputs, lambda: (inner.width, inner.height))
        told = change_camera(scene, camera)
        if not told:
            self.report({"INFO"}, "The cell has this camera already: nothing was changed")
            return {"CANCELLED"}
        self.report({"INFO"}, told)
        return {"FINISHED"}
