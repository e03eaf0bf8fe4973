# SPDX-License-Identifier: GPL-3.0-or-later
"""Add a relation to an object: what it is held by goes in, the object solved with it comes out."""

from typing import ClassVar

import bpy
from bpy.props import EnumProperty, StringProperty

from ..fields import object_property
from ..modelling.model_changes import change_model, name_of, paths_for
from ..polls import NeedsPose
from ..refusals import refuses

KINDS = (
    ("stands_on", "Stands on", "Its base, or another of its faces, lies flush on a plane"),
    ("lies_on", "Lies on", "It lies on its side on a plane"),
    ("leans_on", "Leans on", "A face of it lies flush against a plane, or it touches the plane"),
    ("touches", "Touches", "It touches a plane or line"),
    ("parallel", "Parallel to", "Its axis is parallel to a line, or to a plane's normal"),
    ("perpendicular", "At a right angle to", "Its axis is at a right angle to that direction"),
    ("centred_on", "Centred on", "Its centre lies on a line, or over the middle of a face"),
    ("same_size", "Same size as", "Its sizes are another object's"),
    ("symmetric", "Mirror image of", "It is another object's mirror image in a plane"),
)


def _paths(operator, context, typed):
    return [path for path in paths_for(context.scene) if typed.lower() in path.lower()]


def _own_parts(operator, context, typed):
    from ...core.errors import MonocellError
    from ...core.shape.features import feature_names
    from ..modelling.editing import object_called
    from ..modelling.modelled import standing_cell

    try:
        cell = standing_cell(context.scene)
        thing = object_called(cell, name_of(context, operator.name))
    except MonocellError:
        return []
    return [*feature_names(thing), *thing.size_names]


class AddRelation(NeedsPose, bpy.types.Operator):
    """Say how the object is held by a reference or by another object, and solve it so"""

    bl_idname = "monocell.add_relation"
    bl_label = "Add Relation"
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    name: object_property()
    kind: EnumProperty(name="Relation", description="How it is held", items=KINDS)
    to: StringProperty(
        name="To",
        description="A reference (floor), a feature of an object (crate.top), or an object",
        search=_paths,
    )
    own: StringProperty(
        name="Own",
        description="Which face, edge, axis or size of this object; empty: its base or axis",
        search=_own_parts,
        options={"SKIP_SAVE"},
    )
    about: StringProperty(
        name="About",
        description="The plane of a mirror image",
        search=_paths,
        options={"SKIP_SAVE"},
    )

    def invoke(self, context, event):
        """Ask for it, the active reference offered."""
        stored = context.scene.monocell_cell
        if not self.to and stored.references:
            self.to = stored.references[stored.reference_index].name
        return context.window_manager.invoke_props_dialog(self)

    def draw(self, context):
        """The dialog."""
        column = self.layout.column()
        column.prop(self, "kind")
        column.prop(self, "to")
        column.prop(self, "own")
        if self.kind == "symmetric":
            column.prop(self, "about")

    @refuses
    def execute(self, context):
        """Solve again with it."""
        from ...core.relation import Relation
        from ..modelling.editing import object_called, with_relations

        name = name_of(context, self.name)
        about = self.about or None if self.kind == "symmetric" else None
        relation = Relation(self.kind, self.to, self.own or None, about)

        def added(cell, sigma):
            thing = object_called(cell, name)
            return with_relations(cell, name, (*thing.relations, relation), sigma, on=thing.on)

        for warning in change_model(context.scene, added).warnings:
            self.report({"WARNING"}, warning)
        return {"FINISHED"}
