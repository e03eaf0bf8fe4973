# SPDX-License-Identifier: GPL-3.0-or-later
"""Balls found in a picture: pixels, intrinsics and the radius in, measured outlines out."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..arrays import Array, positive
from ..errors import SphereCut, SphereNotFound
from ..intrinsics import Intrinsics
from ..picture.pictures import Picture, check_size, eight_bits, linear_light
from .candidates import Places, Window, clipped, evidence_of, size_pixels
from .circle_votes import Circle
from .hints import FindHints
from .outline import OutlineMeter, SphereOutline
from .outline_checks import far_doubts
from .ring_edges import NARROW, WIDE, Pyramid
from .ring_search import RoughSphere, circle_of, search_rings
from .roundness import refuse_ellipse
from .sphere import sphere_at

# how many balls are measured when nobody says, and how many more are tried when some are refused
MEASURED, SPARE = 4, 3
# of the voted circles, how many are measured where the rough search sees none
AS_VOTED, AS_VOTED_EVIDENCE = 16, 10.5
MOVED_EVIDENCE = 2.5
# an outline this clear ends the search: what is left had less agreement already
CLEAR_EVIDENCE, CLEAR_COVERAGE = 8.0, 0.45
# in a window the strongest circles are tried before all are compared
TRIED_AT_ONCE, CLEAR_AGREEMENT = 2, 0.6
# up to this radius the first look is as fine as the pixels
FINE_ENOUGH = 32.0
LEAST_AGREEMENT, CLOSER_LOOKS, SMALL = 0.33, 3, 16.0
# an outline of which more is seen can't be a part of something else's
WHOLE_COVERAGE = 0.8
# a whole picture holds so many circles that some stand out by chance, or are a part of an ellipse
FAINT_REFUSED, FAINT_DOUBTED, HALF_SEEN = 6.5, 9.0, 0.6
# a small outline can't stand out by more, but nearly all of it is seen; half of one should
SMALL_REFUSED, MOSTLY_SEEN, HALF_REFUSED = 5.5, 0.7, 7.9
# edges of a texture make loose circles, by their radius, or circles that most edges are not on
LOOSE_SHARE, FEW_USED = 0.05, 0.45
# around the rough outline, as a share of its radius and in pixels, what the fine measurement sees
CROP_SHARE, CROP_PIXELS = 1.25, 14.0


def find_spheres(
    picture: Picture,
    intrinsics: Intrinsics,
    radius: float,
    window: Window | None = None,
    *,
    hints: FindHints | None = None,
    most: int = MEASURED,
) -> tuple[SphereOutline, ...]:
    """Balls of `radius` metres in a picture (H, W, 3) as `read_picture` gives it, the best first.

    `window` (x, y, width, height) in pixels limits where balls are; it should hold the whole
    outline. `hints` tell what is known of the ball, `most` how many are wanted. Overlapping answers
    are told apart by how much of the outline has its edge: the best of each place is kept.

    Raises PictureError when the picture is not of the camera's size, SphereNotFound when there is
    no ball that can be believed, SphereCut when the best leaves the picture, and what hints raise.
    """
    search = _Search(picture, intrinsics, radius, window, hints)
    return search.found(most)


def find_sphere(
    picture: Picture,
    intrinsics: Intrinsics,
    radius: float,
    window: Window | None = None,
    *,
    hints: FindHints | None = None,
) -> SphereOutline:
    """The ball in a picture: the best of `find_spheres`, which see for what is raised.

    Places are measured from the most agreed on, until one is clear.
    """
    search = _Search(picture, intrinsics, radius, window, hints)
    clear = search.first_clear() if window is not None else None
    if clear is not None:
        return clear
    return search.found(MEASURED, until_clear=True)[0]


def measure_sphere(
    picture: Picture,
    intrinsics: Intrinsics,
    radius: float,
    rough_centre_camera: Array,
    *,
    predicted: bool = False,
    beforehand: float = 0.0,
) -> SphereOutline:
    """The ball near a known place (3,) in the camera frame, to a few pixels.

    A place `predicted` by a pose is known to a fraction of a pixel, and searched as closely.
    `beforehand` are sigmas of evidence for a ball there that the outline does not have to bring.

    Raises SphereNotFound and SphereCut, as `find_spheres`.
    """
    circle = circle_of(intrinsics, rough_centre_camera, radius)
    reach = CROP_SHARE * circle.radius + CROP_PIXELS
    left, top, width, height = clipped(
        (circle.u - reach, circle.v - reach, 2 * reach, 2 * reach), intrinsics
    )
    light = linear_light(np.ascontiguousarray(picture[top : top + height, left : left + width]))
    meter = OutlineMeter(light, np.array([left, top], dtype=float), intrinsics, radius)
    return meter.measure(rough_centre_camera, predicted=predicted, beforehand=beforehand)


class _Search:
    """One search of one picture: rough circles first, then ever fewer and finer."""

    def __init__(
        self,
        picture: Picture,
        intrinsics: Intrinsics,
        radius: float,
        window: Window | None,
        hints: FindHints | None,
    ) -> None:
        self._radius = positive(radius, "radius")
        check_size(picture, intrinsics, "the picture")
        self._picture, self._intrinsics, self._window = picture, intrinsics, window
        coded = eight_bits(picture)
        self._pyramid = Pyramid(coded)
        self._hints = hints or FindHints()
        self._places = Places(coded, intrinsics, window, self._hints)

    def first_clear(self) -> SphereOutline | None:
        """The first circle that turns out to be a clear ball at once, as in a good window."""
        for circle in self._places.circles(TRIED_AT_ONCE, MEASURED):
            roughs = search_rings(self._pyramid, self._intrinsics, [circle], self._radius, WIDE)
            if circle.radius > FINE_ENOUGH:
                roughs = self._closer(roughs)
            if not roughs or roughs[0].agreement < CLEAR_AGREEMENT:
                continue
            try:
                outline = self._believed(roughs[0])
            except SphereNotFound:
                continue
            if self._is_clear(outline):
                return outline
        return None

    def found(self, most: int, until_clear: bool = False) -> tuple[SphereOutline, ...]:
        """The outlines of rough spheres; without any, of voted circles: the search sees less."""
        try:
            return self.measured(self.roughs(most), most, until_clear)
        except SphereNotFound as error:
            try:
                outlines = self.measured(self._voted(), most, until_clear)
            except SphereNotFound:
                raise error from None
            clear = tuple(o for o in outlines if o.evidence > AS_VOTED_EVIDENCE)
            if not clear:
                raise
            return clear

    def _voted(self) -> list[RoughSphere]:
        roughs = []
        for circle in self._places.circles(AS_VOTED, MEASURED):
            at = (circle.u, circle.v)
            try:
                centre = sphere_at(self._intrinsics, at, circle.radius, self._radius)
            except SphereNotFound:
                continue
            roughs.append(RoughSphere(centre, circle.support, 1.0, circle))
        return roughs

    def roughs(self, most: int) -> list[RoughSphere]:
        """The rough spheres that enough edges agree on, each place once, the best first."""
        circles = self._places.circles(self._places.searched(most), most)
        wide = search_rings(self._pyramid, self._intrinsics, circles, self._radius, WIDE)
        best = self._best_of(wide)[: most + CLOSER_LOOKS]
        # a closer look at a small ball sees less around it, and no finer
        small = [rough for rough in best if rough.circle.radius < SMALL]
        return self._best_of([*self._closer(best), *small])[: most + SPARE]

    def measured(
        self, roughs: list[RoughSphere], most: int, until_clear: bool = False
    ) -> tuple[SphereOutline, ...]:
        """The outlines of rough spheres, the best first. Raises what stands for all of them."""
        outlines: list[SphereOutline] = []
        refusal: SphereNotFound | None = None
        for rough in roughs:
            try:
                outline = self._believed(rough)
            except SphereNotFound as error:
                # that a ball is cut says more than that something else is none
                cut = isinstance(error, SphereCut) and rough.agreement > CLEAR_AGREEMENT
                if refusal is None or cut:
                    refusal = error
                continue
            if not any(self._same(outline.centre_camera, o.centre_camera) for o in outlines):
                outlines.append(outline)
            if len(outlines) == most or (until_clear and self._is_clear(outline)):
                break
        if not outlines:
            raise self._none(refusal)
        return tuple(sorted(outlines, key=self._rank, reverse=True))

    def _closer(self, roughs: list[RoughSphere]) -> list[RoughSphere]:
        circles = [circle_of(self._intrinsics, r.centre_camera, self._radius) for r in roughs]
        return search_rings(self._pyramid, self._intrinsics, circles, self._radius, NARROW)

    def _best_of(self, roughs: list[RoughSphere]) -> list[RoughSphere]:
        found = [
            (self._places.weight(rough.circle) * evidence_of(rough), rough)
            for rough in roughs
            if rough.agreement >= LEAST_AGREEMENT
        ]
        distinct: list[RoughSphere] = []
        for _, rough in sorted(found, key=lambda pair: -pair[0]):
            if not any(self._same(rough.centre_camera, kept.centre_camera) for kept in distinct):
                distinct.append(rough)
        return distinct

    def _believed(self, rough: RoughSphere) -> SphereOutline:
        """The measured outline with what speaks against it. Raises SphereNotFound."""
        # fewer circles lie where something moved, and fewer of them look like balls by chance
        beforehand = MOVED_EVIDENCE if self._places.moved(rough.circle) else 0.0
        outline = measure_sphere(
            self._picture,
            self._intrinsics,
            self._radius,
            rough.centre_camera,
            beforehand=beforehand,
        )
        self._places.refuse_size(size_pixels(self._intrinsics, outline))
        doubts = self._faint(outline, outline.evidence + beforehand)
        doubts += far_doubts(float(np.linalg.norm(outline.centre_camera)), self._radius)
        if outline.coverage < WHOLE_COVERAGE:
            circle, centre = self._circle(outline), outline.centre_camera
            refuse_ellipse(self._pyramid, self._intrinsics, circle, centre, self._radius)
        if self._hints.weigh:
            doubts = (*doubts, *self._places.doubts(self._circle(outline)))
        return replace(outline, warnings=(*outline.warnings, *doubts)) if doubts else outline

    def _faint(self, outline: SphereOutline, evidence: float) -> tuple[str, ...]:
        """Doubts that a whole picture raises. Raises SphereNotFound for an outline too faint."""
        if self._window is not None:
            return ()
        faint = evidence < FAINT_DOUBTED
        loose = outline.rms_pixels > LOOSE_SHARE * size_pixels(self._intrinsics, outline)
        loose |= float(outline.used.mean()) < FEW_USED
        least = SMALL_REFUSED if outline.coverage > MOSTLY_SEEN else FAINT_REFUSED
        if outline.coverage < HALF_SEEN:
            least = HALF_REFUSED
        if evidence < least or (faint and loose):
            raise SphereNotFound(
                f"the best outline stands out by {outline.evidence:.1f} sigmas only "
                f"({outline.rms_pixels:.1f} px rms), as some of the many circles of a whole "
                "picture do by chance; give a window around the ball"
            )
        if faint or outline.coverage < HALF_SEEN:
            return (
                f"found in the whole picture with {100 * outline.coverage:.0f} % of its outline "
                f"and {outline.evidence:.1f} sigmas: a window around it would make sure",
            )
        return ()

    def _is_clear(self, outline: SphereOutline) -> bool:
        return (
            outline.evidence > CLEAR_EVIDENCE
            and outline.coverage > CLEAR_COVERAGE
            and self._weight(outline) > self._places.clear_weight
        )

    def _rank(self, outline: SphereOutline) -> float:
        return outline.evidence * self._weight(outline)

    def _weight(self, outline: SphereOutline) -> float:
        return self._places.weight(self._circle(outline)) if self._hints.weigh else 1.0

    def _circle(self, outline: SphereOutline) -> Circle:
        return circle_of(self._intrinsics, outline.centre_camera, self._radius)

    def _same(self, one: Array, other: Array) -> bool:
        """Whether two centres show at about the same place in the picture, at whatever depth."""
        nearer = min(float(np.linalg.norm(one)), float(np.linalg.norm(other)))
        angle = np.linalg.norm(one / np.linalg.norm(one) - other / np.linalg.norm(other))
        return bool(angle < 0.3 * self._radius / nearer)

    def _none(self, refusal: SphereNotFound | None) -> SphereNotFound:
        where, advice = "in the picture", "give a window around it, or a picture that shows"
        if self._window is not None:
            where = f"in the window {[round(float(v)) for v in self._window]}"
            advice = "give a window that holds it whole, or a picture that shows"
        if refusal is not None:
            return type(refusal)(f"no ball found {where}: {refusal}")
        return SphereNotFound(
            f"no ball found {where}: no outline of one{self._places.of_size} stands out; {advice} "
            "all of it with more contrast"
        )
