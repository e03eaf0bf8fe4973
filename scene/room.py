# SPDX-License-Identifier: GPL-3.0-or-later
"""The lab round a synthetic work cell: table, floor, the two walls the camera faces, and light."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np
from numpy.typing import ArrayLike

from ..core.arrays import Array
from ..core.pose import Pose
from ..core.shape.tessellation import box
from .materials import mottled, surface, wood
from .meshes import fill_mesh
from .transforms import matrix_of
from .work_cell import Lab, Table, WorkCell

TOP_THICKNESS, SHEET = 0.036, 0.002
LEG = 0.06
WALL_BEHIND = 0.85
LINE_DISTANCE, LINE_WIDTH = 0.35, 0.06
WALL_HEIGHT, WALL_THICKNESS = 2.2, 0.1
DADO_HEIGHT = 0.95
ROOM = 9.0
STAIN = 0.68
LAMP_DISTANCE = 2.7
# nearer things than this shade each other from the ambient light, metres
AMBIENT_REACH = 0.025


@dataclass(frozen=True, eq=False)
class _Band:
    """A horizontal band of a wall, metres; it stands out from the wall's face towards the room."""

    bottom: float
    height: float
    stands_out: float
    material: Any


def build_room(scene: Any, cell: WorkCell) -> None:
    """Build all that does not move. The walls stand on the far sides, as seen from the camera."""
    _build_table(scene, cell.table, cell.lab)
    away = -np.sign(cell.camera.centre_world[:2] - cell.table.centre)
    away[away == 0] = 1.0
    _build_shell(scene, cell.table, cell.lab, away)
    _build_light(scene, cell)


def lamp_place(cell: WorkCell) -> Array:
    """Where the lamp stands in the world, (3,): what it shines on casts its shadow away from it."""
    target = np.array([*cell.table.centre, 0.1])
    if cell.lab.to_lamp is not None:
        there: Array = cell.lab.to_lamp * (LAMP_DISTANCE / np.linalg.norm(cell.lab.to_lamp))
        return target + there
    away = _far_sides(cell)
    # over the camera's shoulder and to its side, as a lamp on a tripod would stand
    side = np.array([away[1], -away[0]]) if away[0] * away[1] > 0 else np.array([-away[1], away[0]])
    return target + np.array([*(-away * 0.9 + side * 1.1), 2.3])


def _far_sides(cell: WorkCell) -> Array:
    """In x and y, the sign of the side that the camera looks towards."""
    away: Array = -np.sign(cell.camera.centre_world[:2] - cell.table.centre)
    away[away == 0] = 1.0
    return away


def _build_table(scene: Any, table: Table, lab: Lab) -> None:
    colors = lab.table_dark.tolist(), lab.table_light.tolist()
    laminate = wood("table top", *colors, lab.grain.tolist())
    edge = surface("table edge", (0.028, 0.03, 0.034), roughness=0.5)
    frame = surface("table frame", (0.42, 0.43, 0.45), roughness=0.35, metallic=0.9)
    x, y = table.centre
    # the laminate is a thin sheet on a dark core, which shows as the edge
    _block(scene, "table top", (*table.size, SHEET), (x, y, -SHEET / 2), laminate)
    core_middle = -SHEET - TOP_THICKNESS / 2
    _block(scene, "table core", (*table.size, TOP_THICKNESS), (x, y, core_middle), edge)
    below = table.height - SHEET - TOP_THICKNESS
    for signs in ((-1, -1), (-1, 1), (1, -1), (1, 1)):
        corner = table.centre + np.array(signs) * (table.size / 2 - LEG)
        middle = (*corner, below / 2 - table.height)
        _block(scene, "table leg", (LEG, LEG, below), middle, frame)


def _build_shell(scene: Any, table: Table, lab: Lab, away: Array) -> None:
    stained = (STAIN * lab.floor).tolist()
    floor = mottled("floor", stained, lab.floor.tolist(), 1.6, 0.6)
    upper = surface("wall", lab.wall.tolist(), roughness=0.9)
    lower = surface("dado", lab.dado.tolist(), roughness=0.7)
    trim = surface("trim", (0.72, 0.73, 0.74), roughness=0.6)
    ground = -table.height
    _keep_out_line(scene, table)
    _block(scene, "floor", (ROOM, ROOM, 0.1), (*table.centre, ground - 0.05), floor)
    rail = ground + DADO_HEIGHT
    bands = (
        _Band(ground, DADO_HEIGHT, 0.0, lower),
        _Band(ground, 0.08, 0.010, trim),
        _Band(rail, 0.03, 0.012, trim),
        _Band(rail, WALL_HEIGHT, 0.0, upper),
    )
    for axis in (0, 1):
        for band in bands:
            _add_wall(scene, table, axis, float(away[axis]), band)


def _keep_out_line(scene: Any, table: Table) -> None:
    """The yellow line on the floor round a robot's reach."""
    paint = surface("line", (0.78, 0.47, 0.03), roughness=0.55)
    half = table.size / 2 + LINE_DISTANCE
    for axis in (0, 1):
        for side in (-1, 1):
            size, centre = np.full(3, 0.002), np.array([*table.centre, -table.height + 0.001])
            # one pair reaches to the corners, the other ends before them
            overlap = LINE_WIDTH if axis == 0 else -LINE_WIDTH
            size[axis], size[1 - axis] = LINE_WIDTH, 2 * half[1 - axis] + overlap
            centre[axis] += side * half[axis]
            _block(scene, "line", size, centre, paint)


def _add_wall(scene: Any, table: Table, axis: int, away: float, band: _Band) -> None:
    """One band of the wall across an axis, on the side that `away` (+1 or -1) points to."""
    size, centre = np.array([ROOM, ROOM, band.height]), np.zeros(3)
    size[axis] = WALL_THICKNESS
    face = table.size[axis] / 2 + WALL_BEHIND - band.stands_out
    centre[:2] = table.centre
    centre[axis] += away * (face + WALL_THICKNESS / 2)
    centre[2] = band.bottom + band.height / 2
    _block(scene, "wall", size, centre, band.material)


def _build_light(scene: Any, cell: WorkCell) -> None:
    lab, target = cell.lab, np.array([*cell.table.centre, 0.1])
    key, watts = lamp_place(cell), lab.lamp_watts * cell.light
    _area(scene, "key", key, target, size=lab.lamp_size, watts=watts, color=(1.0, 0.96, 0.90))
    world = bpy.data.worlds.new("monocell stage")
    if bpy.app.version < (5, 0):
        world.use_nodes = True
    background = next(n for n in world.node_tree.nodes if n.type == "BACKGROUND")
    background.inputs["Color"].default_value = (0.86, 0.93, 1.0, 1.0)
    background.inputs["Strength"].default_value = lab.ambient * cell.light
    scene.world = world
    _ambient_instead_of_bounces(scene)


def _ambient_instead_of_bounces(scene: Any) -> None:
    """Ambient light with soft contact shadows: a third of the time, and half of the grain."""
    cycles = scene.cycles
    cycles.use_fast_gi, cycles.fast_gi_method = True, "REPLACE"
    cycles.ao_bounces_render = 1
    scene.world.light_settings.ao_factor = 1.0
    scene.world.light_settings.distance = AMBIENT_REACH
    # with one lamp there is nothing to choose from
    cycles.use_light_tree = False


def _area(
    scene: Any, name: str, eye: Array, target: Array, *, size: float, watts: float, color: ArrayLike
) -> None:
    light = bpy.data.lights.new(name, "AREA")
    light.shape, light.size, light.energy = "DISK", size, watts
    light.color = color
    ob = bpy.data.objects.new(name, light)
    # a lamp shines along its -z
    looking = Pose.looking_at(eye, target, [0.0, 1.0, 0.01]).inverse()
    flipped = Pose(looking.rotation @ np.diag([1.0, -1.0, -1.0]), looking.translation)
    ob.matrix_world = matrix_of(flipped)
    scene.collection.objects.link(ob)


def _block(scene: Any, name: str, size: ArrayLike, centre: ArrayLike, material: Any) -> Any:
    mesh = bpy.data.meshes.new(name)
    fill_mesh(mesh, box(size))
    mesh.materials.append(material)
    ob = bpy.data.objects.new(name, mesh)
    ob.location = tuple(np.asarray(centre, dtype=float))
    scene.collection.objects.link(ob)
    return ob
