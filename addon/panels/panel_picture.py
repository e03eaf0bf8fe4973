# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar's first step: which picture, taken by which camera."""

from pathlib import PurePath
from typing import ClassVar

import bpy

from ..cell.document import bare_cell, has_cell
from ..on_picture.camera_view import camera_region
from ..operators.change_camera import ChangeCamera
from ..operators.find_pictures import FindPictures
from ..operators.look_through import LookThrough
from ..operators.open_cell import OpenCell
from ..operators.open_picture import OpenPicture
from ..operators.open_sample import SAMPLES, OpenSample
from .panel_lens import camera_inputs
from .panel_parts import CellPanel, draw_work, next_thing, numbers, paragraph, standing
from .steps import picture_step

SAMPLE_ICONS = {"STACK": "OUTLINER_OB_CAMERA", "TABLE": "FILE_3D"}


class PicturePanel(CellPanel, bpy.types.Panel):
    """Opens a cell, and says which one is open."""

    bl_idname = "MONOCELL_PT_picture"
    bl_label = "Picture"

    def draw_header(self, context):
        """Blender's call."""
        standing(self.layout, picture_step(context.scene))

    def draw(self, context):
        """Blender's call."""
        layout, scene = self.layout, context.scene
        next_thing(layout, context, picture_step(scene))
        if has_cell(scene):
            if scene.monocell_cell.shown_told:
                paragraph(layout, context, scene.monocell_cell.shown_told, "INFO")
            _draw_opened(layout, context)
        else:
            _draw_start(layout, context)


def _draw_start(layout, context):
    inputs = context.scene.monocell_inputs
    column = layout.column(align=True)
    for name, label, _ in SAMPLES:
        column.operator(OpenSample.bl_idname, text=label, icon=SAMPLE_ICONS[name]).sample = name
    column.operator(OpenCell.bl_idname, icon="FILE_FOLDER")
    layout.separator(type="LINE")
    layout.prop(inputs, "picture", text="", placeholder="Picture")
    camera_inputs(layout, context)
    stated = {"FILE": inputs.camera, "BOARD": context.scene.monocell_lens.estimate}
    if context.window_manager.monocell_work.title:
        # the board's own fields show it already
        if inputs.camera_source != "BOARD":
            draw_work(layout.row(align=True), context)
        return
    ready = layout.row()
    ready.enabled = bool(inputs.picture and stated.get(inputs.camera_source, True))
    opened = ready.operator(OpenPicture.bl_idname, icon="IMAGE_DATA")
    opened.picture = inputs.picture


def _draw_opened(layout, context):
    scene = context.scene
    stored = scene.monocell_cell
    if stored.camera is not None and len(stored.camera.data.background_images):
        plate = stored.camera.data.background_images[0]
        row = layout.row(align=True)
        eye = "HIDE_OFF" if plate.show_background_image else "HIDE_ON"
        row.prop(plate, "show_background_image", text="", icon=eye)
        # which of the cell's pictures is seen is told where it is faded
        told = f"Opacity of {PurePath(stored.shown_picture).name}" if stored.shown_picture else ""
        row.prop(plate, "alpha", text=told or "Opacity", slider=True)
        row.separator()
        row.operator(OpenCell.bl_idname, text="", icon="FILE_FOLDER")
    if picture_step(scene).mark == "doubt" and stored.shown_picture:
        layout.operator(FindPictures.bl_idname, icon="VIEWZOOM")
    if not _looks_through(context):
        layout.operator(LookThrough.bl_idname, icon="VIEW_CAMERA")


def _looks_through(context):
    """Whether this viewport shows the picture already."""
    camera, area = context.scene.monocell_cell.camera, context.area
    if camera is None or area is None or not camera.visible_get(viewport=context.space_data):
        return False
    return camera_region(context.scene, area) is not None


class LensPanel(CellPanel, bpy.types.Panel):
    """The camera's numbers, and how to change them."""

    bl_idname = "MONOCELL_PT_lens"
    bl_parent_id = PicturePanel.bl_idname
    bl_label = "Lens"
    bl_options: ClassVar = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        """Blender's question whether it is shown."""
        return has_cell(context.scene)

    def draw(self, context):
        """Blender's call."""
        layout, camera = self.layout, bare_cell(context.scene).camera.intrinsics
        numbers(
            layout,
            (
                ("Size", f"{camera.width} × {camera.height} px"),
                ("Focal", f"{camera.fx:.1f}, {camera.fy:.1f} px"),
                ("Centre", f"{camera.cx:.1f}, {camera.cy:.1f} px"),
                ("Lens", camera.distortion.model.replace("_", " ")),
            ),
        )
        layout.separator(type="LINE")
        layout.label(text="Another camera")
        camera_inputs(layout, context)
        layout.operator(ChangeCamera.bl_idname, icon="CAMERA_DATA")
