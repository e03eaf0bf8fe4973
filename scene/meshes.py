# SPDX-License-Identifier: GPL-3.0-or-later
"""Tessellated solids into Blender's meshes, and a mesh's vertices out, sizes in metres."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..core.arrays import Array
from ..core.shape.tessellation import Tessellation


def fill_mesh(mesh: Any, shape: Tessellation) -> None:
    """Replace a mesh's geometry by a shape; its materials stay."""
    mesh.clear_geometry()
    mesh.vertices.add(len(shape.vertices))
    mesh.vertices.foreach_set("co", shape.vertices.astype(np.float32).ravel())
    mesh.loops.add(len(shape.corners))
    mesh.loops.foreach_set("vertex_index", shape.corners)
    mesh.polygons.add(len(shape.starts))
    mesh.polygons.foreach_set("loop_start", shape.starts)
    mesh.polygons.foreach_set("use_smooth", shape.smooth)
    mesh.update(calc_edges=True)


def mesh_vertices(mesh: Any) -> Array:
    """The vertices of a mesh, (N, 3), as an edit that still goes on has them."""
    if mesh.is_editmode:
        import bmesh

        edited = bmesh.from_edit_mesh(mesh).verts
        return np.array([vertex.co for vertex in edited], dtype=float).reshape(-1, 3)
    values = np.empty(len(mesh.vertices) * 3, np.float32)
    mesh.vertices.foreach_get("co", values)
    return values.reshape(-1, 3).astype(float)
