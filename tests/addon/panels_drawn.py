# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar drawn without a window: every panel's own functions called on a layout of ours."""

from __future__ import annotations

from functools import partial
from types import SimpleNamespace


class Context:
    """Blender's context with a sidebar of a usual width."""

    region = SimpleNamespace(width=300, height=800)

    def __init__(self, bpy):
        self._bpy = bpy
        # without a window Blender has no interface scale
        scaled = SimpleNamespace(ui_scale=1.0)
        self.preferences = SimpleNamespace(system=scaled, addons=bpy.context.preferences.addons)

    def __getattr__(self, name):
        return getattr(self._bpy.context, name)


class Layout:
    """Takes what a panel draws, and asks for every value as Blender would to show it."""

    def __init__(self, bpy, lists):
        self._bpy, self._lists = bpy, lists

    def prop(self, data, name, **shown):
        getattr(data, name)

    def label(self, text="", icon="NONE"):
        assert isinstance(text, str)

    def operator(self, idname, **shown):
        room, verb = idname.split(".")
        getattr(getattr(self._bpy.ops, room), verb).get_rna_type()
        return SimpleNamespace()

    def template_list(self, kind, _, data, name, active_data, active_name, **shown):
        getattr(active_data, active_name)
        context, drawn = Context(self._bpy), self._lists[kind]
        for i, item in enumerate(getattr(data, name)):
            drawn.draw_item(
                SimpleNamespace(), context, self, data, item, None, active_data, active_name, i
            )

    def __getattr__(self, name):
        return lambda *arguments, **shown: self if name in CONTAINERS else None


CONTAINERS = {"row", "column", "split", "grid_flow", "box", "column_flow"}


class Drawn:
    """A panel without Blender's own part of it."""

    def __init__(self, panel, layout):
        self._panel, self.layout = panel, layout

    def __getattr__(self, name):
        return partial(getattr(self._panel, name), self)


def draw_panels(bpy, module):
    """Draw every panel of the tab that Blender would show now."""
    classes = module("addon")._classes()
    lists = {one.bl_idname: one for one in classes if issubclass(one, bpy.types.UIList)}
    context, layout = Context(bpy), Layout(bpy, lists)
    for panel in classes:
        if not issubclass(panel, bpy.types.Panel):
            continue
        if getattr(panel, "poll", None) is not None and not panel.poll(context):
            continue
        drawn = Drawn(panel, layout)
        if hasattr(panel, "draw_header"):
            panel.draw_header(drawn, context)
        panel.draw(drawn, context)
