# SPDX-License-Identifier: GPL-3.0-or-later
"""Convex pieces of solids to the file that PyBullet makes a compound of hulls from."""

from __future__ import annotations

from collections.abc import Sequence

from ...core.arrays import Array


def pieces_text(pieces: Sequence[Array]) -> str:
    """The pieces as Wavefront OBJ, one object each: PyBullet makes a convex hull of every one."""
    lines, before = [], 1
    for i, corners in enumerate(pieces):
        lines.append(f"o piece{i}")
        lines += [f"v {x:.9g} {y:.9g} {z:.9g}" for x, y, z in corners]
        # only the corners count for a hull; any faces that use them all will do
        count = len(corners)
        lines += [f"f {before} {before + j} {before + j + 1}" for j in range(1, count - 1)]
        before += count
    return "\n".join(lines) + "\n"
