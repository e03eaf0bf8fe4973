# SPDX-License-Identifier: GPL-3.0-or-later
"""Balls of all sightings looked for in their pictures: a cell in, outlines or reasons out.

Pictures are read one at a time, each once a pass.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial

import numpy as np

from ..arrays import Array
from ..ball.outline import SphereOutline
from ..cell import Cell
from ..errors import MonocellError, SphereNotFound
from ..picture.shelf import PictureShelf
from ..sighting import PointSighting, Sighting, SphereSighting
from .candidate_choice import choose_candidates, outlines_of
from .observation import Place
from .scenery import Scenery
from .seen import Seen, seen_targets
from .sighting_report import NOT_FITTING

# beside the balls that sightings tell of, a picture shows other round things
CANDIDATES, MORE_CANDIDATES = 4, 3

Outlines = list[SphereOutline | None]
Failures = dict[int, str]


def look_for_each(cell: Cell, shelf: PictureShelf) -> tuple[Outlines, Failures]:
    """The ball that stands out most for each sighting, and why where there is none."""
    from ..ball.find import find_sphere

    outlines: Outlines = [None] * len(cell.sightings)
    failures: Failures = {}
    scenery = Scenery.of(cell, shelf)
    for i, sighting in _by_picture(cell.sightings):
        find = partial(
            find_sphere,
            shelf.read(sighting.picture),
            cell.camera.intrinsics,
            sighting.radius,
            sighting.window,
        )
        try:
            outlines[i] = scenery.hinted(find, sighting)
        except SphereNotFound as error:
            failures[i] = str(error)
    return outlines, failures


def look_for_all(
    cell: Cell, shelf: PictureShelf, places: Sequence[Place]
) -> tuple[Outlines, Failures]:
    """Of all that could be a ball, in all pictures, what fits together."""
    candidates = _candidates(cell, shelf)
    seen = [
        [one for one in _seen_of(cell, i, listed, places[i]) if one is not None]
        for i, listed in enumerate(candidates)
    ]
    chosen = outlines_of(choose_candidates(seen, [s.picture for s in cell.sightings]))
    failures = {
        i: NOT_FITTING if candidates[i] else "no ball found"
        for i, sighting in enumerate(cell.sightings)
        if chosen[i] is None and isinstance(sighting, SphereSighting)
    }
    return chosen, failures


def look_again(
    cell: Cell, shelf: PictureShelf, expected_camera: dict[int, Array], *, closely: bool = False
) -> dict[int, SphereOutline]:
    """Outlines of some sightings, looked for where each is expected (3,) in the camera.

    `closely` where the expectation is better than a pixel.
    """
    from ..ball.find import measure_sphere

    found: dict[int, SphereOutline] = {}
    for i, sighting in _by_picture(cell.sightings):
        if i not in expected_camera or not np.isfinite(expected_camera[i]).all():
            continue
        try:
            picture = shelf.read(sighting.picture)
            found[i] = measure_sphere(
                picture,
                cell.camera.intrinsics,
                sighting.radius,
                expected_camera[i],
                predicted=closely,
            )
        except MonocellError:
            # the first refusal stands, and says more
            continue
    return found


def share_a_picture(sightings: Sequence[Sighting]) -> bool:
    """Whether some picture shows the balls of more than one sighting."""
    pictures = [s.picture for s in sightings if isinstance(s, SphereSighting)]
    return len(set(pictures)) < len(pictures)


def _candidates(cell: Cell, shelf: PictureShelf) -> list[tuple[SphereOutline, ...]]:
    from ..ball.find import find_spheres

    balls = [s for s in cell.sightings if isinstance(s, SphereSighting)]
    candidates: list[tuple[SphereOutline, ...]] = [()] * len(cell.sightings)
    # the same look at the same picture gives the same outlines
    looks: dict[tuple[object, ...], tuple[SphereOutline, ...]] = {}
    scenery = Scenery.of(cell, shelf)
    for i, sighting in _by_picture(cell.sightings):
        look = (sighting.picture, sighting.radius, sighting.window)
        if look not in looks:
            shared = sum((s.picture, s.radius, s.window) == look for s in balls)
            most = max(CANDIDATES, shared + MORE_CANDIDATES)
            find = partial(
                find_spheres,
                shelf.read(sighting.picture),
                cell.camera.intrinsics,
                sighting.radius,
                sighting.window,
                most=most,
            )
            try:
                looks[look] = scenery.hinted(find, sighting)
            except SphereNotFound:
                looks[look] = ()
        candidates[i] = looks[look]
    return candidates


def _seen_of(
    cell: Cell, i: int, outlines: Sequence[SphereOutline], place: Place
) -> list[Seen | None]:
    sighting = cell.sightings[i]
    listed: list[SphereOutline | None] = (
        [None] if isinstance(sighting, PointSighting) else list(outlines)
    )
    if not listed:
        return []
    return seen_targets(
        [sighting] * len(listed), listed, [place] * len(listed), cell.camera.intrinsics
    )


def _by_picture(sightings: Sequence[Sighting]) -> Iterator[tuple[int, SphereSighting]]:
    """The balls' sightings with their indices, those of one picture after each other."""
    first: dict[str, int] = {}
    for i, sighting in enumerate(sightings):
        first.setdefault(sighting.picture, i)
    for i in sorted(range(len(sightings)), key=lambda i: first[sightings[i].picture]):
        sighting = sightings[i]
        if isinstance(sighting, SphereSighting):
            yield i, sighting
