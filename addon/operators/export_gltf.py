# SPDX-License-Identifier: GPL-3.0-or-later
"""Export the scene's cell as glTF, or in any other format."""

from pathlib import Path
from time import monotonic
from typing import ClassVar

import bpy
from bpy.props import EnumProperty
from bpy_extras.io_utils import ExportHelper

from ...core.formats.endings import FORMATS, known_ending
from ..cell.cell_scene import title_of
from ..cell.document import doubts_of, read_scene
from ..fields import endings_property
from ..polls import NeedsCell
from ..refusals import refuses
from ..waiting import waiting

# a shorter wait is none, seconds
FELT = 0.5


def format_of(ending):
    """The identifier of a format by its ending."""
    return ending[1:].upper()


def _show_files_of(operator, context):
    """The chosen format's files in the browser, and its ending on the name."""
    # a menu's entry has the properties alone
    ending = "." + operator.format.lower()
    operator.filter_glob = "*" + ending
    browser = context.space_data
    if browser is None or browser.type != "FILE_BROWSER" or browser.params is None:
        return
    name = Path(browser.params.filename)
    if name.suffix.lower() in FORMATS:
        browser.params.filename = str(name.with_suffix(ending))
    browser.params.filter_glob = operator.filter_glob


class ExportCell(NeedsCell, bpy.types.Operator, ExportHelper):
    """Export all objects, hidden ones too, and the camera, in the format that is chosen"""

    bl_idname = "monocell.export_gltf"
    bl_label = "Export Cell"
    bl_options: ClassVar = {"REGISTER"}

    format: EnumProperty(
        name="Format",
        description="What to write; the ending of the file's name follows",
        items=[
            (format_of(ending), f"{format_of(ending)} ({ending})", told)
            for ending, told in FORMATS.items()
        ],
        default="GLB",
        update=_show_files_of,
    )
    filter_glob: endings_property("*.glb")

    @property
    def filename_ext(self):
        """The ending of the chosen format, which Blender gives the file's name."""
        return "." + self.format.lower()

    @classmethod
    def description(cls, context, properties):
        """Blender's call for the tooltip: that of the format."""
        told = FORMATS["." + properties.format.lower()]
        return f"Export objects and camera: {told}"

    def invoke(self, context, event):
        """Offer a name beside the document."""
        stored = context.scene.monocell_cell
        folder = bpy.path.abspath("//") or stored.folder + "/"
        name = title_of(stored.path or context.scene.name)
        self.filepath = folder + name + self.filename_ext
        _show_files_of(self, context)
        return super().invoke(context, event)

    def draw(self, context):
        """Blender's call: what stands beside the files."""
        layout = self.layout
        layout.prop(self, "format")
        for line in _lines(FORMATS[self.filename_ext]):
            layout.label(text=line)

    @refuses
    def execute(self, context):
        """Write it whole or not at all; the ending of the name tells the format."""
        from ...scene.export import export_cell

        began = monotonic()
        path = bpy.path.abspath(self.filepath)
        self.format = format_of(known_ending(path))
        # Blender's exporters run on its own thread: a hand sees at least that they do
        with waiting(context):
            cell = read_scene(context.scene)
            warnings = (*export_cell(cell, path), *doubts_of(context.scene))
        for warning in warnings:
            self.report({"WARNING"}, warning)
        open_ones = [sketch.name for sketch in cell.sketches]
        if open_ones:
            self.report({"WARNING"}, f"{', '.join(open_ones)}: not solved yet, so not in the file")
        told = f"{Path(path)}: {len(cell.objects)} objects exported"
        self.report({"INFO"}, told + lasting(monotonic() - began))
        return {"FINISHED"}


def lasting(seconds):
    """Words on how long a wait was, where it was one."""
    return f" in {seconds:.1f} s" if seconds > FELT else ""


def _lines(told):
    """The description in rows that fit beside the files."""
    import textwrap

    return textwrap.wrap(told, 34)
