# SPDX-License-Identifier: GPL-3.0-or-later
"""The report of a calibration for a machine: its numbers in, one value for JSON out."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..core.calibration.accuracy import SurfaceAccuracy
from ..core.calibration.advise import Advice
from ..core.calibration.ellipsoid import PoseError
from ..core.calibration.leave_one_out import LeftOut
from ..core.calibration.sighting_report import SightingReport
from ..core.document.entries import camera_entry, pose_entry
from .calibration_report import Report
from .calibration_unknowns import unknowns_document


def document(report: Report) -> dict[str, Any]:
    """The whole report as JSON values; metres, unless the name has another unit."""
    calibration, accuracy = report.calibration, report.accuracy
    camera = calibration.camera
    sigma = camera.rotation_sigma()
    return {
        "verdict": calibration.verdict,
        "warnings": report.warnings,
        "method": calibration.method,
        "camera": camera_entry(camera),
        "center_world": camera.centre_world,
        "center_sigma": camera.centre_sigma(),
        "rotation_sigma_degrees": None if sigma is None else np.degrees(sigma),
        "ellipsoid_95": None if accuracy.error is None else _ellipsoids(accuracy.error),
        "surface": None if accuracy.surface is None else _surface(accuracy.surface),
        "rms_pixels": calibration.rms_pixels,
        "edge_bias_pixels": calibration.edge_bias_pixels,
        "edge_bias_sigma_pixels": calibration.edge_bias_sigma_pixels,
        "misfit": calibration.misfit,
        **unknowns_document(calibration),
        "positions": _positions(report),
        "candidates": [
            {
                "camera_from_base": pose_entry(candidate.camera_from_base),
                "off_pixels": candidate.off_pixels,
            }
            for candidate in calibration.candidates
        ],
        "sightings": [
            _sighting(one, without)
            for one, without in zip(calibration.sightings, accuracy.without, strict=True)
        ],
        "advice": None if report.advice is None else _advice(report.advice),
    }


def _ellipsoids(error: PoseError) -> dict[str, Any]:
    return {
        "position": {
            "semi_axes": error.position.semi_axes,
            "directions_world": error.position.directions,
        },
        "rotation": {
            "semi_axes_degrees": np.degrees(error.rotation.semi_axes),
            "directions_world": error.rotation.directions,
        },
        "sigmas": error.reach,
        "degrees_of_freedom": error.freedom,
    }


def _surface(surface: SurfaceAccuracy) -> dict[str, Any]:
    return {
        "name": surface.plane.name,
        "work_area": surface.area.told,
        "sigma_at_work": surface.at_work,
        "sigma_at_picture_centre": surface.at_centre,
        "sigma_median": surface.median,
        "sigma_worst": surface.worst,
        "share_of_picture": surface.seen,
        "grid_pixels": surface.grid_pixels,
        "grid_sigma": surface.grid,
    }


def _positions(report: Report) -> dict[str, Any]:
    geometry, span = report.calibration.geometry, report.accuracy.span
    return {
        "count": geometry.count,
        "length": geometry.length,
        "off_line": geometry.off_line,
        "off_plane": geometry.off_plane,
        "share_of_picture": span.share,
        "share_of_width": span.width_share,
        "share_of_height": span.height_share,
        "nearest": span.nearest,
        "farthest": span.farthest,
    }


def _sighting(one: SightingReport, without: LeftOut | None) -> dict[str, Any]:
    return {
        "picture": one.picture,
        "center": one.center_world,
        "status": one.status,
        "reason": one.reason,
        "rms_pixels": one.rms_pixels,
        "off_pixels": one.off_pixels,
        "off_millimetres": one.off_millimetres,
        "left_out": None
        if without is None
        else {
            "center_moves": without.centre_moves,
            "turns_degrees": np.degrees(without.turns),
            "sigmas": without.sigmas,
            "position_sigma": without.position_sigma,
            "agreement": without.agreement,
            "chance": without.chance,
        },
    }


def _advice(advice: Advice) -> dict[str, Any]:
    return {
        "surface": advice.area.plane.name,
        "work_area": advice.area.told,
        "sigma": advice.sigma,
        "position_sigma": advice.position_sigma,
        "tried": advice.tried,
        "usable": advice.usable,
        "next": [
            {
                "center": step.position_world,
                "pixel": step.pixel,
                "radius_pixels": step.radius_pixels,
                "sigma": step.sigma,
                "position_sigma": step.position_sigma,
            }
            for step in advice.steps
        ],
    }
