# SPDX-License-Identifier: GPL-3.0-or-later
"""A fitted group's linear system in; how sure its objects are, or what is left open, out."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..camera import Camera
from ..covariance import inverse_information
from ..errors import PickError
from ..primitives import Primitive
from .group_system import CAMERA, GroupSystem
from .noise_sources import Key, factor

# a sigma below this share of the largest (radians beside metres) is rounding
DUST = 1e-10


@dataclass(frozen=True, eq=False)
class Spreads:
    """How a group's tangent follows the shared noise (D, Q) and its picks' own noise (D, F)."""

    by_noise: Array
    own: Array


def spreads_of(
    system: GroupSystem, group: Sequence[str], things: Mapping[str, Primitive]
) -> Spreads:
    """Linearised at the fit. Raises PickError naming what the picks leave open."""
    jacobian, by_noise, _ = system.reduced
    information = jacobian.T @ jacobian
    inverse = inverse_information(information) if len(information) else information
    if inverse is None:
        raise PickError(_left_open(system, group, things))
    root = np.linalg.cholesky(inverse) if len(inverse) else inverse
    follows = system.carried - system.free @ inverse @ jacobian.T @ by_noise
    return Spreads(follows, system.free @ root)


def with_doubts(
    spreads: Spreads, columns: Sequence[tuple[str, slice]], doubts: Mapping[str, Array]
) -> Spreads:
    """With motions of one sigma (6 + P, K) towards rivals of some objects; the group follows.

    The others of the group move as they do on average where the picks' noise moves that one.
    """
    own = spreads.own
    parts = []
    for name, part in columns:
        if name in doubts:
            moved = own @ np.linalg.pinv(own[part], rcond=DUST) @ doubts[name]
            moved[part] = doubts[name]
            parts.append(moved)
    return Spreads(spreads.by_noise, np.hstack([own, *parts])) if parts else spreads


def noise_scale(chi_squared: float, spare: int) -> float:
    """How many times the stated noise the residuals show; 1 unless they clearly exceed it.

    Clearly: beyond two standard deviations of chi squared, and never with fewer than two spare
    equations, which could not tell.
    """
    if spare < 2:
        return 1.0
    reduced = chi_squared / spare
    return float(np.sqrt(reduced)) if reduced > 1.0 + 2.0 * float(np.sqrt(2.0 / spare)) else 1.0


def without_dust(covariance: Array) -> Array:
    """A covariance whose exact directions are exact: rounding leaves 1e-17 where zero is meant."""
    sigma = np.sqrt(np.maximum(np.diag(covariance), 0.0))
    kept = (sigma > DUST * max(float(sigma.max()), 1e-300)).astype(float)
    clean: Array = 0.5 * (covariance + covariance.T) * np.outer(kept, kept)
    return clean


def by_camera_of(
    by_noise: Array, layout: Sequence[tuple[Key, int]], camera: Camera
) -> Array | None:
    """How a tangent (T,) follows the camera's twist, (T, 6); None without its covariance."""
    if camera.covariance is None:
        return None
    start = 0
    for key, count in layout:
        if key == CAMERA:
            root = np.linalg.pinv(factor(camera.covariance))
            moved: Array = by_noise[:, start : start + count] @ root
            return moved
        start += count
    return np.zeros((len(by_noise), 6))


def noise_covariance_of(systems: Iterable[GroupSystem], count: int) -> Array:
    """What all objects together leave of the shared noise, (Q, Q)."""
    information = np.eye(count)
    for system in systems:
        jacobian, by_noise, _ = system.reduced
        cross = jacobian.T @ by_noise
        inverse = np.linalg.pinv(jacobian.T @ jacobian, hermitian=True)
        information += by_noise.T @ by_noise - cross.T @ inverse @ cross
    return np.linalg.inv(information)


def columns_of(group: Sequence[str], things: Mapping[str, Primitive]) -> list[tuple[str, slice]]:
    """Each object of a group with its part of the group's tangent."""
    widths = [6 + len(things[name].parameters) for name in group]
    ends = np.cumsum(widths)
    return [
        (name, slice(int(end) - width, int(end)))
        for name, end, width in zip(group, ends, widths, strict=True)
    ]


def _left_open(system: GroupSystem, group: Sequence[str], things: Mapping[str, Primitive]) -> str:
    """Which numbers may change without any pick noticing."""
    jacobian = system.reduced[0]
    scale = np.linalg.norm(jacobian, axis=0)
    scale[scale == 0] = 1e-300
    _, _, directions = np.linalg.svd(jacobian / scale)
    loose = system.free @ (directions[-1] / scale)
    loose = np.abs(loose) / max(float(np.abs(loose).max()), 1e-300) > 0.05
    told = []
    for name, columns in columns_of(group, things):
        part = loose[columns]
        names = things[name].size_names
        open_ones = [
            n for n, is_loose in zip(names, part[6 : 6 + len(names)], strict=True) if is_loose
        ]
        open_ones += ["its polygon"] if part[6 + len(names) :].any() else []
        open_ones += ["its place"] if part[3:6].any() else []
        open_ones += ["its turn"] if part[:3].any() else []
        if open_ones:
            told.append(f"{name}: the picks do not determine {', '.join(open_ones)}")
    return f"{'; '.join(told)}; add picks, a relation or a known size"
