# SPDX-License-Identifier: GPL-3.0-or-later
"""The picks of a sketch in, checked pixels with a name for every pick out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arrays import Array, frozen
from ..errors import InvalidValue, PickError
from ..intrinsics import Intrinsics
from ..sketch import Sketch

# a corner just outside the picture may be guessed; farther out it is a slip
OUTSIDE_SHARE = 0.5


@dataclass(frozen=True, eq=False)
class RolePicks:
    """The pixels (N, 2) picked for one role; `places` are their indices in the document's list.

    `labels` name each for messages, like `block: base[2]`.
    """

    pixels: Array
    places: tuple[int, ...]
    labels: tuple[str, ...]

    def __len__(self) -> int:
        return len(self.places)


def read_picks(
    sketch: Sketch, intrinsics: Intrinsics, roles: Sequence[str], nullable: Sequence[str] = ()
) -> dict[str, RolePicks]:
    """The picks of every one of `roles`, empty where the sketch has none.

    A role in `nullable` may hold null for what was not seen.

    Raises PickError, naming object and pick, for an unknown role, anything but a list of [u, v], a
    number that is not finite, or a pixel more than half a picture outside the picture or past what
    the lens images.
    """
    for role in sketch.picks:
        if role not in roles:
            raise PickError(
                f"{sketch.name}: picks of a {sketch.kind} are called {', '.join(roles)}; "
                f"{role!r} is none of them"
            )
    return {role: _read_role(sketch, role, role in nullable, intrinsics) for role in roles}


def _read_role(sketch: Sketch, role: str, nullable: bool, intrinsics: Intrinsics) -> RolePicks:
    entries = sketch.picks.get(role, ())
    if not isinstance(entries, list | tuple | np.ndarray):
        raise PickError(
            f"{sketch.name}: {role}: expected a list of pixels [u, v], got {entries!r:.60}"
        )
    places = tuple(i for i, entry in enumerate(entries) if not (nullable and entry is None))
    labels = tuple(f"{sketch.name}: {role}[{i}]" for i in places)
    pixels = [_read_pixel(entries[i], label) for i, label in zip(places, labels, strict=True)]
    picked = RolePicks(np.array(pixels).reshape(-1, 2), places, labels)
    _refuse_outside(picked, intrinsics)
    return picked


def _read_pixel(entry: Any, label: str) -> Array:
    try:
        return frozen(entry, (2,), label)
    except InvalidValue as error:
        raise PickError(f"{error}; a pick is [u, v] in pixels") from None


def _refuse_outside(picked: RolePicks, intrinsics: Intrinsics) -> None:
    if not len(picked):
        return
    size = np.array([intrinsics.width, intrinsics.height])
    margin = OUTSIDE_SHARE * size
    outside = (picked.pixels < -0.5 - margin) | (picked.pixels > size - 0.5 + margin)
    not_imaged = np.isnan(intrinsics.rays(picked.pixels)).any(axis=1)
    for i, label in enumerate(picked.labels):
        u, v = picked.pixels[i]
        if outside[i].any():
            raise PickError(
                f"{label} at ({u:.1f}, {v:.1f}) lies more than half a picture outside the "
                f"{size[0]} x {size[1]} px picture; pick it again"
            )
        if not_imaged[i]:
            raise PickError(
                f"{label} at ({u:.1f}, {v:.1f}) is past the edge of what this lens images; "
                "pick nearer to the centre"
            )
