# SPDX-License-Identifier: GPL-3.0-or-later
"""What has to hold of a scene after any step: scene in, its document out, or an AssertionError."""

from __future__ import annotations

import json

import numpy as np
from monocell.core.document.cell_file import document_from_cell, read_cell
from monocell.core.shape.tessellation import tessellated
from panels_drawn import draw_panels

# a mesh is taken for its kind where it is that near, a share of its size
SHAPE_SHARE = 4e-3


def check_scene(bpy, module, folder):
    """Check document, lists, overlay and panels against each other. Returns the document's text.

    A scene without a cell gives an empty text; one with an object that is no longer of its kind the
    refusal, which is one line.
    """
    scene = bpy.context.scene
    draw_panels(bpy, module)
    if not scene.monocell_cell.text:
        return ""
    path = folder / "now.cell.json"
    _check_overlay(bpy, module)
    try:
        # saving by the operator makes the file the scene's own, and a check changes nothing
        written = module("addon.cell.document").read_scene(scene)
        module("core.document.cell_file").write_cell(written, path)
    except module("core.errors").MonocellError as refusal:
        assert "\n" not in str(refusal), refusal
        return f"Error: {refusal}"
    cell = read_cell(path)
    assert document_from_cell(cell, folder) == json.loads(path.read_text())
    _check_rows(scene.monocell_cell, cell)
    _check_objects(bpy, module, cell)
    return path.read_text()


def _check_rows(stored, cell):
    """The lists of the sidebar show what the document has."""
    rows, references = list(stored.sightings), list(stored.references)
    assert [row.index for row in rows] == list(range(len(cell.sightings)))
    for row, sighting in zip(rows, cell.sightings, strict=True):
        assert row.use == sighting.use
        assert row.radius == np.float32(getattr(sighting, "radius", 0.0))
        if sighting.center_world is not None:
            assert tuple(row.center) == tuple(np.float32(sighting.center_world))
    assert [row.name for row in references] == [one.name for one in cell.references]
    assert 0 <= stored.reference_index < len(references)
    assert 0 <= stored.sighting_index < max(1, len(rows))


def _check_objects(bpy, module, cell):
    """Every object is where the document has it, as Blender shows it."""
    objects = module("scene.objects")
    modelled = [ob for ob in bpy.context.scene.objects if objects.is_modelled(ob)]
    assert len(modelled) == len(cell.objects), ([ob.name for ob in modelled], cell.objects)
    if bpy.context.mode != "OBJECT":
        # the mesh is Blender's own until the mode is left
        return
    graph = bpy.context.evaluated_depsgraph_get()
    for ob, thing in zip(modelled, cell.objects, strict=True):
        # where a hidden object stands Blender may not know before it is shown
        if not ob.data.vertices or not ob.visible_get():
            continue
        place = ob.evaluated_get(graph).matrix_world
        seen = np.array([place @ vertex.co for vertex in ob.data.vertices])
        told = thing.world_from_object.apply(tessellated(thing).vertices)
        off = max(
            np.abs(seen.min(axis=0) - told.min(axis=0)).max(),
            np.abs(seen.max(axis=0) - told.max(axis=0)).max(),
        )
        assert off <= SHAPE_SHARE * np.ptp(told, axis=0).max(), (ob.name, thing.kind, off, place)


def _check_overlay(bpy, module):
    """All that would be drawn can be computed, and is finite."""
    scene, document, lines = (
        bpy.context.scene,
        module("addon.cell.document"),
        module("addon.overlay.overlay_lines"),
    )
    cell, report = document.bare_cell(scene), document.stored_report(scene)
    stored = scene.monocell_cell
    look = module("addon.preferences").settings(bpy.context)
    strokes = list(
        lines.sighting_strokes(cell, report, stored.sighting_index, look, stored.shown_picture)
    )
    list(lines.sighting_labels(cell, report, look))
    if cell.camera.camera_from_world is not None:
        plane = document.active_plane(scene)
        grid = (
            None
            if plane is None
            else module("addon.overlay.plane_grid").plane_grid(cell.camera, plane)
        )
        strokes += [] if grid is None else list(lines.grid_strokes(grid, look))
        wires = module("addon.overlay.object_lines")
        for ob in scene.objects:
            if module("scene.objects").is_modelled(ob):
                wires._object_key(ob, True)
                wires._lines_of(scene, ob, True, look)
    for stroke in strokes:
        assert all(np.isfinite(line).all() for line in stroke.lines), stroke
