# SPDX-License-Identifier: GPL-3.0-or-later
"""A cell to one glTF file, made by Blender's exporter from real objects, z up turned to y up.

Every node's `extras.monocell` is its object's entry of the document without picks, still z up, and
the scene's extras hold the camera with all that a glTF camera can't: principal point, distortion,
covariance. So nothing is lost, and robot programs get exact shapes instead of meshes. A composite
is a node without mesh above the nodes of its parts.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

import bpy

from ..core.atomic import atomic_path
from ..core.camera import Camera
from ..core.cell import Cell
from ..core.document.cell_file import picture_from
from ..core.document.entries import camera_entry, composite_entry, object_entry
from ..core.document.reference_entries import reference_entry
from ..core.errors import InvalidValue, RenderFailed
from ..core.links import without_lost_joints
from ..core.primitives import Primitive
from ..core.shape.tessellation import tessellated
from .blender_camera import DISTORTION, place_camera
from .glb_names import named_by_their_entries
from .materials import PLAIN, surface
from .meshes import fill_mesh
from .quiet import quiet_stdout
from .textures import is_textured, painted_mesh
from .transforms import stand

CAMERA_NODE = "camera"
# what tells the extras of a composite's node from those of an object
COMPOSITE = "composite"
VERSION = 1


def export_gltf(cell: Cell, path: str | Path) -> None:
    """Write a binary glTF (`.glb`) of the cell's objects and camera, whole or not at all.

    Everything is built in a Blender scene of its own that is gone afterwards; the user's scene
    stays as it was, and active. Textures are embedded. Raises InvalidValue for another ending than
    .glb, DocumentError when the file can't be written, PictureError for a texture that can't be
    read, RenderFailed when the exporter gives none.
    """
    if Path(path).suffix.lower() != ".glb":
        raise InvalidValue(f"{path}: a glTF export is one binary file; name it .glb")
    with atomic_path(path) as temporary, _scene_of(_beside(cell, Path(path).parent)):
        temporary.unlink()
        _export(temporary)
        if not temporary.is_file():
            raise RenderFailed(f"{path}: Blender's glTF exporter wrote nothing")
        temporary.write_bytes(named_by_their_entries(temporary.read_bytes()))


def scene_extras(cell: Cell) -> dict[str, Any]:
    """What the scene's `extras.monocell` holds: version, camera, references."""
    return {
        "version": VERSION,
        "camera": camera_entry(cell.camera),
        "references": [reference_entry(reference) for reference in cell.references],
    }


def _beside(cell: Cell, folder: Path) -> Cell:
    """Textures named from where the file will stand, so that whoever opens it finds them."""

    def dressed(thing: Primitive) -> Primitive:
        if thing.appearance is None:
            return thing
        look = thing.appearance.with_pictures(lambda name: picture_from(name, cell.folder, folder))
        return replace(thing, appearance=look)

    return replace(cell.with_objects(map(dressed, cell.objects)), folder=folder)


@contextmanager
def _scene_of(cell: Cell) -> Iterator[None]:
    """A scene of the cell, active while it lasts; all that is built is taken away again."""
    window = bpy.context.window
    before = window.scene if window else None
    built: list[Any] = []
    scene = bpy.data.scenes.new("monocell export")
    try:
        scene["monocell"] = scene_extras(cell)
        _build_objects(scene, cell, built)
        if cell.camera.camera_from_world is not None:
            _build_camera(scene, cell.camera, built)
        if window:
            window.scene = scene
        with bpy.context.temp_override(scene=scene, view_layer=scene.view_layers[0]):
            yield
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


def _export(path: Path) -> None:
    with quiet_stdout():
        bpy.ops.export_scene.gltf(
            filepath=str(path),
            export_format="GLB",
            use_active_scene=True,
            export_extras=True,
            export_cameras=True,
            export_yup=True,
            export_apply=False,
            export_image_format="AUTO",
            export_animations=False,
            export_skins=False,
            export_morph=False,
            export_texcoords=True,
        )
