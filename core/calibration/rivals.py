# SPDX-License-Identifier: GPL-3.0-or-later
"""Other poses that fit as well: a fit of few sightings in, the best one or a refusal out.

Three points have up to four poses, four in a plane seen from afar have two. Where a second pose
explains the sightings as well as the first, neither is told.
"""

from __future__ import annotations

from collections.abc import Sequence

from ..errors import AmbiguousPose, DegeneratePositions
from ..pose import Pose
from .pose_search import ConsistentFit, fitted
from .seen import Seen
from .start_poses import all_poses, same_pose
from .unknowns import Refinable

# chi-squared by which a pose has to be worse to be ruled out: three sigmas
RULED_OUT = 9.0
# directions told beyond what is unknown: with more of them no second pose was ever met
FEW_LEFT_OVER = 4


def without_rivals(
    seen: Sequence[Seen], consistent: ConsistentFit, refine: Sequence[Refinable] = ()
) -> ConsistentFit:
    """The best of all poses of the sightings used. Raises AmbiguousPose where two are as good."""
    chosen = [one for one, use in zip(seen, consistent.used, strict=True) if use]
    if 2 * len(chosen) - 6 - 3 * len(consistent.fit.targets) > FEW_LEFT_OVER:
        return consistent
    fits = [consistent]
    for start in all_poses([one.hint for one in chosen]):
        try:
            rival = fitted(seen, consistent.used, start, refine)
        except DegeneratePositions:
            continue
        if not any(same_pose(rival.start, other.start) for other in fits):
            fits.append(rival)
    fits.sort(key=lambda one: one.fit.asked.chi_squared)
    best = fits[0]
    limit = best.fit.asked.chi_squared + RULED_OUT * best.fit.misfit**2
    as_good = [one for one in fits if one.fit.asked.chi_squared < limit]
    if len(as_good) > 1:
        places = " and ".join(_told(one.fit.camera_from_base) for one in as_good)
        raise AmbiguousPose(
            f"{len(as_good)} poses fit the {len(chosen)} sightings equally well, with the camera "
            f"at {places}; add a sighting away from the plane of the others"
        )
    return best


def _told(pose: Pose) -> str:
    return "(" + ", ".join(f"{v:.2f}" for v in pose.inverse().translation) + ") m"
