# SPDX-License-Identifier: GPL-3.0-or-later
"""What is drawn at the cursor: its size and the free part of the region in, its place there out.

All in region pixels, y up. Boxes are left, bottom, right and top.
"""

from __future__ import annotations

from itertools import product

Box = tuple[float, float, float, float]
# how far from the cursor words and loupe keep, screen pixels at an interface scale of 1
WORDS_AWAY, LOUPE_AWAY, RIM = 18.0, 34.0, 6.0


def loupe_box(side: float, cursor: tuple[float, float], free: Box, scale: float) -> Box:
    """Where a square of that side goes: above to the left of the cursor, elsewhere at a rim."""
    (x, y), away = cursor, LOUPE_AWAY * scale
    left = x - away - side if x - away - side > free[0] else x + away
    bottom = y + away if y + away + side < free[3] else y - away - side
    return left, bottom, left + side, bottom + side


def words_box(
    size: tuple[float, float],
    cursor: tuple[float, float],
    free: Box,
    scale: float,
    loupe: Box | None = None,
) -> Box:
    """Where a plate of that width and height goes: below to the right, or where else it is seen.

    It stays in the free part and off the loupe; where nothing of that kind is left, it stays in the
    free part.
    """
    (width, height), (x, y) = size, cursor
    away, rim = WORDS_AWAY * scale, RIM * scale
    # a plate that is wider than what is free is read from its beginning
    most = max(free[2] - width - rim, free[0] + rim)
    pushed = min(max(x + away, free[0] + rim), most)
    lefts, bottoms = [x + away, x - away - width, pushed], [y - away - height, y + away]
    usual = [(left, low, left + width, low + height) for left, low in product(lefts, bottoms)]
    if loupe is not None:
        lefts += [loupe[2] + rim, loupe[0] - rim - width]
        bottoms += [loupe[3] + rim, loupe[1] - rim - height]
    boxes = [(left, low, left + width, low + height) for left, low in product(lefts, bottoms)]
    cursor_box = (x, y, x, y)
    fitting = (
        box
        for box in boxes
        if _inside(box, free) and not _touch(box, loupe) and not _touch(box, cursor_box)
    )
    return next(fitting, usual[-2] if _inside(usual[-2], free) else usual[-1])


def _inside(box: Box, free: Box) -> bool:
    left, bottom, right, top = free
    return left <= box[0] and bottom <= box[1] and box[2] <= right and box[3] <= top


def _touch(box: Box, other: Box | None) -> bool:
    if other is None:
        return False
    return box[0] < other[2] and other[0] < box[2] and box[1] < other[3] and other[1] < box[3]
