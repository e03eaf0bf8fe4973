# SPDX-License-Identifier: GPL-3.0-or-later
"""What a click was meant for: a picture and a pixel in, the corner or edge next to it out.

Found on amounts of light, so that blur does not move an edge to its dark side, and only where it
stands out from the noise round it. Where shadows, stains or other things come near, what is found
may be theirs: a hand is then surer, and nothing is said.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import cv2
import numpy as np

from ..arrays import Array, positive
from .pictures import Picture, linear_light

# gradients are those of light blurred by this, pixels
BLUR = 1.0
# what is read beyond the radius: the blur, the window of a corner, and the way that it may move
MARGIN = 10
CORNER_REACH, CORNER_HOLE, ROUNDS = 7.0, 2.5, 12
# a corner that a smaller window puts elsewhere by more than this, pixels, is not one corner
SMALL_REACH, MOST_APART = 4.5, 0.6
# of all that is steep near it, this share belongs to edges that pass within so many pixels
LEAST_THROUGH, THROUGH = 0.85, 2.0
# of the least gradient worth snapping to: what is less is noise, too, and no other edge
NOISE_SHARE = 0.5
# a gradient worth snapping to, in sigmas of noise, of the strongest near, and at all
LEAST_SIGMAS, LEAST_SHARE, LEAST_GRADIENT = 6.0, 0.2, 2e-3
# a step of about a tenth of the light there: less is the grain of wood, a stain, a soft shadow
LEAST_CONTRAST = 0.03
# this far from an edge its gradient has fallen to less than this share, pixels
WIDTH, MOST_BEYOND = 4.0, 0.6
# second differences both ways, which see noise and no edges, scaled to the noise of a pixel
SECOND_DIFFERENCE = np.array([[1.0, -2, 1], [-2, 4, -2], [1, -2, 1]]) / 6
# what the blurred gradient has of a pixel's noise
GRADIENT_NOISE = 0.2
# a corner has edges in two directions: the smaller eigenvalue of the structure, of the larger
LEAST_SECOND = 0.08
# how far the exact corner may lie from where it was first seen, and an edge from its pixel
MOST_REFINED, MOST_OFF_EDGE = 4.0, 1.0
# of the two directions of its edges, the weaker against the stronger
MOST_CONDITION = 40.0


@dataclass(frozen=True, eq=False)
class Snap:
    """A pixel (2,) to the fraction, and whether a corner or an edge is there."""

    pixel: Array
    kind: Literal["corner", "edge"]


def snapped(picture: Picture, pixel: Array, radius: float) -> Snap | None:
    """The corner nearest to a pixel (2,) within `radius` pixels, else the nearest edge, or None.

    None, too, where that is less sure than a click: the corner moves with the window that is looked
    at, or other edges than its own are near. A corner is where edges of two directions meet: the
    point that all gradients round it are square to (Foerstner 1987). An edge is where the gradient
    is steepest along its own direction.
    """
    reach = positive(radius, "snapping radius")
    cut, left_top = _cut(picture, np.asarray(pixel, dtype=float), reach)
    if cut is None:
        return None
    at = np.asarray(pixel, dtype=float) - left_top
    gx, gy = _gradients(cut)
    strength = np.hypot(gx, gy)
    least = _least_strength(cut, strength)
    corner = _corner(gx, gy, at, reach, least)
    if corner is not None:
        return Snap(corner + left_top, "corner") if _sure_corner(gx, gy, corner, least) else None
    edge = _edge(strength, gx, gy, at, reach, least)
    sure = edge is not None and _through(gx, gy, edge, least) >= LEAST_THROUGH
    return Snap(edge + left_top, "edge") if edge is not None and sure else None


def _cut(picture: Picture, pixel: Array, reach: float) -> tuple[Array | None, Array]:
    """The light round the pixel, and where its top-left pixel stands in the picture."""
    height, width = picture.shape[:2]
    if not np.isfinite(pixel).all():
        return None, pixel
    size = int(np.ceil(reach)) + MARGIN
    u, v = (round(float(value)) for value in pixel)
    left, right = max(u - size, 0), min(u + size + 1, width)
    top, bottom = max(v - size, 0), min(v + size + 1, height)
    if right - left < 2 * MARGIN or bottom - top < 2 * MARGIN:
        return None, pixel
    light = linear_light(np.ascontiguousarray(picture[top:bottom, left:right]))
    grey = cv2.cvtColor(light, cv2.COLOR_BGR2GRAY)
    return np.asarray(grey, dtype=np.float64), np.array([left, top], dtype=float)


def _gradients(cut: Array) -> tuple[Array, Array]:
    smooth = cv2.GaussianBlur(cut, (0, 0), BLUR)
    gx, gy = (
        cv2.Sobel(smooth, cv2.CV_64F, x, y, ksize=3, scale=0.125) for x, y in ((1, 0), (0, 1))
    )
    return np.asarray(gx, dtype=np.float64), np.asarray(gy, dtype=np.float64)


def _least_strength(cut: Array, strength: Array) -> float:
    """The gradient of a step that is no noise (Immerkaer 1996), nor a faint one beside a strong."""
    rough = cv2.filter2D(cut, cv2.CV_64F, SECOND_DIFFERENCE)
    noise = 1.4826 * float(np.median(np.abs(rough))) * GRADIENT_NOISE
    faint = LEAST_CONTRAST * float(np.median(cut))
    return max(LEAST_SIGMAS * noise, LEAST_SHARE * float(strength.max()), faint, LEAST_GRADIENT)


def _corner(gx: Array, gy: Array, at: Array, reach: float, least: float) -> Array | None:
    small, large = _structure(gx, gy)
    # two edges of the least strength that meet have this much of it in either direction
    strong = (small > LEAST_SECOND * large) & (small > 0.1 * least**2)
    peaks = strong & (small >= cv2.dilate(small, np.ones((3, 3))))
    rows, columns = np.nonzero(peaks)
    places = np.stack([columns, rows], axis=1).astype(float)
    near = places[np.linalg.norm(places - at, axis=1) <= reach + MOST_REFINED]
    best, nearest = None, reach
    for place in near:
        exact = _refined(gx, gy, place)
        distance = float(np.linalg.norm(exact - at))
        if distance <= nearest:
            best, nearest = exact, distance
    return best


def _structure(gx: Array, gy: Array) -> tuple[Array, Array]:
    """The two eigenvalues of the gradients' second moments round each pixel."""
    xx, yy, xy = (cv2.GaussianBlur(m, (0, 0), 1.5) for m in (gx * gx, gy * gy, gx * gy))
    half, root = (xx + yy) / 2, np.hypot((xx - yy) / 2, xy)
    return half - root, half + root


def _sure_corner(gx: Array, gy: Array, corner: Array, least: float) -> bool:
    small = _refined(gx, gy, corner, SMALL_REACH)
    # a NaN, of what is no corner in the small, is not near either
    near = float(np.linalg.norm(small - corner)) <= MOST_APART
    return near and _through(gx, gy, corner, least) >= LEAST_THROUGH


def _through(gx: Array, gy: Array, place: Array, least: float) -> float:
    """The share of the squared gradients near a place, beyond noise, whose edges run through it."""
    rows, columns = np.mgrid[: gx.shape[0], : gx.shape[1]]
    u, v = columns - place[0], rows - place[1]
    squared = u**2 + v**2
    steep = gx**2 + gy**2 > (NOISE_SHARE * least) ** 2
    asked = steep & (squared <= CORNER_REACH**2) & (squared >= CORNER_HOLE**2)
    energy = (gx**2 + gy**2)[asked]
    missed = np.abs(gx * u + gy * v)[asked] / np.maximum(np.sqrt(energy), 1e-12)
    return float(energy[missed < THROUGH].sum() / max(float(energy.sum()), 1e-300))


def _refined(gx: Array, gy: Array, place: Array, far: float = CORNER_REACH) -> Array:
    """The corner near a pixel: `sum g g^T (corner - q) = 0` over places q with gradients g.

    The innermost places, where blur rounds the corner, are not asked. NaN where it is none.
    """
    rows, columns = np.mgrid[: gx.shape[0], : gx.shape[1]]
    corner = place
    for _ in range(ROUNDS):
        squared = (columns - corner[0]) ** 2 + (rows - corner[1]) ** 2
        asked = (squared <= far**2) & (squared >= CORNER_HOLE**2)
        g = np.stack([gx[asked], gy[asked]], axis=1)
        q = np.stack([columns[asked], rows[asked]], axis=1)
        along = (g * q).sum(axis=1)
        moments = g.T @ g
        if np.linalg.cond(moments) > MOST_CONDITION:
            return np.full(2, np.nan)
        moved = np.linalg.solve(moments, g.T @ along)
        if np.linalg.norm(moved - place) > MOST_REFINED:
            return np.full(2, np.nan)
        corner = (corner + moved) / 2
    return corner


def _edge(
    strength: Array, gx: Array, gy: Array, at: Array, reach: float, least: float
) -> Array | None:
    """The steepest place nearest to `at`, to the fraction of a pixel along its own gradient."""
    inner = np.zeros_like(strength, dtype=bool)
    inner[1:-1, 1:-1] = True
    rows, columns = np.nonzero(inner & (strength > least))
    places = np.stack([columns, rows], axis=1).astype(float)
    close = np.linalg.norm(places - at, axis=1) <= reach + MOST_OFF_EDGE
    rows, columns, places = rows[close], columns[close], places[close]
    if not len(places):
        return None
    steep = strength[rows, columns]
    way = np.stack([gx[rows, columns], gy[rows, columns]], axis=1) / steep[:, None]
    before, after = (_sampled(strength, places + sign * way) for sign in (-1, 1))
    bend = before - 2 * steep + after
    step = np.where(bend < 0, (before - after) / (2 * np.minimum(bend, -1e-12)), np.inf)
    # the steepest along its gradient, not on its slope, and not a shading that is steep for long
    top = (steep >= before) & (steep >= after) & (np.abs(step) <= MOST_OFF_EDGE)
    beyond = [_sampled(strength, places + sign * WIDTH * way) for sign in (-1, 1)]
    top &= np.maximum(*beyond) < MOST_BEYOND * steep
    exact = places[top] + step[top, None] * way[top]
    # from the click straight on to the edge, not to the next pixel's share of it
    along = np.stack([-way[top][:, 1], way[top][:, 0]], axis=1)
    slide = np.clip(((at - exact) * along).sum(axis=1), -0.7, 0.7)
    exact = exact + slide[:, None] * along
    distances = np.linalg.norm(exact - at, axis=1)
    if not len(distances) or distances.min() > reach:
        return None
    return exact[int(distances.argmin())]


def _sampled(values: Array, points: Array) -> Array:
    """Values between pixels, bicubic, (N,)."""
    u, v = (points[:, i].astype(np.float32)[:, None] for i in (0, 1))
    read = cv2.remap(values.astype(np.float32), u, v, cv2.INTER_CUBIC)
    return np.asarray(read[:, 0], dtype=float)
