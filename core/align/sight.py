# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture in, all that alignment looks at in it out: light, colours, edges, sharpness, noise."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np

from ..arrays import Array
from ..picture.pictures import Picture, eight_bits, linear_light
from .edge_map import EdgeMap, edge_map
from .step_edges import profiles, step_misfits

# blurs that are tried, and by how many edges of the picture they are judged
BLURS = (0.6, 0.75, 0.95, 1.2, 1.6, 2.1)
JUDGES, REACH, SEARCH = 240, 5.0, 1.0
# of flat places this share has no texture of its own
FLAT_SHARE = 0.25
LEAST_NOISE = 0.001


@dataclass(frozen=True, eq=False)
class PictureSight:
    """`encoded` (H, W, 3) 8 bits, `light` (H, W, 3) linear, the edges, `blur` and `noise`.

    `blur` is 1 sigma of the sharpness in pixels, `noise` of a sample, in light.
    """

    encoded: Picture
    light: Picture
    edges: EdgeMap
    blur: float
    noise: float

    @staticmethod
    def of(picture: Picture) -> PictureSight:
        """Of a picture (H, W, 3), blue green red, 8 or 16 bits, sRGB-encoded."""
        light = linear_light(picture)
        encoded = eight_bits(picture)
        edges = edge_map(encoded)
        noise = _noise(light)
        return PictureSight(encoded, light, edges, _blur(light, edges, noise), noise)


def _noise(light: Picture) -> float:
    """Of the flat quarter of the picture: what a pixel differs from its neighbours' mean."""
    part = np.ascontiguousarray(light[::2, ::2])
    rest = np.abs(part[1:-1, 1:-1] * 2 - light[1:-3:2, 2:-2:2] - light[3:-1:2, 2:-2:2])
    return max(float(np.quantile(rest, FLAT_SHARE)) / (0.3186 * np.sqrt(6)), LEAST_NOISE)


def _blur(light: Picture, edges: EdgeMap, noise: float) -> float:
    """The blur whose steps leave least of the picture's clearest edges."""
    weight = edges.structure[..., 0] + edges.structure[..., 2]
    rows, columns = np.nonzero(weight > 0.9)
    if len(rows) < JUDGES // 4:
        return BLURS[1]
    chosen = np.linspace(0, len(rows) - 1, min(JUDGES, len(rows))).astype(int)
    rows, columns = rows[chosen], columns[chosen]
    xx, xy, yy = edges.structure[rows, columns].T
    turn = 0.5 * np.arctan2(2 * xy, xx - yy)
    normals = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    across = profiles(light, np.stack([columns, rows], axis=1).astype(float), normals, REACH)
    plain = np.zeros(len(rows), dtype=bool)
    left = [
        float(np.median(step_misfits(across, plain, REACH, SEARCH, b, noise).with_step.min(axis=0)))
        for b in BLURS
    ]
    return BLURS[int(np.argmin(left))]


def filled(shape: tuple[int, ...], hulls: list[Array]) -> Picture:
    """Ones (H, W), uint8, inside outlines (M, 2) of pixels."""
    mask = np.zeros(shape[:2], dtype=np.uint8)
    for hull in hulls:
        cv2.fillConvexPoly(mask, np.round(hull * 16).astype(np.int32), (1,), shift=4)
    return mask
