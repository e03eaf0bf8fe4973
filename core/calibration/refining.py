# SPDX-License-Identifier: GPL-3.0-or-later
"""What a fit may refine: a fit and the wish in, a refusal out where it can't be told."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..errors import InvalidValue, NotObservable
from ..sighting import Sighting, SphereSighting
from .asking import Answer
from .joint_pose import JointFit
from .unknowns import REFINABLE, Refinable

# a lens file and a caliper know them this well: what is known worse is better left as stated,
# unless it is that much farther off; beyond the worst it is not known at all
USEFUL = {"focal": 0.003, "radius": 0.005}
FAR_OFF, WORST = 3.0, 0.03
WORDS = {"focal": "the focal length", "radius": "the ball's radius"}
ADVICE = {
    "focal": "add sightings nearer to the picture's border, and much nearer and farther",
    "radius": "add sightings of the ball much nearer to the camera, where it shows larger",
}


def check_wish(refine: Sequence[str], method: str, sightings: Sequence[Sighting]) -> None:
    """Raises InvalidValue for what can't be refined in any rig."""
    for name in refine:
        if name not in REFINABLE:
            raise InvalidValue(f"refine: {name!r} is none of {', '.join(REFINABLE)}")
    if refine and method != "joint":
        raise InvalidValue(f"refine: the baseline {method} refines nothing; use the method joint")
    radii = {s.radius for s in sightings if isinstance(s, SphereSighting)}
    if "radius" in refine and len(radii) != 1:
        raise InvalidValue(
            f"refine: the sightings state {len(radii)} different radii; there must be one"
        )


def check_observable(fit: JointFit, refine: Sequence[Refinable]) -> None:
    """Raises NotObservable for what would be known worse than is of use, with how well."""
    distances = np.linalg.norm(fit.camera_from_base.apply(fit.places_base), axis=1)
    for name in refine:
        answer = fit.asked.about(name, [other for other in refine if other != name])
        if answer is None or not _is_of_use(name, answer):
            told = "not at all" if answer is None else f"to ± {100 * answer.sigma:.2g} % only"
            raise NotObservable(
                f"refine: {WORDS[name]} would be known {told} ({100 * USEFUL[name]:g} % is "
                f"needed) by the {len(fit.says)} sightings at {distances.min():.3g} to "
                f"{distances.max():.3g} m; {ADVICE[name]}"
            )


def _is_of_use(name: str, answer: Answer) -> bool:
    if answer.sigma > WORST:
        return False
    return answer.sigma < USEFUL[name] or abs(answer.value) > FAR_OFF * answer.sigma
