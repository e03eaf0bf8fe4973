# SPDX-License-Identifier: GPL-3.0-or-later
"""Fits on edges in, what they say as rows of a least-squares problem out, as picks do.

Near where a fit ended, its edges stay where they are: the rows are linear in the object's tangent
and in the camera's twist.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ..arrays import Array
from ..camera import Camera
from ..modelling.observed import Observe, Observed
from ..modelling.solid import Solid
from ..robust import correlation_inflation
from ..rotation import vector_from_rotation
from .refine import EdgeFit, tangent

# what all stations of one edge may share that is wrong: shading, encoding, the lens; 1 sigma
COMMON_PIXELS = 0.12
# a weight below this tells nothing
LEAST_WEIGHT = 0.05


def edge_observer(fits: Mapping[str, EdgeFit], camera: Camera) -> Observe:
    """What the edges of the fits, found through `camera`, say of other solids and cameras."""
    rows = {name: _rows(fit) for name, fit in fits.items()}

    def observe(solids: Mapping[str, Solid], tried: Camera) -> Mapping[str, Observed]:
        twist = _twist(camera, tried)
        return {
            name: _moved(rows[name], tangent(fits[name].solid, solid), twist)
            for name, solid in solids.items()
            if name in rows
        }

    return observe


def _moved(rows: Observed, step: Array, twist: Array) -> Observed:
    residuals = rows.residuals + rows.by_object @ step + rows.by_camera @ twist
    return Observed(residuals, rows.by_object, rows.by_camera, rows.sigma)


def _rows(fit: EdgeFit) -> Observed:
    """The stations that lie on edges, with sigmas that hold what neighbours repeat."""
    stations = fit.stations
    weight = fit.weight * stations.worth
    kept = fit.supported & (weight > LEAST_WEIGHT)
    scatter = np.where(kept, np.nan_to_num(fit.residual) / fit.sigma, 0.0)
    inflation = correlation_inflation(scatter, kept, 6) if kept.sum() > 8 else 1.0
    scale = max(1.0, float(np.sqrt(np.mean(scatter[kept] ** 2))) if kept.any() else 1.0)
    count = np.bincount(stations.curve[kept], minlength=int(stations.curve.max()) + 1)
    common = COMMON_PIXELS * np.sqrt(count[stations.curve[kept]])
    sigma = fit.sigma[kept] * scale * np.sqrt(inflation / weight[kept])
    return Observed(
        fit.residual[kept],
        stations.by_object[kept],
        stations.by_camera[kept],
        np.hypot(sigma, common),
    )


def _twist(start: Camera, end: Camera) -> Array:
    """The twist (6,) of `Pose.perturbed` from one camera's pose to another's."""
    if start is end:
        return np.zeros(6)
    moved = end.pose @ start.pose.inverse()
    return np.concatenate([vector_from_rotation(moved.rotation), moved.translation])
