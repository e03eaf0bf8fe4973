# SPDX-License-Identifier: GPL-3.0-or-later
"""The paper's own way to a ball: edge points near a predicted place in, the ball's centre out.

With intrinsics and radius known, a ball has three parameters: where its centre is. Around the place
that the arm's joint angles predict, every edge point votes for all the centres whose outline it may
lie on: for a direction of the centre that is the one depth at which the outline reaches the edge
point (Tan, Clapworthy & Belousov, section 3.2). A baseline to hold others against: it takes edges
as whole pixels, and all of them.
"""

from __future__ import annotations

import numpy as np

from ..arrays import Array, frozen, positive
from ..errors import SphereNotFound
from ..intrinsics import Intrinsics
from ..picture.pictures import Picture, check_size, eight_bits
from .circle_votes import edge_pixels
from .sphere import outline_pixels

# cells along each of the three parameters; each pass looks at a part of the last one's range
CELLS, PASSES, NARROWER = 25, 3, 0.35
FINEST_PIXELS = 0.3
FEWEST_EDGES, LEAST_SHARE = 12, 0.3


def vote_for_sphere(
    picture: Picture,
    intrinsics: Intrinsics,
    radius: float,
    rough_centre_camera: Array,
    reach: float,
) -> Array:
    """The centre (3,) in the camera frame that most edge points vote for.

    `reach` metres around `rough_centre_camera` (3,) are searched, across and along the line of
    sight. Raises SphereNotFound when there are few edges or they agree on no ball, and InvalidValue
    for numbers that can't be.
    """
    check_size(picture, intrinsics, "the picture")
    positive(radius, "radius")
    centre = frozen(rough_centre_camera, (3,), "rough_centre_camera")
    half = np.full(3, positive(reach, "reach"))
    finest = CELLS // 2 * _step_of_a_pixel(intrinsics, centre, radius) * FINEST_PIXELS
    rays = _edge_rays(picture, intrinsics, radius, centre, reach)
    share = 0.0
    for _ in range(PASSES):
        # smaller cells than edges are sure would scatter the votes
        centre, share = _voted(rays, centre, np.maximum(half, finest), radius, intrinsics)
        half = half * NARROWER
    if share < LEAST_SHARE:
        raise SphereNotFound(
            f"the best place has the votes of {100 * share:.0f} % of an outline "
            f"(at least {100 * LEAST_SHARE:.0f} % is needed)"
        )
    return centre


def _step_of_a_pixel(intrinsics: Intrinsics, centre: Array, radius: float) -> Array:
    """By how much a ball moves (across, across, along) for one pixel of its outline, in metres."""
    distance = float(np.linalg.norm(centre))
    across = distance / intrinsics.fx
    return np.array([across, across, across * distance / radius])


def _edge_rays(
    picture: Picture, intrinsics: Intrinsics, radius: float, centre: Array, reach: float
) -> Array:
    """Rays (N, 3) of the edge pixels in the window that the ball may cover."""
    outline = outline_pixels(intrinsics, centre, radius + reach, 72)
    size = [intrinsics.width, intrinsics.height]
    low = np.clip(np.nanmin(outline, axis=0) - 2, 0, size).astype(int)
    high = np.clip(np.nanmax(outline, axis=0) + 3, 0, size).astype(int)
    window = eight_bits(picture)[low[1] : high[1], low[0] : high[0]]
    if min(window.shape[:2]) < 3:
        raise SphereNotFound("the predicted place lies outside the picture")
    column, row = edge_pixels(np.ascontiguousarray(window))[:2]
    rays = intrinsics.rays(np.stack([column + low[0], row + low[1]], axis=1))
    rays = rays[np.isfinite(rays).all(axis=1)]
    if len(rays) < FEWEST_EDGES:
        raise SphereNotFound(
            f"only {len(rays)} edge points around the predicted place, {FEWEST_EDGES} are needed"
        )
    return rays


def _voted(
    rays: Array, centre: Array, half: Array, radius: float, intrinsics: Intrinsics
) -> tuple[Array, float]:
    """The cell with the most votes, and the share of its outline that voted for it."""
    distance = float(np.linalg.norm(centre))
    axis = centre / distance
    right = np.cross([0.0, 1.0, 0.0], axis)
    right /= np.linalg.norm(right)
    steps = np.linspace(-1, 1, CELLS)
    across = steps[:, None, None] * right + steps[None, :, None] * np.cross(axis, right)
    ways = centre + half[0] * across.reshape(-1, 3)
    ways /= np.linalg.norm(ways, axis=1)[:, None]
    # a ball in this direction touches the edge's ray at this depth
    sine = np.sqrt(np.maximum(1 - (ways @ rays.T) ** 2, 1e-12))
    depth = radius / sine
    cell = np.rint((depth - distance) / half[2] * (CELLS // 2)).astype(int) + CELLS // 2
    hit = (cell >= 0) & (cell < CELLS)
    places = (np.arange(len(ways))[:, None] * CELLS + cell)[hit]
    votes = np.bincount(places, minlength=len(ways) * CELLS).astype(float)
    # edges are whole pixels: what falls beside the right cell counts for it too
    gathered = _blurred(votes.reshape(CELLS, CELLS, CELLS))
    peak = [int(i) for i in np.unravel_index(int(np.argmax(gathered)), gathered.shape)]
    best = _between(gathered, peak)
    offset = (best / (CELLS // 2) - 1) * half
    way = centre + offset[0] * right + offset[1] * np.cross(axis, right)
    found = way / np.linalg.norm(way) * (distance + offset[2])
    # who voted for it: the edge pixels on its outline
    voters = np.abs(rays @ (found / np.linalg.norm(found)) - _cosine(found, radius))
    near = voters < _sine(found, radius) * 1.5 / intrinsics.fx
    circumference = 2 * np.pi * _sine(found, radius) * intrinsics.fx
    return found, float(near.sum()) / circumference


def _sine(centre: Array, radius: float) -> float:
    return radius / float(np.linalg.norm(centre))


def _cosine(centre: Array, radius: float) -> float:
    return float(np.sqrt(1 - _sine(centre, radius) ** 2))


def _blurred(votes: Array) -> Array:
    kernel = np.array([0.25, 0.5, 0.25])
    for axis in range(3):
        votes = np.apply_along_axis(np.convolve, axis, votes, kernel, "same")
    return votes


def _between(votes: Array, peak: list[int]) -> Array:
    """The peak between the cells, by a parabola along each parameter."""
    best = np.array(peak, dtype=float)
    for axis, at in enumerate(peak):
        if 0 < at < CELLS - 1:
            others = [p for i, p in enumerate(peak) if i != axis]
            row = np.moveaxis(votes, axis, -1)[others[0], others[1]]
            before, here, after = row[at - 1 : at + 2]
            bend = before - 2 * here + after
            best[axis] += 0.5 * (before - after) / bend if bend < 0 else 0.0
    return best
