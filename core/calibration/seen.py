# SPDX-License-Identifier: GPL-3.0-or-later
"""A sighting as the search for a pose sees it: its measurement, and what that alone tells."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..ball.outline import SphereOutline
from ..ball.sphere import OutlineRays
from ..intrinsics import Intrinsics
from ..sighting import PointSighting, Sighting, SphereSighting
from .observation import Observation, OutlineObservation, Place, PointObservation
from .start_poses import Hint

# so many pixels beside its place, and as many radii for a ball, a target still is the one expected
ROUGH_PIXELS, ROUGH_ACROSS, ROUGH_DEPTH = 12.0, 0.35, 0.2


@dataclass(frozen=True, eq=False)
class Seen:
    """A target found in a picture: a ball by its outline, a point by its pixel."""

    observation: Observation
    hint: Hint
    pixels_per_radian: float
    outline: SphereOutline | None = None

    @property
    def place(self) -> Place:
        return self.observation.place

    @property
    def is_ball(self) -> bool:
        return isinstance(self.observation, OutlineObservation)

    def off_pixels(self, predicted_camera: Array) -> float:
        """How far, across the picture, it is from where a pose puts it (3,)."""
        ray = self.hint.ray
        angle = np.arctan2(np.linalg.norm(np.cross(predicted_camera, ray)), predicted_camera @ ray)
        return float(angle * self.pixels_per_radian)


@dataclass(frozen=True, eq=False)
class Beliefs:
    """Where C targets were found, as arrays: what a pose is held against, over and over."""

    rays: Array
    distances: Array
    tolerances: Array

    @staticmethod
    def of(seen: Sequence[Seen]) -> Beliefs:
        tolerances = [
            ROUGH_ACROSS * one.observation.radius / (one.hint.distance or np.inf)
            if isinstance(one.observation, OutlineObservation)
            else ROUGH_PIXELS / one.pixels_per_radian
            for one in seen
        ]
        return Beliefs(
            np.array([one.hint.ray for one in seen]).reshape(-1, 3),
            np.array([one.hint.distance or np.nan for one in seen]),
            np.array(tolerances),
        )

    def disagreement(self, predicted_camera: Array) -> Array:
        """How far each is from where a pose puts it (C, 3), squared; 1 and more is elsewhere."""
        expected = np.linalg.norm(predicted_camera, axis=1)
        cosines = np.einsum("ci,ci->c", predicted_camera, self.rays) / expected
        across = np.arccos(np.clip(cosines, -1, 1)) / self.tolerances
        # a point tells no depth, but is not behind the camera
        along = np.nan_to_num((expected / self.distances - 1) / ROUGH_DEPTH, nan=0.0)
        return np.nan_to_num(across * across + along * along, nan=np.inf)


def seen_targets(
    sightings: Sequence[Sighting],
    outlines: Sequence[SphereOutline | None],
    places: Sequence[Place],
    intrinsics: Intrinsics,
) -> list[Seen | None]:
    """What was found of each sighting, None for a ball without an outline.

    All outlines' pixels go through the lens at once.
    """
    pixels = [
        outline.pixels[outline.used] if outline is not None else np.zeros((0, 2))
        for outline in outlines
    ]
    clicked = [
        s.pixel[None] if isinstance(s, PointSighting) else np.zeros((0, 2)) for s in sightings
    ]
    both = [np.concatenate([a, b]) for a, b in zip(pixels, clicked, strict=True)]
    rays = OutlineRays.of(intrinsics, np.concatenate(both))
    ends = np.cumsum([len(p) for p in both])
    parts = [slice(end - len(p), end) for p, end in zip(both, ends, strict=True)]
    return [
        _seen(sighting, outline, place, _part(rays, part), intrinsics)
        for sighting, outline, place, part in zip(sightings, outlines, places, parts, strict=True)
    ]


def _part(rays: OutlineRays, part: slice) -> OutlineRays:
    return OutlineRays(rays.pixels[part], rays.rays[part], rays.rays_by_pixel[part])


def _seen(
    sighting: Sighting,
    outline: SphereOutline | None,
    place: Place,
    rays: OutlineRays,
    intrinsics: Intrinsics,
) -> Seen | None:
    if isinstance(sighting, SphereSighting) and outline is None:
        return None
    radians_per_pixel = float(np.median(np.linalg.norm(rays.rays_by_pixel, axis=(1, 2)))) / np.sqrt(
        2
    )
    if outline is None:
        assert isinstance(sighting, PointSighting)
        point = PointObservation(rays, sighting.sigma_pixels, place, intrinsics)
        return Seen(point, Hint(rays.rays[0], None, place), 1 / radians_per_pixel)
    ball = OutlineObservation(
        rays, outline.sigma_pixels[outline.used], place, outline.radius, intrinsics
    )
    distance = float(np.linalg.norm(outline.centre_camera))
    hint = Hint(outline.centre_camera / distance, distance, place)
    return Seen(ball, hint, 1 / radians_per_pixel, outline)
