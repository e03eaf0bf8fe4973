# SPDX-License-Identifier: GPL-3.0-or-later
"""Pixels that surely show an object: things, camera and their errors in, masks of pixels out.

A pixel on an object's edge mixes the object with what lies behind it; and the edge itself is only
known to the object's stated error.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray

from ..arrays import Array, Mask
from ..camera import Camera
from ..errors import InvalidValue
from ..picture.pictures import Light
from ..primitives import Primitive
from ..shape.hits import SeenMap, seen_map

Indices = NDArray[np.intp]
# an edge lies within two sigma of where it is told, 19 times out of 20
SIGMAS = 2.0


@dataclass(frozen=True, eq=False)
class Sight:
    """What a picture of the camera shows of the things, and where something else hides them.

    `seen` is the map of the whole picture, without the pixels (H, W) that are `hidden` behind what
    is not modelled: an arm, a cable.
    """

    things: tuple[Primitive, ...]
    camera: Camera
    seen: SeenMap

    @staticmethod
    def of(things: Sequence[Primitive], camera: Camera, hidden: Mask | None = None) -> Sight:
        """Raises NoPose, and InvalidValue for a mask that is not of the picture's size."""
        seen = seen_map(things, camera)
        if hidden is None:
            return Sight(tuple(things), camera, seen)
        if hidden.shape != seen.owner.shape:
            height, width = seen.owner.shape
            raise InvalidValue(
                f"hidden: the mask is {hidden.shape[1]} x {hidden.shape[0]} px, the picture "
                f"{width} x {height}; draw it on the cell's own picture"
            )
        # what is hidden belongs to nobody, but still counts as something in front
        owner = np.where(hidden, len(things), seen.owner).astype(np.int16)
        return Sight(tuple(things), camera, replace(seen, owner=owner))

    def window(self, index: int, margin_pixels: float = 0.0) -> tuple[slice, slice] | None:
        """Rows and columns round the pixels that show a thing, None where none does."""
        rows, columns = np.nonzero(self.seen.owner == index)
        if not len(rows):
            return None
        margin = math.ceil(margin_pixels) + 2
        return (
            slice(max(int(rows.min()) - margin, 0), int(rows.max()) + margin + 1),
            slice(max(int(columns.min()) - margin, 0), int(columns.max()) + margin + 1),
        )

    def sure(self, index: int, rim_pixels: float, face: int | None = None) -> Mask:
        """Pixels (H, W) that show a thing, or one face of it, at least `rim_pixels` off any edge.

        The picture's own border is no edge. Things that are less well known than this one keep
        their own distance.
        """
        sure = np.zeros(self.seen.owner.shape, dtype=bool)
        part = self.window(index, rim_pixels)
        if part is None:
            return sure
        owner = self.seen.owner[part]
        shown = (
            owner == index if face is None else (owner == index) & (self.seen.face[part] == face)
        )
        sure[part] = _distance(shown) > rim_pixels
        for other, thing in enumerate(self.things):
            reach = edge_sigma_pixels(thing, self.camera) * SIGMAS
            if other != index and reach > rim_pixels:
                sure[part] &= _distance(owner != other) > reach
        return sure


def edge_sigma_pixels(thing: Primitive, camera: Camera) -> float:
    """By how many pixels, 1 sigma, the edges of a thing may lie elsewhere; 0 where not stated."""
    if thing.covariance is None:
        return 0.0
    sigma = np.sqrt(np.diag(thing.covariance))
    reach = float(np.linalg.norm(thing.half_extent))
    # a length moves both ends by half of it, a radius or a corner moves the edge by the whole
    shape = float(sigma[6:].max(initial=0.0))
    metres = np.linalg.norm([*sigma[3:6], *(reach * sigma[:3]), shape])
    inner = camera.intrinsics
    away = float(np.linalg.norm(thing.world_from_object.translation - camera.centre_world))
    return float(metres) * max(inner.fx, inner.fy) / max(away, 1e-9)


def light_at(light: Light, rows: Indices, columns: Indices) -> Array:
    """Red, green, blue (N, 3) of a picture of linear light (H, W, 3) blue, green, red."""
    picked: Array = light[rows, columns, ::-1].astype(np.float64)
    return picked


def _distance(mask: Mask) -> NDArray[np.float32]:
    """How far each pixel of the mask is from the nearest that is not; outside 0."""
    flat = mask.astype(np.uint8)
    # OpenCV's own answer where there is no zero at all is no distance
    if flat.all():
        return np.full(mask.shape, np.inf, np.float32)
    return np.asarray(cv2.distanceTransform(flat, cv2.DIST_L2, cv2.DIST_MASK_PRECISE))
