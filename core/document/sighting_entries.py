# SPDX-License-Identifier: GPL-3.0-or-later
"""Sightings and the camera's mount: nouns to JSON values and back, strictly read."""

from __future__ import annotations

from typing import Any

from ..arrays import Array
from ..errors import DocumentError
from ..mount import Mount
from ..pose import Pose
from ..sighting import CLICK_SIGMA_PIXELS, PointSighting, Sighting, SphereSighting
from .entries import Entry, named, pose_entry, pose_from_entry
from .fields import Fields, keyed, shown

PLACE = ("center", "world_from_flange", "target", "use")


def sighting_entry(sighting: Sighting) -> Entry:
    """A ball or a point of a picture, and what tells its place."""
    entry: Entry = {"picture": sighting.picture}
    if sighting.center_world is not None:
        entry["center"] = sighting.center_world.tolist()
    if sighting.world_from_flange is not None:
        entry["world_from_flange"] = pose_entry(sighting.world_from_flange)
    if sighting.target:
        entry["target"] = sighting.target
    if not sighting.use:
        entry["use"] = False
    if isinstance(sighting, PointSighting):
        entry |= {"pixel": sighting.pixel.tolist(), "sigma_pixels": sighting.sigma_pixels}
        return entry
    entry["radius"] = sighting.radius
    if sighting.window is not None:
        entry["window"] = list(sighting.window)
    return entry


def sighting_from_entry(entry: Any, where: str) -> Sighting:
    """The inverse of `sighting_entry`: a point where there is a `pixel`, else a ball."""
    if isinstance(entry, dict) and "pixel" in entry:
        fields = keyed(entry, where, ("picture", "pixel"), (*PLACE, "sigma_pixels"))
        sigma = fields.number("sigma_pixels") if fields.has("sigma_pixels") else CLICK_SIGMA_PIXELS
        with named(where):
            return PointSighting(
                fields.text("picture"),
                _center(fields),
                fields.vector("pixel", 2),
                sigma,
                _flange(fields),
                _target(fields),
                _use(fields),
            )
    fields = keyed(entry, where, ("picture", "radius"), (*PLACE, "window"))
    window = fields.vector("window", 4).tolist() if fields.has("window") else None
    with named(where):
        return SphereSighting(
            fields.text("picture"),
            _center(fields),
            fields.number("radius"),
            None if window is None else (window[0], window[1], window[2], window[3]),
            _flange(fields),
            _target(fields),
            _use(fields),
        )


def mount_entry(mount: Mount) -> Entry:
    """What a camera rides on, and, where known, its place there."""
    entry: Entry = {"on": "flange"}
    if mount.camera_from_flange is not None:
        entry["camera_from_flange"] = pose_entry(mount.camera_from_flange)
    if mount.covariance is not None:
        entry["covariance"] = mount.covariance.tolist()
    if mount.world_from_flange is not None:
        entry["world_from_flange"] = pose_entry(mount.world_from_flange)
    return entry


def mount_from_entry(entry: Any, where: str = "mount") -> Mount:
    """The inverse of `mount_entry`."""
    fields = keyed(entry, where, ("on",), ("camera_from_flange", "covariance", "world_from_flange"))
    if fields.text("on") != "flange":
        raise DocumentError(
            f"{fields.path('on')}: {fields.text('on')!r} is not known; a camera rides on the flange"
        )
    pose = fields.raw("camera_from_flange")
    with named(where):
        return Mount(
            None if pose is None else pose_from_entry(pose, fields.path("camera_from_flange")),
            fields.matrix("covariance", 6, 6) if fields.has("covariance") else None,
            _flange(fields),
        )


def _center(fields: Fields) -> Array | None:
    if fields.has("center"):
        return fields.vector("center", 3)
    if not fields.has("world_from_flange"):
        raise DocumentError(
            f"{fields.path('center')}: is missing; give the place in the world, or "
            "world_from_flange where the offset in the flange is unknown"
        )
    return None


def _flange(fields: Fields) -> Pose | None:
    if not fields.has("world_from_flange"):
        return None
    return pose_from_entry(fields.raw("world_from_flange"), fields.path("world_from_flange"))


def _use(fields: Fields) -> bool:
    """A sighting takes part unless it is switched off."""
    value = fields.raw("use")
    if value is not None and not isinstance(value, bool):
        raise DocumentError(f"{fields.path('use')}: expected true or false, got {shown(value)}")
    return value is not False


def _target(fields: Fields) -> str:
    return fields.text("target") if fields.has("target") else ""
