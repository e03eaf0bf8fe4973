# SPDX-License-Identifier: GPL-3.0-or-later
"""Textures onto meshes: a mesh of a solid and its appearance in, materials and UVs by face out.

Which face a polygon of the mesh belongs to, and where its corners lie in that face's picture,
follows from where the polygon is: it does not matter how the mesh was cut into polygons.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

from ..core.appearance import Appearance
from ..core.arrays import Array
from ..core.errors import PictureError
from ..core.primitives import Primitive
from ..core.shape.charts import chart_of
from ..core.shape.intervals import face_names
from ..core.shape.tessellation import tessellated
from .materials import PLAIN, shader_of, surface
from .meshes import fill_mesh, mesh_vertices

UV_LAYER = "monocell"


def is_textured(thing: Primitive) -> bool:
    """Whether the pictures of some of its faces are known."""
    return thing.appearance is not None and bool(thing.appearance.textures)


def painted_mesh(thing: Primitive, folder: Path, *, glow: bool = False) -> tuple[Any, list[Any]]:
    """A new mesh of the solid with its colour and textures; also all that was made, it included."""
    mesh = bpy.data.meshes.new(thing.name)
    fill_mesh(mesh, tessellated(thing))
    try:
        return mesh, [mesh, *paint(mesh, thing, folder, glow=glow)]
    except PictureError:
        bpy.data.meshes.remove(mesh)
        raise


def paint(mesh: Any, thing: Primitive, folder: Path, *, glow: bool = False) -> list[Any]:
    """Give a mesh of `thing` its uniform colour, and the pictures of its faces where it has them.

    Pictures are named from `folder`. The uniform colour is the first material. With `glow` the
    object shines with its colours by itself and takes no light. Returns the materials and images
    made. Raises PictureError for a picture that is missing or can't be read.
    """
    look = thing.appearance or Appearance(np.array(PLAIN))
    images = _images(look, folder)
    materials = [_surface(f"{thing.name} color", look.color, glow)]
    for face, image in images.items():
        materials.append(_surface(f"{thing.name}.{face}", look.color, glow))
        _show(materials[-1], image, glow)
    mesh.materials.clear()
    for material in materials:
        mesh.materials.append(material)
    if images:
        _lay_out(mesh, thing, {face: i + 1 for i, face in enumerate(images)})
    return [*materials, *images.values()]


def _lay_out(mesh: Any, thing: Primitive, slots: dict[str, int]) -> None:
    """Material and UV of each polygon."""
    faces = polygon_faces(mesh, thing)
    names = face_names(thing)
    starts, corners = _polygons(mesh)
    points = mesh_vertices(mesh)[corners]
    owner = np.repeat(np.arange(len(starts)), np.diff([*starts, len(corners)]))
    middles = _middles(points, owner, len(starts))
    uv = np.zeros((len(corners), 2))
    slot = np.zeros(len(starts), np.int32)
    for number, name in enumerate(names):
        if name not in slots:
            continue
        slot[faces == number] = slots[name]
        here = faces[owner] == number
        chart = chart_of(thing, name)
        # a polygon over the seam runs on past the picture's edge, not back across all of it
        near = chart.coordinates(middles)[owner[here]]
        st = chart.coordinates(points[here], near)
        uv[here] = np.stack([st[:, 0], 1 - st[:, 1]], axis=1)
    mesh.polygons.foreach_set("material_index", slot)
    layer = mesh.uv_layers.get(UV_LAYER) or mesh.uv_layers.new(name=UV_LAYER)
    layer.uv.foreach_set("vector", uv.astype(np.float32).ravel())
    mesh.update()


def polygon_faces(mesh: Any, thing: Primitive) -> NDArray[np.intp]:
    """Which face of the solid each polygon of its mesh belongs to: the one it looks along with."""
    starts, corners = _polygons(mesh)
    points = mesh_vertices(mesh)[corners]
    owner = np.repeat(np.arange(len(starts)), np.diff([*starts, len(corners)]))
    middles = _middles(points, owner, len(starts))
    normals = np.empty(len(starts) * 3, np.float32)
    mesh.polygons.foreach_get("normal", normals)
    normals = normals.reshape(-1, 3).astype(float)
    size = float(np.linalg.norm(thing.half_extent))
    misfit = []
    for name in face_names(thing):
        chart = chart_of(thing, name)
        st = chart.coordinates(middles)
        away = np.linalg.norm(chart.points(st) - middles, axis=1) / size
        turned = 1 - np.einsum("ij,ij->i", chart.normals(st), normals)
        misfit.append(away + turned)
    return np.argmin(misfit, axis=0)


def _polygons(mesh: Any) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    starts = np.empty(len(mesh.polygons), np.int32)
    mesh.polygons.foreach_get("loop_start", starts)
    corners = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("vertex_index", corners)
    return starts, corners


def _middles(points: Array, owner: NDArray[np.intp], count: int) -> Array:
    counts = np.bincount(owner, minlength=count)
    sums = [np.bincount(owner, weights=points[:, axis], minlength=count) for axis in range(3)]
    return np.stack(sums, axis=1) / counts[:, None]


def _surface(name: str, color: Array, glow: bool) -> Any:
    material = surface(name, tuple(color))
    if glow:
        inputs = shader_of(material).inputs
        inputs["Base Color"].default_value = (0, 0, 0, 1)
        inputs["Specular IOR Level"].default_value = 0.0
        inputs["Emission Color"].default_value = (*color, 1)
        inputs["Emission Strength"].default_value = 1.0
    return material


def _show(material: Any, image: Any, glow: bool) -> None:
    nodes, links = material.node_tree.nodes, material.node_tree.links
    node = nodes.new("ShaderNodeTexImage")
    # beyond the picture's edge its last texel goes on: nothing bleeds in from the other side
    node.image, node.extension, node.interpolation = image, "EXTEND", "Linear"
    links.new(
        node.outputs["Color"],
        shader_of(material).inputs["Emission Color" if glow else "Base Color"],
    )


def _images(look: Appearance, folder: Path) -> dict[str, Any]:
    """The pictures by face; a refusal leaves none of them behind."""
    images: dict[str, Any] = {}
    try:
        for face, texture in look.textures.items():
            images[face] = _image(folder / texture.picture)
    except PictureError:
        bpy.data.batch_remove(list(images.values()))
        raise
    return images


def _image(path: Path) -> Any:
    try:
        image = bpy.data.images.load(str(path), check_existing=False)
    except RuntimeError:
        raise PictureError(f"{path}: there is no such texture, or it can't be read") from None
    if not image.has_data and not all(image.size):
        bpy.data.images.remove(image)
        raise PictureError(f"{path}: is no picture that Blender can read; make the texture again")
    image.name = path.name
    # alpha tells what was seen; the colours under it are to be shown all the same
    image.alpha_mode = "CHANNEL_PACKED"
    image.colorspace_settings.name = "sRGB"
    return image
