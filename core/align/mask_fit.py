# SPDX-License-Identifier: GPL-3.0-or-later
"""A part of a picture in, boxes and cylinders on a plane that cover it out."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..camera import Camera
from ..modelling.solid import Solid
from ..reference import ReferencePlane
from ..rotation import rotation_from_vector
from .draws import normals
from .hypotheses import Outlines, hull_points, outlines
from .seeds import Seed
from .window import looked_up

DRAWN, ELITE, ROUNDS, POINTS = 72, 12, 12, 40
# first spreads: of the foot in its extent, of sizes as a share, of the turn in radians
PLACE, SIZE, TURN = 0.5, 0.4, 0.35
TURNS = (0.0, np.pi / 6, np.pi / 3)
# a solid counts as covering a mask from this share of agreement on (area shared over area joined)
LEAST_OVERLAP = 0.78
LEAST_SIZE = 0.005


@dataclass(frozen=True, eq=False)
class Cover:
    """A solid whose outline covers a seed; `overlap` is the area shared over the area joined."""

    solid: Solid
    seed: Seed
    overlap: float

    @property
    def promise(self) -> float:
        """How much of the picture it explains, and how well."""
        return max(self.overlap - LEAST_OVERLAP, 0.0) * float(np.sqrt(self.seed.mask.sum()))


def covering(seed: Seed, kind: str, camera: Camera, plane: ReferencePlane) -> Cover | None:
    """The box or cylinder standing on the plane whose outline covers the seed best.

    None where the seed's foot is not on the plane in front of the camera, or nothing covers it.
    """
    begun = _first(seed, camera, plane)
    if begun is None:
        return None
    foot, across, up = begun
    tried = []
    for turn in TURNS if kind == "box" else (0.0,):
        start = _solid(kind, plane, foot, across, up, turn)
        tried.append(_covered(start, seed, camera, plane))
    overlap, best = max(tried, key=lambda pair: pair[0])
    return Cover(best, seed, overlap) if overlap >= LEAST_OVERLAP else None


def _first(seed: Seed, camera: Camera, plane: ReferencePlane) -> tuple[Array, float, float] | None:
    """Where a seed stands (3,), how wide and how high it may be, metres."""
    rows, columns = np.nonzero(seed.mask)
    step = seed.window.step
    low, high = rows.max(), rows.min()
    middle = 0.5 * (columns.min() + columns.max())
    pixels = np.array([[columns[rows == low].mean(), low], [middle, high]]) * step
    eye, rays = camera.rays_world(pixels)
    towards = rays @ plane.normal
    depth = ((plane.point - eye) @ plane.normal) / towards[0]
    if not np.isfinite(depth) or depth <= 0:
        return None
    foot = eye + depth * rays[0]
    pixel = depth / (0.5 * (camera.intrinsics.fx + camera.intrinsics.fy))
    across = max(float(np.ptp(columns)) * step * pixel, 2 * LEAST_SIZE)
    steep = float(np.sqrt(max(1 - towards[0] ** 2, 0.05)))
    tall = max(float(low - high) * step * pixel / steep - 0.5 * across, 0.3 * across)
    level = rays[0] - plane.normal * towards[0]
    return foot + 0.4 * across * level / max(float(np.linalg.norm(level)), 1e-9), across, tall


def _solid(
    kind: str, plane: ReferencePlane, foot: Array, across: float, tall: float, turn: float
) -> Solid:
    rotation = plane.world_from_plane.rotation @ rotation_from_vector(np.array([0.0, 0.0, turn]))
    sizes = [0.5 * across, tall] if kind == "cylinder" else [0.75 * across, 0.75 * across, tall]
    return Solid(kind, rotation, foot + 0.5 * tall * plane.normal, np.array(sizes))


def _covered(
    start: Solid, seed: Seed, camera: Camera, plane: ReferencePlane
) -> tuple[float, Solid]:
    """The agreement with the seed and the solid, drawn and drawn closer."""
    motions = _motions(start, plane)
    signed = np.where(seed.mask, 1.0, -1.0)
    sums = (np.cumsum(signed, axis=1) - 0.5 * signed)[:, :, None]
    count = motions.shape[1]
    mean, root, best = np.zeros(count), np.eye(count), np.zeros(count)
    for number in range(ROUNDS):
        states = mean + normals(DRAWN, count, number) @ root.T
        states[0] = mean
        sizes = start.parameters + states @ motions[6:].T
        hulls = hull_points(start, states @ motions.T, camera)
        hulls = np.where(np.isfinite(hulls), hulls, -1e3)
        drawn = outlines(hulls, POINTS)
        placed = Outlines(
            seed.window.places(drawn.pixels), drawn.normals, drawn.step / seed.window.step
        )
        inside = placed.integrals(looked_up(sums, placed.pixels)[..., 0])
        inside = np.where((sizes > LEAST_SIZE).all(axis=1), inside, -np.inf)
        order = np.argsort(-inside)[:ELITE]
        best, mean = states[order[0]], states[order].mean(axis=0)
        spread = 1.3 * np.cov(states[order].T).reshape(count, count)
        root = np.linalg.cholesky(spread + np.eye(count) * 0.02**2)
    found = start.moved(motions @ best)
    still = np.zeros((1, 6 + len(start.parameters)))
    covered = seed.window.mask(hull_points(found, still, camera)[0]) > 0
    shared, joined = (covered & seed.mask).sum(), (covered | seed.mask).sum()
    return float(shared / max(int(joined), 1)), found


def _motions(solid: Solid, plane: ReferencePlane) -> Array:
    """What may change (6 + P, F) while a solid stands on the plane, one sigma each."""
    count = len(solid.parameters)
    across = float(solid.parameters[0])
    motions = np.zeros((6 + count, 2 + count + (solid.kind == "box")))
    motions[3:6, :2] = plane.world_from_plane.rotation[:, :2] * PLACE * across
    for i in range(count):
        motions[6 + i, 2 + i] = SIZE * solid.parameters[i]
    motions[3:6, 1 + count] = plane.normal * SIZE * solid.parameters[-1] / 2
    if solid.kind == "box":
        motions[:3, -1] = plane.normal * TURN
    return motions
