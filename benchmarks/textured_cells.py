# SPDX-License-Identifier: GPL-3.0-or-later
"""Random table tops with printed objects: a seed in, the true cell and its printed faces out."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
from monocell.core.appearance import Appearance, Texture
from monocell.core.camera import Camera
from monocell.core.cell import Cell
from monocell.core.distortion import Distortion
from monocell.core.intrinsics import Intrinsics
from monocell.core.pose import Pose
from monocell.core.primitives import Box, Cone, Cylinder, Primitive, Prism, Sphere, Tube
from monocell.core.reference import ReferencePlane
from monocell.core.shape.charts import chart_of
from monocell.core.shape.hits import face_names

TABLE = ReferencePlane("table", np.zeros(3), np.array([0.0, 0.0, 1.0]))
KINDS = ("box", "box", "cylinder", "prism", "cone", "tube", "cylinder", "sphere", "box")
TEXELS_PER_METRE = 1600.0
# two objects are of one colour
PLAIN = (0, 6)


def textured_cell(seed: int, folder: Path, kinds: tuple[str, ...] = KINDS) -> Cell:
    """The cell with its textures written to `folder`; they are named absolutely."""
    rng = np.random.default_rng(seed)
    camera = _camera(rng)
    objects: list[Primitive] = []
    for number, kind in enumerate(kinds):
        thing = _placed(rng, f"{kind}{number}", kind, objects)
        color = rng.uniform(0.04, 0.75, 3)
        textures = {}
        if number not in PLAIN:
            textures = {
                face: Texture(str(_print(rng, thing, face, color, folder)))
                for face in face_names(thing)
            }
        objects.append(replace(thing, appearance=Appearance(color, textures)))
    return Cell(camera, "cell.png", references=(TABLE,), objects=tuple(objects), folder=folder)


def turned_aside(camera: Camera, degrees: float) -> Camera:
    """The camera carried round the middle of the table top about the vertical."""
    middle = Pose(np.eye(3), np.array([0.4, 0.0, 0.0]))
    turn = Pose.from_rotation_vector([0, 0, np.radians(degrees)], np.zeros(3))
    return camera.placed(camera.pose @ middle @ turn @ middle.inverse())


def _camera(rng: np.random.Generator) -> Camera:
    k1 = rng.uniform(-0.2, -0.08)
    lens = Distortion("plumb_bob", np.array([k1, -0.35 * k1, 0.0005, -0.0004, 0.0]))
    focal = rng.uniform(1020, 1120)
    inner = Intrinsics(960, 720, focal, 0.997 * focal, 489.0, 351.0, lens)
    around = np.radians(rng.uniform(-55, 55))
    eye = [0.4 + 1.25 * np.cos(around), 1.25 * np.sin(around), rng.uniform(0.7, 1.0)]
    return Camera(inner, Pose.looking_at(eye, [0.4, 0, 0.06], [0, 0, 1]))


def _placed(rng: np.random.Generator, name: str, kind: str, others: list[Primitive]) -> Primitive:
    """A thing on the table that stands in no other."""
    for _ in range(500):
        thing = _thing(rng, name, kind)
        here = thing.world_from_object.translation[:2]
        reach = np.linalg.norm(thing.half_extent[:2])
        if all(
            np.linalg.norm(here - other.world_from_object.translation[:2])
            > reach + np.linalg.norm(other.half_extent[:2])
            for other in others
        ):
            return thing
    raise RuntimeError(f"{name}: no room left on the table")


def _thing(rng: np.random.Generator, name: str, kind: str) -> Primitive:
    place, turn = rng.uniform([0.12, -0.32], [0.68, 0.32]), rng.uniform(0, 2 * np.pi)
    radius, height = rng.uniform(0.025, 0.055), rng.uniform(0.05, 0.16)
    up = radius if kind == "sphere" else height / 2
    pose = Pose.from_rotation_vector([0, 0, turn], [*place, up])
    if kind == "box":
        sizes = np.array([*rng.uniform(0.05, 0.13, 2), height])
        return Box(name, pose, on="table", size=sizes)
    if kind == "cylinder":
        return Cylinder(name, pose, on="table", radius=radius, height=height)
    if kind == "cone":
        return Cone(name, pose, on="table", radius=radius, top_radius=radius / 2, height=height)
    if kind == "tube":
        return Tube(name, pose, on="table", radius=radius, inner_radius=0.75 * radius,
                    height=height)  # fmt: skip
    if kind == "sphere":
        return Sphere(name, pose, on="table", radius=radius)
    angles = np.arange(5) * 2 * np.pi / 5
    corners = 1.2 * radius * np.stack([np.cos(angles), np.sin(angles)], 1)
    return Prism(name, pose, on="table", polygon=corners, height=height)


def _print(
    rng: np.random.Generator, thing: Primitive, face: str, color: np.ndarray, folder: Path
) -> Path:
    """A label with letters, bars and blotches, as finely printed as a photo would show."""
    chart = chart_of(thing, face)
    middle = np.array([[0.5, 0.5]])
    size = [
        np.linalg.norm(chart.points(middle + step) - chart.points(middle - step)) / 2e-3
        for step in ([[1e-3, 0]], [[0, 1e-3]])
    ]
    columns, rows = (int(max(48, TEXELS_PER_METRE * length)) for length in size)
    encoded = 255 * color[::-1] ** (1 / 2.2)
    blotches = cv2.resize(
        rng.normal(0, 18, (rows // 24 + 2, columns // 24 + 2)).astype(np.float32),
        (columns, rows),
        interpolation=cv2.INTER_CUBIC,
    )
    label = np.clip(encoded + blotches[..., None], 0, 255).astype(np.uint8)
    ink = tuple(int(v) for v in (255 - encoded if encoded.mean() > 127 else [235, 240, 245]))
    bars = np.cumsum(rng.integers(6, 22, 8))
    for left, right in zip(bars[::2], bars[1::2], strict=True):
        cv2.rectangle(label, (int(left), int(0.7 * rows)), (int(right), rows - 8), ink, -1)
    paint = tuple(int(v) for v in rng.uniform(20, 235, 3))
    for corner in (0, columns // 2):
        cv2.circle(label, (corner + columns // 4, rows // 2), rows // 6, paint, -1, cv2.LINE_AA)
    scale = min(columns / 160, rows / 80)
    text = f"{thing.name} {face}"
    for corner in (6, columns // 2):
        cv2.putText(label, text, (corner, int(0.3 * rows)), 0, 0.5 * scale, ink,
                    max(1, round(1.4 * scale)), cv2.LINE_AA)  # fmt: skip
    path = (folder / f"print.{thing.name}.{face}.png").resolve()
    cv2.imwrite(str(path), label)
    return path
