# SPDX-License-Identifier: GPL-3.0-or-later
"""The lowest of a row of values by walking downhill: a function of an index in, the index out."""

from __future__ import annotations

from collections.abc import Callable


def lowest(value: Callable[[int], float], start: int, count: int) -> int:
    """The index of the lowest value downhill from `start`, each asked for once."""
    at = start
    while True:
        beside = [i for i in (at - 1, at + 1) if 0 <= i < count]
        lower = min(beside, key=value)
        if value(lower) >= value(at):
            return at
        at = lower
