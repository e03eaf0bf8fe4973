# SPDX-License-Identifier: GPL-3.0-or-later
"""What a user sets for good: colours, widths, snapping, units, and the keys of the tools."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, FloatVectorProperty, IntProperty

from .keymap import ENTRIES, KEYMAP
from .overlay.drawing import Color
from .settings import DEFAULTS, Settings

EXTENSION = __package__.rpartition(".")[0]


def settings(context: Any) -> Settings:
    """The user's preferences; the defaults where the add-on runs without being an extension."""
    entry = context.preferences.addons.get(EXTENSION)
    if entry is None or entry.preferences is None:
        return DEFAULTS
    given = entry.preferences
    return Settings(**{f.name: _plain(getattr(given, f.name)) for f in fields(Settings)})


def _plain(value: Any) -> Any:
    return value if isinstance(value, bool | int | float | str) else tuple(value)


def _color(name: str, default: Color, description: str) -> Any:
    return FloatVectorProperty(
        name=name,
        description=description,
        size=4,
        subtype="COLOR_GAMMA",
        min=0.0,
        max=1.0,
        default=default,
    )


class Preferences(bpy.types.AddonPreferences):
    """Shown under Edit > Preferences > Add-ons > monocell."""

    bl_idname = EXTENSION

    object_color: _color("Object", DEFAULTS.object_color, "Wire-frames of modelled objects")
    active_color: _color("Active", DEFAULTS.active_color, "The active object, and picks")
    good_color: _color("Good", DEFAULTS.good_color, "Outlines that the pose explains")
    doubtful_color: _color("Doubtful", DEFAULTS.doubtful_color, "Outlines that it hardly explains")
    rejected_color: _color("Rejected", DEFAULTS.rejected_color, "Balls that do not fit the others")
    advice_color: _color("Advice", DEFAULTS.advice_color, "Where to hold the ball next")
    grid_color: _color("Grid", DEFAULTS.grid_color, "The active reference on the picture")
    line_width: FloatProperty(
        name="Line width",
        description="Width of wire-frames and outlines, pixels at an interface scale of 1",
        default=DEFAULTS.line_width,
        min=0.5,
        max=6.0,
    )
    snap: BoolProperty(
        name="Snap",
        description="Snap clicks to corners and edges of the picture, and to corners of what is "
        "modelled; Ctrl does the opposite",
        default=DEFAULTS.snap,
    )
    snap_radius: FloatProperty(
        name="Snapping radius",
        description="How near the cursor has to be, screen pixels at an interface scale of 1",
        default=DEFAULTS.snap_radius,
        min=1.0,
        max=60.0,
    )
    loupe: BoolProperty(
        name="Loupe",
        description="Show the picture at the cursor enlarged while picking",
        default=DEFAULTS.loupe,
    )
    loupe_zoom: IntProperty(
        name="Enlarged",
        description="How many screen pixels a pixel of the picture takes in the loupe",
        default=DEFAULTS.loupe_zoom,
        min=2,
        max=32,
    )
    unit: EnumProperty(
        name="Unit",
        description="Unit of the sizes that panels show; documents are always in metres",
        items=(
            ("mm", "Millimetres", "Sizes in mm, to a tenth"),
            ("cm", "Centimetres", "Sizes in cm, to a hundredth"),
            ("m", "Metres", "Sizes in m, to a tenth of a millimetre"),
            ("in", "Inches", "Sizes and places in inches, to a thousandth"),
        ),
    )

    def draw(self, context):
        """Blender's call."""
        layout = self.layout
        layout.use_property_split = True
        column = layout.column(heading="Picking")
        for name in ("snap", "snap_radius", "loupe", "loupe_zoom"):
            column.prop(self, name)
        layout.column().prop(self, "unit")
        column = layout.column(heading="Lines")
        column.prop(self, "line_width")
        for field in fields(Settings):
            if field.name.endswith("_color"):
                column.prop(self, field.name)
        _draw_keys(layout, context)


def _draw_keys(layout: Any, context: Any) -> None:
    """The user's own keys, to be changed here or under Keymap."""
    config = context.window_manager.keyconfigs.user
    keymap = config.keymaps.get(KEYMAP) if config is not None else None
    ours = {verb for verb, *_ in ENTRIES}
    for item in keymap.keymap_items if keymap is not None else ():
        if item.idname in ours:
            row = layout.row(align=True)
            row.prop(item, "active", text=item.name)
            row.prop(item, "type", text="", full_event=True)
