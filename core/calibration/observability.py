# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether sightings can hold a pose at all: where their targets are in, a named refusal out."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..arrays import Array
from ..errors import DegeneratePositions, TooFewSightings
from .agreement import fewest
from .observation import Place
from .position_geometry import check_positions
from .unknowns import Unknowns, offset_targets

# an offset that the flange turned by less is nothing but its place
LEAST_TURN_DEGREES, ADVISED_TURN_DEGREES = 3.0, 30.0


def check_places(places: Sequence[Place], are_balls: Sequence[bool]) -> None:
    """Raises TooFewSightings and DegeneratePositions, before any picture is read.

    Known places must not lie on a line; for an unknown offset the flange must have turned about two
    axes, else the offset can't be told apart from the place of the camera.
    """
    if not offset_targets(places):
        check_positions([place.in_base() for place in places])
        return
    needed = fewest(places, are_balls)
    if len(places) < needed:
        raise TooFewSightings(
            f"a pose and an offset that is not known need {needed} sightings or more, there "
            f"{'is' if len(places) == 1 else 'are'} {len(places)}; add sightings"
        )
    turned = least_turn(places)
    if np.degrees(turned) < LEAST_TURN_DEGREES:
        raise DegeneratePositions(
            f"the flange turned by only {np.degrees(turned):.1f} deg about a second axis in the "
            f"{len(places)} sightings, so that the unknown offset can't be told apart from the "
            f"camera's place; turn it by {ADVISED_TURN_DEGREES:g} deg or more about two axes"
        )


def least_turn(places: Sequence[Place]) -> float:
    """By how much carriers turned about the axis that they turned least about, radians (rms).

    An offset v and a shift w of the camera are the same where `R_i v + w == 0` for all i: the
    least singular value of the rows [R_i, I] tells how far from that the sightings are.
    """
    unknowns = Unknowns.of_places(places)
    blocks: list[Array] = [np.broadcast_to(np.eye(3), unknowns.rotations.shape)]
    for k in range(len(unknowns.targets)):
        blocks.append(unknowns.rotations * (unknowns.which == k)[:, None, None])
    rows = np.concatenate(blocks, axis=-1).reshape(3 * len(places), -1)
    least = float(np.linalg.svd(rows, compute_uv=False)[-1])
    return float(np.sqrt(2.0) * least / np.sqrt(len(places)))
