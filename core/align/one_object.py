# SPDX-License-Identifier: GPL-3.0-or-later
"""One rough object, the picture and what stands about in; its best fit on the edges out, judged."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..camera import Camera
from ..modelling.solid import Solid
from ..picture.pictures import Picture
from .depth_order import hull_of
from .foot import foot_rivals
from .freedom import Freedom
from .hypotheses import hull_points, outlines
from .prior import prior_root, strayed_sigmas
from .refine import EdgeFit, refine, rivalry
from .search import Found, Surroundings, Worth, search
from .sight import PictureSight
from .stations import CREASES, Look
from .verdict import Verdict, texture_of, verdict, with_strayed
from .window import looked_up

# two searches, one led by edges and one by colours: where they differ, doubt begins
SEARCHES = (
    (Worth(0.1, 1.0, 4.0), Worth(0.0, 2.0, 6.0)),
    (Worth(1.0, 0.0, 2.0), Worth(0.0, 2.0, 6.0)),
)
# an edge counts to this distance, pixels; an outline without edges costs this share of it
NEAR_PIXELS, EDGELESS = 0.8, 0.35
POINTS, BESIDE, LOUDEST = 96, (2.0, 4.0), 2.5


@dataclass(frozen=True, eq=False)
class Tried:
    """The best fit of an object and its verdict; `fit` is None where no search came to one.

    `texture` is as of `texture_of`.
    """

    fit: EdgeFit | None
    verdict: Verdict
    texture: float = 0.0


def align_one(
    start: Solid,
    freedom: Freedom,
    camera: Camera,
    sight: PictureSight,
    around: Surroundings,
    hidden: Picture,
    reach_pixels: float,
) -> Tried:
    """Search and fit; `hidden` (H, W) is above 0 where others are in front or too near."""
    basis = freedom.basis(start)
    stated = freedom.thing.covariance
    root = prior_root(start, basis, camera, reach_pixels, stated)
    if root is None:
        return _nothing("it is not in the picture, or nothing of it is free to move")
    motions = basis @ root
    ends: list[tuple[EdgeFit, Found, Look]] = []
    for worth in SEARCHES:
        found = search(start, freedom, motions, camera, sight, around, worth)
        if found is None:
            return _nothing("it is not in the picture")
        stands = freedom.thing.on is not None
        look = Look(
            sight.light, sight.blur, sight.noise, hidden, found.window, found.region, stands
        )
        own = freedom.basis_like(found.solid, motions)
        fit = refine(found.solid, freedom, own, camera, look)
        if fit is not None:
            ends.append((fit, found, look))
    if not ends:
        return _nothing("the picture has no edges where it should have its own")
    tried = _best(ends, camera, sight)
    if stated is None or tried.fit is None:
        return tried
    strayed = strayed_sigmas(start, tried.fit.solid, basis, stated)
    return replace(tried, verdict=with_strayed(tried.verdict, strayed))


def _best(
    ends: Sequence[tuple[EdgeFit, Found, Look]],
    camera: Camera,
    sight: PictureSight,
) -> Tried:
    scores = [
        _on_edges(fit) + float(np.mean([_sides(fit, found, camera) for _, found, _ in ends]))
        for fit, _, _ in ends
    ]
    fit, _, look = ends[int(np.argmax(scores))]
    hull = hull_of(fit.solid, camera)
    texture = 0.0 if hull is None else texture_of(hull, fit, sight.edges)
    others = [other for other, _, _ in ends if other is not fit]
    judged = verdict(
        fit,
        others,
        rivalry(fit, camera, look),
        texture,
        foot_rivals(fit, camera, look),
    )
    if len(ends) < len(SEARCHES):
        judged = Verdict(False, (*judged.reasons, "only one of two searches came to an end"))
    return Tried(fit, judged, texture)


def _nothing(reason: str) -> Tried:
    return Tried(None, Verdict(False, (reason,)))


def _on_edges(fit: EdgeFit) -> float:
    """Pixels of visible edges that lie on the picture's, less a share of them all."""
    worth = np.where(fit.stations.outline, 1.0, CREASES) * fit.stations.length
    near = np.maximum(0, 1 - np.square(np.nan_to_num(fit.residual, nan=9.0) / NEAR_PIXELS))
    return float((worth * (near - EDGELESS)).sum())


def _sides(fit: EdgeFit, found: Found, camera: Camera) -> float:
    """Pixels of outline that part the object's colours from others."""
    still = np.zeros((1, 6 + len(fit.solid.parameters)))
    drawn = outlines(hull_points(fit.solid, still, camera), POINTS)
    own, other = (
        np.mean(
            [
                looked_up(
                    found.region[:, :, None],
                    found.window.places(drawn.pixels + side * away * drawn.normals),
                )[0, :, 0]
                for away in BESIDE
            ],
            axis=0,
        )
        for side in (-1, 1)
    )
    return float((own - other).sum() / 2 * drawn.step[0] / LOUDEST)
