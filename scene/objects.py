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
from ..core.primitives import Box, Cylinder, Primitive
from .materials import PLAIN, colour_material, colour_of
from .meshes import box, cylinder, fill_mesh, mesh_vertices, shape_of
from .transforms import matrix_of, pose_and_scale, stand, world_matrix

ENTRY = "monocell"
# picks have gaps (null), which an ID property can't hold
PICKS = "monocell_picks"
# the name that Blender gave, to tell its ".001" from a user's new name
BLENDER_NAME = "monocell_name"
# float32 holds seven digits; what a user changes on purpose is more than that
SAME = 1e-6
# a turned cylinder's facets reach 0.05 % less far
KIND_TOLERANCE = 2e-3


def build_object(thing: Primitive, collection: Any) -> Any:
    """Build `thing` in `collection`, or rebuild the object of its name there in place.

    Scale 1, the sizes in the mesh, the origin at the centre of volume. Returns the bpy object.
    """
    ob = find_object(thing.name, collection)
    if ob is None:
        ob = bpy.data.objects.new(thing.name, bpy.data.meshes.new(thing.name))
        collection.objects.link(ob)
    elif ob.data.users > 1:
        # a linked duplicate keeps the old shape
        ob.data = bpy.data.meshes.new(thing.name)
    fill_object(ob, thing)
    return ob


def find_object(name: str, collection: Any) -> Any | None:
    """The object of a collection that is modelled and has that name in the document, or None."""
    ob = collection.objects.get(name)
    if ob is not None and is_modelled(ob) and _name(ob) == name:
        return ob
    return next((ob for ob in collection.objects if is_modelled(ob) and _name(ob) == name), None)


def is_modelled(ob: Any) -> bool:
    """Whether `build_object` made it (or it was duplicated from one that was)."""
    return ob.type == "MESH" and ENTRY in ob


def fill_object(ob: Any, thing: Primitive) -> None:
    """Give an object the mesh, colour, place and entry of `thing`."""
    fill_mesh(ob.data, shape_of(thing))
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
    built = replace(object_from_entry(entry, ob.name), name=_name(ob))
    built = replace(built, appearance=_appearance(ob, built.appearance))
    expected = np.array(matrix_of(built.world_from_object))
    now, centre, half = world_matrix(ob), *_mesh_box(ob)
    same_place = np.abs(now - expected).max() <= SAME * max(1.0, np.abs(expected).max())
    same_mesh = np.abs(half - built.half_extent).max() <= SAME * half.max()
    if same_place and same_mesh and np.abs(centre).max() <= SAME * half.max():
        return built
    _check_kind(ob, built, centre, half)
    pose, scale = pose_and_scale(ob)
    if (scale == 1.0).all() or np.abs(scale - 1).max() < SAME:
        scale = np.ones(3)
    moved = Pose(pose.rotation, world_matrix(ob)[:3] @ [*centre, 1.0])
    sized = _with_extent(built, built.half_extent if same_mesh else half, scale)
    return replace(sized, world_from_object=moved, covariance=None)


def _name(ob: Any) -> str:
    return ob[ENTRY]["name"] if ob.name == ob.get(BLENDER_NAME) else ob.name


def _appearance(ob: Any, built: Appearance | None) -> Appearance | None:
    color = colour_of(ob.active_material)
    if color is None:
        return built
    entry_color = np.array(PLAIN if built is None else built.color, dtype=np.float32)
    if (np.array(color, np.float32) == entry_color).all():
        return built
    return Appearance(np.clip(color, 0.0, 1.0))


def _mesh_box(ob: Any) -> tuple[Array, Array]:
    """Centre and half edges of the mesh in the object's frame."""
    vertices = mesh_vertices(ob.data)
    if len(vertices) < 3:
        raise InvalidValue(f"{ob.name}: its mesh is empty; undo the edit, or delete the object")
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    return (low + high) / 2, (high - low) / 2


def _check_kind(ob: Any, built: Primitive, centre: Array, half: Array) -> None:
    """Raise InvalidValue when the mesh is not the box or cylinder that its own extent says."""
    if (half <= 0).any():
        raise InvalidValue(f"{ob.name}: its mesh is flat; undo the edit, or delete the object")
    vertices = mesh_vertices(ob.data) - centre
    unit = np.abs(vertices) / half
    if isinstance(built, Cylinder):
        ideal = cylinder(1.0, 2.0).vertices * half
        unit = np.stack([np.hypot(unit[:, 0], unit[:, 1]), unit[:, 2]], axis=1)
    else:
        ideal = box(2 * half).vertices
    dent = np.abs(unit.max(axis=1) - 1.0).max() * half.max()
    # a convex shape is known by how far it reaches in each direction
    direction = ideal / np.linalg.norm(ideal, axis=1, keepdims=True)
    reach = (ideal @ direction.T).max(axis=0) - (vertices @ direction.T).max(axis=0)
    worst = max(float(dent), float(np.abs(reach).max()))
    if worst > KIND_TOLERANCE * half.max():
        raise InvalidValue(
            f"{ob.name}: its mesh is {worst * 1e3:.1f} mm off a {built.kind}; "
            "undo the edit, or build the shape from several objects"
        )


def _with_extent(built: Primitive, half: Array, scale: Array) -> Primitive:
    if isinstance(built, Box):
        size = built.size if half is built.half_extent else 2 * half
        return replace(built, size=size * scale)
    if isinstance(built, Cylinder):
        return _scaled_cylinder(built, half, scale)
    raise TypeError(f"{built.kind}: can't be read back")


def _scaled_cylinder(built: Cylinder, half: Array, scale: Array) -> Cylinder:
    across = half[:2] * scale[:2]
    if abs(across[0] - across[1]) > 1e-3 * across.max():
        raise InvalidValue(
            f"{built.name}: stretched to {across[0]:.4f} x {across[1]:.4f} m across, so it is no "
            "longer round; scale x and y alike"
        )
    radius = float(across.mean())
    return replace(built, radius=radius, height=float(2 * half[2] * scale[2]))
