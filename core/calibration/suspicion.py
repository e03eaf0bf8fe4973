# SPDX-License-Identifier: GPL-3.0-or-later
"""What seems wrong with radius or lens, though it was not solved for: a fit in, sentences out."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..intrinsics import Intrinsics
from .asking import Answer
from .joint_pose import JointFit

# by how many sigmas something has to be off, and by what share or by how many pixels at least
SIGMAS = 3.0
LEAST = {"radius": 0.005, "focal": 0.003}
LEAST_RADIAL_PIXELS = 0.3
# a radius or a focal length that is told worse than this is not told
MOST_SIGMA = 0.03
# what explains the residuals nearly as well can't be told apart: two sigmas less
NEARLY_AS_WELL = 4.0


@dataclass(frozen=True)
class Suspect:
    """One thing that seems wrong, in words that complete `the ball seems ...`."""

    name: str
    answer: Answer
    told: str


def suspicions(fit: JointFit, radius: float | None, lens: Intrinsics) -> tuple[str, ...]:
    """Sentences, one for each thing that seems wrong; none for a rig that is as stated.

    What can't be told apart stands in one sentence. `radius` is that of the balls, None for none.
    """
    suspects = _suspects(fit, radius, lens)
    if not suspects:
        return ()
    first = suspects[0]
    rivals = [s for s in suspects[1:] if _explains_as_well(s, first)]
    if rivals:
        either = ", or ".join(s.told for s in (first, *rivals))
        return (f"the sightings do not fit what is stated, and can't tell which: {either}",)
    second = [s.told for s in suspects[1:] if _remains(fit, s.name, first.name)]
    return (first.told, *second)


def _suspects(fit: JointFit, radius: float | None, lens: Intrinsics) -> list[Suspect]:
    """All that would explain the residuals better by more than chance, the best first."""
    found = []
    for name in fit.asked.names:
        answer = fit.asked.about(name)
        if answer is None or answer.significance < SIGMAS or (name == "radius" and not radius):
            continue
        told = _told(name, answer, fit, radius or 0.0, lens)
        if told is not None:
            found.append(Suspect(name, answer, told))
    return sorted(found, key=lambda s: -s.answer.explained)


def _told(name: str, answer: Answer, fit: JointFit, radius: float, lens: Intrinsics) -> str | None:
    value, sigma = answer.value, answer.sigma
    if name in LEAST and (abs(value) < LEAST[name] or sigma > MOST_SIGMA):
        return None
    if name == "radius":
        seems, spread = 1e3 * radius * np.exp(value), 1e3 * radius * sigma
        digits = int(np.clip(1 - np.floor(np.log10(max(spread, 1e-9))), 0, 4))
        return (
            f"the ball's radius seems to be {seems:.{digits}f} ± {spread:.{digits}f} mm, not "
            f"{1e3 * radius:g}: measure it, or refine it"
        )
    if name == "focal":
        return (
            f"a focal length {100 * value:+.1f} ± {100 * sigma:.1f} % longer would fit better: is "
            "the camera file that of this lens and zoom?"
        )
    corner = _pixels_at_the_border(fit, lens)
    if abs(value) * corner < LEAST_RADIAL_PIXELS:
        return None
    side = "outside" if value > 0 else "inside"
    return (
        f"outlines towards the picture's corners lie {abs(value) * corner:.1f} ± "
        f"{sigma * corner:.1f} px {side} of where the lens puts them: is the distortion right?"
    )


def _pixels_at_the_border(fit: JointFit, lens: Intrinsics) -> float:
    """By how many pixels a radial coefficient of 1 moves the outermost target."""
    pixels = lens.project(fit.camera_from_base.apply(fit.places_base))
    away = np.linalg.norm(pixels - [lens.cx, lens.cy], axis=1)
    return float(np.nanmax(away) ** 3 / (lens.fx * lens.fy))


def _explains_as_well(other: Suspect, first: Suspect) -> bool:
    return other.answer.explained > first.answer.explained - NEARLY_AS_WELL


def _remains(fit: JointFit, name: str, given: str) -> bool:
    answer = fit.asked.about(name, [given])
    return answer is not None and answer.significance > SIGMAS
