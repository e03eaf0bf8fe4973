# SPDX-License-Identifier: GPL-3.0-or-later
"""What the four panels share: their place in the sidebar, wrapped text, and labelled numbers."""

import textwrap

from ..operators.cancel_work import CancelWork

# a sidebar of usual width holds about so many letters a line at the usual interface scale
LETTER_WIDTH = 6.6
EDGE_WIDTH = 46


class CellPanel:
    """A panel of the tab "monocell" in the 3D viewport's sidebar."""

    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "monocell"


def paragraph(layout, context, text, icon="NONE"):
    """Text over as many lines as the sidebar's width needs."""
    scale = context.preferences.system.ui_scale
    letters = int((context.region.width / scale - EDGE_WIDTH) / LETTER_WIDTH)
    column = layout.column(align=True)
    column.scale_y = 0.75
    for i, line in enumerate(textwrap.wrap(text, max(letters, 16))):
        shown = icon if i == 0 else "BLANK1" if icon != "NONE" else "NONE"
        column.label(text=line, icon=shown)


def numbers(layout, rows):
    """Names on the left, values on the right."""
    column = layout.column(align=True)
    column.scale_y = 0.8
    for name, value in rows:
        split = column.split(factor=0.3)
        left = split.row()
        left.alignment = "RIGHT"
        left.label(text=name)
        split.label(text=value)


def standing(layout, step):
    """The mark in a panel's head that says how far its step has come."""
    layout.label(text="", icon=MARKS[step.mark])


def next_thing(layout, context, step):
    """What the step says comes next; a doubt has its sign."""
    if step.said:
        paragraph(layout, context, step.said, "ERROR" if step.mark == "doubt" else "NONE")


def draw_work(row, context):
    """How far the work in the background is, and a way out."""
    work = context.window_manager.monocell_work
    row.progress(factor=work.share, text=f"{work.title}: {work.name}")
    row.operator(CancelWork.bl_idname, text="", icon="CANCEL")


MARKS = {"done": "CHECKMARK", "next": "RIGHTARROW_THIN", "waiting": "BLANK1", "doubt": "ERROR"}
VERDICT_ICONS = {"good": "CHECKMARK", "weak": "ERROR", "failed": "CANCEL"}
