# SPDX-License-Identifier: GPL-3.0-or-later
"""Where each sighting's target is: sightings and the camera's mount in, places in the base out."""

from __future__ import annotations

from collections.abc import Sequence

from ..mount import Mount
from ..sighting import Sighting
from .observation import Place


def places_of(sightings: Sequence[Sighting], mount: Mount | None) -> list[Place]:
    """The place of each target, in the world for a fixed camera, in the flange for a mounted one.

    Before a fixed camera the flange carries what has no known place; for a mounted one the world
    does, and moves against the flange.
    """
    return [_mounted(s) if mount is not None else _fixed(s) for s in sightings]


def _fixed(sighting: Sighting) -> Place:
    if sighting.center_world is not None:
        return Place(sighting.center_world)
    assert sighting.world_from_flange is not None
    return Place(None, sighting.world_from_flange, sighting.target)


def _mounted(sighting: Sighting) -> Place:
    assert sighting.world_from_flange is not None
    flange_from_world = sighting.world_from_flange.inverse()
    return Place(sighting.center_world, flange_from_world, sighting.target)
