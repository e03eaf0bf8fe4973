# SPDX-License-Identifier: GPL-3.0-or-later
"""An offer and a camera in, lines and words over the picture out: what is, and what would be."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from ...core.arrays import Array
from ...core.camera import Camera
from ...core.picture.wireframe import Polyline, wireframe
from ...core.primitives import Primitive
from ..lengths import length
from ..overlay.drawing import GREY, ORANGE, WHITE, Color
from ..overlay.overlay_lines import Label, Stroke, haloed
from ..settings import Settings
from .offer import Candidate, Offer

BEFORE: Color = (1.0, 1.0, 1.0, 0.75)
REASON_COLUMNS = 60

Frames = tuple[tuple[Polyline, ...], tuple[Polyline, ...]]


@dataclass(frozen=True, eq=False)
class OfferFrames:
    """The wire-frames of every candidate, before and after, in undistorted pixels."""

    frames: tuple[Frames, ...]

    @classmethod
    def of(cls, offer: Offer, camera: Camera) -> OfferFrames:
        pinhole = replace(camera, intrinsics=camera.intrinsics.undistorted())

        def lines(thing: Primitive | None) -> tuple[Polyline, ...]:
            return () if thing is None else wireframe(thing, pinhole)

        return cls(tuple((lines(one.before), lines(one.after)) for one in offer.candidates))

    def strokes(self, offer: Offer, settings: Settings, only_before: bool) -> Iterator[Stroke]:
        """What is, thin and white; what would be, in the colour of whether it is taken."""
        for one, (before, after) in zip(offer.candidates, self.frames, strict=True):
            yield Stroke(_visible(before), BEFORE, 1.0)
            if not only_before:
                yield from haloed(_visible(after), color_of(one, settings), settings.line_width)

    def labels(self, offer: Offer, settings: Settings) -> Iterator[Label]:
        """A name and a word at the upper right of each."""
        for one, (before, after) in zip(offer.candidates, self.frames, strict=True):
            lines = _visible(after) or _visible(before)
            if lines:
                points = np.concatenate(lines)
                corner = np.array([points[:, 0].max(), points[:, 1].min()])
                yield Label(corner, _word(one), color_of(one, settings))

    def near(self, offer: Offer, settings: Settings) -> list[tuple[Array, Color]]:
        """The visible lines with their colours, for the loupe."""
        told = []
        for one, (before, after) in zip(offer.candidates, self.frames, strict=True):
            told += [(line, BEFORE) for line in _visible(before)]
            told += [(line, color_of(one, settings)) for line in _visible(after)]
        return told


def color_of(one: Candidate, settings: Settings) -> Color:
    """Green for what is taken, orange for what is not believed, grey for what is left."""
    if one.taken:
        return settings.good_color
    return settings.doubtful_color if one.reasons else GREY


def rows_of(one: Candidate, unit: str) -> list[tuple[str, Color]]:
    """The words beside the cursor over a candidate."""
    rows = [(f"{one.name}: {one.told}", WHITE)]
    if one.after is not None:
        sigmas = one.after.size_sigma()
        for i, (name, size) in enumerate(zip(one.after.size_names, one.after.sizes, strict=True)):
            sigma = None if sigmas is None else float(sigmas[i])
            was = "" if one.before is None else f"  was {length(float(one.before.sizes[i]), unit)}"
            told = f"{name.replace('_', ' ')} {length(float(size), unit, sigma)}{was}"
            rows.append((told, WHITE))
    for reason in one.reasons:
        rows += [(line, ORANGE) for line in textwrap.wrap(reason, REASON_COLUMNS)]
    if one.free:
        rows.append(("click to leave it" if one.taken else "click to take it", WHITE))
    return rows


def _word(one: Candidate) -> str:
    """Short, as many stand near each other; the rest is told under the cursor."""
    if one.taken:
        return one.name if one.moved is None else f"{one.name}  {one.moved:.1f} px"
    return f"{one.name}  {'stays' if one.before is not None else 'left out'}"


def _visible(lines: tuple[Polyline, ...]) -> tuple[Array, ...]:
    return tuple(line.pixels for line in lines if line.visible)
