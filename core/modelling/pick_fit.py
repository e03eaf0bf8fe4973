# SPDX-License-Identifier: GPL-3.0-or-later
"""Residuals of picks in pixels in, the best parameters with their covariance and doubts out."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..arrays import Array, Mask
from ..camera import Camera
from ..covariance import inverse_information, propagated
from ..errors import PickError
from ..least_squares import levenberg_marquardt
from ..primitives import Primitive

# a size whose 1 sigma is beyond this share of it deserves a word
DOUBTFUL_SHARE = 0.1


@dataclass(frozen=True, eq=False)
class Modelled:
    """A solved object, how far each pick is from it in pixels, and what is doubtful.

    `residual_pixels` (N,) follow the order of the picks, role by role: distances for corners,
    signed distances for curves. `rms_pixels` is their root mean square.
    """

    object: Primitive
    residual_pixels: Array
    rms_pixels: float
    warnings: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class PickEquations:
    """Residuals (N,) in pixels with derivatives by the parameters (N, P) and the twist (N, 6)."""

    residuals: Array
    by_parameters: Array
    by_twist: Array


@dataclass(frozen=True, eq=False)
class PickFit:
    """The parameters (P,) that fit the picks best; those not `free` were given.

    `sigma` is the stated 1 sigma of a pick in pixels.
    """

    parameters: Array
    free: Mask
    equations: PickEquations
    sigma: float
    converged: bool

    @property
    def chi_squared(self) -> float:
        """The sum of squared residuals in units of the stated pick noise."""
        return float(np.sum((self.equations.residuals / self.sigma) ** 2))

    @property
    def spare_equations(self) -> int:
        return len(self.equations.residuals) - int(self.free.sum())

    @cached_property
    def noise_scale(self) -> float:
        """How many times the stated noise the residuals show; 1 unless they clearly exceed it.

        Clearly: beyond two standard deviations of chi squared, and never with fewer than two spare
        equations, which could not tell.
        """
        if self.spare_equations < 2:
            return 1.0
        reduced = self.chi_squared / self.spare_equations
        usual = 1.0 + 2.0 * float(np.sqrt(2.0 / self.spare_equations))
        return float(np.sqrt(reduced)) if reduced > usual else 1.0

    def covariance(self, camera: Camera) -> Array | None:
        """Covariance (P, P) from pick noise and the camera's pose; None if not determined.

        The solution satisfies the normal equations J^T r = 0, so it follows a twist x of the camera
        by `-(J^T J)^-1 J^T dr/dx` (implicit function theorem, to first order in the residuals).
        """
        jacobian = self.equations.by_parameters[:, self.free]
        inverse = inverse_information(jacobian.T @ jacobian)
        if inverse is None:
            return None
        solved = inverse * (self.sigma * self.noise_scale) ** 2
        if camera.covariance is not None:
            by_twist = -inverse @ jacobian.T @ self.equations.by_twist
            solved = solved + propagated(by_twist, camera.covariance)
        whole = np.zeros((len(self.free), len(self.free)))
        whole[np.ix_(self.free, self.free)] = solved
        return whole


def fit_picks(
    start: Array,
    free: Mask,
    equations: Callable[[Array], PickEquations],
    sigma: float,
    steps: int = 100,
) -> PickFit | None:
    """Least squares over the `free` of the parameters; None where the start is not imaged at all.

    `equations` may give NaN for parameters that can't be seen: the descent then turns back.
    """
    first = equations(start)
    if not all(np.isfinite(a).all() for a in (first.residuals, first.by_parameters)):
        return None

    def evaluate(parameters: Array) -> tuple[Array, Array]:
        at = equations(parameters)
        return at.residuals / sigma, at.by_parameters[:, free] / sigma

    def move(parameters: Array, step: Array) -> Array:
        moved = parameters.copy()
        moved[free] += step
        return moved

    minimum = levenberg_marquardt(start, evaluate, move, steps=steps, tolerance=1e-12)
    value = minimum.value
    return PickFit(value, free, equations(value), sigma, minimum.converged)


def covariance_or_refusal(
    fit: PickFit, camera: Camera, name: str, parameter_names: Sequence[str]
) -> Array:
    """The fit's covariance (P, P). Raises PickError naming what the picks leave open."""
    covariance = fit.covariance(camera)
    if covariance is not None:
        return covariance
    jacobian = fit.equations.by_parameters[:, fit.free]
    scale = np.linalg.norm(jacobian, axis=0)
    _, _, directions = np.linalg.svd(jacobian / np.where(scale > 0, scale, 1.0))
    # the parameters that may move without moving any residual
    loose = np.abs(directions[-1]) > 0.1
    names = [n for n, free in zip(parameter_names, fit.free, strict=True) if free]
    open_ones = ", ".join(n for n, is_loose in zip(names, loose, strict=True) if is_loose)
    raise PickError(f"{name}: the picks do not determine {open_ones}; add picks or a known size")


def fit_warnings(
    fit: PickFit, camera: Camera, solved: Primitive, labels: Sequence[str], distances: Array
) -> tuple[str, ...]:
    """What is doubtful about a fit: residuals above the stated noise, and sizes barely known."""
    warnings = []
    if not fit.converged:
        warnings.append(f"{solved.name}: the fit had not settled when its steps ran out")
    if fit.noise_scale > 1.0:
        worst = int(np.argmax(np.abs(distances)))
        warnings.append(
            f"{solved.name}: the picks miss the {solved.kind} by {rms(distances):.1f} px rms, more "
            f"than {fit.sigma:g} px of pick noise explain; the worst is {labels[worst]} with "
            f"{abs(distances[worst]):.1f} px"
        )
    sigmas = solved.size_sigma()
    if sigmas is not None:
        warnings += [
            f"{solved.name}: {size} {1e3 * value:.1f} mm is only known to {1e3 * sigma:.1f} mm"
            for size, value, sigma in zip(solved.size_names, solved.sizes, sigmas, strict=True)
            if sigma > DOUBTFUL_SHARE * value
        ]
    return tuple(warnings)


def rms(values: Array) -> float:
    """Root mean square, 0 for none."""
    return float(np.sqrt(np.mean(values**2))) if len(values) else 0.0
