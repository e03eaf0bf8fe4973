# SPDX-License-Identifier: GPL-3.0-or-later
"""What is kept in the scene of finding and calibrating: core's answers in, text and back out."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

NOT_LOOKED = ("", "", None, None)


@dataclass(frozen=True)
class SeenSighting:
    """What became of one sighting; `ball` is where its outline puts it: x, y, z (camera), radius.

    `status` is used, doubtful or rejected, `found` before a calibration, empty for what was not
    looked for. `rms_pixels` is None for what is not in the fit, `ball` for one not found.
    """

    status: str
    reason: str
    rms_pixels: float | None
    ball: tuple[float, float, float, float] | None


@dataclass(frozen=True)
class AdvisedPlace:
    """Where to hold the ball next: world place, pixel as the lens images it, its size there.

    `sigma_millimetres` is what a point worked at is then known to.
    """

    place: tuple[float, float, float]
    pixel: tuple[float, float]
    radius_pixels: float
    sigma_millimetres: float


@dataclass(frozen=True)
class Report:
    """The last search or calibration of a scene, sightings in the document's order.

    `verdict` is empty, and the numbers are None, after a search alone. `changed` tells that
    sightings were edited since, `searched` that balls were found anew and the sightings show that.
    `surface_millimetres` is how well a point worked at is known on the plane called `surface`.
    """

    verdict: str
    warnings: tuple[str, ...]
    rms_pixels: float | None
    edge_bias_pixels: float | None
    sightings: tuple[SeenSighting, ...]
    surface: str = ""
    advice: tuple[AdvisedPlace, ...] = ()
    changed: bool = False
    searched: bool = False
    surface_millimetres: float | None = None

    def arranged(self, kept: Sequence[int | None]) -> Report:
        """The report after sightings were edited: `kept` has the old index of each, None of a new.

        What was advised is for the sightings as they were, and goes.
        """
        rows = tuple(SeenSighting(*NOT_LOOKED) if i is None else self.sightings[i] for i in kept)
        return replace(self, sightings=rows, advice=(), changed=True)

    def with_search(self, found: Report) -> Report:
        """The calibration with its numbers, and the balls as a later search has found them."""
        return replace(self, sightings=found.sightings, searched=True)


def seen_of(sighting: Any) -> SeenSighting:
    """What is kept of a `core.calibration.SightingReport`."""
    rms = float(sighting.rms_pixels)
    return SeenSighting(
        sighting.status,
        sighting.reason,
        # NaN is no JSON
        rms if math.isfinite(rms) else None,
        ball_of(sighting.outline),
    )


def ball_of(outline: Any) -> tuple[float, float, float, float] | None:
    """Centre in the camera and radius of a found outline, in metres."""
    if outline is None:
        return None
    x, y, z = (float(value) for value in outline.centre_camera)
    return (x, y, z, float(outline.radius))


def dump_report(report: Report) -> str:
    """Text for the scene."""
    return json.dumps(asdict(report), allow_nan=False)


def parse_report(text: str) -> Report | None:
    """The inverse of `dump_report`; None for an empty text, before any search."""
    if not text:
        return None
    fields = json.loads(text)
    sightings = tuple(
        SeenSighting(**entry | {"ball": tuple(entry["ball"]) if entry["ball"] else None})
        for entry in fields["sightings"]
    )
    advice = tuple(
        AdvisedPlace(**entry | {key: tuple(entry[key]) for key in ("place", "pixel")})
        for entry in fields.get("advice", ())
    )
    told = {"warnings": tuple(fields["warnings"]), "sightings": sightings, "advice": advice}
    return Report(**fields | told)
