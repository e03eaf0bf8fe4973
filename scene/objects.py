# SPDX-License-Identifier: GPL-3.0-or-later
"""Modelled objects into Blender and back, exactly, unless the user changed them there.

The object's `monocell` ID property is its entry of the document, in double precision. Blender's own
numbers are float32: as long as they are those of the entry, the entry is the object; where the user
moved, scaled, edited, coloured or renamed it, Blender's numbers are.
"""

from __future__ import annotations

import json
from dataclasses import replace
from typing import Any

import bpy
import numpy as np

from ..core.appearance import Appearance
from ..core.arrays import Array
from ..core.document.entries import object_entry, object_from_entry
from ..core.errors import InvalidValue
from ..core.pose import Pose
from ..core.primitives import Primitive, Prism
from ..core.shape.tessellation import tessellated
from .materials import PLAIN, colour_material, colour_of
from .meshes import fill_mesh, mesh_vertices
from .read_shape import scaled, shape_of_mesh
from .transforms import matrix_of, pose_and_scale, stand, world_matrix

ENTRY = "monocell"
# picks have gaps (null), which an ID property can't hold
PICKS = "monocell_picks"
# the name that Blender gave, to tell its ".001" from a user's new name
BLENDER_NAME = "monocell_name"
# float32 holds seven digits; what a user changes on purpose is more than that
SAME = 1e-6


def build_object(thing: Primitive, collection: Any, scene: Any = None) -> Any:
    """Build `thing` in `collection`, or rebuild the object of its name in place.

    That is looked for in the collection, or in the whole of `scene`. Scale 1, the sizes in the
    mesh, the origin of the object's own frame. Returns the bpy object.
    """
    ob = find_object(thing.name, scene or collection)
    if ob is None:
        ob = bpy.data.objects.new(thing.name, bpy.data.meshes.new(thing.name))
        collection.objects.link(ob)
    elif ob.data.users > 1 or ob.data.library is not None:
        # a linked duplicate keeps the old shape
        ob.data = bpy.data.meshes.new(thing.name)
    fill_object(ob, thing)
    return ob


def find_object(name: str, holder: Any) -> Any | None:
    """The object of a collection or scene that is modelled and called so in the document."""
    ob = holder.objects.get(name)
    if ob is not None and is_modelled(ob) and document_name(ob) == name:
        return ob
    named = (ob for ob in holder.objects if is_modelled(ob) and document_name(ob) == name)
    return next(named, None)


def is_modelled(ob: Any) -> bool:
    """Whether `build_object` made it (or it was duplicated from one that was)."""
    return ob.type == "MESH" and ENTRY in ob


def built_name(ob: Any) -> str:
    """The name in the document that a modelled object was built with."""
    return str(ob[ENTRY]["name"])


def document_name(ob: Any) -> str:
    """What a modelled object is called in the document: as the user renamed it, or as built."""
    return str(ob[ENTRY]["name"] if ob.name == ob.get(BLENDER_NAME) else ob.name)


def library_of(ob: Any) -> str | None:
    """The .blend file that an object belongs to and is changed in; None for this one."""
    if ob.library is not None:
        return str(ob.library.filepath)
    if ob.override_library is not None:
        return str(ob.override_library.reference.library.filepath)
    return None


def left_out(ob: Any) -> tuple[str, ...]:
    """Words on what Blender shows of a modelled object and `read_object` does not read."""
    told = []
    names = ", ".join(modifier.name for modifier in ob.modifiers if modifier.show_viewport)
    if names:
        told.append(f"its modifiers are no part of the model: apply or remove {names}")
    keys = ob.data.shape_keys
    if keys is not None and any(key.value and not key.mute for key in keys.key_blocks[1:]):
        told.append("its shape keys are no part of the model: apply or remove them")
    return tuple(f"{document_name(ob)}: {words}" for words in told)


def fill_object(ob: Any, thing: Primitive) -> None:
    """Give an object the mesh, colour, place and entry of `thing`."""
    if ob.data.shape_keys is not None:
        # they hold the old vertices
        ob.shape_key_clear()
    fill_mesh(ob.data, tessellated(thing))
    color = PLAIN if thing.appearance is None else thing.appearance.color
    ob.data.materials.clear()
    ob.data.materials.append(colour_material(color))
    place_object(ob, thing)


def place_object(ob: Any, thing: Primitive) -> None:
    """Give an object that has its mesh already the place and entry of `thing`."""
    stand(ob, thing.world_from_object)
    ob[ENTRY] = object_entry(thing, with_picks=False)
    ob[PICKS] = json.dumps(object_entry(thing).get("picks", {}))
    ob[BLENDER_NAME] = ob.name


def read_object(ob: Any) -> Primitive:
    """The object as it stands in Blender now.

    Untouched, it is what was built, to the last bit. Moved or resized, it takes the new pose and
    sizes and loses its covariance, which spoke of the old ones. Raises InvalidValue when it is not
    a modelled object, is sheared, or its mesh is no longer of its kind.
    """
    if not is_modelled(ob):
        raise InvalidValue(f"{ob.name}: was not made by monocell, so its kind is not known")
    entry = ob[ENTRY].to_dict() | {"picks": json.loads(ob.get(PICKS, "{}"))}
    built = replace(object_from_entry(entry, ob.name), name=document_name(ob))
    built = replace(built, appearance=_appearance(ob, built.appearance))
    expected = np.array(matrix_of(built.world_from_object))
    now, vertices = world_matrix(ob), mesh_vertices(ob.data)
    same_place = np.abs(now - expected).max() <= SAME * max(1.0, np.abs(expected).max())
    same_mesh = _is_mesh_of(built, vertices)
    if same_place and same_mesh:
        return built
    here = Pose.identity()
    shape = replace(built, covariance=None, world_from_object=here)
    if not same_mesh:
        shape = shape_of_mesh(shape, vertices)
    pose, scale = pose_and_scale(ob, mirror_axis=2 if isinstance(built, Prism) else 0)
    if np.abs(scale - 1).max() >= SAME:
        shape = scaled(shape, scale)
    centre = now[:3] @ [*shape.world_from_object.translation, 1.0]
    return replace(shape, world_from_object=Pose(pose.rotation, centre))


def _appearance(ob: Any, built: Appearance | None) -> Appearance | None:
    color = colour_of(ob.active_material)
    if color is None:
        return built
    entry_color = np.array(PLAIN if built is None else built.color, dtype=np.float32)
    if (np.array(color, np.float32) == entry_color).all():
        return built
    return Appearance(np.clip(color, 0.0, 1.0))


def _is_mesh_of(built: Primitive, vertices: Array) -> bool:
    """Whether the vertices are those that `build_object` made."""
    wanted = tessellated(built).vertices
    reach = built.half_extent.max()
    return wanted.shape == vertices.shape and bool(np.abs(wanted - vertices).max() <= SAME * reach)
