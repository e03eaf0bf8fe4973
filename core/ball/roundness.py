# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether an outline is a ball's or a disc's seen aslant: edges around it in, a refusal out.

A part of an ellipse passes for a circle. Around the axis to a ball's centre, its outline is a
circle through any lens; a conic that explains far more of the edges there, and is none, betrays the
end of a cylinder, a coin or a ring.
"""

from __future__ import annotations

import numpy as np

from ..arrays import Array, Mask
from ..errors import SphereNotFound
from ..intrinsics import Intrinsics
from .circle_votes import Circle
from .ring_edges import EDGES_PER_PROFILE, PROFILES, Pyramid, RingEdges, Span, edges_around

LOOKED_AT = Span(0.4, 1.6, 24.0, 0.03)
# a conic must be this narrow and explain this much more of the profiles to outdo the ball
ROUND_RATIO, MORE_EXPLAINED, LEAST_EXPLAINED = 0.95, 0.3, 0.7
# from coarse to fine, in shares of the radius
SCALES = np.geomspace(0.3, 0.03, 10)


def refuse_ellipse(
    pyramid: Pyramid, intrinsics: Intrinsics, circle: Circle, centre_camera: Array, radius: float
) -> None:
    """Raises SphereNotFound when the edges around a ball's outline form an ellipse instead."""
    edges = edges_around(pyramid, intrinsics, [circle], LOOKED_AT)
    polar, strength = _around_axis(edges, centre_camera, radius)
    conic = _conic(polar, strength)
    ratio = _axis_ratio(conic)
    as_ball = _share(np.abs(polar[0] - 1) < LOOKED_AT.agreement, strength, edges)
    off = np.abs(_design(polar) @ conic - polar[0] ** -2) / 2
    as_conic = _share(off < LOOKED_AT.agreement, strength, edges)
    if ratio < ROUND_RATIO and as_conic > LEAST_EXPLAINED and as_conic > as_ball + MORE_EXPLAINED:
        raise SphereNotFound(
            f"{100 * as_conic:.0f} % of the outline lies on an ellipse of axis ratio {ratio:.2f}, "
            f"{100 * as_ball:.0f} % on a ball's: it looks like a disc or a ring seen aslant"
        )


def _around_axis(edges: RingEdges, centre: Array, radius: float) -> tuple[Array, Array]:
    """Edges (2, M) as distance from a ball's axis, 1 on its outline, and angle; their weights."""
    axis = centre / np.linalg.norm(centre)
    rays, weights = edges.rays[0], edges.weights[0]
    along = rays @ axis
    across = rays - along[:, None] * axis
    right = np.array([axis[2], 0.0, -axis[0]])
    right /= max(float(np.linalg.norm(right)), 1e-12)
    x, y = across @ right, across @ np.cross(axis, right)
    tangent = radius / np.sqrt(float(centre @ centre) - radius * radius)
    good = (weights > 0) & (along > 1e-6)
    distance = np.where(good, np.hypot(x, y) / np.where(good, along, 1) / tangent, 10.0)
    return np.stack([np.maximum(distance, 1e-3), np.arctan2(y, x)]), np.where(good, weights, 0)


def _conic(polar: Array, strength: Array) -> Array:
    """The conic (5,) that most edges lie on, by weights that narrow from coarse to fine.

    `A x^2 + B x y + C y^2 + D x + E y = 1`, divided by the distance squared.
    """
    design, target = _design(polar), polar[0] ** -2
    conic = np.array([1.0, 0.0, 1.0, 0.0, 0.0])
    for scale in SCALES:
        off = (design @ conic - target) / 2
        root = strength / (1 + (off / scale) ** 2)
        conic = np.linalg.lstsq(design * root[:, None], target * root, rcond=None)[0]
    return conic


def _design(polar: Array) -> Array:
    distance, angle = polar
    c, s = np.cos(angle), np.sin(angle)
    return np.stack([c * c, c * s, s * s, c / distance, s / distance], axis=1)


def _axis_ratio(conic: Array) -> float:
    """The shorter by the longer axis; 0 for what is no ellipse."""
    a, b, c = conic[:3].tolist()
    least, most = np.linalg.eigvalsh([[a, b / 2], [b / 2, c]])
    return float(np.sqrt(max(least, 0.0) / most)) if most > 0 else 0.0


def _share(near: Mask, strength: Array, edges: RingEdges) -> float:
    """The share of the visible profiles one of whose edges is near."""
    hit = (near & (strength > 0.2)).reshape(EDGES_PER_PROFILE, PROFILES).any(axis=0)
    return float(hit.mean() / edges.visible[0])
