# SPDX-License-Identifier: GPL-3.0-or-later
"""One picture of every way to pick an object out: `python docs/make_modelling_pictures.py`.

What is drawn is what `choose` makes of the picks, not what they were taken from.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import cv2
import numpy as np
from modelling_scenes import CAMERA, FLOOR, REFERENCES, ROPE, SCENES, WALL, Scene
from monocell.core.arrays import Array
from monocell.core.modelling.candidates import choose
from monocell.core.primitives import Primitive
from monocell.core.shape.curves import curves_seen
from monocell.core.shape.tessellation import tessellated

HERE = Path(__file__).parent / "pictures"
FINER, FONT = 3, cv2.FONT_HERSHEY_DUPLEX
PAPER, GRID, WALL_GRID, ROPE_INK = (252, 250, 248), (226, 220, 214), (218, 214, 224), (90, 120, 60)
INK, FAINT = (70, 60, 50), (170, 160, 150)
SOLID, OTHER = np.array([222.0, 178.0, 128.0]), np.array([206.0, 206.0, 206.0])
LIGHT = np.array([0.35, -0.6, 0.75]) / np.linalg.norm([0.35, -0.6, 0.75])
ROLES = {
    "base": (40, 90, 220),
    "rim": (40, 90, 220),
    "outline": (40, 90, 220),
    "top": (150, 50, 170),
    "apex": (150, 50, 170),
    "sides": (50, 140, 40),
    "hole": (170, 120, 0),
}


@dataclass(eq=False)
class Canvas:
    """A picture three times as large as it will be, and where labels stand in it already."""

    image: Array
    taken: list[tuple[float, float, float, float]] = field(default_factory=list)

    def line(self, points_world: Array, colour: tuple[int, int, int], width: float) -> None:
        """A chain of world points."""
        pixels = CAMERA.project(points_world) * FINER
        if np.isfinite(pixels).all():
            chain = np.round(pixels * 16).astype(np.int32)[None]
            thick = max(round(width * FINER), 1)
            cv2.polylines(self.image, chain, False, colour, thick, cv2.LINE_AA, 4)


def main() -> None:
    """Write all pictures."""
    HERE.mkdir(exist_ok=True)
    for scene in SCENES:
        intrinsics = CAMERA.intrinsics
        size = (intrinsics.height * FINER, intrinsics.width * FINER, 3)
        canvas = Canvas(np.full(size, PAPER, dtype=np.uint8))
        chosen = choose(CAMERA, scene.sketch, REFERENCES, scene.things, 1.0)
        _references(canvas, scene)
        # what holds the object stands behind it in all of these
        for thing, colour in (
            *((t, OTHER) for t in scene.things.values()),
            (chosen.fitted.thing, SOLID),
        ):
            _solid(canvas, thing, colour)
            _edges(canvas, thing)
        _picks(canvas, scene.sketch.picks)
        small = cv2.resize(
            canvas.image, None, fx=1 / FINER, fy=1 / FINER, interpolation=cv2.INTER_AREA
        )
        cv2.imwrite(str(HERE / f"pick_{scene.file}.png"), small, [cv2.IMWRITE_PNG_COMPRESSION, 9])
        print(scene.file, *chosen.warnings, sep="\n  ")


def _references(canvas: Canvas, scene: Scene) -> None:
    marks = np.arange(-4, 5) * 0.1
    for plane, colour, shown in ((FLOOR, GRID, True), (WALL, WALL_GRID, "wall" in scene.shown)):
        if shown:
            level = [-0.4, 0.4] if plane is FLOOR else [0.0, 0.5]
            across = marks if plane is FLOOR else np.arange(0, 6) * 0.1
            frame = plane.world_from_plane
            for mark in marks:
                canvas.line(frame.apply([[mark, level[0], 0], [mark, level[1], 0]]), colour, 1)
            for mark in across:
                canvas.line(frame.apply([[-0.4, mark, 0], [0.4, mark, 0]]), colour, 1)
    if "rope" in scene.shown:
        canvas.line(ROPE.point + np.outer([0.0, 0.6], ROPE.direction), ROPE_INK, 2)


def _solid(canvas: Canvas, thing: Primitive, own_colour: Array) -> None:
    """All faces that are turned towards the camera, the farthest first."""
    faces = []
    solid = tessellated(thing)
    points = thing.world_from_object.apply(solid.vertices)
    for corners in solid.triangles:
        a, b, c = points[corners]
        normal = np.cross(b - a, c - a)
        sight = CAMERA.centre_world - (a + b + c) / 3
        length = float(np.linalg.norm(normal))
        if length > 0 and normal @ sight > 0:
            shade = 0.62 + 0.38 * max(float(normal @ LIGHT) / length, 0.0)
            faces.append((float(np.linalg.norm(sight)), points[corners], own_colour * shade))
    for _, triangle, colour in sorted(faces, key=lambda f: -f[0]):
        pixels = np.round(CAMERA.project(triangle) * FINER * 16).astype(np.int32)
        # no seam between neighbours: the fill is drawn with a rim of its own colour
        cv2.fillPoly(canvas.image, [pixels], colour.tolist(), cv2.LINE_8, 4)
        cv2.polylines(canvas.image, [pixels], True, colour.tolist(), 2, cv2.LINE_8, 4)


def _edges(canvas: Canvas, thing: Primitive) -> None:
    seen = curves_seen(thing, CAMERA)
    for i in range(len(seen)):
        one = seen.chosen(np.array([i]))
        start, end = seen.ends[i]
        t = np.linspace(start, end, 97)
        points = thing.world_from_object.apply(one.points(t[:, None])[:, 0])
        if seen.visible[i]:
            canvas.line(points, INK, 1.4)
        else:
            for k in range(0, 96, 8):
                canvas.line(points[k : k + 5], FAINT, 1)


def _picks(canvas: Canvas, picks: Mapping[str, list]) -> None:
    marked = [(r, i, np.array(p)) for r, ps in picks.items() for i, p in enumerate(ps) if p]
    middle = np.mean([p for _, _, p in marked], axis=0)
    for role, _, pixel in marked:
        at = tuple(int(v) for v in np.round(pixel * FINER * 16))
        cv2.circle(canvas.image, at, 6 * FINER * 16, (255, 255, 255), -1, cv2.LINE_AA, 4)
        cv2.circle(canvas.image, at, round(4.2 * FINER * 16), ROLES[role], -1, cv2.LINE_AA, 4)
        canvas.taken.append((*(pixel - 7), *(pixel + 7)))
    for role, i, pixel in marked:
        _label(canvas, f"{role}[{i}]", pixel, pixel - middle, ROLES[role])


def _label(
    canvas: Canvas, text: str, pixel: Array, away: Array, colour: tuple[int, int, int]
) -> None:
    """Beside its pick, on the side away from the others, where nothing else stands."""
    scale = 0.42
    (width, height), _ = cv2.getTextSize(text, FONT, scale * FINER, FINER)
    size = np.array([width, height]) / FINER
    first = np.arctan2(away[1], away[0])
    for reach in (14.0, 20.0, 28.0, 38.0):
        for turn in (0.0, 0.5, -0.5, 1.0, -1.0, 1.6, -1.6, 2.3, -2.3, 3.1):
            to = np.array([np.cos(first + turn), np.sin(first + turn)])
            middle = pixel + to * (reach + np.abs(to) @ size / 2 - 4)
            low, high = middle - size / 2 - 2, middle + size / 2 + 2
            inside = (low > 2).all() and (
                high < [canvas.image.shape[1] / FINER - 2, canvas.image.shape[0] / FINER - 2]
            ).all()
            if inside and not any(
                low[0] < c and a < high[0] and low[1] < d and b < high[1]
                for a, b, c, d in canvas.taken
            ):
                canvas.taken.append((*low, *high))
                left = tuple(int(v) for v in np.round((middle + size * [-0.5, 0.5]) * FINER))
                for ink, thick in (((255, 255, 255), 5 * FINER), (colour, FINER)):
                    cv2.putText(
                        canvas.image, text, left, FONT, scale * FINER, ink, thick, cv2.LINE_AA
                    )
                return


if __name__ == "__main__":
    main()
