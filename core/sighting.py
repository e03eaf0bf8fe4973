# SPDX-License-Identifier: GPL-3.0-or-later
"""A ball of known radius seen at a known place in the world."""

from __future__ import annotations

from dataclasses import dataclass

from .arrays import Array, frozen, positive
from .errors import InvalidValue

# what a camera can see and a robot or a crane can hold; squares of less or more lose their digits
LEAST_RADIUS, MOST_RADIUS = 1e-5, 1e3


@dataclass(frozen=True, eq=False)
class SphereSighting:
    """Where the robot held the ball, and in which picture it is to be found.

    `center_world` (3,) and `radius` in metres; `window` (x, y, width, height) in pixels tells where
    to look, the whole picture without it.
    """

    picture: str
    center_world: Array
    radius: float
    window: tuple[float, float, float, float] | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "center_world", frozen(self.center_world, (3,), "center"))
        object.__setattr__(self, "radius", positive(self.radius, "radius"))
        if not LEAST_RADIUS <= self.radius <= MOST_RADIUS:
            raise InvalidValue(
                f"radius: {self.radius:g} m is no ball's; give metres, "
                f"{LEAST_RADIUS:g} to {MOST_RADIUS:g}"
            )
        if self.window is not None:
            x, y, width, height = frozen(self.window, (4,), "window").tolist()
            if width < 8 or height < 8:
                raise InvalidValue(
                    f"window: {width:g} x {height:g} px is too small to hold a ball; "
                    "give [x, y, width, height] of at least 8 x 8 px"
                )
            object.__setattr__(self, "window", (x, y, width, height))
