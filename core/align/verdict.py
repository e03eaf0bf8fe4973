# SPDX-License-Identifier: GPL-3.0-or-later
"""An object's edge fits from several searches in, whether the best can be believed out, and why.

Strong edges in a wrong place look like right ones. So each fit has to be found by every search
alike, to have no rival that nearly as many edges vote for, to be determined by its edges in every
direction, and to have its foot on an edge: most wrong fits follow a shadow there. What was picked
before must agree with it within what the picks say of themselves.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np

from ..arrays import Array
from .edge_map import EdgeMap
from .refine import ROUGH, EdgeFit
from .stations import CREASES

# searches may end this far apart, rms pixels; what edges leave open at the worst place, 1 sigma
APART_PIXELS, OPEN_PIXELS = 0.5, 0.16
# what even agreeing edges have in common that is wrong, 1 sigma of every station
COMMON_PIXELS = 0.15
# rivals may have this share of the votes; edges inside the outline, per pixel of its area
RIVAL_SHARE, TEXTURE = 1.0, 0.1
# the foot of what stands on something is held by so much of an edge at least, pixels
FOOT_PIXELS = 12.0
# picks and edges that show the same object agree within so many sigmas, as rms of all directions
STRAYED_SIGMAS = 2.5
# edges below the foot may have this share of its votes
LOWER_SHARE = 0.7
# of the visible outline so much has an edge
SUPPORTED_SHARE = 0.8
CREASE_MARGIN = 9
TEXTURE_MARGIN = np.ones((9, 9), dtype=np.uint8)


@dataclass(frozen=True)
class Verdict:
    """Whether a fit is believed; if not, the reasons with their numbers."""

    believed: bool
    reasons: tuple[str, ...]


def verdict(
    fit: EdgeFit,
    others: Sequence[EdgeFit],
    rivals: float,
    texture: float,
    feet: float,
) -> Verdict:
    """Judge a fit beside those of `others` searches.

    `rivals` is as of `refine.rivalry`, `texture` as of `texture_of`, `feet` as of
    `foot.foot_rivals`.
    """
    told = [
        _supported(fit),
        _open(fit),
        _foot(fit),
        _apart(fit, others),
        (
            f"below its foot lie edges with {100 * feet:.0f} % of the foot's votes"
            if feet > LOWER_SHARE
            else None
        ),
        (
            f"edges elsewhere have {100 * rivals:.0f} % of its votes"
            if rivals > RIVAL_SHARE
            else None
        ),
        (
            f"its texture has edges like its outline's on {100 * texture:.0f} % of its area"
            if texture > TEXTURE
            else None
        ),
    ]
    reasons = tuple(reason for reason in told if reason is not None)
    return Verdict(not reasons, reasons)


def with_strayed(judged: Verdict, sigmas: float) -> Verdict:
    """A verdict that also knows how far from its picks the fit is, in sigmas of theirs."""
    if sigmas <= STRAYED_SIGMAS:
        return judged
    told = f"its edges lie {sigmas:.1f} sigmas from where it was: its picks or its edges are wrong"
    return Verdict(False, (*judged.reasons, told))


def supported_share(fit: EdgeFit) -> float:
    """The part of the visible outline that has an edge where the solid's is."""
    length = fit.stations.length * fit.stations.outline
    return float((length * fit.supported).sum() / max(float(length.sum()), 1e-9))


def moved_pixels(fit: EdgeFit, tangent: Array) -> float:
    """How far a motion (6 + P,) of the solid moves its visible edges, rms pixels."""
    return float(np.sqrt(np.mean((fit.stations.by_object @ tangent) ** 2)))


def texture_of(hull: Array, fit: EdgeFit, edges: EdgeMap) -> float:
    """Edges per pixel inside an outline (M, 2), away from it and from the solid's own edges."""
    x, y, width, height = cv2.boundingRect(np.round(hull).astype(np.int32))
    x, y = max(x, 0), max(y, 0)
    part = edges.structure[y : y + height, x : x + width]
    if not part.size:
        return 0.0
    mask = np.zeros(part.shape[:2], dtype=np.uint8)
    cv2.fillConvexPoly(mask, np.round(hull - [x, y]).astype(np.int32), (1,))
    for own in fit.stations.pixels[~fit.stations.outline] - [x, y]:
        cv2.circle(mask, (round(own[0]), round(own[1])), CREASE_MARGIN, (0,), -1)
    inside = cv2.erode(mask, TEXTURE_MARGIN) > 0
    weight = part[..., 0] + part[..., 2]
    return float(weight[inside].sum() / max(int(inside.sum()), 1))


def _supported(fit: EdgeFit) -> str | None:
    share = supported_share(fit)
    if share >= SUPPORTED_SHARE:
        return None
    return f"only {100 * share:.0f} % of its visible outline lies on edges"


def _open(fit: EdgeFit) -> str | None:
    worth = np.where(fit.stations.outline, 1.0, CREASES) * fit.supported
    over = worth / (fit.sigma**2 + COMMON_PIXELS**2)
    information = (fit.jacobian * over[:, None]).T @ fit.jacobian
    covariance = np.linalg.inv(information + np.eye(len(information)) / ROUGH**2)
    spread = np.einsum("si,ij,sj->s", fit.jacobian, covariance, fit.jacobian)
    worst = float(np.sqrt(spread.max()))
    if worst <= OPEN_PIXELS:
        return None
    return f"its edges leave {worst:.2f} px of its outline open"


def _foot(fit: EdgeFit) -> str | None:
    at_foot = np.array(["base" in name for name in fit.names])[fit.stations.curve]
    if not fit.stands:
        return None
    length = float((fit.stations.length * at_foot * fit.stations.outline * fit.supported).sum())
    if length >= FOOT_PIXELS:
        return None
    return f"where it stands only {length:.0f} px of an edge show"


def _apart(fit: EdgeFit, others: Sequence[EdgeFit]) -> str | None:
    apart = max((moved_pixels(fit, fit.tangent_to(other.solid)) for other in others), default=0.0)
    if apart <= APART_PIXELS:
        return None
    return f"two searches end {apart:.1f} px apart"
