# SPDX-License-Identifier: GPL-3.0-or-later
"""Independent causes of error and how a quantity follows each in, its covariance out.

What was made from the same picks, the same object or the same camera errs together. Hence every
quantity keeps, to first order, how it follows each cause, and two that are combined add up cause by
cause, not covariance by covariance.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from ..arrays import Array
from ..camera import Camera
from ..covariance import bound_of_sum, propagated, remainder
from ..primitive import Primitive

CAMERA = "the camera"


@dataclass(frozen=True, eq=False)
class Cause:
    """One source of error: its covariance (K, K), None where none is stated.

    `entangled` when it hangs on the camera in a way that is not known.
    """

    covariance: Array | None
    entangled: bool = False


@dataclass(frozen=True, eq=False)
class Influences:
    """How a quantity (M,) follows each cause: derivatives (M, K) by the cause's name."""

    rows: int
    parts: Mapping[str, tuple[Array, Cause]] = field(default_factory=dict)

    def through(self, jacobian: Array) -> Influences:
        """Those of another quantity (R,) that follows this one by `jacobian` (R, M)."""
        moved = {name: (jacobian @ by, cause) for name, (by, cause) in self.parts.items()}
        return Influences(len(jacobian), moved)

    def __add__(self, other: Influences) -> Influences:
        parts = dict(self.parts)
        for name, (by, cause) in other.parts.items():
            parts[name] = (by + parts[name][0], cause) if name in parts else (by, cause)
        return Influences(self.rows, parts)

    @property
    def entangled(self) -> bool:
        """Whether part of the error hangs on the camera in a way that is not known."""
        return any(cause.entangled for _, cause in self.parts.values())

    @property
    def by_camera(self) -> Array | None:
        """The derivative (M, 6) by the camera's twist; None where it is not known."""
        if self.entangled:
            return None
        by, _ = self.parts.get(CAMERA, (np.zeros((self.rows, 6)), None))
        return by

    def covariance(self) -> Array | None:
        """The joint covariance (M, M), None when no cause states any error.

        An upper bound where objects hang on the camera in a way that is not known.
        """
        stated = {
            name: (propagated(by, cause.covariance), cause.entangled)
            for name, (by, cause) in self.parts.items()
            if cause.covariance is not None
        }
        if not stated:
            return None
        tangle = [part for name, (part, e) in stated.items() if e or name == CAMERA]
        free = [part for name, (part, e) in stated.items() if not (e or name == CAMERA)]
        whole = sum(free, np.zeros((self.rows, self.rows)))
        if tangle:
            whole = whole + (bound_of_sum(tangle) if self.entangled else sum(tangle))
        return 0.5 * (whole + whole.T)


def of_cause(name: str, by: Array, covariance: Array | None) -> Influences:
    """A quantity that follows one cause, by derivatives (M, K)."""
    return Influences(len(by), {name: (by, Cause(covariance))})


def of_camera(by_twist: Array, camera: Camera) -> Influences:
    """A quantity that follows the camera's twist, by derivatives (M, 6)."""
    return of_cause(CAMERA, by_twist, camera.covariance)


def of_object(thing: Primitive, camera: Camera) -> Influences:
    """An object's tangent (6 + P,): what it shares with the camera, and the rest of its error."""
    name, identity = f"object {thing.name}", np.eye(6 + len(thing.parameters))
    if thing.covariance is None or camera.covariance is None:
        return of_cause(name, identity, thing.covariance)
    if thing.by_camera is None:
        return Influences(
            len(identity), {name: (identity, Cause(thing.covariance, entangled=True))}
        )
    share = propagated(thing.by_camera, camera.covariance)
    rest = of_cause(name, identity, remainder(thing.covariance, share))
    return rest + of_camera(thing.by_camera, camera)


def blocks(parts: Array) -> Array:
    """Matrices (N, R, C) down the diagonal of one, (N R, N C)."""
    n, r, c = parts.shape
    whole = np.zeros((n, r, n, c))
    whole[np.arange(n), :, np.arange(n), :] = parts
    return whole.reshape(n * r, n * c)
