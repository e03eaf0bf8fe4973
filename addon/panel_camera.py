# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar's second step: the sightings, the camera's pose, and how far to believe it."""

import bpy
import numpy as np

from .cell_scene import camera_stands
from .document import bare_cell, has_cell, stored_report
from .lists import SightingList, columns
from .operators.calibrate import Calibrate
from .operators.look_through import LookThrough
from .operators.show_picture import ShowPicture
from .panel_parts import DONE, DOUBT, NEXT, WAITING, CellPanel, numbers, paragraph, standing

VERDICT_ICONS = {"good": "CHECKMARK", "weak": "ERROR", "failed": "CANCEL"}


class CameraPanel(CellPanel, bpy.types.Panel):
    """Calibrates, and shows what came of it."""

    bl_idname = "MONOCELL_PT_camera"
    bl_label = "Camera"

    def draw_header(self, context):
        """Blender's call."""
        standing(self.layout, _standing(context.scene))

    def draw(self, context):
        """Blender's call."""
        layout, scene = self.layout, context.scene
        if not has_cell(scene):
            paragraph(layout, context, "Comes after the picture.")
            return
        cell = bare_cell(scene)
        if cell.sightings:
            self._draw_sightings(layout, context, cell)
        self._draw_pose(layout, context, cell)

    def _draw_sightings(self, layout, context, cell):
        stored = context.scene.monocell_cell
        columns(layout.row(), "Ball", "centre, m", "px")
        layout.template_list(
            SightingList.bl_idname, "", stored, "sightings", stored, "sighting_index", rows=4
        )
        active = stored.sightings[min(stored.sighting_index, len(stored.sightings) - 1)]
        if active.reason:
            paragraph(layout, context, f"{active.status}: {active.reason}", "INFO")
        row = layout.row(align=True)
        again = "Calibrate Again" if cell.camera.camera_from_world is not None else "Calibrate"
        row.operator(Calibrate.bl_idname, text=again, icon="CON_CAMERASOLVER")
        shown = row.operator(ShowPicture.bl_idname, text="", icon="IMAGE_BACKGROUND")
        # a second press goes back to the cell's own picture
        back = active.picture == stored.shown_picture and cell.picture is not None
        shown.picture = cell.picture if back else active.picture

    def _draw_pose(self, layout, context, cell):
        camera, report = cell.camera, stored_report(context.scene)
        if camera.camera_from_world is None:
            paragraph(layout, context, _what_is_missing(cell), "INFO")
            return
        if not camera_stands(context.scene):
            alert = layout.column()
            alert.alert = True
            paragraph(alert, context, "Blender's camera was changed; models miss the picture.")
            layout.operator(LookThrough.bl_idname, text="Put It Back", icon="VIEW_CAMERA")
        numbers(layout, _pose_rows(camera, report))
        if report is not None:
            verdict = f"Calibration {report.verdict}"
            layout.label(text=verdict, icon=VERDICT_ICONS[report.verdict])
            for warning in report.warnings:
                paragraph(layout, context, warning, "DOT")


def _standing(scene):
    if not has_cell(scene):
        return WAITING
    if bare_cell(scene).camera.camera_from_world is None:
        return NEXT
    report = stored_report(scene)
    return DONE if report is None or report.verdict == "good" else DOUBT


def _what_is_missing(cell):
    if cell.sightings:
        return "Not calibrated yet: the camera stands at a guessed place."
    return (
        "Not calibrated, and without ball sightings it can't be: open a document with sightings "
        "or with camera_from_world."
    )


def _pose_rows(camera, report):
    x, y, z = camera.centre_world
    yield "Position", f"{x:.4f}  {y:.4f}  {z:.4f} m"
    if camera.covariance is not None:
        x, y, z = 1e3 * camera.centre_sigma()
        yield "± 1 sigma", f"{x:.2f}  {y:.2f}  {z:.2f} mm"
        x, y, z = np.degrees(camera.rotation_sigma())
        yield "Turned ±", f"{x:.3f}  {y:.3f}  {z:.3f}°"
    if report is not None:
        yield "Outlines", f"{report.rms_pixels:.2f} px rms"
        yield "Edge bias", f"{report.edge_bias_pixels:+.2f} px"
