# SPDX-License-Identifier: GPL-3.0-or-later
"""A pixel in, the face, edge or axis of an object, or the reference, that it shows out."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...core.arrays import Array
from ...core.camera import Camera
from ...core.cell import Cell
from ...core.modelling.reverse_mapping import points_on_plane_or_nan
from ...core.primitives import Box, Primitive, Prism, Sphere
from ...core.reference import ReferencePlane
from ...core.shape.features import feature, feature_names
from ...core.shape.hits import bounds, face_names, hits, occluded
from ...core.shape.intervals import BOX_FACES

CIRCLE = np.linspace(0.0, 2 * np.pi, 65)
# an axis is drawn so far beyond the ends of its object
BEYOND = 1.25
# an edge lies on its own object, which must not count as hiding it, metres
OWN_SURFACE = 1e-3


@dataclass(frozen=True, eq=False)
class Shown:
    """What a pixel shows: the `path` of a feature (`crate.top`) or the name of a reference.

    `line` (N, 3) in the world is what to draw of it, empty for a reference.
    """

    path: str
    kind: str
    line: Array


def shown_at(
    cell: Cell,
    pixel: Array,
    reach: float,
    *,
    axis: bool = False,
    hidden: Collection[str] = (),
) -> Shown | None:
    """The edge within `reach` pixels of a pixel (2,), else the face there, else the plane there.

    Of a round side the axis is meant; with `axis` of whatever object is there. Objects of the names
    `hidden` are looked through. None where the pixel shows nothing that could be a reference, such
    as a ball.
    """
    camera = cell.standing_camera()
    there = [thing for thing in cell.objects if thing.name not in hidden]
    near = [thing for thing in there if _near(thing, camera, pixel, reach)]
    origin, rays = camera.rays_world(pixel[None])
    met = [hits(thing, origin, rays) for thing in near]
    depths = np.array([hit.depth[0] for hit in met])
    if not axis:
        edge = _edge_at(near, camera, pixel, reach)
        if edge is not None:
            return edge
    if not np.isfinite(depths).any():
        return _plane_at(cell, camera, pixel)
    nearest = int(depths.argmin())
    thing = near[nearest]
    face = face_names(thing)[int(met[nearest].face[0])]
    name = "axis" if axis or face in ("side", "inside") else face
    return _of(thing, name) if name in feature_names(thing) else None


def path_of(cell: Cell, path: str) -> str | None:
    """The name of the reference that is the feature of that path already, None without one."""
    for reference in cell.references:
        if path in (reference.name, getattr(reference.source, "of", None)):
            return reference.name
    return None


def outline_of(thing: Primitive, name: str) -> Array:
    """A line (N, 3) in the world round a face, or along an edge or axis."""
    local = _face_line(thing, name)
    if local is not None:
        return thing.world_from_object.apply(local)
    found = feature(thing, name)
    along = thing.world_from_object.inverse().rotate(found.direction)
    half = float(np.abs(along) @ thing.half_extent) * (BEYOND if name.startswith("axis") else 1.0)
    return found.point + np.outer([-half, half], found.direction)


def _of(thing: Primitive, name: str) -> Shown:
    return Shown(f"{thing.name}.{name}", feature(thing, name).kind, outline_of(thing, name))


def _near(thing: Primitive, camera: Camera, pixel: Array, reach: float) -> bool:
    """Whether a pixel lies on what is seen of a thing, or within reach of it."""
    left, top, right, bottom = bounds(thing, camera)
    u, v = pixel
    return left - reach <= u <= right + reach and top - reach <= v <= bottom + reach


def _edge_at(
    things: Sequence[Primitive], camera: Camera, pixel: Array, reach: float
) -> Shown | None:
    """The nearest visible edge, if it is near enough. `things` are all that may hide it."""
    best: tuple[float, Shown] | None = None
    for index, thing in enumerate(things):
        for name in feature_names(thing):
            if name.startswith("axis") or not _is_edge(thing, name):
                continue
            shown = _of(thing, name)
            away, point = _from_line(camera, shown.line, pixel)
            if away > reach or (best is not None and away >= best[0]):
                continue
            if _seen(things, camera, index, point):
                best = away, shown
    return None if best is None else best[1]


def _is_edge(thing: Primitive, name: str) -> bool:
    if isinstance(thing, Box):
        return name not in (*BOX_FACES, "centre")
    return isinstance(thing, Prism) and name.startswith("edge")


def _from_line(camera: Camera, line: Array, pixel: Array) -> tuple[float, Array]:
    """Pixels from a straight line (2, 3) in the world, and its point (3,) that is nearest."""
    shares = np.linspace(0.0, 1.0, 33)[:, None]
    points = line[0] + shares * (line[1] - line[0])
    away = np.linalg.norm(camera.project(points) - pixel, axis=1)
    if not np.isfinite(away).any():
        return np.inf, points[0]
    middle = int(np.nanargmin(away))
    fine = np.linspace(max(middle - 1, 0) / 32, min(middle + 1, 32) / 32, 17)[:, None]
    points = line[0] + fine * (line[1] - line[0])
    away = np.linalg.norm(camera.project(points) - pixel, axis=1)
    best = int(np.nanargmin(away))
    return float(away[best]), points[best]


def _seen(things: Sequence[Primitive], camera: Camera, index: int, point: Array) -> bool:
    origin = camera.centre_world
    others = occluded(things, origin, point[None], [index])[0]
    itself = occluded([things[index]], origin, point[None], [-1], OWN_SURFACE)[0]
    return not (others or itself)


def _plane_at(cell: Cell, camera: Camera, pixel: Array) -> Shown | None:
    """The nearest plane of the list that a pixel beside all objects shows; no object's face."""
    best: tuple[float, str] | None = None
    for reference in cell.placed_references:
        if not isinstance(reference, ReferencePlane) or hasattr(reference.source, "of"):
            continue
        point = points_on_plane_or_nan(camera, reference, pixel[None])[0]
        away = float(np.linalg.norm(point - camera.centre_world))
        if np.isfinite(away) and (best is None or away < best[0]):
            best = away, reference.name
    return None if best is None else Shown(best[1], "plane", np.zeros((0, 3)))


def _face_line(thing: Primitive, name: str) -> Array | None:
    """Round a face in the object's own frame; None for what is no face."""
    half = thing.half_extent
    if isinstance(thing, Sphere):
        return None
    if isinstance(thing, Box) and name in BOX_FACES:
        at = feature(replace_pose(thing), name)
        axis = int(np.abs(at.direction).argmax())
        ring = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1], [-1, -1]], dtype=float)
        points = np.insert(ring, axis, 0.0, axis=1) * half
        points[:, axis] = at.point[axis]
        return points
    if name in ("base", "top"):
        level = half[2] if name == "top" else -half[2]
        if isinstance(thing, Prism):
            flat = np.vstack([thing.polygon, thing.polygon[:1]])
        else:
            sizes = dict(zip(thing.size_names, thing.sizes, strict=True))
            radius = sizes.get("top_radius", sizes["radius"]) if name == "top" else sizes["radius"]
            flat = radius * np.stack([np.cos(CIRCLE), np.sin(CIRCLE)], axis=1)
        return np.column_stack([flat, np.full(len(flat), level)])
    if isinstance(thing, Prism) and name.startswith("side"):
        i = int(name.removeprefix("side"))
        a, b = thing.polygon[i], thing.polygon[(i + 1) % len(thing.polygon)]
        low, high = [-half[2]], [half[2]]
        return np.array([[*a, *low], [*b, *low], [*b, *high], [*a, *high], [*a, *low]])
    return None


def replace_pose(thing: Box) -> Box:
    """The box in its own frame."""
    from ...core.pose import Pose

    return replace(thing, world_from_object=Pose.identity(), covariance=None, by_camera=None)
