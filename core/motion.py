# SPDX-License-Identifier: GPL-3.0-or-later
"""How an object may move: not at all, freely with a mass, or on a joint of another object."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .arrays import Array, frozen, positive
from .errors import InvalidValue

MOTIONS = ("static", "movable", "attached")
JOINTS = ("fixed", "hinge", "slider")


@dataclass(frozen=True, eq=False)
class Motion:
    """`static`; `movable`; or `attached` to the object `to` by a `joint`.

    `mass` in kg or `density` in kg/m^3, not both; neither leaves the choice to the user of the
    scene. A hinge turns about, a slider moves along, `axis` (3,) through `point` (3,), both in the
    object's own frame; `limits` (lower, upper) in radians or metres from where it stands.

    Raises InvalidValue for a mass of what is static, or a joint without what it needs.
    """

    kind: str = "static"
    mass: float | None = None
    density: float | None = None
    to: str | None = None
    joint: str | None = None
    axis: Array | None = None
    point: Array | None = None
    limits: tuple[float, float] | None = None

    def __post_init__(self) -> None:
        if self.kind not in MOTIONS:
            raise InvalidValue(f"motion {self.kind!r} is none of {', '.join(MOTIONS)}")
        self._check_mass()
        if self.kind == "attached":
            self._check_joint()
        elif any(v is not None for v in (self.to, self.joint, self.axis, self.point, self.limits)):
            raise InvalidValue(f"motion {self.kind}: only `attached` has a joint to something")

    def _check_mass(self) -> None:
        if self.kind == "static" and (self.mass is not None or self.density is not None):
            raise InvalidValue("motion static: what never moves needs no mass; call it movable")
        if self.mass is not None and self.density is not None:
            raise InvalidValue("motion: mass and density are both given; give one")
        for name in ("mass", "density"):
            if getattr(self, name) is not None:
                object.__setattr__(self, name, positive(getattr(self, name), f"motion.{name}"))

    def _check_joint(self) -> None:
        if not self.to or self.joint not in JOINTS:
            raise InvalidValue(
                f"motion attached: needs `to`, an object's name, and `joint`, one of "
                f"{', '.join(JOINTS)}; got to {self.to!r}, joint {self.joint!r}"
            )
        if self.joint == "fixed":
            if self.axis is not None or self.point is not None or self.limits is not None:
                raise InvalidValue("motion attached: a fixed joint has no axis, point or limits")
            return
        if self.axis is None:
            raise InvalidValue(f"motion attached: a {self.joint} needs its axis")
        axis = frozen(self.axis, (3,), "motion.axis")
        length = float(np.linalg.norm(axis))
        if length < 1e-9:
            raise InvalidValue("motion.axis: has no length, so it gives no direction")
        # a unit vector that was written and read again keeps its last digit
        unit = axis if abs(length - 1) < 1e-15 else axis / length
        object.__setattr__(self, "axis", frozen(unit, (3,), "motion.axis"))
        point = np.zeros(3) if self.point is None else self.point
        object.__setattr__(self, "point", frozen(point, (3,), "motion.point"))
        if self.limits is not None:
            lower, upper = (float(v) for v in frozen(self.limits, (2,), "motion.limits"))
            if lower > 0 or upper < 0:
                raise InvalidValue(
                    f"motion.limits: from {lower:g} to {upper:g} leaves out 0, where it stands"
                )
            object.__setattr__(self, "limits", (lower, upper))
