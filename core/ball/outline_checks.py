# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a measured outline is a ball's: its numbers in, doubts or a named refusal out."""

from __future__ import annotations

from ..errors import SphereCut, SphereNotFound

LEAST_COVERAGE, DOUBTFUL_COVERAGE = 0.35, 0.5
LARGEST_CUT = 0.25
# no camera of a work cell is that many metres from its ball
FARTHEST = 100.0
SMALLEST_PIXELS, FEWEST_USED = 4.0, 8
# sigmas over chance that an outline has to stand out by, and by which it may be loose
LEAST_EVIDENCE, EVIDENCE_IN_PART, EVIDENCE_IF_LOOSE, LOOSE_SHARE = 8.0, 9.0, 10.0, 0.025
# where the ball's other places predict it, chance has hardly room
LEAST_EVIDENCE_WHERE_PREDICTED = 1.5


def cut_refusal(cut: float) -> SphereCut:
    """The refusal of a ball of whose outline the share `cut` lies outside the picture."""
    return SphereCut(
        f"the ball is cut by the border: {100 * cut:.0f} % of its outline lies outside the picture "
        f"(at most {100 * LARGEST_CUT:.0f} % may); use a picture that shows more of it"
    )


def refuse_little(coverage: float, cut: float) -> None:
    """Raises SphereCut or SphereNotFound when too little of an outline is seen."""
    if cut > LARGEST_CUT:
        raise cut_refusal(cut)
    if coverage < LEAST_COVERAGE:
        raise SphereNotFound(
            f"only {100 * coverage:.0f} % of the outline has an edge where a ball has one "
            f"(at least {100 * LEAST_COVERAGE:.0f} % is needed)"
        )


def refuse_small(size: float) -> None:
    """Raises SphereNotFound for an outline of fewer pixels radius than profiles can be laid across.

    A fit that follows stray edges shrinks to nothing, and ends here as well.
    """
    if size < SMALLEST_PIXELS:
        raise SphereNotFound(
            f"the edges lead to a ball of {size:.1f} px radius, too small to be measured; "
            f"{SMALLEST_PIXELS:g} px are needed"
        )


def refuse_few(used: int, of: int) -> None:
    """Raises SphereNotFound when too few points of an outline agree with each other."""
    if used < FEWEST_USED:
        raise SphereNotFound(
            f"only {used} of {of} edges lie on one outline, {FEWEST_USED} are needed"
        )


def refuse_clutter(
    evidence: float,
    coverage: float,
    rms: float,
    size: float,
    *,
    predicted: bool,
    beforehand: float = 0.0,
) -> None:
    """Edges of a texture agree with some circle too, but by less, not as well, or in part.

    `beforehand` are sigmas of evidence that something else gives, as that the place has changed.
    """
    least = LEAST_EVIDENCE
    if coverage < DOUBTFUL_COVERAGE:
        least = EVIDENCE_IN_PART
    if rms > LOOSE_SHARE * size:
        least = EVIDENCE_IF_LOOSE
    if predicted:
        least = LEAST_EVIDENCE_WHERE_PREDICTED
    if evidence + beforehand < least:
        raise SphereNotFound(
            f"the edges make a circle of {size:.0f} px radius only {evidence:.1f} sigmas better "
            f"than chance ({least:g} are needed), {rms:.1f} px rms off it, and "
            f"{100 * coverage:.0f} % of it are seen"
        )


def doubts_of(coverage: float, cut: float, rms: float, size: float) -> tuple[str, ...]:
    """What to tell of an outline of `size` pixels radius that is used all the same."""
    doubts = []
    if coverage < DOUBTFUL_COVERAGE:
        doubts.append(f"only {100 * coverage:.0f} % of the outline is seen")
    if cut > 0.01:
        doubts.append(f"the border cuts {100 * cut:.0f} % of the outline")
    if rms > max(0.5, 0.01 * size):
        doubts.append(f"the outline is {rms:.2f} px rms off a sphere's: is it round?")
    return tuple(doubts)


def far_doubts(distance: float, radius: float) -> tuple[str, ...]:
    """What to tell of a ball that is farther than any camera of a cell can be."""
    if distance < FARTHEST:
        return ()
    return (
        f"a ball of radius {radius:g} m would be {distance:.0f} m away: is the radius in metres?",
    )
