# SPDX-License-Identifier: GPL-3.0-or-later
"""Places that may be a ball's, weighed by what is known of it: a picture and hints in, circles out.

Hints rank, they do not decide: a ball in another light than thought is found still, with a warning.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..errors import SphereNotFound
from ..intrinsics import Intrinsics
from .change import change_shares, changed_mask
from .circle_votes import CANDIDATES_PER_LEVEL, Circle, vote_for_circles
from .color import color_shares
from .hints import ROUGHLY, FindHints
from .outline import SphereOutline
from .ring_search import RoughSphere

Window = tuple[float, float, float, float]

SEARCHED, SEARCHED_IN_WINDOW = 48, 8
# with hints that weigh, more circles are worth a look
MORE = 4
# a hint that does not fit at all leaves this much of a candidate's weight
LEAST_WEIGHT = 0.35
CLEAR_WEIGHT = 0.75
# where less than this changed no ball came or went, and a changed one has half its inside changed
UNCHANGED, CHANGED = 0.08, 0.5
DOUBTFUL_SHARE = 0.25
SHARE_BY_CHANCE = 0.25
INDEPENDENT_EDGES = 300
# rough circles are rougher than measured ones
ROUGH_CIRCLE = 1.3


class Places:
    """Where in a window of an 8-bit picture a ball may be, as far as hints tell."""

    def __init__(
        self,
        coded: NDArray[np.uint8],
        intrinsics: Intrinsics,
        window: Window | None,
        hints: FindHints,
    ) -> None:
        self._coded, self._window, self._hints = coded, window, hints
        self._clip = clipped(window, intrinsics)
        self._changed = None
        if hints.background is not None:
            self._changed = changed_mask(coded, hints.background)
        self._circles: list[Circle] | None = None
        self.clear_weight = CLEAR_WEIGHT if hints.weigh else 0.0
        rough = hints.rough_radius_pixels
        self.of_size = "" if rough is None else f" of about {rough:.0f} px radius"

    def searched(self, most: int) -> int:
        """How many circles are worth a search when `most` balls are wanted."""
        return max(SEARCHED if self._window is None else SEARCHED_IN_WINDOW, 3 * most)

    def circles(self, count: int, most: int) -> list[Circle]:
        """The `count` likeliest rough circles, the best first, when `most` balls are wanted."""
        if self._circles is None:
            self._circles = self._voted(most)
        return self._circles[:count]

    def weight(self, circle: Circle) -> float:
        """How far a circle fits the hints, from nearly 0 to 1."""
        weight = 1.0
        if self._hints.color is not None:
            share = float(color_shares(self._coded, [circle], self._hints.color)[0])
            weight *= LEAST_WEIGHT + (1 - LEAST_WEIGHT) * min(1.0, share / 0.6)
        if self._changed is not None:
            share = float(change_shares(self._changed, [circle])[0])
            weight *= LEAST_WEIGHT + (1 - LEAST_WEIGHT) * min(1.0, share / CHANGED)
        return weight

    def moved(self, circle: Circle) -> bool:
        """Whether most of a circle's inside differs from the background that was given."""
        if self._changed is None:
            return False
        return float(change_shares(self._changed, [circle])[0]) > CHANGED

    def doubts(self, circle: Circle) -> tuple[str, ...]:
        """What to tell of a ball that does not fit the hints."""
        told = []
        if self._hints.color is not None:
            share = float(color_shares(self._coded, [circle], self._hints.color)[0])
            if share < DOUBTFUL_SHARE:
                told.append(f"only {100 * share:.0f} % of its inside has the colour given")
        if self._changed is not None:
            share = float(change_shares(self._changed, [circle])[0])
            if share < DOUBTFUL_SHARE:
                told.append(f"only {100 * share:.0f} % of its inside differs from the background")
        return tuple(told)

    def refuse_size(self, size: float) -> None:
        """Raises SphereNotFound for an outline far from the radius in pixels that was said."""
        rough = self._hints.rough_radius_pixels
        if rough is not None and not rough / ROUGHLY <= size <= rough * ROUGHLY:
            raise SphereNotFound(
                f"the outline found has a radius of {size:.0f} px, {rough:.0f} px was said"
            )

    def _voted(self, most: int) -> list[Circle]:
        left, top, width, height = self._clip
        crop = np.ascontiguousarray(self._coded[top : top + height, left : left + width])
        largest = 0.6 * float(
            max(self._coded.shape[:2] if self._window is None else self._clip[2:])
        )
        rough = self._hints.rough_radius_pixels
        ends = (6.0, largest) if rough is None else (rough / ROUGHLY, rough * ROUGHLY)
        per_level = CANDIDATES_PER_LEVEL * (MORE if self._hints.weigh else 1)
        voted = [
            Circle(c.u + left, c.v + top, c.radius, c.support)
            for c in vote_for_circles(crop, *ends, per_level=max(per_level, 2 * most))
            if ends[0] / ROUGH_CIRCLE <= c.radius <= ends[1] * ROUGH_CIRCLE
        ]
        if self._changed is not None:
            shares = change_shares(self._changed, voted)
            voted = [c for c, share in zip(voted, shares, strict=True) if share > UNCHANGED]
        if self._hints.weigh:
            voted.sort(key=lambda c: -c.support * np.sqrt(c.radius) * self.weight(c))
        return voted


def evidence_of(rough: RoughSphere) -> float:
    """How much speaks for an outline of which a share is seen, in sigmas over chance.

    Clutter agrees with a part of any circle; the longer the outline, the less that is by chance.
    """
    independent = min(2 * np.pi * rough.circle.radius * rough.visible, INDEPENDENT_EDGES)
    return float((rough.agreement - SHARE_BY_CHANCE) * np.sqrt(independent))


def size_pixels(intrinsics: Intrinsics, outline: SphereOutline) -> float:
    """The radius in pixels that a ball's outline has at the middle of the picture."""
    focal = 0.5 * (intrinsics.fx + intrinsics.fy)
    distance = float(np.linalg.norm(outline.centre_camera))
    return float(focal * np.tan(np.arcsin(outline.radius / distance)))


def clipped(window: Window | None, intrinsics: Intrinsics) -> tuple[int, int, int, int]:
    """The window in whole pixels within the picture. Raises SphereNotFound when it is outside."""
    if window is None:
        return 0, 0, intrinsics.width, intrinsics.height
    x, y, width, height = window
    left, top = max(0, int(np.floor(x))), max(0, int(np.floor(y)))
    right = min(intrinsics.width, int(np.ceil(x + width)))
    bottom = min(intrinsics.height, int(np.ceil(y + height)))
    if right - left < 8 or bottom - top < 8:
        raise SphereNotFound(
            f"the window {[round(float(v)) for v in window]} leaves {max(0, right - left)} x "
            f"{max(0, bottom - top)} px of the {intrinsics.width} x {intrinsics.height} picture"
        )
    return left, top, right - left, bottom - top
