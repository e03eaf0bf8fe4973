# SPDX-License-Identifier: GPL-3.0-or-later
"""A plane whose normal may point either way in, the normal on the side that is meant out."""

from __future__ import annotations

from ..arrays import Array
from ..errors import NoPose
from .placed import Task

# a stated normal this far off (cosine) says nothing of the side any more
SAME_SIDE = 0.5


def seen_side(task: Task, point: Array, normal: Array, otherwise: Array) -> Array:
    """The normal on the side that the document states, else on the camera's.

    Without a camera pose on the side of `otherwise`: things stand on the side that is seen.
    """
    if task.stated is not None and abs(float(task.stated @ normal)) > SAME_SIDE:
        towards = task.stated
    else:
        try:
            towards = task.camera().centre_world - point
        except NoPose:
            towards = otherwise
    return normal if float(towards @ normal) >= 0 else -normal
