# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials: uniform colours for modelled objects, and the surfaces of the synthetic work cell."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import bpy
import numpy as np
from numpy.typing import ArrayLike

# what an object without appearance looks like
PLAIN = (0.6, 0.6, 0.62)
ROUGHNESS = 0.5


def colour_material(color: ArrayLike) -> Any:
    """The material of a uniform colour (3,) in linear light, shared by all objects that have it.

    A user who edits it makes it his own: the next object of the old colour gets a new one.
    """
    wanted = np.asarray(color, dtype=np.float32)
    name = "monocell " + " ".join(f"{part:.4g}" for part in wanted)
    material = bpy.data.materials.get(name)
    if material is not None and _is_colour(material, wanted):
        return material
    return surface(name, wanted.tolist(), roughness=ROUGHNESS)


def colour_of(material: Any) -> tuple[float, float, float] | None:
    """The uniform base colour of a material; None when it has none (a texture, no shader)."""
    shader = shader_of(material) if material is not None else None
    if shader is None or shader.inputs["Base Color"].is_linked:
        return None
    red, green, blue, _ = shader.inputs["Base Color"].default_value
    return red, green, blue


def surface(
    name: str,
    color: Sequence[float],
    *,
    roughness: float = ROUGHNESS,
    metallic: float = 0.0,
    coat: float = 0.0,
) -> Any:
    """A new material of one Principled shader. `color` (3,) is linear light."""
    material = bpy.data.materials.new(name)
    if bpy.app.version < (5, 0):
        material.use_nodes = True
    inputs = shader_of(material).inputs
    inputs["Base Color"].default_value = (*color, 1.0)
    inputs["Roughness"].default_value = roughness
    inputs["Metallic"].default_value = metallic
    inputs["Coat Weight"].default_value = coat
    # the same colour in the viewport's solid mode
    material.diffuse_color = (*color, 1.0)
    material.roughness, material.metallic = roughness, metallic
    return material


def shader_of(material: Any) -> Any | None:
    """The Principled shader of a material, None without one."""
    tree = material.node_tree
    nodes = tree.nodes if tree is not None else ()
    return next((node for node in nodes if node.type == "BSDF_PRINCIPLED"), None)


def wood(name: str, dark: Sequence[float], light: Sequence[float], grain: Sequence[float]) -> Any:
    """A laminate between two colours (3,) of linear light.

    Its pattern repeats `grain` (3,) times a metre along x, y, z: straight fibres where one is much
    less than the others, blotches where all are alike.
    """
    material = surface(name, light, roughness=0.42)
    fibres = _noise(material, scale=grain, detail=2.0, distortion=0.0)
    _ramp(material, fibres, ((0.30, dark), (0.52, light), (0.75, [0.93 * c for c in light])))
    return material


def mottled(
    name: str, dark: Sequence[float], light: Sequence[float], scale: float, roughness: float
) -> Any:
    """A surface whose colour wanders slowly between two: concrete, painted plaster."""
    material = surface(name, light, roughness=roughness)
    stains = _noise(material, scale=(scale, scale, scale), detail=2.0, distortion=0.0)
    _ramp(material, stains, ((0.35, dark), (0.65, light)))
    return material


def _noise(material: Any, *, scale: Sequence[float], detail: float, distortion: float) -> Any:
    nodes, links = material.node_tree.nodes, material.node_tree.links
    place, stretch, noise = (
        nodes.new(f"ShaderNode{kind}") for kind in ("NewGeometry", "Mapping", "TexNoise")
    )
    stretch.inputs["Scale"].default_value = tuple(scale)
    noise.inputs["Scale"].default_value = 1.0
    noise.inputs["Detail"].default_value = detail
    noise.inputs["Distortion"].default_value = distortion
    links.new(place.outputs["Position"], stretch.inputs["Vector"])
    links.new(stretch.outputs["Vector"], noise.inputs["Vector"])
    return noise.outputs[0]


def _ramp(material: Any, value: Any, stops: Sequence[tuple[float, Sequence[float]]]) -> None:
    nodes, links = material.node_tree.nodes, material.node_tree.links
    ramp = nodes.new("ShaderNodeValToRGB")
    elements = ramp.color_ramp.elements
    while len(elements) < len(stops):
        elements.new(1.0)
    for element, (position, color) in zip(elements, stops, strict=True):
        element.position, element.color = position, (*color, 1.0)
    links.new(value, ramp.inputs["Fac"])
    links.new(ramp.outputs["Color"], shader_of(material).inputs["Base Color"])


def _is_colour(material: Any, wanted: Any) -> bool:
    color = colour_of(material)
    return color is not None and bool((np.array(color, np.float32) == wanted).all())
