# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar's second step: the ball sightings, and where they put the camera."""

from typing import ClassVar

import bpy
import numpy as np

from ..cell.cell_scene import camera_stands
from ..cell.document import bare_cell, has_cell, stored_report
from ..lengths import length, lengths, place_unit
from ..operators.add_pictures import AddPictures
from ..operators.add_point import AddPoint
from ..operators.add_sighting import AddSighting
from ..operators.calibrate import Calibrate
from ..operators.clear_window import ClearWindow
from ..operators.drag_window import DragWindow
from ..operators.find_all import FindAll
from ..operators.look_through import LookThrough
from ..operators.paste_sightings import PasteSightings
from ..operators.read_sightings import ReadSightings
from ..operators.remove_sighting import RemoveSighting
from ..operators.show_picture import ShowPicture
from ..preferences import settings
from .lists import SightingList
from .panel_parts import (
    VERDICT_ICONS,
    CellPanel,
    draw_work,
    next_thing,
    numbers,
    paragraph,
    standing,
)
from .steps import FEWEST_SIGHTINGS, camera_step, is_posed


class CameraPanel(CellPanel, bpy.types.Panel):
    """Calibrates, and shows what came of it."""

    bl_idname = "MONOCELL_PT_camera"
    bl_label = "Camera"

    def draw_header(self, context):
        """Blender's call."""
        standing(self.layout, camera_step(context.scene))

    def draw(self, context):
        """Blender's call."""
        layout, scene = self.layout, context.scene
        next_thing(layout, context, camera_step(scene))
        if not has_cell(scene):
            return
        cell = bare_cell(scene)
        if not is_posed(scene):
            if cell.sightings:
                draw_sightings(layout, context, cell)
            if len(cell.sightings) < FEWEST_SIGHTINGS:
                draw_adding(layout, context)
        _draw_verdict(layout, context, cell)
        # what is done needs no button at hand: the sightings have it
        if camera_step(scene).mark != "done" or context.window_manager.monocell_work.title:
            _draw_work(layout, context, cell)


class AccuracyPanel(CellPanel, bpy.types.Panel):
    """Where the camera is and how surely, and where to hold the ball next."""

    bl_idname = "MONOCELL_PT_accuracy"
    bl_parent_id = CameraPanel.bl_idname
    bl_label = ""
    bl_options: ClassVar = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        """Once there is a pose."""
        return is_posed(context.scene)

    def draw_header(self, context):
        """How much there is to read."""
        report = stored_report(context.scene)
        count = len(report.warnings) if report is not None else 0
        remarks = "" if not count else ", 1 remark" if count == 1 else f", {count} remarks"
        self.layout.label(text=f"Accuracy{remarks}")

    def draw(self, context):
        """Blender's call."""
        layout, unit = self.layout, settings(context).unit
        camera, report = bare_cell(context.scene).camera, stored_report(context.scene)
        numbers(layout, _pose_rows(camera, report, unit))
        if report is None:
            return
        if report.verdict == "good":
            draw_warnings(layout, context, report)
        if report.advice:
            layout.label(text="Hold the ball here next", icon="OUTLINER_OB_LIGHTPROBE")
            numbers(layout, _advice_rows(report, unit))


class SightingsPanel(CellPanel, bpy.types.Panel):
    """The sightings once they did their work, and ways to add more."""

    bl_idname = "MONOCELL_PT_sightings"
    bl_parent_id = CameraPanel.bl_idname
    bl_label = ""
    bl_options: ClassVar = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        """Until there are enough, the panel above shows the same."""
        scene = context.scene
        enough = has_cell(scene) and len(scene.monocell_cell.sightings) >= FEWEST_SIGHTINGS
        return enough or is_posed(scene)

    def draw_header(self, context):
        """What it holds."""
        count = len(context.scene.monocell_cell.sightings)
        told = f"Sightings: {count}" if is_posed(context.scene) else "More Sightings"
        self.layout.label(text=told)

    def draw(self, context):
        """Blender's call."""
        cell = bare_cell(context.scene)
        if is_posed(context.scene) and cell.sightings:
            draw_sightings(self.layout, context, cell)
            if camera_step(context.scene).mark == "done":
                _draw_work(self.layout, context, cell)
        draw_adding(self.layout, context)


def draw_adding(layout, context):
    """The ways to add sightings."""
    inputs = context.scene.monocell_inputs
    column = layout.column(align=True)
    row = column.row(align=True)
    row.prop(inputs, "ball_radius", text="Radius")
    row.prop(inputs, "position_unit", text="")
    column.operator(AddPictures.bl_idname, text="Pictures + Copied Positions", icon="ADD")
    row = column.row(align=True)
    row.operator(ReadSightings.bl_idname, text="Read File", icon="FILE_FOLDER")
    row.operator(PasteSightings.bl_idname, text="Paste", icon="PASTEDOWN").becomes = "NEW"
    layout.label(text="In the picture shown")
    layout.row(align=True).prop(inputs, "place_source", expand=True)
    _draw_place(layout, context, inputs)
    row = layout.row(align=True)
    row.operator(AddSighting.bl_idname, icon="SPHERE")
    row.operator(AddPoint.bl_idname, icon="EMPTY_AXIS")


def _draw_place(layout, context, inputs):
    column = layout.column(align=True)
    if inputs.place_source == "TYPED":
        column.prop(inputs, "place", text="")
        return
    if inputs.place_source == "CURSOR":
        column.prop(context.scene.cursor, "location", text="")
        return
    if inputs.place_source == "OBJECT":
        active = context.view_layer.objects.active
        column.label(text=active.name if active else "no active object", icon="OBJECT_DATA")
    else:
        column.prop(inputs, "urdf", text="", placeholder="Robot, URDF")
        column.prop(inputs, "flange", text="", placeholder="Flange link (the last)")
        row = column.row(align=True)
        row.prop(inputs, "joints", text="", placeholder="Joints")
        row.prop(inputs, "joint_unit", text="")
    column.prop(inputs, "offset_known", text="Ball's place on it is known")
    if inputs.offset_known:
        column.prop(inputs, "offset", text="")


def draw_sightings(layout, context, cell):
    """The list, what is done with the active one, and its numbers."""
    stored = context.scene.monocell_cell
    row = layout.row()
    row.template_list(
        SightingList.bl_idname, "", stored, "sightings", stored, "sighting_index", rows=5
    )
    active = stored.sightings[stored.sighting_index]
    side = row.column(align=True)
    side.operator(RemoveSighting.bl_idname, text="", icon="REMOVE")
    side.separator()
    shown = side.operator(ShowPicture.bl_idname, text="", icon="IMAGE_BACKGROUND")
    # a second press goes back to the cell's own picture
    back = active.picture == stored.shown_picture and cell.picture is not None
    shown.picture = cell.picture if back else active.picture
    side.operator(DragWindow.bl_idname, text="", icon="SELECT_SET")
    side.operator(ClearWindow.bl_idname, text="", icon="X")
    side.operator(PasteSightings.bl_idname, text="", icon="PASTEDOWN").becomes = "PLACES"
    if active.reason:
        paragraph(layout, context, f"{active.status}: {active.reason}", "INFO")
    if cell.sightings[active.index].center_world is not None:
        column = layout.column(align=True)
        column.row(align=True).prop(active, "center", text="")
        if active.kind == "ball":
            column.prop(active, "radius")


def _draw_work(layout, context, cell):
    row = layout.row(align=True)
    row.scale_y = 1.3
    if context.window_manager.monocell_work.title:
        draw_work(row, context)
        return
    if not cell.sightings:
        return
    row.operator(FindAll.bl_idname, icon="VIEWZOOM")
    row.operator(
        Calibrate.bl_idname,
        text="Calibrate Again" if is_posed(context.scene) else "Calibrate",
        icon="CON_CAMERASOLVER",
    )


def _draw_verdict(layout, context, cell):
    """What became of the calibration, in a line; why not, where it is not good."""
    report = stored_report(context.scene)
    if report is not None and report.verdict:
        layout.label(
            text=verdict(report, settings(context).unit), icon=VERDICT_ICONS[report.verdict]
        )
    if is_posed(context.scene) and not camera_stands(context.scene):
        alert = layout.column()
        alert.alert = True
        paragraph(alert, context, "Blender's camera was changed; models miss the picture.")
        layout.operator(LookThrough.bl_idname, text="Put It Back", icon="VIEW_CAMERA")
    if report is not None and report.verdict != "good":
        draw_warnings(layout, context, report)


def draw_warnings(layout, context, report):
    """What is doubtful, each in its own lines."""
    for warning in report.warnings:
        paragraph(layout, context, warning, "DOT")


def verdict(report, unit):
    """What came of the calibration, and how well a point worked at is known, in a line."""
    before = " before the search" if report.searched else ""
    if report.surface_millimetres is None:
        return f"Calibration {report.verdict}{before}"
    told = length(1e-3 * report.surface_millimetres, unit, finer=1)
    return f"{report.verdict.capitalize()}{before}: ± {told} on {report.surface}"


def _pose_rows(camera, report, unit):
    yield "Position", lengths(camera.centre_world, place_unit(unit))
    if camera.covariance is not None:
        yield "± 1 sigma", lengths(camera.centre_sigma(), unit, finer=1)
        x, y, z = np.degrees(camera.rotation_sigma())
        yield "Turned ±", f"{x:.3f}  {y:.3f}  {z:.3f}°"
    if report is not None and report.verdict:
        if report.surface_millimetres is not None:
            told = length(1e-3 * report.surface_millimetres, unit, finer=1)
            yield "A point ±", f"{told} on {report.surface}"
        yield "Outlines", f"{report.rms_pixels:.2f} px rms"
        yield "Edge bias", f"{report.edge_bias_pixels:+.2f} px"


def _advice_rows(report, unit):
    for k, one in enumerate(report.advice):
        then = length(1e-3 * one.sigma_millimetres, unit, finer=1)
        yield f"{k + 1}", f"{lengths(one.place, place_unit(unit), finer=-2)}: ± {then}"
