# SPDX-License-Identifier: GPL-3.0-or-later
"""Covariance matrices: checked on the way in, propagated through derivatives on the way on."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from .arrays import Array, frozen
from .errors import InvalidValue


def checked_covariance(value: ArrayLike, size: int, name: str) -> Array:
    """A read-only, symmetric, positive semi-definite (size, size) matrix. Raises InvalidValue."""
    matrix = frozen(value, (size, size), name)
    scale = np.sqrt(np.abs(np.diag(matrix)))
    tolerance = 1e-6 * np.outer(scale, scale) + 1e-300
    if (np.diag(matrix) < 0).any() or (np.abs(matrix - matrix.T) > tolerance).any():
        raise InvalidValue(f"{name}: not a covariance (not symmetric, or negative on its diagonal)")
    unit = matrix / np.outer(np.where(scale > 0, scale, 1.0), np.where(scale > 0, scale, 1.0))
    lowest = float(np.linalg.eigvalsh(unit).min())
    if lowest < -1e-6:
        raise InvalidValue(f"{name}: not a covariance (an eigenvalue of {lowest:.2g})")
    return matrix


def propagated(jacobian: Array, covariance: Array) -> Array:
    """`J C J^T` over leading dimensions: (..., m, n) and (n, n) to (..., m, m)."""
    result: Array = jacobian @ covariance @ np.swapaxes(jacobian, -1, -2)
    return result


def remainder(covariance: Array, share: Array) -> Array:
    """What is left of a covariance without a part of it that is told apart, both (N, N).

    A share that is larger somewhere, as after another calibration, leaves nothing there.
    """
    scale = np.sqrt(np.maximum(np.diag(covariance), np.diag(share)))
    unit = np.where(scale > 0, scale, 1.0)
    values, vectors = np.linalg.eigh((covariance - share) / np.outer(unit, unit))
    rest: Array = (vectors * np.maximum(values, 0.0)) @ vectors.T * np.outer(unit, unit)
    return rest


def bound_of_sum(parts: Sequence[Array]) -> Array:
    """An upper bound (..., N, N) of the covariance of a sum whose terms may be correlated anyhow.

    `sum C_i / w_i` with weights that sum to 1 is one for every choice of them (covariance
    intersection, Julier and Uhlmann 1997); here they give the least trace: sigmas add up.
    """
    sigmas = np.sqrt(np.array([np.trace(part, axis1=-2, axis2=-1) for part in parts]))
    whole = sigmas.sum(axis=0)
    with np.errstate(divide="ignore", invalid="ignore"):
        weights = np.where(sigmas > 0, whole / sigmas, 0.0)
    bound: Array = (np.array(parts) * weights[..., None, None]).sum(axis=0)
    return bound


def inverse_information(information: Array) -> Array | None:
    """The inverse of a normal matrix, or None where some direction is not determined.

    Rows and columns are scaled first, so that metres beside radians do not hide a weak direction.
    """
    diagonal = np.diag(information)
    if not np.isfinite(information).all() or (diagonal <= 0).any():
        return None
    scale = 1.0 / np.sqrt(diagonal)
    scaled = information * np.outer(scale, scale)
    values, vectors = np.linalg.eigh(scaled)
    if values.min() < 1e-12 * values.max():
        return None
    inverse: Array = (vectors / values) @ vectors.T * np.outer(scale, scale)
    return 0.5 * (inverse + inverse.T)
