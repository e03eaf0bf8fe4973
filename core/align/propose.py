# SPDX-License-Identifier: GPL-3.0-or-later
"""A camera, its picture and a plane in, boxes and cylinders that may stand on it out, with scores.

Parts of the picture that edges enclose are covered by a box and by a cylinder; those that cover
best are aligned on the edges, and the ones that most of the picture's edges support are proposed.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from ..camera import Camera
from ..modelling.solid import Solid
from ..picture.pictures import Picture, check_size
from ..pose import Pose
from ..primitives import KINDS, Primitive
from ..reference import ReferencePlane
from .align import align_in
from .depth_order import hull_of
from .mask_fit import Cover, covering
from .seeds import seeds
from .sight import PictureSight, filled
from .window import Window

PROPOSED = ("box", "cylinder")
# two outlines that share so much of their area (over what they cover together) are one thing
SAME_SHARE = 0.25
# below this nothing is worth a word
LEAST_SCORE = 0.4
# with more edges inside than this, per pixel, it may be several things
PLAIN = 0.02
# so often a part of the picture is tried
TRIES = 2
# the model of a seed is rougher than a person's
REACH_PIXELS = 8.0


@dataclass(frozen=True, eq=False)
class Proposal:
    """A thing that may be there.

    `score` from 0 to 1 is the share of its outline on edges, halved by one reason not to believe
    it, a third with two, and so on. `why` tells what made it a candidate, `reasons` why it is not
    `believed`.
    """

    thing: Primitive
    score: float
    believed: bool
    why: str
    reasons: tuple[str, ...]


def propose(
    camera: Camera,
    picture_bgr: Picture,
    plane: ReferencePlane,
    things: Sequence[Primitive] = (),
    watch: Callable[[str], None] | None = None,
) -> tuple[Proposal, ...]:
    """Candidates standing on `plane`, best first; where `things` are already, none is looked for.

    They are named `proposal 1`, ... in the order given. `watch` is told each outline in the picture
    and each part of it that is tried, and may raise to end it. Raises PictureError for a picture of
    another size, NoPose without a camera pose.
    """
    check_size(picture_bgr, camera.intrinsics, "the picture")
    sight = PictureSight.of(picture_bgr)
    known = [hull_of(Solid.of(thing), camera) for thing in things]
    taken = filled(sight.encoded.shape, [hull for hull in known if hull is not None])
    covers: list[Cover] = []
    outlines = list(seeds(sight, taken))
    for i, seed in enumerate(outlines):
        # a chequered floor has a thousand, and who waits may want to end it
        if watch is not None:
            watch(f"outline {i + 1} of {len(outlines)}")
        every = [covering(seed, kind, camera, plane) for kind in PROPOSED]
        covers += [cover for cover in every if cover is not None]
    covers.sort(key=lambda cover: cover.promise, reverse=True)
    found: list[Proposal] = []
    tried: list[Picture] = []
    for cover in covers:
        # what was tried twice over the same part of the picture is not tried again
        if sum(_shared(cover.seed.mask, other) > SAME_SHARE for other in tried) < TRIES:
            tried.append(cover.seed.mask)
            if watch is not None:
                watch(f"part {len(tried)}")
            found += _aligned(cover, camera, sight, plane)
    found.sort(key=lambda p: (p.believed, p.score), reverse=True)
    kept = _different(found, camera, sight.encoded.shape)
    return tuple(_named(proposal, i + 1) for i, proposal in enumerate(kept))


def _aligned(
    cover: Cover, camera: Camera, sight: PictureSight, plane: ReferencePlane
) -> list[Proposal]:
    """What covers a seed, aligned on the edges; nothing where they do not support it."""
    thing = _thing(cover.solid, plane)
    aligned = align_in(sight, [thing], camera, [plane], {thing.name}, REACH_PIXELS)
    told = aligned.objects[thing.name]
    if told.tried is None:
        return []
    reasons = told.reasons
    if told.texture > PLAIN:
        reasons = (*reasons, "edges inside it may be other things'")
    believed = told.believed and not reasons
    score = told.supported / (1 + len(reasons))
    if score < LEAST_SCORE:
        return []
    return [Proposal(told.tried, score, believed, cover.seed.why, reasons)]


def _thing(solid: Solid, plane: ReferencePlane) -> Primitive:
    sizes = dict(zip(KINDS[solid.kind].size_names, solid.parameters, strict=True))
    shape = {"size": solid.parameters} if solid.kind == "box" else sizes
    pose = Pose(solid.rotation, solid.place)
    made: Primitive = KINDS[solid.kind]("proposal", pose, on=plane.name, **shape)
    return made


def _different(
    proposals: Sequence[Proposal], camera: Camera, shape: tuple[int, ...]
) -> list[Proposal]:
    """Without those that cover what a better one covers."""
    window = Window(0, 0, 2, shape[1] // 2, shape[0] // 2)
    kept: list[tuple[Proposal, Picture]] = []
    for proposal in proposals:
        hull = hull_of(Solid.of(proposal.thing), camera)
        if hull is None:
            continue
        mask = window.mask(hull) > 0
        if all(_shared(mask, other) < SAME_SHARE for _, other in kept):
            kept.append((proposal, mask))
    return [proposal for proposal, _ in kept]


def _shared(one: Picture, other: Picture) -> float:
    return float((one & other).sum() / max(min(int(one.sum()), int(other.sum())), 1))


def _named(proposal: Proposal, number: int) -> Proposal:
    thing = replace(proposal.thing, name=f"proposal {number}")
    return replace(proposal, thing=thing)
