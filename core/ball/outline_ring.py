# SPDX-License-Identifier: GPL-3.0-or-later
"""One look around a ball's outline: light and a centre in, the edges on its profiles out."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np

from ..arrays import Array, Mask
from ..errors import SphereNotFound
from ..intrinsics import Intrinsics
from ..picture.pictures import Light
from ..robust import middle_of
from .edge_consensus import WeighedEdges, weighed
from .limb import UNKNOWNS, LimbEdges, Reach, find_limb
from .outline_checks import LARGEST_CUT, cut_refusal, refuse_small
from .sphere import OutlineRays, tangency

MOST_POINTS, FEWEST_POINTS = 200, 48
# farther into the ball than out of it: what stands beside a ball is not known
INWARDS, OUTWARDS = 4.0, 3.0
# an edge is measured where the picture reaches this far beyond it
BEYOND_EDGE = 1.5


@dataclass(frozen=True, eq=False)
class Look:
    """One look around the outline of `centre`: edges on profiles, and which of these are inside.

    `noise` is the variance of one sample and `freedom` the samples that are free in a profile;
    `by_centre` (N, 3) how the outline moves away from fixed pixels with the centre.
    """

    centre: Array
    places: OutlineRays
    normals: Array
    by_centre: Array
    inside: Mask
    edges: LimbEdges
    noise: float
    freedom: float

    @property
    def noise_to_contrast(self) -> float:
        """How the noise compares with the profiles' contrast."""
        gains = self.edges.flat_misfits - self.edges.misfits[0]
        return float(np.sqrt(10 * self.noise / max(middle_of(gains), 1e-12)))

    def weighed(self, trust: float) -> WeighedEdges:
        """The edges judged, see there. Raises SphereCut when too much lies outside the picture."""
        if self.inside.mean() < 1 - LARGEST_CUT:
            raise cut_refusal(1 - float(self.inside.mean()))
        return weighed(self.edges, self.noise, self.freedom, self.inside, trust)


@dataclass(frozen=True, eq=False)
class _Profiles:
    """Light (N, K, C) across N places of the outline of a ball at `centre`."""

    centre: Array
    reach: Reach
    light: Array
    places: OutlineRays
    normals: Array
    by_centre: Array
    inside: Mask

    def is_for(self, centre: Array, reach: Reach, count: int) -> bool:
        same = self.reach == reach and len(self.normals) == count
        return same and bool((self.centre == centre).all())


class OutlineRing:
    """Looks in one picture of linear light (H, W, 3) whose corner is `origin` (2,)."""

    def __init__(self, light: Light, origin: Array, intrinsics: Intrinsics, radius: float) -> None:
        self._light, self._origin = light, origin
        self._intrinsics, self._radius = intrinsics, radius
        self._last: _Profiles | None = None

    def look(
        self, centre: Array, search: float, blur: float, contrast: float, most: int = MOST_POINTS
    ) -> Look:
        """Edges within `search` pixels of the outline of a ball at `centre` (3,), camera frame.

        Raises SphereNotFound for a ball too small or not wholly imaged by the lens.
        """
        size = self.size_pixels(centre)
        refuse_small(size)
        farther = 0.5 * search + max(0.0, 2 * blur - 2)
        reach = Reach(
            min(INWARDS + farther, 0.7 * size), min(OUTWARDS + farther, max(0.7 * size, 3.0))
        )
        ring = self._profiles(centre, reach, int(np.clip(2 * np.pi * size, FEWEST_POINTS, most)))
        edges = find_limb(ring.light, reach, min(search, 0.35 * size), blur, size, contrast)
        freedom = max(1, (ring.light.shape[1] - UNKNOWNS) * ring.light.shape[2] - 1)
        noise = max(middle_of(edges.misfits[0]) / freedom, 1e-10)
        return Look(
            centre, ring.places, ring.normals, ring.by_centre, ring.inside, edges, noise, freedom
        )

    def _profiles(self, centre: Array, reach: Reach, count: int) -> _Profiles:
        """Those around a centre; several looks at one place share them."""
        if self._last is not None and self._last.is_for(centre, reach, count):
            return self._last
        places = OutlineRays.around(self._intrinsics, centre, self._radius, count)
        if not np.isfinite(places.pixels).all():
            raise SphereNotFound("part of the outline lies outside what the lens images")
        held = tangency(places, centre, self._radius)
        at = places.pixels[:, None] + held.normals[:, None] * reach.offsets()[:, None]
        beyond = BEYOND_EDGE * held.normals
        inside = self._intrinsics.contains(places.pixels + beyond)
        inside &= self._intrinsics.contains(places.pixels - beyond)
        light = self._sampled(at)
        self._last = _Profiles(centre, reach, light, places, held.normals, held.by_centre, inside)
        return self._last

    def _sampled(self, at: Array) -> Array:
        places = (at - self._origin).astype(np.float32)
        sampled = cv2.remap(
            self._light,
            places[..., 0],
            places[..., 1],
            cv2.INTER_CUBIC,
            borderMode=cv2.BORDER_REPLICATE,
        )
        return sampled.reshape(*places.shape[:2], -1).astype(float)

    def size_pixels(self, centre: Array) -> float:
        """The outline's radius where the lens is not distorted."""
        focal = 0.5 * (self._intrinsics.fx + self._intrinsics.fy)
        distance = float(np.linalg.norm(centre))
        return float(np.tan(np.arcsin(min(0.999, self._radius / distance))) * focal)
