# SPDX-License-Identifier: GPL-3.0-or-later
"""All measured pixels of all sightings in one place: targets' centres in, residuals out at once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..ball.sphere import OutlineRays, tangency
from ..intrinsics import Intrinsics
from .observation import Observation, OutlineObservation, PointObservation
from .unknowns import SHARED, Columns, State


@dataclass(frozen=True, eq=False)
class Measured:
    """The pixels of all outlines, and after them those of all points, which make two rows each.

    - `owner` (N,): each row's sighting; `rows` (S,): where each sighting's rows are
    - `radii` (M,) of each row of an outline, `sigma_pixels` (N,) of each row
    - `by_lens` (., 2, 2): by how much a longer lens, and one with more radial distortion, would
      show each pixel farther out

    One set of arrays for all sightings costs a handful of calls instead of one a sighting.
    """

    outlines: OutlineRays
    points: OutlineRays
    radii: Array
    sigma_pixels: Array
    owner: NDArray[np.intp]
    rows: tuple[slice, ...]
    intrinsics: Intrinsics | None
    by_lens: Array

    @staticmethod
    def of(observations: Sequence[Observation]) -> Measured:
        balls = [(i, o) for i, o in enumerate(observations) if isinstance(o, OutlineObservation)]
        points = [(i, o) for i, o in enumerate(observations) if isinstance(o, PointObservation)]
        order = np.array([i for i, _ in (*balls, *points)], dtype=np.intp)
        lengths = [len(o.sigma_pixels) for _, o in balls] + [2] * len(points)
        ends = np.cumsum(lengths).tolist()
        rows = [slice(0)] * len(observations)
        for i, end, length in zip(order, ends, lengths, strict=True):
            rows[i] = slice(end - length, end)
        sigmas = [o.sigma_pixels for _, o in balls]
        intrinsics = observations[0].intrinsics
        outlines = _joined([o.outline for _, o in balls])
        clicked = _joined([o.outline for _, o in points])
        return Measured(
            outlines,
            clicked,
            np.repeat([o.radius for _, o in balls], lengths[: len(balls)]),
            np.concatenate([*sigmas, np.repeat([o.sigma_pixels for _, o in points], 2)]),
            np.repeat(order, lengths),
            tuple(rows),
            intrinsics,
            _by_lens(np.concatenate([outlines.pixels, clicked.pixels]), intrinsics),
        )

    def columns(self, centres_camera: Array, state: State) -> Columns:
        """Residuals and what moves them, the targets' centres being at (S, 3) in the camera."""
        here = self if state.log_focal == 0 else self._through(_longer(self.intrinsics, state))
        count = len(self.radii)
        balls = here._of_balls(centres_camera[self.owner[:count]], state)
        if not len(self.points.pixels):
            return balls
        points = here._of_points(centres_camera[self.owner[count::2]])
        return Columns(
            np.concatenate([balls.residual_pixels, points.residual_pixels]),
            np.concatenate([balls.by_centre, points.by_centre]),
            np.concatenate([balls.shared, points.shared]),
        )

    def _through(self, lens: Intrinsics) -> Measured:
        outlines = OutlineRays.of(lens, self.outlines.pixels)
        points = OutlineRays.of(lens, self.points.pixels)
        return replace(self, outlines=outlines, points=points, intrinsics=lens)

    def _of_balls(self, centres: Array, state: State) -> Columns:
        radii = self.radii * np.exp(state.log_radius)
        held = tangency(self.outlines, centres, radii)
        shared = np.empty((len(radii), len(SHARED)))
        shared[:, 0] = -1
        shared[:, 1] = held.by_radius * radii
        shared[:, 2:] = -np.einsum("nci,ni->nc", self.by_lens[: len(radii)], held.normals)
        return Columns(held.residual_pixels - state.edge_bias_pixels, held.by_centre, shared)

    def _of_points(self, centres: Array) -> Columns:
        """Measured minus expected pixel, to first order: finite wherever the point lies."""
        by_pixel = self.points.rays_by_pixel
        transposed = np.swapaxes(by_pixel, 1, 2)
        pixel_by_ray = np.linalg.solve(transposed @ by_pixel, transposed)
        distance = np.linalg.norm(centres, axis=1)
        axes = centres / distance[:, None]
        residual = np.einsum("nij,nj->ni", pixel_by_ray, self.points.rays - axes)
        across = np.eye(3) - axes[:, :, None] * axes[:, None, :]
        by_centre = -(pixel_by_ray @ across) / distance[:, None, None]
        shared = np.zeros((len(centres), 2, len(SHARED)))
        shared[:, :, 2:] = -np.swapaxes(self.by_lens[len(self.radii) :], 1, 2)
        return Columns(
            residual.ravel(), by_centre.reshape(-1, 3), shared.reshape(-1, shared.shape[2])
        )


def _by_lens(pixels: Array, lens: Intrinsics | None) -> Array:
    """Where a longer lens, and one with more radial distortion, show pixels: (N, 2, 2)."""
    if lens is None:
        return np.zeros((len(pixels), 2, 2))
    from_middle = pixels - [lens.cx, lens.cy]
    squared = ((from_middle / [lens.fx, lens.fy]) ** 2).sum(axis=1)
    return np.stack([from_middle, from_middle * squared[:, None]], axis=1)


def _longer(intrinsics: Intrinsics | None, state: State) -> Intrinsics:
    assert intrinsics is not None
    factor = float(np.exp(state.log_focal))
    return replace(intrinsics, fx=intrinsics.fx * factor, fy=intrinsics.fy * factor)


def _joined(parts: Sequence[OutlineRays]) -> OutlineRays:
    if not parts:
        return OutlineRays(np.zeros((0, 2)), np.zeros((0, 3)), np.zeros((0, 3, 2)))
    return OutlineRays(
        np.concatenate([p.pixels for p in parts]),
        np.concatenate([p.rays for p in parts]),
        np.concatenate([p.rays_by_pixel for p in parts]),
    )
