# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the errors of camera, references and objects come from, so that shared ones stay shared.

Two objects measured through one camera are wrong together; a box on a crate is wrong where the
crate is. Everything that can be off is kept as `tangent = sum of map[source] @ noise[source]`, with
noise of one sigma in each number.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..camera import Camera
from ..primitives import Primitive
from .group_system import CAMERA
from .holding import References

Key = tuple[str, str]
# an eigenvalue below this share of the largest is a direction without error
EXACT = 1e-14


@dataclass(frozen=True, eq=False)
class NoiseSources:
    """For each thing that can be off, its map (tangent, noise) from every source that moves it."""

    maps: Mapping[Key, Mapping[Key, Array]]

    @staticmethod
    def of(camera: Camera, references: References, things: Iterable[Primitive]) -> NoiseSources:
        """The sources that stand in covariances: each thing its own, where it states one.

        A plane that was picked through this camera says so by `by_camera`: that part is shared.
        """
        maps: dict[Key, dict[Key, Array]] = {}
        if camera.covariance is not None:
            maps[CAMERA] = {CAMERA: factor(camera.covariance)}
        for reference in references.values():
            key = ("reference", reference.name)
            maps |= _of_covariance(key, reference.covariance, reference.by_camera, camera)
        for thing in things:
            maps |= _of_covariance(
                ("object", thing.name), thing.covariance, thing.by_camera, camera
            )
        return NoiseSources(maps)

    def spread(self, keys: Iterable[Key]) -> tuple[dict[Key, Array], tuple[tuple[Key, int], ...]]:
        """The maps of `keys` over one common noise, and the sources it is made of, with counts."""
        wanted = [key for key in dict.fromkeys(keys) if key in self.maps]
        counts: dict[Key, int] = {}
        for key in wanted:
            counts |= {source: m.shape[1] for source, m in self.maps[key].items()}
        layout = tuple(counts.items())
        return {key: self._row(key, layout) for key in wanted}, layout

    def with_object(
        self, name: str, by_noise: Array, layout: Sequence[tuple[Key, int]], own: Array, group: Key
    ) -> NoiseSources:
        """With a solved object: how it follows the noise it was solved under, and its own."""
        mine = dict(zip((key for key, _ in layout), _cut(by_noise, layout), strict=True))
        return NoiseSources({**self.maps, ("object", name): {**mine, group: own}})

    def _row(self, key: Key, layout: Sequence[tuple[Key, int]]) -> Array:
        maps = self.maps[key]
        height = len(next(iter(maps.values())))
        parts = [maps.get(source, np.zeros((height, count))) for source, count in layout]
        return np.hstack(parts) if parts else np.zeros((height, 0))


def factor(covariance: Array) -> Array:
    """L (n, k) with `L L^T` the covariance, one column for every direction that has an error."""
    scale = np.sqrt(np.diag(covariance))
    scale = np.where(scale > 0, scale, 1.0)
    values, vectors = np.linalg.eigh(covariance / np.outer(scale, scale))
    kept = values > EXACT * max(float(values.max()), 1e-300)
    whole: Array = scale[:, None] * vectors[:, kept] * np.sqrt(values[kept])
    return whole


def _of_covariance(
    key: Key, covariance: Array | None, by_camera: Array | None, camera: Camera
) -> dict[Key, dict[Key, Array]]:
    """What is shared with the camera, and the rest as the thing's own."""
    if covariance is None:
        return {}
    if by_camera is None or camera.covariance is None:
        return {key: {key: factor(covariance)}}
    shared = by_camera @ factor(camera.covariance)
    return {key: {CAMERA: shared, key: factor(_positive(covariance - shared @ shared.T))}}


def _positive(matrix: Array) -> Array:
    """Without the negative eigenvalues that rounding leaves behind."""
    values, vectors = np.linalg.eigh(0.5 * (matrix + matrix.T))
    clean: Array = (vectors * np.maximum(values, 0.0)) @ vectors.T
    return clean


def _cut(by_noise: Array, layout: Sequence[tuple[Key, int]]) -> list[Array]:
    ends = np.cumsum([count for _, count in layout])[:-1]
    return np.split(by_noise, ends, axis=1) if layout else []
