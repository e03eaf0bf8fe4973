# SPDX-License-Identifier: GPL-3.0-or-later
"""A cell to a Blender scene of its own, for as long as an exporter needs it.

Every object's `monocell` ID property is its entry of the document without picks, the scene's holds
the camera with all that no exporter can keep. A composite is an empty above its parts.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

import bpy

from ..core.camera import Camera
from ..core.cell import Cell
from ..core.document.entries import camera_entry, composite_entry, object_entry
from ..core.document.reference_entries import reference_entry
from ..core.links import without_lost_joints
from ..core.primitives import Primitive
from ..core.shape.tessellation import tessellated
from .blender_camera import DISTORTION, place_camera
from .materials import PLAIN, surface
from .meshes import fill_mesh
from .textures import is_textured, painted_mesh
from .transforms import stand

CAMERA_NODE = "camera"
# what tells the extras of a composite's node from those of an object
COMPOSITE = "composite"
VERSION = 1


@contextmanager
def scene_of(cell: Cell) -> Iterator[Any]:
    """A scene of the cell, active while it lasts; all that is built is taken away again.

    The user's scene stays as it was. Raises PictureError for a texture that can't be read.
    """
    window = bpy.context.window
    before = window.scene if window else None
    built: list[Any] = []
    scene = bpy.data.scenes.new("monocell export")
    try:
        scene["monocell"] = _scene_extras(cell)
        _build_objects(scene, cell, built)
        if cell.camera.camera_from_world is not None:
            _build_camera(scene, cell.camera, built)
        if window:
            window.scene = scene
        with bpy.context.temp_override(scene=scene, view_layer=scene.view_layers[0]):
            yield scene
    finally:
        if window:
            window.scene = before
        bpy.data.scenes.remove(scene)
        bpy.data.batch_remove(built)


def _build_objects(scene: Any, cell: Cell, built: list[Any]) -> None:
    """Objects of the same shape and colour share a mesh, as glTF lets them."""
    materials: dict[tuple[float, ...], Any] = {}
    meshes: dict[tuple[Any, ...], Any] = {}
    parents = _build_composites(scene, cell, built)
    for thing in cell.objects:
        if is_textured(thing):
            mesh, made = painted_mesh(thing, cell.folder)
            built += made
            _stand(scene, thing, mesh, parents, built)
            continue
        color = tuple(PLAIN if thing.appearance is None else thing.appearance.color)
        key = (thing.kind, *thing.parameters, *color)
        if color not in materials:
            materials[color] = surface(f"color {len(materials)}", color)
            built.append(materials[color])
        if key not in meshes:
            meshes[key] = _mesh(thing, materials[color])
            built.append(meshes[key])
        _stand(scene, thing, meshes[key], parents, built)


def _stand(
    scene: Any, thing: Primitive, mesh: Any, parents: Mapping[str, Any], built: list[Any]
) -> None:
    ob = bpy.data.objects.new(thing.name, mesh)
    built.append(ob)
    stand(ob, thing.world_from_object)
    ob["monocell"] = object_entry(thing, with_picks=False)
    # a composite's own node stands at the world's origin, and moves no part of it
    ob.parent = parents.get(thing.name)
    scene.collection.objects.link(ob)


def _build_composites(scene: Any, cell: Cell, built: list[Any]) -> dict[str, Any]:
    """An empty for each composite of solved objects; the parent of each part by its name."""
    parents = {}
    # parts that are only picked so far are no nodes
    _, composites, _ = without_lost_joints(cell.objects, cell.composites)
    for composite in composites:
        ob = bpy.data.objects.new(composite.name, None)
        built.append(ob)
        ob["monocell"] = {"kind": COMPOSITE} | composite_entry(composite)
        scene.collection.objects.link(ob)
        parents |= dict.fromkeys(composite.parts, ob)
    return parents


def _mesh(thing: Primitive, material: Any) -> Any:
    mesh = bpy.data.meshes.new(thing.name)
    fill_mesh(mesh, tessellated(thing))
    mesh.materials.append(material)
    return mesh


def _build_camera(scene: Any, camera: Camera, built: list[Any]) -> None:
    data = bpy.data.cameras.new(CAMERA_NODE)
    ob = bpy.data.objects.new(CAMERA_NODE, data)
    built += [ob, data]
    place_camera(ob, scene.render, camera.intrinsics, camera.pose)
    # the scene's extras have it already
    del data[DISTORTION]
    ob["monocell"] = {"name": CAMERA_NODE, "kind": "camera"}
    scene.collection.objects.link(ob)
    scene.camera = ob


def _scene_extras(cell: Cell) -> dict[str, Any]:
    """What the scene's `extras.monocell` holds: version, camera, references."""
    return {
        "version": VERSION,
        "camera": camera_entry(cell.camera),
        "references": [reference_entry(reference) for reference in cell.references],
    }
