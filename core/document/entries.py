# SPDX-License-Identifier: GPL-3.0-or-later
"""The entries of a cell document: nouns to JSON values and back, strictly read.

Cameras and references stand here; objects, motions and poses have files of their own.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ..camera import Camera
from ..distortion import Distortion
from ..intrinsics import Intrinsics
from .fields import Fields, keyed, number
from .motion_entries import composite_entry, composite_from_entry
from .object_entries import object_entry, object_from_entry, thing_from_entry
from .pose_entries import Entry, named, pose_entry, pose_from_entry

INTRINSICS = ("width", "height", "fx", "fy", "cx", "cy")


def camera_entry(camera: Camera) -> Entry:
    """Intrinsics, distortion, and, where known, pose and covariance."""
    entry: Entry = {name: getattr(camera.intrinsics, name) for name in INTRINSICS}
    distortion = camera.intrinsics.distortion
    entry["distortion"] = {
        "model": distortion.model,
        "coefficients": distortion.coefficients.tolist(),
    }
    if camera.camera_from_world is not None:
        entry["camera_from_world"] = pose_entry(camera.camera_from_world)
    if camera.covariance is not None:
        entry["covariance"] = camera.covariance.tolist()
    return entry


def camera_from_entry(entry: Any, where: str = "camera") -> Camera:
    """The camera of a document, of a camera file of our own, or of a glTF's extras."""
    fields = keyed(entry, where, INTRINSICS, ("distortion", "camera_from_world", "covariance"))
    pose = fields.raw("camera_from_world")
    with named(where):
        return Camera(
            Intrinsics(
                fields.whole("width"),
                fields.whole("height"),
                fields.number("fx"),
                fields.number("fy"),
                fields.number("cx"),
                fields.number("cy"),
                _distortion(fields),
            ),
            None if pose is None else pose_from_entry(pose, fields.path("camera_from_world")),
            fields.matrix("covariance", 6, 6) if fields.has("covariance") else None,
        )


def _distortion(fields: Fields) -> Distortion:
    if not fields.has("distortion"):
        return Distortion()
    where = fields.path("distortion")
    inner = keyed(fields.raw("distortion"), where, ("model",), ("coefficients",))
    listed = inner.items("coefficients")
    values = [number(v, f"{where}.coefficients[{i}]") for i, v in enumerate(listed)]
    with named(fields.where):
        return Distortion(inner.text("model"), np.array(values))


__all__ = [
    "Entry",
    "camera_entry",
    "camera_from_entry",
    "composite_entry",
    "composite_from_entry",
    "named",
    "object_entry",
    "object_from_entry",
    "pose_entry",
    "pose_from_entry",
    "thing_from_entry",
]
