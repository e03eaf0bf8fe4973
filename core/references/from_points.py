# SPDX-License-Identifier: GPL-3.0-or-later
"""World points in, the plane or line through them in its place out."""

from __future__ import annotations

import numpy as np

from ..arrays import Array
from ..errors import DegenerateReference
from .doubt import doubt_of_tilt, noise_scale
from .fits import PointFit, fit_line, fit_plane
from .influences import of_cause
from .placed import Placed, Task
from .sides import seen_side
from .sources import ThroughPoints

# metres, and share of the length, below which points are one place or one line
LEAST_LENGTH, LEAST_SHARE = 1e-6, 1e-6


def through_points(task: Task, source: ThroughPoints) -> Placed:
    """The least-squares plane or line through world points, each weighted by its own sigma.

    Without stated sigmas the scatter about the fit stands for them, where there is one. A plane's
    normal is on the stated side, else on the camera's, else where three points go anticlockwise.

    Raises DegenerateReference for too few points, or points on one line or in one place.
    """
    fewest = 3 if task.kind == "plane" else 2
    if len(source.points) < fewest:
        raise DegenerateReference(
            f"{task.name}: {len(source.points)} points make no {task.kind}; give {fewest} or more"
        )
    exact = source.sigma is None or not source.sigma.any()
    sigma = np.ones(len(source.points)) if source.sigma is None or exact else source.sigma
    fit = (fit_plane if task.kind == "plane" else fit_line)(source.points, sigma**-2)
    _refuse_degenerate(task, fit)
    covariance, warnings = _noise(task, source, fit, sigma)
    direction = fit.direction
    if task.kind == "plane":
        direction = seen_side(task, fit.point, fit.direction, _anticlockwise(source.points))
    error = of_cause(f"points of {task.name}", fit.by_points, covariance)
    placed = Placed(task.kind, fit.point, direction, error, warnings, fit.residuals)
    return doubt_of_tilt(task.name, placed, fit)


def _noise(
    task: Task, source: ThroughPoints, fit: PointFit, sigma: Array
) -> tuple[Array | None, tuple[str, ...]]:
    """The points' covariance (3N, 3N), None where nothing tells it, and a word on misfits."""
    spare = len(sigma) - 3 if task.kind == "plane" else 2 * len(sigma) - 4
    whitened = fit.residuals / sigma
    if source.sigma is None:
        # the scatter alone, and with as many points as the fit has unknowns there is none
        scatter = float(np.sqrt(whitened @ whitened / max(spare, 1)))
        return (None if spare < 1 else scatter**2 * np.eye(3 * len(sigma))), ()
    if not source.sigma.any():
        return np.zeros((3 * len(sigma), 3 * len(sigma))), ()
    scale = noise_scale(whitened, spare)
    covariance = np.diag(np.repeat((scale * sigma) ** 2, 3))
    if scale == 1.0:
        return covariance, ()
    worst = int(np.argmax(np.abs(whitened)))
    return covariance, (
        f"{task.name}: the points miss the {task.kind} by up to "
        f"{1e3 * abs(fit.residuals[worst]):.3g} mm (points[{worst}]), {scale:.1f} times what their "
        "sigma explains; its error is stated as that much larger",
    )


def _refuse_degenerate(task: Task, fit: PointFit) -> None:
    if fit.length < LEAST_LENGTH:
        raise DegenerateReference(
            f"{task.name}: its points lie within {1e3 * fit.length:.2g} mm of each other; "
            "give points that are apart"
        )
    if task.kind == "plane" and fit.width < LEAST_SHARE * fit.length:
        raise DegenerateReference(
            f"{task.name}: its points lie within {1e3 * fit.width:.2g} mm of one line "
            f"{1e3 * fit.length:.4g} mm long; give one beside it"
        )


def _anticlockwise(points: Array) -> Array:
    """The direction from which the points go anticlockwise, of no certain length."""
    arms = points - points.mean(axis=0)
    normal: Array = np.cross(arms, np.roll(arms, -1, axis=0)).sum(axis=0)
    return normal
