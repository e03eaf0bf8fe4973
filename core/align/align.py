# SPDX-License-Identifier: GPL-3.0-or-later
"""A rough model and its picture in, the model aligned on the picture's edges out.

What is nearer is aligned first, so that what it hides is known. Relations, references and typed
sizes are kept throughout; the last fit is the solver of `core/modelling`, with edges for picks.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import cv2
import numpy as np

from ..arrays import Array, positive
from ..camera import Camera
from ..errors import InvalidValue, NotConverged, PickError
from ..modelling.model_fit import ModelFit, fit_model
from ..modelling.solid import Solid
from ..picture.pictures import Picture, check_size
from ..primitives import Primitive
from ..reference import Reference
from .depth_order import hull_of, in_front, nearest_first
from .edge_rows import edge_observer
from .freedom import Freedom
from .one_object import Tried, align_one
from .refine import EdgeFit, tangent
from .result import Aligned, AlignedObject
from .search import Surroundings
from .sight import PictureSight, filled
from .verdict import moved_pixels, supported_share

Watch = Callable[[str], None]

# how far a rough outline may be off, pixels, and its sizes, as a share
REACH_PIXELS = 8.0
# of a picture that is another's hardly any object is believed
FEW_SHARE = 0.2
# what is in front covers so much more of the picture, and its edges reach so far
COVER, NEAR = (np.ones((n, n), dtype=np.uint8) for n in (3, 9))
# what stands about is rough itself: its place is known to so many pixels
ROUGHLY = (13, 13)


def align(
    things: Sequence[Primitive],
    camera: Camera,
    picture_bgr: Picture,
    references: Iterable[Reference] = (),
    names: Collection[str] | None = None,
    reach_pixels: float = REACH_PIXELS,
    watch: Watch | None = None,
) -> Aligned:
    """Align the objects in `names` (None: all) that may be about `reach_pixels` off.

    The picture is as it came from the lens, sRGB-encoded, 8 or 16 bits. `references` are what the
    objects' `on` and relations name. An object that is not believed stays as it was given, and says
    why. `watch` is told the name of each object that is looked at, and may raise to end it.
    Covariances join the edges' scatter, `camera.covariance` and the errors of what holds an object.

    Raises PictureError for a picture of another size, InvalidValue for a name or relation that
    means nothing or a reach that is none, NoPose without a camera pose.
    """
    reach = positive(reach_pixels, "reach_pixels")
    check_size(picture_bgr, camera.intrinsics, "the picture")
    wanted = _wanted(things, names)
    return align_in(PictureSight.of(picture_bgr), things, camera, references, wanted, reach, watch)


def align_in(
    sight: PictureSight,
    things: Sequence[Primitive],
    camera: Camera,
    references: Iterable[Reference],
    wanted: Collection[str],
    reach_pixels: float,
    watch: Watch | None = None,
) -> Aligned:
    """`align` in a picture that has been looked at already."""
    known = {reference.name: reference for reference in references}
    work = _Work(list(things), camera, sight, known, reach_pixels)
    before = in_front(things, camera)
    away = [float(np.linalg.norm(camera.pose.apply(_place(thing)))) for thing in things]
    for i in nearest_first(before, away):
        if things[i].name in wanted:
            if watch is not None:
                watch(things[i].name)
            work.align(i, before[i])
    return work.finished(things)


@dataclass(eq=False)
class _Work:
    """Objects being aligned: where they stand by now, and what was found."""

    now: list[Primitive]
    camera: Camera
    sight: PictureSight
    references: dict[str, Reference]
    reach: float

    def __post_init__(self) -> None:
        self.tried: dict[str, Tried] = {}
        self.hulls = [hull_of(Solid.of(thing), self.camera) for thing in self.now]
        self.about: dict[int, Picture] = {}

    def align(self, i: int, before: set[int]) -> None:
        """One object, after those before it."""
        thing = self.now[i]
        front = self._filled([self.hulls[j] for j in sorted(before)])
        others = [self._about(j) for j in range(len(self.now)) if j != i and j not in before]
        around = Surroundings(cv2.dilate(front, COVER), others)
        freedom = Freedom.of(thing, self.now, self.references)
        tried = align_one(
            Solid.of(thing),
            freedom,
            self.camera,
            self.sight,
            around,
            cv2.dilate(front, NEAR),
            self.reach,
        )
        self.tried[thing.name] = tried
        if tried.fit is not None:
            self.now[i] = tried.fit.solid.applied(thing)
            self.hulls[i] = hull_of(tried.fit.solid, self.camera)
            self.about.pop(i, None)

    def finished(self, given: Sequence[Primitive]) -> Aligned:
        """The believed objects fitted with all that holds them; the others as they were given."""
        fits = {n: t.fit for n, t in self.tried.items() if t.verdict.believed and t.fit is not None}
        start = [n if n.name in fits else g for n, g in zip(self.now, given, strict=True)]
        fitted, failed = _fitted(fits, start, self.camera, self.references)
        objects: dict[str, AlignedObject] = {}
        things = []
        for thing in given:
            if thing.name not in self.tried:
                things.append(thing)
                continue
            tried = self.tried[thing.name]
            reasons = tried.verdict.reasons + failed.get(thing.name, ())
            final = fitted.get(thing.name)
            told = _told(thing, tried, final, reasons)
            objects[thing.name] = told
            things.append(told.thing)
        return Aligned(tuple(things), objects, _doubts(objects))

    def _about(self, j: int) -> Picture:
        """Where an object may be, (H, W), from 0 to 255: its place is known roughly."""
        if j not in self.about:
            self.about[j] = cv2.blur(255 * self._filled([self.hulls[j]]), ROUGHLY)
        return self.about[j]

    def _filled(self, hulls: Sequence[Array | None]) -> Picture:
        return filled(self.sight.encoded.shape, [hull for hull in hulls if hull is not None])


def _fitted(
    fits: Mapping[str, EdgeFit],
    start: Sequence[Primitive],
    camera: Camera,
    references: Mapping[str, Reference],
) -> tuple[dict[str, Primitive], dict[str, tuple[str, ...]]]:
    """The believed objects solved together; those that can't be, with the reason, one by one."""
    if not fits:
        return {}, {}
    try:
        return _solved(fits, list(fits), start, camera, references), {}
    except (PickError, NotConverged, InvalidValue):
        pass
    done: dict[str, Primitive] = {}
    failed: dict[str, tuple[str, ...]] = {}
    for name in fits:
        try:
            done |= _solved(fits, [name], start, camera, references)
        except (PickError, NotConverged, InvalidValue) as error:
            failed[name] = (str(error),)
    return done, failed


def _solved(
    fits: Mapping[str, EdgeFit],
    names: Sequence[str],
    start: Sequence[Primitive],
    camera: Camera,
    references: Mapping[str, Reference],
) -> dict[str, Primitive]:
    observe = edge_observer({name: fits[name] for name in names}, camera)
    fit: ModelFit = fit_model(camera, references, start, observe, names)
    return {name: fit.objects[name].thing for name in names}


def _told(
    given: Primitive, tested: Tried, final: Primitive | None, reasons: tuple[str, ...]
) -> AlignedObject:
    """What is said of one object that was tried."""
    fit = tested.fit
    if fit is None:
        return AlignedObject(given, None, False, reasons)
    tried = replace(final or fit.solid.applied(given), picks=given.picks)
    back = tangent(fit.solid, Solid.of(given))
    residual = fit.residual[fit.supported]
    off = fit.stations.by_object[fit.supported] @ back + residual
    believed = final is not None and not reasons
    thing = tried if believed else given
    return AlignedObject(
        thing,
        tried,
        believed,
        reasons,
        moved_pixels(fit, back),
        _rms(off),
        _rms(residual),
        float(np.median(np.abs(residual))) if len(residual) else 0.0,
        supported_share(fit),
        tested.texture,
    )


def _doubts(objects: Mapping[str, AlignedObject]) -> tuple[str, ...]:
    """One that fits a strange picture does so by chance: few among many are doubtful, too."""
    believed = [name for name, one in objects.items() if one.believed]
    if not believed or len(believed) >= FEW_SHARE * len(objects):
        return ()
    return (
        f"only {', '.join(believed)} of {len(objects)} objects fits the picture's edges: is it the "
        "picture of this cell, the right way round?",
    )


def _rms(values: Array) -> float:
    return float(np.sqrt(np.mean(values**2))) if len(values) else 0.0


def _wanted(things: Sequence[Primitive], names: Collection[str] | None) -> set[str]:
    there = {thing.name for thing in things}
    if names is None:
        return there
    for name in names:
        if name not in there:
            listed = ", ".join(sorted(there)) or "none"
            raise InvalidValue(f"no object is called {name!r}; there is {listed}")
    return set(names)


def _place(thing: Primitive) -> Array:
    return thing.world_from_object.translation
