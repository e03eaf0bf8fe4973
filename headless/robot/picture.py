# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture of the robot scene and a path through it: joint angles in, a PNG out."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import ArrayLike

from ...core.appearance import Appearance
from ...core.arrays import Array
from ...core.atomic import atomic_path
from ...core.errors import InvalidValue, PictureError
from .environment import WorldMesh
from .light import srgb_from_linear
from .scene import RobotScene
from .shading import backdrop, lit, open_sky, surface, with_floor
from .stage import Layer, Stage, View
from .tessellation import ball, rod, triangles_of

TABLE, FLOOR, UNPAINTED = (np.full(3, 0.78), np.full(3, 0.5), np.array([0.45, 0.47, 0.5]))
BALL, STEM = np.array([0.9, 0.35, 0.03]), np.full(3, 0.08)
FREE, BLOCKED = np.array([0.01, 0.42, 0.16]), np.array([0.75, 0.015, 0.02])
GHOST_STRENGTH = 0.3
BEAD_RADIUS, BEAD_SPACING = 0.0065, 0.024
# the picture is made at twice its size and averaged down
FINER = 2
SHADOW_PIXELS = 1600


def draw_scene(
    scene: RobotScene,
    out: str | Path,
    *,
    joints: ArrayLike,
    path: ArrayLike | None = None,
    blocked: ArrayLike | None = None,
    ghosts: int = 3,
    view: View | None = None,
    size: tuple[int, int] = (960, 720),
) -> None:
    """Write a PNG of the arm at `joints` (n,) among its obstacles.

    The way of the held ball (of the flange without one) along `path` (N, n) is drawn as green
    beads, with `ghosts` transparent arms on it, the last at its end; along `blocked` (M, n), a
    motion that can't be, as red ones. Objects have their own colours. Without `view` the picture
    shows all of it, with the objects in front of the arm.
    """
    if min(size) < 16:
        raise InvalidValue(f"size: {size[0]} x {size[1]} px is too small for a picture")
    here = scene.arm.checked(joints)
    along = None if path is None else np.array([scene.arm.checked(q) for q in np.asarray(path)])
    cut = None if blocked is None else np.array([scene.arm.checked(q) for q in np.asarray(blocked)])
    traces = [
        (_trace(scene, q), color) for q, color in ((cut, BLOCKED), (along, FREE)) if q is not None
    ]
    eye = view or default_view(scene, here, [points for points, _ in traces], size)
    light = _painted(scene, here, traces, eye, _ghost_poses(along, ghosts), size)
    small = cv2.resize(light.astype(np.float32), size, interpolation=cv2.INTER_AREA)
    _write(srgb_from_linear(_exposed(small.astype(float))), Path(out))


def default_view(
    scene: RobotScene, joints: Array, traces: Sequence[Array], size: tuple[int, int]
) -> View:
    """An eye beyond the objects, to one side and above, from where all of it is in the picture."""
    arm = scene.arm
    base = arm.world_from_base.translation
    corners = [triangles_of(thing).vertices for thing in scene.objects]
    corners += [mesh.vertices for mesh in scene.meshes]
    links = np.array([part.world_from_mesh.translation for part in arm.parts(joints)])
    things = np.vstack(corners or [base[None] + [[0.5, 0, 0]]])
    every = np.vstack([things, links, base[None], *traces])
    middle = (every.min(axis=0) + every.max(axis=0)) / 2
    radius = float(np.linalg.norm(every - middle, axis=1).max()) + 0.1
    outward = things.mean(axis=0) - base
    azimuth = np.arctan2(outward[1], outward[0]) - 0.75
    elevation, angle = 0.46, 0.56
    tightest = angle * min(1.0, size[0] / size[1])
    distance = 0.86 * radius / np.sin(tightest / 2)
    level = np.cos(elevation)
    direction = [level * np.cos(azimuth), level * np.sin(azimuth), np.sin(elevation)]
    far = distance + 3 * radius + 2
    eye = middle + distance * np.array(direction)
    return View(eye, middle, angle, max(0.05, distance - 2 * radius), far)


def _painted(
    scene: RobotScene,
    joints: Array,
    traces: Sequence[tuple[Array, Array]],
    view: View,
    ghosts: Sequence[Array],
    size: tuple[int, int],
) -> Array:
    """Linear light at FINER times the size."""
    width, height = size[0] * FINER, size[1] * FINER
    with Stage() as stage:
        colors = _dressed(stage, scene)
        colors |= _posed(stage, scene, joints)
        sun = stage.seen(_sun(view), SHADOW_PIXELS, SHADOW_PIXELS)
        for points, color in traces:
            for bead in _spaced(points):
                colors[stage.add_mesh(ball("bead", bead, BEAD_RADIUS, rings=8))] = color
        solid = stage.seen(view, width, height)
    seen, mist = with_floor(surface(solid, colors), solid, _floor_height(scene), FLOOR)
    behind = backdrop(height, width)
    light = lit(seen, sun, open_sky(seen, solid))
    light = np.where(seen.there[..., None], light, behind)
    light += (behind - light) * mist[..., None]
    for pose in ghosts:
        light = _haunted(light, solid, scene, pose, sun)
    return light


def _dressed(stage: Stage, scene: RobotScene) -> dict[int, Array]:
    """Put everything on the stage that stands still; the colours by number."""
    colors = {}
    for thing in scene.objects:
        colors[stage.add_mesh(triangles_of(thing))] = _paint(thing.appearance)
    for mesh in scene.meshes:
        colors[stage.add_mesh(mesh)] = UNPAINTED
    if scene.table is not None:
        colors[stage.add_mesh(triangles_of(scene.table))] = TABLE
    return colors


def _posed(stage: Stage, scene: RobotScene, joints: Array) -> dict[int, Array]:
    """Put the arm and what it holds on the stage; the colours by number."""
    colors = {stage.add_part(part): part.color for part in scene.arm.parts(joints)}
    for mesh, color in _held(scene, joints):
        colors[stage.add_mesh(mesh)] = color
    return colors


def _held(scene: RobotScene, joints: Array) -> list[tuple[WorldMesh, Array]]:
    held = scene.arm.ball
    if held is None:
        return []
    center = scene.arm.ball_center(joints)
    meshes = [(ball("ball", center, held.radius), BALL)]
    flange = scene.arm.world_from_flange(joints).translation
    if held.stem_radius is not None and np.linalg.norm(center - flange) > 1e-6:
        meshes.append((rod("stem", flange, center, held.stem_radius), STEM))
    return meshes


def _haunted(light: Array, solid: Layer, scene: RobotScene, joints: Array, sun: Layer) -> Array:
    """The picture with a transparent arm in it, hidden where something solid is nearer.

    Made at the picture's final size: no eye finds the steps on an edge as faint as that.
    """
    rows, columns = (n // FINER for n in solid.depth.shape)
    with Stage() as stage:
        colors = _posed(stage, scene, joints)
        layer = stage.seen(solid.view, columns, rows)
    seen = surface(layer, colors)
    above = seen.there & (layer.depth < solid.depth[::FINER, ::FINER])
    glow = lit(seen, _nothing_between(sun), np.ones(above.shape))
    strength = GHOST_STRENGTH * above[..., None].astype(float)
    mixed = np.concatenate([glow * strength, strength], axis=2)
    full = cv2.resize(mixed, light.shape[1::-1], interpolation=cv2.INTER_LINEAR)
    mixed_in: Array = light * (1 - full[..., 3:]) + full[..., :3]
    return mixed_in


def _nothing_between(sun: Layer) -> Layer:
    return Layer(sun.view, np.full((2, 2), np.inf), np.full((2, 2), -1))


def _trace(scene: RobotScene, poses: Array) -> Array:
    """Where the ball's centre, or the flange, goes: (N, 3)."""
    arm = scene.arm
    if arm.ball is not None:
        return np.array([arm.ball_center(q) for q in poses])
    return np.array([arm.world_from_flange(q).translation for q in poses])


def _spaced(points: Array) -> Array:
    """Points at even distances along a line of points (N, 3)."""
    lengths = np.concatenate([[0], np.linalg.norm(np.diff(points, axis=0), axis=1).cumsum()])
    count = max(2, round(float(lengths[-1]) / BEAD_SPACING))
    at = np.linspace(0, lengths[-1], count)
    return np.stack([np.interp(at, lengths, points[:, i]) for i in range(3)], axis=1)


def _ghost_poses(path: Array | None, count: int) -> list[Array]:
    if path is None or count < 1:
        return []
    return [path[round(i * (len(path) - 1) / count)] for i in range(1, count + 1)]


def _sun(view: View) -> View:
    """From above, at the viewer's left shoulder, far enough that its rays are nearly parallel."""
    away = view.eye - view.target
    azimuth = np.arctan2(away[1], away[0]) - 0.9
    direction = np.array([0.55 * np.cos(azimuth), 0.55 * np.sin(azimuth), 0.84])
    return View(view.target + 7.0 * direction, view.target, 0.36, 4.5, 10.0)


def _floor_height(scene: RobotScene) -> float:
    if scene.table is not None:
        return float(scene.table.corners_world()[:, 2].min()) - 0.001
    return float(scene.arm.world_from_base.translation[2])


def _paint(appearance: Appearance | None) -> Array:
    return UNPAINTED if appearance is None else np.clip(appearance.color, 0.015, 0.9)


def _exposed(light: Array) -> Array:
    """Highlights rolled off, so that nothing bright turns into a flat patch."""
    return np.where(light < 0.6, light, 1 - 0.4 * np.exp(-(light - 0.6) / 0.4))


def _write(screen: Array, out: Path) -> None:
    pixels = np.rint(screen * 255).astype(np.uint8)[..., ::-1]
    done, data = cv2.imencode(".png", pixels)
    if not done:
        raise PictureError(f"{out}: OpenCV can't write this picture as PNG")
    with atomic_path(out) as temporary:
        temporary.write_bytes(data.tobytes())
