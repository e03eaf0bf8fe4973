# SPDX-License-Identifier: GPL-3.0-or-later
"""Where to hold the ball next: a calibration and positions in reach in, the most telling ones out.

A sighting that was not made yet says what the sphere's geometry and outlines as sharp as those
already used let it say; its information is added to the fit's, and what the pose then does to the
points worked at is compared. The best three are chosen one after the other, each knowing the last.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array, frozen
from ..ball.outline import SphereOutline
from ..ball.outline_ring import MOST_POINTS
from ..ball.sphere import OutlineRays, tangency
from ..camera import Camera
from ..errors import InvalidValue
from .common_error import common_of, marginalised
from .joint_pose import JointFit
from .measured import Measured
from .observation import OutlineObservation, Place
from .unknowns import State, Unknowns
from .work_surface import WorkArea

MOST_ADVISED = 3
SMALLEST_PIXELS = 8.0
# a ball this near to the picture's rim, or a robot not quite there, is soon cut
MARGIN_PIXELS, MARGIN_SHARE = 8.0, 0.25
# at a place already used, a sighting repeats what is wrong with it: in ball diameters
NEAREST_DIAMETERS = 1.0
SAMPLES = 64
STEPS = (9, 9, 7)
ENLARGED = 0.5
USABLE = "usable"


@dataclass(frozen=True, eq=False)
class NextPosition:
    """Where to hold the ball, where it is then seen, and what it does.

    `sigma` and `position_sigma`: 1 sigma afterwards of a point worked at and of the camera's place,
    metres.
    """

    position_world: Array
    pixel: Array
    radius_pixels: float
    sigma: float
    position_sigma: float


@dataclass(frozen=True, eq=False)
class Advice:
    """The best positions in order, each on top of those before; `sigma` is that of now, metres.

    `tried` positions were looked at, `usable` of them can be seen well.
    """

    area: WorkArea
    sigma: float
    position_sigma: float
    steps: tuple[NextPosition, ...]
    tried: int
    usable: int


@dataclass(frozen=True)
class TypicalOutline:
    """The ball's radius, and what a pixel of its outline weighs: the sum of 1 / sigma^2 there."""

    radius: float
    weight_per_pixel: float

    @staticmethod
    def of(outlines: Sequence[SphereOutline], grown: float = 1.0) -> TypicalOutline:
        """The middle one of those measured, at least one; the radius by a refined factor."""
        weights = [
            float((1 / o.sigma_pixels[o.used] ** 2).sum()) / (2 * np.pi * _radius_pixels(o.pixels))
            for o in outlines
        ]
        return TypicalOutline(
            grown * float(np.median([o.radius for o in outlines])), float(np.median(weights))
        )


def reachable_box(positions_world: ArrayLike) -> Array:
    """Low and high corner (2, 3) of a box round positions (N, 3), half as large again.

    It goes no lower than the lowest of them: what is below is often the table.
    """
    p = np.asarray(positions_world, dtype=float)
    low, high = p.min(axis=0), p.max(axis=0)
    more = 0.5 * ENLARGED * (high - low)
    return np.stack([np.append(low[:2] - more[:2], low[2]), high + more])


def positions_in_box(box: ArrayLike) -> Array:
    """A grid of positions (N, 3) in a box (2, 3). Raises InvalidValue where it is one point."""
    corners = frozen(box, (2, 3), "advise box")
    low, high = corners.min(axis=0), corners.max(axis=0)
    if (low == high).all():
        raise InvalidValue("advise box: both corners are the same; give two, X0 Y0 Z0 X1 Y1 Z1")
    sides = [
        np.linspace(a, b, n) if b > a else np.array([a])
        for a, b, n in zip(low, high, STEPS, strict=True)
    ]
    return np.stack(np.meshgrid(*sides, indexing="ij"), axis=-1).reshape(-1, 3)


def advise(
    camera: Camera,
    fit: JointFit,
    area: WorkArea,
    typical: TypicalOutline,
    candidates_world: ArrayLike,
    used_world: ArrayLike,
) -> Advice:
    """The best three of candidate positions (N, 3), beside those used already (M, 3).

    Raises InvalidValue when none of them can be seen well, with how many fail why, and where the
    ball's places are not known in the world.
    """
    _refuse_unknown_places(fit, used_world)
    candidates = frozen(candidates_world, (None, 3), "advised positions")
    used = np.asarray(used_world, dtype=float).reshape(-1, 3)
    seen, why = [], Counter[str]()
    for place in candidates:
        view = _view(camera, place, typical.radius, used)
        why[view if isinstance(view, str) else USABLE] += 1
        if not isinstance(view, str):
            seen.append((place, view))
    if not seen:
        raise InvalidValue(_none_usable(why, len(candidates)))
    places = np.array([place for place, _ in seen])
    informations = _predicted(camera, fit, typical, places, [view for _, view in seen])
    chosen = _greedy(fit, area, places, informations, 2 * typical.radius)
    now = _covariances(fit, _information(fit)[None])
    steps = tuple(
        NextPosition(places[k], *_where(seen[k][1].pixels), sigma, position)
        for k, sigma, position in chosen
    )
    sigma_now = float(area.sigmas(now)[0])
    return Advice(area, sigma_now, _centre_sigma(now[0]), steps, len(candidates), len(seen))


def _refuse_unknown_places(fit: JointFit, used_world: ArrayLike) -> None:
    places = np.asarray(used_world, dtype=float)
    if fit.targets or places.shape != fit.places_base.shape:
        raise InvalidValue("advice needs balls at known places; here the offset is solved for too")
    if not np.allclose(places, fit.places_base, atol=1e-9):
        raise InvalidValue("advice is for a camera that stands still; this one is carried")


def _predicted(
    camera: Camera,
    fit: JointFit,
    typical: TypicalOutline,
    places: Array,
    outlines: Sequence[OutlineRays],
) -> Array:
    """What balls not seen yet, at places (K, 3), would say of the fit's P unknowns, (K, P, P)."""
    observations = [
        OutlineObservation(
            outline, np.ones(SAMPLES), Place(place), typical.radius, camera.intrinsics
        )
        for place, outline in zip(places, outlines, strict=True)
    ]
    measured, count = Measured.of(observations), len(places)
    rows = _rows(camera, fit, measured, [one.place for one in observations])
    centres = camera.pose.apply(places)
    held = tangency(measured.outlines, centres[measured.owner], typical.radius)
    by_centre = held.by_centre.reshape(count, SAMPLES, 3)
    # an outline is measured at so many places at most, however long it is
    sizes = np.array([_radius_pixels(outline.pixels) for outline in outlines])
    lengths = np.minimum(2 * np.pi * sizes, MOST_POINTS)
    root = np.sqrt(typical.weight_per_pixel * lengths / SAMPLES)[:, None, None]
    nothing_left = np.zeros((count, SAMPLES, 1))
    columns = [by_centre, rows.reshape(count, SAMPLES, -1), nothing_left]
    whitened = np.concatenate(columns, axis=2) * root
    allowed = np.array(
        [common_of(by, c, typical.radius) for by, c in zip(by_centre, centres, strict=True)]
    )
    reduced, _ = marginalised(np.swapaxes(whitened, 1, 2) @ whitened, allowed)
    informations: Array = reduced[:, 3:-1, 3:-1]
    return informations


def _rows(camera: Camera, fit: JointFit, measured: Measured, places: Sequence[Place]) -> Array:
    """Derivatives (N, P) of all outlines' residuals by the fit's unknowns."""
    unknowns = Unknowns.of_places(places, tuple(one.name for one in fit.refined))
    state = State(camera.pose, np.zeros((0, 3)))
    columns = measured.columns(camera.pose.apply(unknowns.places_base(state)), state)
    return unknowns.rows(columns, measured.owner, state)


def _view(camera: Camera, place: Array, radius: float, used: Array) -> OutlineRays | str:
    """The outline of a ball at `place`, or why it would not be seen well."""
    centre = camera.pose.apply(place)
    if centre[2] <= radius:
        return "behind the camera"
    outline = OutlineRays.around(camera.intrinsics, centre, radius, SAMPLES)
    pixels = outline.pixels
    if not np.isfinite(pixels).all():
        return "outside the picture"
    size = _radius_pixels(pixels)
    margin = max(MARGIN_PIXELS, MARGIN_SHARE * size)
    inner = camera.intrinsics
    inside = (pixels >= margin - 0.5) & (pixels <= [inner.width, inner.height] - np.array(margin))
    if not inside.all():
        return "outside the picture"
    if size < SMALLEST_PIXELS:
        return f"smaller than {SMALLEST_PIXELS:g} px"
    if _apart(place, used) < NEAREST_DIAMETERS * 2 * radius:
        return "at a place already used"
    return outline


def _apart(place: Array, others: Array) -> float:
    return float(np.linalg.norm(others - place, axis=1).min(initial=np.inf))


def _none_usable(why: Counter[str], count: int) -> str:
    reasons = ", ".join(f"{n} {reason}" for reason, n in why.most_common())
    if not count:
        return "advised positions: there are none to choose from"
    return (
        f"none of the {count} positions to choose from would show the ball well ({reasons}); "
        "give others, in metres"
    )


def _greedy(
    fit: JointFit, area: WorkArea, places: Array, informations: Array, apart: float
) -> list[tuple[int, float, float]]:
    """Index, sigma of a point worked at, and of the camera's place, after each of the best."""
    information, free = _information(fit), np.ones(len(places), dtype=bool)
    chosen: list[tuple[int, float, float]] = []
    while free.any() and len(chosen) < MOST_ADVISED:
        indices = np.flatnonzero(free)
        covariances = _covariances(fit, information + informations[indices])
        sigmas = area.sigmas(covariances)
        best = int(np.argmin(sigmas))
        k = int(indices[best])
        chosen.append((k, float(sigmas[best]), _centre_sigma(covariances[best])))
        information = information + informations[k]
        free &= np.linalg.norm(places - places[k], axis=1) >= NEAREST_DIAMETERS * apart
    return chosen


def _information(fit: JointFit) -> Array:
    return np.asarray(sum((say.information for say in fit.says), fit.prior_information))


def _covariances(fit: JointFit, informations: Array) -> Array:
    """Of the pose, (K, 6, 6), as uncertain as the sightings' disagreement says."""
    scale = 1 / np.sqrt(np.einsum("kii->ki", informations))
    outer = scale[:, :, None] * scale[:, None, :]
    inverse: Array = np.linalg.inv(informations * outer) * outer
    return inverse[:, :6, :6] * fit.misfit**2


def _centre_sigma(covariance: Array) -> float:
    return float(np.sqrt(np.trace(covariance[3:, 3:])))


def _where(pixels: Array) -> tuple[Array, float]:
    return pixels.mean(axis=0), _radius_pixels(pixels)


def _radius_pixels(pixels: Array) -> float:
    return float(np.median(np.linalg.norm(pixels - pixels.mean(axis=0), axis=1)))
