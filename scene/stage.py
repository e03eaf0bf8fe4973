# SPDX-License-Identifier: GPL-3.0-or-later
"""A synthetic robot cell built once in a Blender scene of its own, then moved and rendered often.

with Stage(cell) as stage:
    for parts, ball in poses:
        stage.move(parts, ball)
        stage.render("pose.png")
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import bpy
import numpy as np
from mathutils import Matrix

from ..core.arrays import Array
from ..core.camera import Camera
from ..core.closing import Closing
from ..core.mesh_part import MeshPart
from ..core.pose import Pose
from ..core.primitives import Primitive
from ..core.shape.tessellation import Tessellation, box, cylinder, sphere, tessellated
from .arm_meshes import import_mesh
from .gripper import Block, grip_frame, gripper_blocks
from .materials import PLAIN, surface
from .meshes import fill_mesh
from .panel import STUB_RADIUS, build_panel, remove_print, stub_centre
from .rendering import render_linear, render_picture, render_window
from .room import build_room
from .textures import is_textured, painted_mesh
from .transforms import matrix_of
from .work_cell import Ball, Panel, WorkCell

# the outline is within 0.01 px of a true sphere's up to a radius of 460 px in the picture
BALL_SEGMENTS = 512
SAMPLES = 4
BOUNCES = 1


class Stage(Closing):
    """A work cell in Blender. The user's own scenes are left alone; `close` takes all away."""

    def __init__(self, cell: WorkCell) -> None:
        self.cell = cell
        self.scene = bpy.data.scenes.new("monocell stage")
        self._arm: list[tuple[Path, tuple[Any, ...]]] = []
        self._ball: Any = None
        self._gripper: list[Any] = []
        self._panel: list[Any] = []
        self._images: list[Any] = []
        # what did not move is not sent to Cycles again
        self.scene.render.use_persistent_data = True
        build_room(self.scene, cell)
        for thing in cell.objects:
            self._add_object(thing)
        self.move(cell.parts, cell.ball)

    def __enter__(self) -> Stage:
        return self

    def move(self, parts: tuple[MeshPart, ...], ball: Ball | None) -> None:
        """Put the arm and the ball elsewhere. Meshes are read from disk the first time only."""
        if [part.path for part in parts] != [path for path, _ in self._arm]:
            self._remove_arm()
            self._arm = [(part.path, import_mesh(self.scene, part)) for part in parts]
        for part, (_, obs) in zip(parts, self._arm, strict=True):
            placed = matrix_of(part.world_from_mesh) @ Matrix.Diagonal((*part.scale, 1.0))
            for ob in obs:
                ob.matrix_world = placed
        self._remove_panel()
        self._show_ball(ball)

    def hold(self, panel: Panel | None) -> None:
        """Put a printed panel into the gripper in the ball's stead, or take it away."""
        self._remove_panel()
        self._remove_ball()
        if panel is None:
            return
        self._panel = build_panel(self.scene, panel)
        if panel.world_from_flange is not None:
            self._show_gripper(stub_centre(panel), STUB_RADIUS, panel.world_from_flange)

    def render(
        self, path: str | Path, *, camera: Camera | None = None, samples: int = SAMPLES
    ) -> None:
        """Render a PNG as the cell's camera, or another, sees it. Errors as `render_picture`."""
        camera = camera or self.cell.camera
        render_picture(self.scene, camera, path, samples=samples, bounces=BOUNCES)

    def linear(self, *, camera: Camera | None = None, samples: int = SAMPLES) -> Array:
        """The same as linear light, (H, W, 3)."""
        camera = camera or self.cell.camera
        return render_linear(self.scene, camera, samples=samples, bounces=BOUNCES)

    def window(
        self,
        window: tuple[int, int, int, int],
        *,
        camera: Camera | None = None,
        samples: int = SAMPLES,
    ) -> Array:
        """Linear light of `window` (x, y, width, height) of the picture alone, (height, width, 3).

        Raises InvalidValue for a window that is not inside the picture.
        """
        camera = camera or self.cell.camera
        return render_window(self.scene, camera, window, samples=samples, bounces=BOUNCES)

    def close(self) -> None:
        """Remove the scene and all that was built for it."""
        # Cycles lets go of the scene; without this Blender crashes when it ends
        self.scene.render.use_persistent_data = False
        remove_print(self._panel)
        obs, world = list(self.scene.collection.all_objects), self.scene.world
        bpy.data.scenes.remove(self.scene)
        _remove(obs)
        bpy.data.batch_remove(self._images)
        bpy.data.worlds.remove(world)

    def _add_object(self, thing: Primitive) -> None:
        if is_textured(thing):
            mesh, made = painted_mesh(thing, self.cell.folder)
            # the rest goes with its object
            self._images += [each for each in made if isinstance(each, bpy.types.Image)]
            ob = self._link(thing.name, mesh)
        else:
            color = PLAIN if thing.appearance is None else tuple(thing.appearance.color)
            material = surface(thing.name, color, roughness=0.38)
            ob = self._add(thing.name, tessellated(thing), material)
        ob.matrix_world = matrix_of(thing.world_from_object)

    def _show_ball(self, ball: Ball | None) -> None:
        if ball is None or self._ball is None or self._ball["radius"] != ball.radius:
            self._remove_ball()
        if ball is None:
            return
        if self._ball is None:
            self._add_ball(ball)
        self._ball.location = ball.center_world.tolist()
        if ball.world_from_flange is None:
            self._remove_gripper()
            return
        self._show_gripper(ball.center_world, ball.radius, ball.world_from_flange)

    def _show_gripper(self, centre: Array, radius: float, world_from_flange: Pose) -> None:
        world_from_grip = grip_frame(centre, world_from_flange)
        reach = float(np.linalg.norm(centre - world_from_flange.translation))
        blocks = gripper_blocks(radius, reach)
        if len(self._gripper) != len(blocks):
            self._remove_gripper()
            self._gripper = [self._add_block(block) for block in blocks]
        for ob, block in zip(self._gripper, blocks, strict=True):
            ob.matrix_world = matrix_of(world_from_grip @ block.grip_from_block)

    def _add_ball(self, ball: Ball) -> None:
        material = surface("ball", ball.color.tolist(), roughness=ball.roughness)
        self._ball = self._add("ball", sphere(ball.radius, BALL_SEGMENTS), material)
        self._ball["radius"] = ball.radius

    def _add_block(self, block: Block) -> Any:
        x, _, z = block.size
        shape = cylinder(x / 2, z, 64) if block.round else box(block.size)
        color = (0.55, 0.56, 0.58) if block.metal else (0.035, 0.037, 0.042)
        material = surface(
            block.name, color, roughness=0.35 if block.metal else 0.45, metallic=float(block.metal)
        )
        return self._add(block.name, shape, material)

    def _add(self, name: str, shape: Tessellation, material: Any) -> Any:
        mesh = bpy.data.meshes.new(name)
        fill_mesh(mesh, shape)
        mesh.materials.append(material)
        return self._link(name, mesh)

    def _link(self, name: str, mesh: Any) -> Any:
        ob = bpy.data.objects.new(name, mesh)
        self.scene.collection.objects.link(ob)
        return ob

    def _remove_arm(self) -> None:
        _remove([ob for _, obs in self._arm for ob in obs])
        self._arm = []

    def _remove_ball(self) -> None:
        if self._ball is not None:
            _remove([self._ball])
        self._ball = None
        self._remove_gripper()

    def _remove_panel(self) -> None:
        remove_print(self._panel)
        _remove(self._panel)
        self._panel = []

    def _remove_gripper(self) -> None:
        _remove(self._gripper)
        self._gripper = []


def _remove(obs: list[Any]) -> None:
    """Objects with their data and the materials that nobody else uses."""
    data = {ob.data for ob in obs}
    materials = {m for d in data for m in getattr(d, "materials", ()) if m is not None}
    bpy.data.batch_remove([*obs, *data])
    bpy.data.batch_remove([material for material in materials if material.users == 0])
