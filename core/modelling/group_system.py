# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects that hang together, as one linear system: what is seen of them and what holds them.

Unknown are the objects' tangents `d` and, shared with everything else, the noise `s` of camera and
references, in units of their own 1 sigma. Seen: `J d + K s + r`, made small. Held: `A d + E s + c`,
made zero, by `d = Z y + B s + b` with Z the null space of A.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..arrays import Array
from ..primitives import Primitive
from .held_rows import RelationRows
from .holding import Hold, References
from .observed import Observed

# a relation that another one implies leaves nothing new: below this share it counts as implied
IMPLIED = 1e-9

# how a thing outside the group moves with the shared noise: its key to (tangent, noise)
Spread = Mapping[tuple[str, str], Array]
CAMERA = ("camera", "")


@dataclass(frozen=True, eq=False)
class GroupSystem:
    """The linear system of one group, residuals in units of their sigma."""

    seen: Array
    by_objects: Array
    by_noise: Array
    held: Array
    held_by_objects: Array
    held_by_noise: Array

    @cached_property
    def _split(self) -> tuple[Array, Array]:
        """The null space Z (D, F) of what holds, and its pseudo-inverse (D, M)."""
        a = self.held_by_objects
        if not len(a):
            return np.eye(a.shape[1]), np.zeros((a.shape[1], 0))
        left, values, right = np.linalg.svd(a, full_matrices=True)
        rank = int((values > IMPLIED * values[0]).sum())
        inverse = (right[:rank].T / values[:rank]) @ left[:, :rank].T
        return right[rank:].T, inverse

    @property
    def free(self) -> Array:
        """Z (D, F): how the objects can move while all that holds them is kept."""
        return self._split[0]

    @cached_property
    def carried(self) -> Array:
        """B (D, Q): how the objects are carried along by the noise of what holds them."""
        moved: Array = -self._split[1] @ self.held_by_noise
        return moved

    @cached_property
    def restored(self) -> Array:
        """b (D,): the step back to where what holds is kept."""
        step: Array = -self._split[1] @ self.held
        return step

    @cached_property
    def reduced(self) -> tuple[Array, Array, Array]:
        """J Z (N, F), K + J B (N, Q) and r + J b (N,)."""
        j = self.by_objects
        return j @ self.free, self.by_noise + j @ self.carried, self.seen + j @ self.restored


def group_system(
    names: Iterable[str],
    things: Mapping[str, Primitive],
    references: References,
    observed: Mapping[str, Observed],
    holds: Iterable[Hold],
    fixed: Mapping[str, Array],
    spread: Spread,
    noise: int,
) -> GroupSystem:
    """The system of the objects `names` as they stand.

    `fixed[name]` (M, 6 + P) are rows that hold an object by itself: its gauges and known sizes.
    `spread` tells how camera, references and other objects move with the `noise` shared numbers.
    """
    columns, width = _columns(names, things)
    seen = _seen(columns, width, observed, spread, noise)
    held = _held(columns, width, things, references, holds, fixed, spread, noise)
    return GroupSystem(*seen, *held)


def gauge_rows(kind: str, rotation: Array, parameters: Array) -> Array:
    """Motions (M, 6 + P) that change nothing: a turn about its own axis, a polygon in its frame."""
    count = len(parameters)
    if kind in ("cylinder", "cone", "tube"):
        row = np.zeros((1, 6 + count))
        row[0, :3] = rotation[:, 2]
        return row
    if kind == "sphere":
        return np.eye(3, 6 + count)
    if kind == "prism":
        polygon = parameters[1:].reshape(-1, 2)
        scale = float(np.abs(polygon).max())
        rows = np.zeros((3, 6 + count))
        rows[0, 7::2] = rows[1, 8::2] = 1.0
        rows[2, 7::2], rows[2, 8::2] = -polygon[:, 1] / scale, polygon[:, 0] / scale
        return rows
    return np.zeros((0, 6 + count))


def _columns(names: Iterable[str], things: Mapping[str, Primitive]) -> tuple[dict[str, slice], int]:
    columns: dict[str, slice] = {}
    start = 0
    for name in names:
        end = start + 6 + len(things[name].parameters)
        columns[name] = slice(start, end)
        start = end
    return columns, start


def _seen(
    columns: Mapping[str, slice],
    width: int,
    observed: Mapping[str, Observed],
    spread: Spread,
    noise: int,
) -> tuple[Array, Array, Array]:
    parts = [(columns[name], observed[name]) for name in columns if name in observed]
    count = sum(len(seen.residuals) for _, seen in parts)
    residuals, by, by_noise = np.empty(count), np.zeros((count, width)), np.zeros((count, noise))
    start = 0
    for place, seen in parts:
        rows = slice(start, start + len(seen.residuals))
        start = rows.stop
        residuals[rows] = seen.residuals / seen.sigma
        by[rows, place] = seen.by_object / seen.sigma[:, None]
        if CAMERA in spread:
            by_noise[rows] = (seen.by_camera / seen.sigma[:, None]) @ spread[CAMERA]
    return residuals, by, by_noise


def _held(
    columns: Mapping[str, slice],
    width: int,
    things: Mapping[str, Primitive],
    references: References,
    holds: Iterable[Hold],
    fixed: Mapping[str, Array],
    spread: Spread,
    noise: int,
) -> tuple[Array, Array, Array]:
    values, by, by_noise = [np.zeros(0)], [np.zeros((0, width))], [np.zeros((0, noise))]
    for name, place in columns.items():
        rows = fixed[name]
        block = np.zeros((len(rows), width))
        block[:, place] = rows
        values.append(np.zeros(len(rows)))
        by.append(block)
        by_noise.append(np.zeros((len(rows), noise)))
    for hold in holds:
        if hold.own not in columns:
            continue
        found = hold.rows(things, references)
        block, shared = np.zeros((len(found.values), width)), np.zeros((len(found.values), noise))
        block[:, columns[hold.own]] += found.by_own
        _add_target(block, shared, columns, hold.to.key, found.by_to, spread)
        if hold.about is not None and found.by_about is not None:
            _add_target(block, shared, columns, hold.about.key, found.by_about, spread)
        values.append(found.values)
        by.append(block)
        by_noise.append(shared)
    return np.concatenate(values), np.vstack(by), np.vstack(by_noise)


def _add_target(
    block: Array,
    shared: Array,
    columns: Mapping[str, slice],
    key: tuple[str, str],
    rows: Array,
    spread: Spread,
) -> None:
    """What holds is in the group itself, or moves with the noise, or stands still."""
    sort, name = key
    if sort == "object" and name in columns:
        block[:, columns[name]] += rows
    elif key in spread:
        shared += rows @ spread[key]


__all__ = ["CAMERA", "GroupSystem", "RelationRows", "Spread", "gauge_rows", "group_system"]
