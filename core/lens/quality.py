# SPDX-License-Identifier: GPL-3.0-or-later
"""What the pictures can tell of a lens: a fit in, coverage, tilts, patterns and errors out."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import cv2
import numpy as np

from ..arrays import Array
from ..covariance import propagated
from .bundle import LensFit
from .parameters import parameter_names, picture_corners, pixels_by_parameters

# cells along the longer side of the picture, of which each is covered or not
CELLS = 24
RINGS = 6
FEWEST_IN_RING = 12


@dataclass(frozen=True, eq=False)
class Ring:
    """The mean residual away from the principal point between two radii, with 1 sigma, in px."""

    inner: float
    outer: float
    outward: float
    sigma: float


@dataclass(frozen=True, eq=False)
class LensQuality:
    """How well the pictures hold the lens.

    `covered` is the part of the picture inside the hull of some picture's corners; `tilts` (V,) are
    the angles in radians between each board and the picture plane, `distances` (V,) to the boards'
    middles in metres; `rings` the radial residuals from the middle outwards.
    """

    covered: float
    tilts: Array
    distances: Array
    rings: tuple[Ring, ...]
    fit: LensFit

    @staticmethod
    def of(fit: LensFit) -> LensQuality:
        boards = zip(fit.poses, fit.views, strict=True)
        middles = [pose.apply(view.points).mean(axis=0) for pose, view in boards]
        tilts = [np.arccos(min(1.0, abs(float(pose.rotation[2, 2])))) for pose in fit.poses]
        return LensQuality(
            _covered(fit),
            np.array(tilts),
            np.linalg.norm(middles, axis=1),
            _rings(fit),
            fit,
        )

    def sigmas(self) -> dict[str, float] | None:
        """1 sigma of each parameter of the lens by name; None where it is not determined."""
        covariance = self.fit.covariance
        if covariance is None:
            return None
        names = parameter_names(self.fit.lens.distortion.model)
        return dict(zip(names, (float(v) for v in np.sqrt(np.diag(covariance))), strict=True))

    def corner_error(self, distance: float) -> float | None:
        """1 sigma in metres of a point at `distance`, seen in the worst corner of the picture.

        How far beside the true ray of that pixel the lens puts it, if the camera's pose were
        exact. None where the lens images nothing there, or is not determined.
        """
        lens, covariance = self.fit.lens, self.fit.covariance
        if covariance is None:
            return None
        rays, by_pixel = lens.rays_with_jacobian(picture_corners(lens))
        seen = np.isfinite(rays).all(axis=1)
        if not seen.any():
            return None
        by_lens = -by_pixel[seen] @ pixels_by_parameters(lens, rays[seen])
        spread = np.trace(propagated(by_lens, covariance), axis1=1, axis2=2)
        return float(distance * np.sqrt(spread.max()))


def _covered(fit: LensFit) -> float:
    size = np.array([fit.lens.width, fit.lens.height])
    scale = CELLS / size.max()
    columns, rows = (max(1, int(n)) for n in np.ceil(size * scale))
    mask = np.zeros((rows, columns), np.uint8)
    for view in fit.views:
        hull = np.round((view.hull + 0.5) * scale - 0.5)
        cv2.fillConvexPoly(mask, np.asarray(hull, np.int32), (1,))
    return float(mask.mean())


def _rings(fit: LensFit) -> tuple[Ring, ...]:
    pixels = np.concatenate([view.pixels for view in fit.views])
    which = np.concatenate([np.full(len(v.pixels), i) for i, v in enumerate(fit.views)])
    away = pixels - [fit.lens.cx, fit.lens.cy]
    radius = np.linalg.norm(away, axis=1)
    outward = (np.concatenate(fit.residuals) * away).sum(axis=1) / np.maximum(radius, 1e-9)
    borders = np.linspace(0, float(radius.max()) * (1 + 1e-9), RINGS + 1)
    rings = []
    for inner, outer in itertools.pairwise(borders.tolist()):
        own = (radius >= inner) & (radius < outer)
        if own.sum() < FEWEST_IN_RING or len(np.unique(which[own])) < 3:
            continue
        mean = float(outward[own].mean())
        # corners of one picture share their error: the pictures are what is counted
        sums = np.bincount(which[own], outward[own] - mean)
        counts = np.count_nonzero(np.bincount(which[own]))
        sigma = float(np.sqrt((sums**2).sum() * counts / max(counts - 1, 1)) / own.sum())
        rings.append(Ring(inner, outer, mean, sigma))
    return tuple(rings)
