# SPDX-License-Identifier: GPL-3.0-or-later
"""What a picture shows of a place that the robot knows: a ball of known radius, or a point."""

from __future__ import annotations

from dataclasses import dataclass

from .arrays import Array, frozen, positive
from .errors import InvalidValue
from .pose import Pose

# what a camera can see and a robot or a crane can hold; squares of less or more lose their digits
LEAST_RADIUS, MOST_RADIUS = 1e-5, 1e3
# a careful click on a corner
CLICK_SIGMA_PIXELS = 0.5
# a click is no sharper than this, and one worse than that shows nothing
LEAST_SIGMA, MOST_SIGMA = 1e-3, 100.0


@dataclass(frozen=True, eq=False)
class SphereSighting:
    """Where the robot held the ball, and in which picture it is to be found.

    `center_world` (3,) and `radius` in metres; `window` (x, y, width, height) in pixels tells where
    to look, the whole picture without it. Before a fixed camera, `world_from_flange` takes the
    place of `center_world`: the ball sits somewhere on the flange, at the same offset in all
    sightings of one `target`. For a camera on the flange it is where the flange stood, and without
    `center_world` the target's place in the world is unknown. What is not in `use` is kept, but
    left out of calibrations.
    """

    picture: str
    center_world: Array | None
    radius: float
    window: tuple[float, float, float, float] | None = None
    world_from_flange: Pose | None = None
    target: str = ""
    use: bool = True

    def __post_init__(self) -> None:
        _check_place(self)
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


@dataclass(frozen=True, eq=False)
class PointSighting:
    """A known point clicked in a picture at `pixel` (2,), both numbers to 1 `sigma_pixels`.

    Its place is told as a ball's is, and so is `use`.
    """

    picture: str
    center_world: Array | None
    pixel: Array
    sigma_pixels: float = CLICK_SIGMA_PIXELS
    world_from_flange: Pose | None = None
    target: str = ""
    use: bool = True

    def __post_init__(self) -> None:
        _check_place(self)
        object.__setattr__(self, "pixel", frozen(self.pixel, (2,), "pixel"))
        object.__setattr__(self, "sigma_pixels", positive(self.sigma_pixels, "sigma_pixels"))
        if not LEAST_SIGMA <= self.sigma_pixels <= MOST_SIGMA:
            raise InvalidValue(
                f"sigma_pixels: {self.sigma_pixels:g} px; a click is known to between "
                f"{LEAST_SIGMA:g} and {MOST_SIGMA:g} px"
            )


Sighting = SphereSighting | PointSighting


def _check_place(sighting: Sighting) -> None:
    if sighting.center_world is not None:
        place = frozen(sighting.center_world, (3,), "center")
        object.__setattr__(sighting, "center_world", place)
    elif sighting.world_from_flange is None:
        raise InvalidValue(
            "center: is missing; give the place in the world, or world_from_flange where the "
            "offset in the flange is unknown"
        )
