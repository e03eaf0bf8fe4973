# SPDX-License-Identifier: GPL-3.0-or-later
"""A printed plate in Blender: a panel in, its plate and its print as objects out."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np

from ..core.arrays import Array
from ..core.pose import Pose
from ..core.shape.tessellation import box
from .materials import shader_of, surface
from .meshes import fill_mesh
from .transforms import matrix_of
from .work_cell import Panel

# the print stands off the plate by this, metres, so that neither hides the other
INK = 0.0001
# the stub behind a plate that the gripper's fingers close on, metres
STUB_RADIUS = 0.015


def build_panel(scene: Any, panel: Panel) -> list[Any]:
    """The objects of a panel, at its place. Remove its print with `remove_print` before them."""
    plate = surface("plate", (0.8, 0.8, 0.8), roughness=0.6)
    mesh = bpy.data.meshes.new("plate")
    fill_mesh(mesh, box([*panel.size, panel.thickness]))
    mesh.materials.append(plate)
    behind = Pose(np.eye(3), np.array([0, 0, INK + panel.thickness / 2]))
    obs = [_linked(scene, "plate", mesh), _linked(scene, "print", _print_mesh(panel))]
    for ob, place in zip(obs, (behind, Pose.identity()), strict=True):
        ob.matrix_world = matrix_of(panel.world_from_panel @ place)
    return obs


def remove_print(obs: list[Any]) -> None:
    """Remove the picture that a panel's print shows."""
    for image in {node.image for ob in obs for node in _image_nodes(ob)}:
        bpy.data.images.remove(image)


def stub_centre(panel: Panel) -> Array:
    """What the gripper closes on, (3,) in the world: a stub in the middle of the plate's back."""
    return panel.world_from_panel.apply([0, 0, INK + panel.thickness + STUB_RADIUS])


def _print_mesh(panel: Panel) -> Any:
    mesh = bpy.data.meshes.new("print")
    corners = np.array([[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]])
    vertices = [(*(corner * panel.size), 0.0) for corner in corners]
    mesh.from_pydata([tuple(map(float, v)) for v in vertices], [], [(0, 3, 2, 1)])
    layer = mesh.uv_layers.new(name="print")
    for loop in mesh.loops:
        x, y = corners[loop.vertex_index]
        # Blender's pictures begin at the bottom
        layer.data[loop.index].uv = (x + 0.5, 0.5 - y)
    mesh.materials.append(_ink(panel.albedo))
    mesh.update()
    return mesh


def _ink(albedo: Array) -> Any:
    height, width = albedo.shape
    image = bpy.data.images.new("print", width, height, alpha=False, float_buffer=True)
    image.colorspace_settings.name = "Non-Color"
    values = np.ones((height, width, 4), np.float32)
    values[:, :, :3] = albedo[::-1, :, None]
    image.pixels.foreach_set(values.ravel())
    material = surface("print", (0.8, 0.8, 0.8), roughness=0.6)
    nodes, links = material.node_tree.nodes, material.node_tree.links
    node = nodes.new("ShaderNodeTexImage")
    # what is printed has sharp edges, however near one looks
    node.image, node.interpolation = image, "Closest"
    links.new(node.outputs["Color"], shader_of(material).inputs["Base Color"])
    return material


def _image_nodes(ob: Any) -> list[Any]:
    trees = [material.node_tree for material in ob.data.materials]
    return [node for tree in trees for node in tree.nodes if node.type == "TEX_IMAGE"]


def _linked(scene: Any, name: str, mesh: Any) -> Any:
    ob = bpy.data.objects.new(name, mesh)
    scene.collection.objects.link(ob)
    return ob
