# SPDX-License-Identifier: GPL-3.0-or-later
"""Textures of faces: a picture, the things in it and a face in, the face laid flat out.

Each texel is looked up where its point of the surface is imaged, lens and principal point included,
and counts as seen only where the picture surely shows that very face. What was not seen is made up,
from the nearest that was, or of the face's own colour, and is marked by an alpha of 0.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from ..arrays import Array, Mask
from ..picture.pictures import Light, encoded_light
from ..shape.charts import Chart, FlatChart, chart_of
from ..shape.hits import face_names
from .sure_pixels import SIGMAS, Sight, edge_sigma_pixels

# a face seen more aslant than this is not textured, nor that part of a round side
SMALLEST_ANGLE = math.radians(10)
# a pixel whose neighbours all show the face shows nothing else; blur reaches as far again
RIM_PIXELS = 1.5
# what the model says is the face is taken from the picture up to here, though not called seen
LIKELY_RIM_PIXELS = 1.0
# unless a round side turns away there: a pixel of background would become a broad band
LIKELY_ROUND_ANGLE = math.radians(25)
# made-up texels this near to a seen one are its continuation
BESIDE_PIXELS = 3.0
PADDING_TEXELS = 4
NODES = 65
LONGEST_SIDE = 4096
SMALLEST_SHARE, FEWEST_TEXELS = 0.02, 25
STEP = 1e-5


@dataclass(frozen=True, eq=False)
class FacePicture:
    """A face laid flat: `pixels` (h, w, 4) blue, green, red in sRGB, and whether seen (255) or not.

    `seen` is the share of the face's own texels that were seen.
    """

    face: str
    pixels: NDArray[np.uint8]
    seen: float


@dataclass(frozen=True, eq=False)
class NotSeen:
    """Why a face has no texture."""

    face: str
    why: str


def face_picture(
    sight: Sight, index: int, face: str, light: Light, color: Array
) -> FacePicture | NotSeen:
    """The texture of a face of the thing `index` from a picture of linear light (H, W, 3) BGR.

    Its resolution is the picture's where the face is largest in it. `color` (3,) fills what was not
    seen where too little was seen to tell the face's own. Raises InvalidValue for a face that the
    thing has not.
    """
    thing = sight.things[index]
    chart, number = chart_of(thing, face), face_names(thing).index(face)
    rim = max(RIM_PIXELS, SIGMAS * edge_sigma_pixels(thing, sight.camera))
    sure = sight.sure(index, rim, number)
    nodes = _grid(NODES, NODES)
    looked = _Look.at(sight, index, chart, nodes, sure)
    if not looked.seen.any():
        return NotSeen(face, _why(sight, index, number, looked))
    columns, rows = _resolution(sight, index, chart, nodes[looked.seen])
    texels = _grid(columns, rows)
    looked = _Look.at(sight, index, chart, texels, sure)
    on_face = chart.covers(texels)
    share = float((looked.seen & on_face).sum() / max(on_face.sum(), 1))
    if share < SMALLEST_SHARE or looked.seen.sum() < FEWEST_TEXELS:
        return NotSeen(face, f"only {100 * share:.1f} % of it is seen")
    likely, beside = _around(sight, index, number, chart, looked)
    shape = rows, columns
    sampled = _sampled(light, looked.pixels.reshape(*shape, 2))
    own = color[::-1].astype(np.float32)
    filled = _filled(sampled, likely.reshape(shape), beside.reshape(shape), own)
    alpha = np.where(looked.seen, 255, 0).astype(np.uint8).reshape(*shape, 1)
    return FacePicture(face, np.concatenate([eight_bit_srgb(filled), alpha], axis=2), share)


def eight_bit_srgb(light: Light) -> NDArray[np.uint8]:
    """Amounts of light from 0 to 1 as 8-bit sRGB, rounded; what lies outside is cut."""
    counts = np.rint(np.clip(light, 0.0, 1.0) * 65535).astype(np.uint16)
    return np.rint(encoded_light(counts) / 257.0).astype(np.uint8)


@dataclass(frozen=True, eq=False)
class _Look:
    """Where (s, t) pairs (N, 2) of a face are imaged: `pixels` (N, 2), NaN where nowhere.

    `steepness` is the sine of the angle between the surface and the ray, below 0 where it is turned
    away, and `seen` tells whether the picture surely shows it.
    """

    pixels: Array
    steepness: Array
    seen: Mask

    @staticmethod
    def at(sight: Sight, index: int, chart: Chart, st: Array, sure: Mask) -> _Look:
        pose, camera = sight.things[index].world_from_object, sight.camera
        points = pose.apply(chart.points(st))
        towards = camera.centre_world - points
        rise = np.einsum("ij,ij->i", pose.rotate(chart.normals(st)), towards)
        steepness = rise / np.linalg.norm(towards, axis=1)
        pixels = camera.project(points)
        seen = (steepness >= math.sin(SMALLEST_ANGLE)) & _at(sure, pixels) & chart.covers(st)
        return _Look(pixels, steepness, seen)


def _around(
    sight: Sight, index: int, number: int, chart: Chart, looked: _Look
) -> tuple[Mask, Mask]:
    """Texels that show the face if the model is right, and those on or beside its picture."""
    by_model = _at(sight.sure(index, LIKELY_RIM_PIXELS, number), looked.pixels)
    least = SMALLEST_ANGLE if isinstance(chart, FlatChart) else LIKELY_ROUND_ANGLE
    likely = looked.seen | (by_model & (looked.steepness >= math.sin(least)))
    shown = (sight.seen.owner == index) & (sight.seen.face == number)
    return likely, _at(_grown(shown), looked.pixels) & (looked.steepness > 0)


def _grid(columns: int, rows: int) -> Array:
    """The centres of columns x rows texels as (s, t), row by row."""
    s, t = (np.arange(columns) + 0.5) / columns, (np.arange(rows) + 0.5) / rows
    return np.stack([a.ravel() for a in np.meshgrid(s, t)], axis=1)


def _at(mask: Mask, pixels: Array) -> Mask:
    """The mask (H, W) at the nearest pixel, False outside."""
    height, width = mask.shape
    place = np.nan_to_num(np.rint(pixels), nan=-1.0, posinf=-1.0, neginf=-1.0)
    inside = ((place >= 0) & (place < [width, height])).all(axis=1)
    found = np.zeros(len(pixels), dtype=bool)
    column, row = place[inside].astype(int).T
    found[inside] = mask[row, column]
    return found


def _resolution(sight: Sight, index: int, chart: Chart, st: Array) -> tuple[int, int]:
    """Columns and rows that give no texel more than a pixel, from the projection's derivative."""
    pose, camera = sight.things[index].world_from_object, sight.camera

    def image(at: Array) -> Array:
        return camera.project(pose.apply(chart.points(at)))

    sides = []
    for axis in range(2):
        step = np.zeros(2)
        step[axis] = STEP
        speed = np.linalg.norm(image(st + step) - image(st - step), axis=1) / (2 * STEP)
        sides.append(int(np.clip(np.ceil(np.nanmax(speed)), 2, LONGEST_SIDE)))
    return sides[0], sides[1]


def _sampled(light: Light, pixels: Array) -> Light:
    place = np.nan_to_num(pixels, nan=-1e4).astype(np.float32)
    nowhere = np.zeros(0, np.float32)
    sampled = cv2.remap(light, place, nowhere, cv2.INTER_CUBIC, None, cv2.BORDER_REPLICATE)
    return np.clip(np.asarray(sampled, dtype=np.float32), 0.0, 1.0)


def _filled(sampled: Light, seen: Mask, beside: Mask, color: Light) -> Light:
    """What was not seen: beside the seen its continuation, elsewhere the middle of what was."""
    own = np.median(sampled[seen], axis=0) if seen.sum() >= FEWEST_TEXELS else color
    away, labels = cv2.distanceTransformWithLabels(
        (~seen).astype(np.uint8), cv2.DIST_L2, 5, labelType=cv2.DIST_LABEL_PIXEL
    )
    rows, columns = np.nonzero(seen)
    nearest = np.zeros((labels.max() + 1, 2), dtype=int)
    nearest[labels[rows, columns]] = np.stack([rows, columns], axis=1)
    source = nearest[labels]
    continued = sampled[source[..., 0], source[..., 1]]
    near = seen | beside | (away <= PADDING_TEXELS)
    return np.where(near[..., None], continued, own).astype(np.float32)


def _grown(mask: Mask) -> Mask:
    away = cv2.distanceTransform((~mask).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
    grown: Mask = np.asarray(away) <= BESIDE_PIXELS
    return grown


def _why(sight: Sight, index: int, number: int, looked: _Look) -> str:
    """What keeps a face from being seen, the plainest cause first."""
    if looked.steepness.max() <= 0:
        return "it is turned away from the camera"
    if looked.steepness.max() < math.sin(SMALLEST_ANGLE):
        return f"it is seen at less than {math.degrees(SMALLEST_ANGLE):.0f} degrees"
    if not sight.camera.intrinsics.contains(np.nan_to_num(looked.pixels, nan=-1e4)).any():
        return "it lies outside the picture"
    shown = (sight.seen.owner == index) & (sight.seen.face == number)
    if not shown.any():
        return "something stands in front of it"
    return f"only {int(shown.sum())} px of it are seen, all beside an edge"
