# SPDX-License-Identifier: GPL-3.0-or-later
"""A calibration as text that a scene can hold, and back: verdict, residuals, and the balls seen."""

from __future__ import annotations

import json
import math
from dataclasses import asdict, dataclass
from typing import Any


@dataclass(frozen=True)
class SeenSighting:
    """What became of one sighting; `ball` is where its outline puts it: x, y, z (camera), radius.

    `rms_pixels` is None for a ball that was left out of the fit, `ball` for one not found.
    """

    status: str
    reason: str
    rms_pixels: float | None
    ball: tuple[float, float, float, float] | None


@dataclass(frozen=True)
class Report:
    """The last calibration of a scene, sightings in the document's order."""

    verdict: str
    warnings: tuple[str, ...]
    rms_pixels: float
    edge_bias_pixels: float
    sightings: tuple[SeenSighting, ...]


def report_of(calibration: Any) -> Report:
    """What is kept of a `core.calibration.Calibration` beside the camera itself."""
    return Report(
        calibration.verdict,
        tuple(calibration.warnings),
        float(calibration.rms_pixels),
        float(calibration.edge_bias_pixels),
        tuple(_seen(sighting) for sighting in calibration.sightings),
    )


def dump_report(report: Report) -> str:
    """Text for the scene."""
    return json.dumps(asdict(report), allow_nan=False)


def parse_report(text: str) -> Report | None:
    """The inverse of `dump_report`; None for an empty text, before any calibration."""
    if not text:
        return None
    fields = json.loads(text)
    sightings = tuple(
        SeenSighting(**entry | {"ball": tuple(entry["ball"]) if entry["ball"] else None})
        for entry in fields["sightings"]
    )
    return Report(**fields | {"warnings": tuple(fields["warnings"]), "sightings": sightings})


def _seen(sighting: Any) -> SeenSighting:
    outline, rms = sighting.outline, float(sighting.rms_pixels)
    ball = None if outline is None else (*map(float, outline.centre_camera), float(outline.radius))
    # NaN is no JSON
    return SeenSighting(sighting.status, sighting.reason, rms if math.isfinite(rms) else None, ball)
