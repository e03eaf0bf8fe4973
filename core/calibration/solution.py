# SPDX-License-Identifier: GPL-3.0-or-later
"""The pose from outlines already measured: what was asked and found in, the calibration out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Array
from ..ball.outline import SphereOutline
from ..camera import Camera
from ..cell import Cell
from ..errors import InvalidValue, NotConverged, SphereNotFound
from ..mount import Mount
from ..pose import Pose
from ..sighting import PointSighting, Sighting, SphereSighting
from .agreement import fewest
from .baselines import baseline_poses
from .observability import check_places
from .observation import Place
from .places import places_of
from .pose_search import ConsistentFit, fit_consistent
from .position_geometry import check_positions
from .refining import check_observable, check_wish
from .result import METHODS, Calibration, Method
from .rivals import without_rivals
from .seen import Seen, seen_targets
from .sighting_report import SightingReport, robust_rms, sighting_reports
from .twins import told_twice
from .unknowns import Refinable, Refined
from .verdict import verdict_of


@dataclass(frozen=True, eq=False)
class Solution:
    """A calibration, and where its pose has every target in the camera (S, 3), NaN for nowhere."""

    calibration: Calibration
    expected_camera: Array

    def expected_again(self, duplicates: dict[int, int]) -> dict[int, Array]:
        """Where to look again for what was rejected; nowhere, when the pose is not believed."""
        if self.calibration.verdict == "failed":
            return {}
        return {
            i: self.expected_camera[i]
            for i, report in enumerate(self.calibration.sightings)
            if report.status == "rejected" and i not in duplicates
        }

    def expected_everywhere(self, duplicates: dict[int, int]) -> dict[int, Array]:
        """Where the pose has every target; nowhere, when the pose is not believed."""
        if self.calibration.verdict == "failed":
            return {}
        return {i: e for i, e in enumerate(self.expected_camera) if i not in duplicates}


@dataclass(frozen=True, eq=False)
class Problem:
    """What is asked: a camera, its sightings with the place of each target, and the method."""

    camera: Camera
    sightings: tuple[Sighting, ...]
    places: tuple[Place, ...]
    method: Method
    refine: tuple[Refinable, ...]
    mount: Mount | None
    duplicates: dict[int, int]

    @staticmethod
    def of_cell(cell: Cell, method: Method, refine: tuple[Refinable, ...]) -> Problem:
        """Raises what can be refused before any picture is read."""
        if method not in METHODS:
            raise InvalidValue(f"method: {method!r} is none of {', '.join(METHODS)}")
        check_wish(refine, method, cell.sightings)
        _check_pixels(cell)
        places = tuple(places_of(cell.sightings, cell.mount))
        check_places(places, [isinstance(s, SphereSighting) for s in cell.sightings])
        duplicates = told_twice(cell.sightings)
        return Problem(cell.camera, cell.sightings, places, method, refine, cell.mount, duplicates)

    def unrefined(self) -> Problem:
        """The same without refining anything."""
        return replace(self, refine=())

    def enough(self, outlines: Sequence[SphereOutline | None]) -> bool:
        """Whether so many balls, and all points, can make a pose."""
        found = self._found(outlines)
        are_balls = [isinstance(self.sightings[i], SphereSighting) for i in found]
        return len(found) >= fewest([self.places[i] for i in found], are_balls)

    def solved(
        self, outlines: Sequence[SphereOutline | None], failures: dict[int, str]
    ) -> Solution:
        """The pose of all that was found and fits together. Raises as `calibrate_cell` does."""
        found = self._found(outlines)
        failures = failures | {
            i: f"it repeats sightings[{k}], and counts once" for i, k in self.duplicates.items()
        }
        if not self.enough(outlines):
            self._refuse_too_few(found, failures)
        check_places([self.places[i] for i in found], self._are_balls(found))
        everything = seen_targets(self.sightings, outlines, self.places, self.camera.intrinsics)
        seen = [one for i in found if (one := everything[i]) is not None]
        consistent = self._consistent(seen)
        reports = sighting_reports(
            self.sightings,
            outlines,
            failures,
            found,
            seen,
            consistent,
            mounted=self.mount is not None,
        )
        used = tuple(i for i, use in zip(found, consistent.used, strict=True) if use)
        calibration = self._told(consistent, reports, used)
        if self.method != "joint":
            chosen = [one for one, use in zip(seen, consistent.used, strict=True) if use]
            candidates = baseline_poses(self.method, chosen)
            camera, mount = self._placed(candidates[0].camera_from_base, None, used)
            calibration = replace(calibration, camera=camera, mount=mount, candidates=candidates)
        return Solution(calibration, consistent.start.centres(self.places))

    def _consistent(self, seen: Sequence[Seen]) -> ConsistentFit:
        consistent = fit_consistent(seen)
        if self.refine:
            check_observable(consistent.fit, self.refine)
            # what did not fit may have been the lens
            consistent = fit_consistent(seen, self.refine)
        return without_rivals(seen, consistent, self.refine)

    def _told(
        self,
        consistent: ConsistentFit,
        reports: tuple[SightingReport, ...],
        used: tuple[int, ...],
    ) -> Calibration:
        fit, left = consistent.fit, np.concatenate(consistent.fit.residuals_pixels)
        if not np.isfinite(left).all():
            raise NotConverged(
                "the joint fit left the pictures; check intrinsics, radius and positions"
            )
        camera, mount = self._placed(fit.camera_from_base, fit.covariance, used, fit.refined)
        geometry = check_positions(fit.places_base)
        radii = [s.radius for s in self.sightings if isinstance(s, SphereSighting)]
        statuses = [(r.status, r.reason, r.contradicts) for r in reports]
        radius = radii[0] if radii else None
        verdict, warnings = verdict_of(camera.intrinsics, fit, geometry, statuses, radius)
        return Calibration(
            camera,
            self.method,
            verdict,
            (*geometry.warnings(), *warnings),
            reports,
            geometry,
            robust_rms(left),
            fit.edge_bias_pixels,
            fit.edge_bias_sigma_pixels,
            fit.disagreement,
            fit,
            used,
            refined=fit.refined,
            mount=mount,
        )

    def _placed(
        self,
        camera_from_base: Pose,
        covariance: Array | None,
        used: Sequence[int],
        refined: Sequence[Refined] = (),
    ) -> tuple[Camera, Mount | None]:
        """The camera where it stood for the cell's picture, and its mount where it has one."""
        lens = self.camera.intrinsics
        factor = next((r.factor for r in refined if r.name == "focal"), 1.0)
        camera = Camera(replace(lens, fx=lens.fx * factor, fy=lens.fy * factor))
        if self.mount is None:
            return camera.placed(camera_from_base, covariance), None
        mount = Mount(camera_from_base, covariance, self.mount.world_from_flange)
        stood = self.mount.world_from_flange or self.sightings[used[0]].world_from_flange
        return replace(mount, world_from_flange=stood).placed(camera), mount

    def _found(self, outlines: Sequence[SphereOutline | None]) -> list[int]:
        return [
            i
            for i, (sighting, outline) in enumerate(zip(self.sightings, outlines, strict=True))
            if (outline is not None or isinstance(sighting, PointSighting))
            and i not in self.duplicates
        ]

    def _are_balls(self, indices: Sequence[int]) -> list[bool]:
        return [isinstance(self.sightings[i], SphereSighting) for i in indices]

    def _refuse_too_few(self, found: Sequence[int], failures: dict[int, str]) -> None:
        needed = fewest(self.places, self._are_balls(range(len(self.sightings))))
        first = min(failures)
        told = "three" if needed == 3 else str(needed)
        raise SphereNotFound(
            f"the ball was found in {len(found)} of {len(self.sightings)} sightings, {told} are "
            f"needed; {self.sightings[first].picture}: {failures[first]}"
        )


def _check_pixels(cell: Cell) -> None:
    for i, sighting in enumerate(cell.sightings):
        if isinstance(sighting, PointSighting):
            lens = cell.camera.intrinsics
            if not lens.contains(sighting.pixel[None])[0]:
                raise InvalidValue(
                    f"sightings[{i}].pixel: {sighting.pixel.round(1).tolist()} lies outside the "
                    f"{lens.width} x {lens.height} px of {sighting.picture}"
                )
            if not np.isfinite(lens.rays(sighting.pixel[None])).all():
                raise InvalidValue(
                    f"sightings[{i}].pixel: the lens images nothing at "
                    f"{sighting.pixel.round(1).tolist()}; is the distortion right?"
                )
