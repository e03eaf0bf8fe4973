# SPDX-License-Identifier: GPL-3.0-or-later
"""Estimate the lens: pictures of a board go in, the camera to open a picture with comes out."""

from pathlib import Path
from typing import ClassVar

import bpy

from ..background_job import OpensInBackground
from ..fields import files_property, folder_property, shows_property


class EstimateLens(OpensInBackground, bpy.types.Operator):
    """Choose three or more pictures of the board, held at angles and up to the picture's rim"""

    bl_idname = "monocell.estimate_lens"
    bl_label = "Estimate Lens"
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    directory: folder_property()
    files: files_property()
    filter_image: shows_property("pictures")
    filter_folder: shows_property("folders")

    def invoke(self, context, event):
        """Let the pictures be chosen that were not dropped; the board is asked for beside them."""
        self.by_hand = True
        if self.files:
            return context.window_manager.invoke_props_dialog(self)
        picture, cell = context.scene.monocell_inputs.picture, context.scene.monocell_cell.folder
        folder = Path(bpy.path.abspath(picture)).parent if picture else cell or Path.home()
        self.directory = self.directory or f"{folder}/"
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def draw(self, context):
        """Blender's call: the board beside the files."""
        from ..panels.panel_lens import board_inputs

        board_inputs(self.layout, context.scene.monocell_lens)

    def prepare(self, context):
        """What is done in the background."""
        from ..camera.lens_estimate import MODELS_TRIED, board_of, estimated, pictures_in

        inputs = context.scene.monocell_lens
        folder = Path(bpy.path.abspath(self.directory))
        names = pictures_in(folder, [file.name for file in self.files if file.name])
        board, model = board_of(inputs), inputs.model
        total = len(names) + (MODELS_TRIED if model == "auto" else 1)
        return "Estimating", total, lambda watch: estimated(folder, names, board, model, watch)

    def finish(self, context, result):
        """Keep it as the camera of the picture that is opened next, or of the open cell."""
        from ..camera.lens_estimate import dump_estimate, told_estimate

        scene = context.scene
        scene.monocell_lens.estimate = dump_estimate(result)
        scene.monocell_inputs.camera_source = "BOARD"
        level = {"good": "INFO", "weak": "WARNING", "failed": "ERROR"}[result.verdict]
        for warning in result.warnings:
            self.report({"WARNING"}, warning)
        self.report({level}, told_estimate(result))
        return {"FINISHED"}
