# SPDX-License-Identifier: GPL-3.0-or-later
"""Corners picked round a base in, which way round they go and how high the top is above them out.

Corners that lie on one line, cross, or stand below their base are refused by name.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...arrays import Array
from ...camera import Camera
from ...errors import PickError
from ...reference import ReferenceLine, ReferencePlane
from ..picks import RolePicks
from ..reverse_mapping import points_on_line

# sine of a corner's angle below which three corners count as one line (6 degrees)
COLLINEAR = 0.1
# pixels by which a hand may miss
SLIP = 5.0


def turn_of(corners: Array, labels: Sequence[str]) -> float:
    """+1 for corners (3 or 4, 2) of a rectangle that go anticlockwise, -1 for clockwise.

    Raises PickError for three corners on one line, or corners that cross.
    """
    count = len(corners)
    bends = [_bend(corners, i) for i in (range(count) if count == 4 else [0])]
    for i, sine in enumerate(bends):
        if abs(sine) < COLLINEAR:
            _refuse_line(labels, i, sine)
    if min(bends) < 0 < max(bends):
        raise PickError(
            f"{labels[0].split(':')[0]}: the base corners cross; pick them in order round the base"
        )
    return float(np.sign(bends[0]))


def _refuse_line(labels: Sequence[str], i: int, sine: float) -> None:
    """Raises PickError for corner i and the two after it."""
    name, roles = labels[0].split(": ")[0], [label.split(": ")[-1] for label in labels]
    count = len(labels)
    raise PickError(
        f"{name}: {roles[i]}, {roles[(i + 1) % count]} and {roles[(i + 2) % count]} lie on one "
        f"line (a bend of {np.degrees(np.arcsin(sine)):.1f} degrees); pick three corners"
    )


def refuse_crossing(picked: RolePicks) -> None:
    """Raises PickError for four corners of a face that are not in order round it, as seen.

    A face seen edge-on may cross itself by the error of a hand, which is no mistake.
    """
    if len(picked) != 4:
        return
    a, b, c, d = picked.pixels
    if _cross(a, b, c, d) or _cross(b, c, d, a):
        name, role = picked.labels[0].split(": ")
        face = role.split("[")[0]
        raise PickError(f"{name}: the {face} corners cross; pick them in order round the {face}")


def top_heights(camera: Camera, plane: ReferencePlane, corners: Array, top: RolePicks) -> Array:
    """How far each top pick is above its base corner. Raises PickError for one below it."""
    world_from_plane = plane.world_from_plane
    heights = []
    for place, label, pixel in zip(top.places, top.labels, top.pixels, strict=True):
        foot = world_from_plane.apply([*corners[place], 0.0])
        upright = ReferenceLine(f"the edge above base[{place}]", foot, plane.normal)
        point = points_on_line(camera, upright, pixel[None], [label])[0]
        height = float((point - foot) @ plane.normal)
        if height <= 0:
            raise PickError(
                f"{label} at ({pixel[0]:.1f}, {pixel[1]:.1f}) lies {-1e3 * height:.1f} mm below "
                f"{plane.name}; a top pick is above base[{place}], along {plane.name}'s normal"
            )
        heights.append(height)
    return np.array(heights)


def _bend(corners: Array, i: int) -> float:
    """The sine of the turn from corner i over the next to the one after; 0 for twice the same."""
    count = len(corners)
    one = corners[(i + 1) % count] - corners[i]
    other = corners[(i + 2) % count] - corners[(i + 1) % count]
    lengths = float(np.linalg.norm(one) * np.linalg.norm(other))
    if lengths < 1e-12:
        return 0.0
    return float(one[0] * other[1] - one[1] * other[0]) / lengths


def _cross(a: Array, b: Array, c: Array, d: Array) -> bool:
    """Whether a-b and c-d cross, none of the four within a slip of the other line."""

    def off(p: Array, q: Array, r: Array) -> float:
        along = q - p
        across = along[0] * (r[1] - p[1]) - along[1] * (r[0] - p[0])
        return float(across) / max(float(np.linalg.norm(along)), 1e-12)

    pairs = ((off(a, b, c), off(a, b, d)), (off(c, d, a), off(c, d, b)))
    return all(one * other < 0 and min(abs(one), abs(other)) > SLIP for one, other in pairs)
