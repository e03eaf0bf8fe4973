# SPDX-License-Identifier: GPL-3.0-or-later
"""Balls found in a picture: pixels, intrinsics and the radius in, measured outlines out."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from ..arrays import Array, positive
from ..errors import SphereCut, SphereNotFound
from ..intrinsics import Intrinsics
from ..picture.pictures import Picture, check_size, linear_light
from .circle_votes import Circle, vote_for_circles
from .outline import OutlineMeter, SphereOutline
from .ring_search import NARROW, WIDE, Pyramid, RoughSphere, Span, circle_of, search_ring

Window = tuple[float, float, float, float]

SEARCHED, SEARCHED_IN_WINDOW, MEASURED = 24, 8, 4
# an outline this clear ends the search: what is left had less agreement already
CLEAR_EVIDENCE, CLEAR_COVERAGE = 8.0, 0.45
# in a window the strongest circles are tried before all are compared
TRIED_AT_ONCE, CLEAR_AGREEMENT = 2, 0.6
# up to this radius the first look is as fine as the pixels
FINE_ENOUGH = 32.0
LEAST_AGREEMENT, SHARE_BY_CHANCE = 0.33, 0.25
INDEPENDENT_EDGES = 300
# around the rough outline, as a share of its radius and in pixels, what the fine measurement sees
CROP_SHARE, CROP_PIXELS = 1.25, 14.0


def find_spheres(
    picture: Picture,
    intrinsics: Intrinsics,
    radius: float,
    window: Window | None = None,
    most: int = MEASURED,
) -> tuple[SphereOutline, ...]:
    """Balls of `radius` metres in a picture (H, W, 3) as `read_picture` gives it, the best first.

    `window` (x, y, width, height) in pixels limits where the ball's middle may be. Overlapping
    answers are told apart by how much of the outline has its edge: the best of each place is kept,
    and `most` places are measured.

    Raises PictureError when the picture is not of the camera's size, SphereNotFound when there is
    no ball that can be believed, and SphereCut when the best leaves the picture.
    """
    return _found(picture, intrinsics, radius, window, until_clear=False, measured=most)


def _found(
    picture: Picture,
    intrinsics: Intrinsics,
    radius: float,
    window: Window | None,
    *,
    until_clear: bool,
    measured: int = MEASURED,
) -> tuple[SphereOutline, ...]:
    positive(radius, "radius")
    check_size(picture, intrinsics, "the picture")
    coded = _eight_bits(picture)
    left, top, width, height = _clipped(window, intrinsics)
    crop = np.ascontiguousarray(coded[top : top + height, left : left + width])
    circles = [
        Circle(c.u + left, c.v + top, c.radius, c.support)
        for c in vote_for_circles(crop, largest=_largest(window, intrinsics))
    ]
    pyramid = Pyramid(coded)
    if until_clear and window is not None:
        clear = _first_clear(picture, pyramid, intrinsics, circles[:TRIED_AT_ONCE], radius)
        if clear is not None:
            return (clear,)
    most = SEARCHED if window is None else SEARCHED_IN_WINDOW
    roughs = _roughs(pyramid, intrinsics, circles[:most], radius, measured)
    return _measured(picture, intrinsics, radius, roughs, _where(window), until_clear)


def find_sphere(
    picture: Picture, intrinsics: Intrinsics, radius: float, window: Window | None = None
) -> SphereOutline:
    """The ball in a picture: the best of `find_spheres`, which see for what is raised.

    Places are measured from the most agreed on, until one is clear.
    """
    return _found(picture, intrinsics, radius, window, until_clear=True)[0]


def measure_sphere(
    picture: Picture, intrinsics: Intrinsics, radius: float, rough_centre_camera: Array
) -> SphereOutline:
    """The ball near a known place (3,) in the camera frame, to a few pixels.

    Raises SphereNotFound and SphereCut, as `find_spheres`.
    """
    circle = circle_of(intrinsics, rough_centre_camera, radius)
    reach = CROP_SHARE * circle.radius + CROP_PIXELS
    left, top, width, height = _clipped(
        (circle.u - reach, circle.v - reach, 2 * reach, 2 * reach), intrinsics
    )
    light = linear_light(np.ascontiguousarray(picture[top : top + height, left : left + width]))
    meter = OutlineMeter(light, np.array([left, top], dtype=float), intrinsics, radius)
    return meter.measure(rough_centre_camera)


def _first_clear(
    picture: Picture,
    pyramid: Pyramid,
    intrinsics: Intrinsics,
    circles: list[Circle],
    radius: float,
) -> SphereOutline | None:
    """The first circle that turns out to be a clear ball at once, as in a good window it does."""
    for circle in circles:
        try:
            rough = search_ring(pyramid, intrinsics, circle, radius, WIDE)
            if circle.radius > FINE_ENOUGH:
                better = circle_of(intrinsics, rough.centre_camera, radius)
                rough = search_ring(pyramid, intrinsics, better, radius, NARROW)
            if rough.agreement < CLEAR_AGREEMENT:
                continue
            outline = measure_sphere(picture, intrinsics, radius, rough.centre_camera)
        except SphereNotFound:
            continue
        if _is_clear(outline):
            return outline
    return None


def _is_clear(outline: SphereOutline) -> bool:
    return outline.evidence > CLEAR_EVIDENCE and outline.coverage > CLEAR_COVERAGE


def _roughs(
    pyramid: Pyramid, intrinsics: Intrinsics, circles: list[Circle], radius: float, most: int
) -> list[RoughSphere]:
    """The rough spheres that enough edges agree on, each place once, the best first."""
    wide = _searched(pyramid, intrinsics, circles, radius, WIDE)
    circles = [circle_of(intrinsics, rough.centre_camera, radius) for rough in wide[: most + 1]]
    return _searched(pyramid, intrinsics, circles, radius, NARROW)[:most]


def _searched(
    pyramid: Pyramid, intrinsics: Intrinsics, circles: list[Circle], radius: float, span: Span
) -> list[RoughSphere]:
    found: list[tuple[float, RoughSphere]] = []
    for circle in circles:
        try:
            rough = search_ring(pyramid, intrinsics, circle, radius, span)
        except SphereNotFound:
            continue
        if rough.agreement >= LEAST_AGREEMENT:
            found.append((_evidence(rough.agreement, circle.radius * rough.visible), rough))
    distinct: list[RoughSphere] = []
    for _, rough in sorted(found, key=lambda pair: -pair[0]):
        if not any(_same(rough.centre_camera, kept.centre_camera, radius) for kept in distinct):
            distinct.append(rough)
    return distinct


def _measured(
    picture: Picture,
    intrinsics: Intrinsics,
    radius: float,
    roughs: list[RoughSphere],
    where: str,
    until_clear: bool,
) -> tuple[SphereOutline, ...]:

    outlines: list[SphereOutline] = []
    refusal: SphereNotFound | None = None
    for rough in roughs:
        try:
            outline = measure_sphere(picture, intrinsics, radius, rough.centre_camera)
        except SphereNotFound as error:
            # that a ball is cut says more than that something else is none
            if refusal is None or isinstance(error, SphereCut):
                refusal = error
            continue
        if not any(_same(outline.centre_camera, o.centre_camera, radius) for o in outlines):
            outlines.append(outline)
        if until_clear and _is_clear(outline):
            break
    if outlines:
        return tuple(sorted(outlines, key=lambda o: o.evidence, reverse=True))
    if refusal is not None:
        raise type(refusal)(f"no ball found {where}: {refusal}")
    raise SphereNotFound(
        f"no ball found {where}: no outline of one stands out; give a window around it, or a "
        "picture that shows all of it with more contrast"
    )


def _evidence(share: float, radius_pixels: float) -> float:
    """How much speaks for an outline of which `share` is seen, in sigmas over chance.

    Clutter agrees with a part of any circle; the longer the outline, the less that is by chance.
    """
    independent = min(2 * np.pi * radius_pixels, INDEPENDENT_EDGES)
    return float((share - SHARE_BY_CHANCE) * np.sqrt(independent))


def _same(one: Array, other: Array, radius: float) -> bool:
    """Whether two centres show at about the same place in the picture, at whatever depth."""
    nearer = min(float(np.linalg.norm(one)), float(np.linalg.norm(other)))
    angle = np.linalg.norm(one / np.linalg.norm(one) - other / np.linalg.norm(other))
    return bool(angle < 0.3 * radius / nearer)


def _eight_bits(picture: Picture) -> NDArray[np.uint8]:
    """The picture at 8 bits, stretched where it uses only the dark part of its range."""
    if picture.dtype == np.uint8:
        return np.asarray(picture, dtype=np.uint8)
    return np.asarray(cv2.convertScaleAbs(picture, alpha=255.0 / 65535.0), dtype=np.uint8)


def _clipped(window: Window | None, intrinsics: Intrinsics) -> tuple[int, int, int, int]:
    """The window in whole pixels within the picture. Raises SphereNotFound when it is outside."""
    if window is None:
        return 0, 0, intrinsics.width, intrinsics.height
    x, y, width, height = window
    left, top = max(0, int(np.floor(x))), max(0, int(np.floor(y)))
    right = min(intrinsics.width, int(np.ceil(x + width)))
    bottom = min(intrinsics.height, int(np.ceil(y + height)))
    if right - left < 8 or bottom - top < 8:
        raise SphereNotFound(
            f"the window {[round(float(v)) for v in window]} leaves {max(0, right - left)} x "
            f"{max(0, bottom - top)} px of the {intrinsics.width} x {intrinsics.height} picture"
        )
    return left, top, right - left, bottom - top


def _largest(window: Window | None, intrinsics: Intrinsics) -> float:
    size = (intrinsics.width, intrinsics.height) if window is None else window[2:]
    return 0.6 * float(max(size))


def _where(window: Window | None) -> str:
    if window is None:
        return "in the picture"
    return f"in the window {[round(float(v)) for v in window]}"
