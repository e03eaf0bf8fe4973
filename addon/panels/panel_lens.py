# SPDX-License-Identifier: GPL-3.0-or-later
"""The fields that state a camera: file, numbers, angle, or a board and what it told."""

from ..camera.lens_estimate import parse_estimate
from ..operators.estimate_lens import EstimateLens
from .panel_parts import VERDICT_ICONS, draw_work, numbers, paragraph


def camera_inputs(layout, context):
    """The fields that state a camera which is not known from a document."""
    inputs = context.scene.monocell_inputs
    layout.row().prop(inputs, "camera_source", expand=True)
    if inputs.camera_source == "BOARD":
        lens = context.scene.monocell_lens
        board_inputs(layout, lens)
        if context.window_manager.monocell_work.title:
            draw_work(layout.row(align=True), context)
        else:
            text = "Estimate from Pictures"
            layout.operator(EstimateLens.bl_idname, text=text, icon="IMAGE_DATA")
        draw_estimate(layout, context, lens)
        return
    column = layout.column(align=True)
    if inputs.camera_source == "FILE":
        column.prop(inputs, "camera", text="", placeholder="Camera file (YAML, XML, JSON, TXT)")
        return
    if inputs.camera_source == "PIXELS":
        column.prop(inputs, "focal_x")
        column.prop(inputs, "focal_y")
    else:
        column.prop(inputs, "field_degrees")
    column.prop(inputs, "centred", text="Principal point in the middle")
    if not inputs.centred:
        column.prop(inputs, "centre_x")
        column.prop(inputs, "centre_y")
    column.prop(inputs, "lens_model", text="")
    if inputs.lens_model != "none":
        column.prop(inputs, "coefficients", text="", placeholder="k1 k2 p1 p2 ...")


def board_inputs(layout, lens):
    """The board that was photographed."""
    column = layout.column(align=True)
    column.row(align=True).prop(lens, "board", expand=True)
    counted = "corners" if lens.board == "chessboard" else "squares"
    row = column.row(align=True)
    row.prop(lens, f"{counted}_x", text=f"{counted.capitalize()}")
    row.prop(lens, f"{counted}_y", text="×")
    column.prop(lens, "square")
    if lens.board == "charuco":
        column.prop(lens, "marker")
        column.prop(lens, "dictionary", text="")
    column.prop(lens, "model", text="")


def draw_estimate(layout, context, lens):
    """What the last pictures told; nothing before any did."""
    found = parse_estimate(lens.estimate)
    if found is None:
        return
    layout.label(text=f"Lens {found.verdict}", icon=VERDICT_ICONS[found.verdict])
    numbers(layout, _rows(found))
    for warning in found.warnings:
        paragraph(layout, context, warning, "DOT")


def _rows(found):
    camera = found.camera
    yield "Size", f"{camera['width']} × {camera['height']} px"
    for label, pair in (("Focal", ("fx", "fy")), ("Centre", ("cx", "cy"))):
        yield label, ", ".join(f"{camera[name]:.1f}" for name in pair) + " px"
        if found.sigmas is not None:
            yield "±", ", ".join(f"{found.sigmas[name]:.2f}" for name in pair) + " px"
    yield "Lens", camera["distortion"]["model"].replace("_", " ")
    yield "Corners", f"{found.rms_pixels:.2f} px rms"
    yield "Pictures", f"{found.used} of {found.pictures} used"
