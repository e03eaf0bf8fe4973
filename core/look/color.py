# SPDX-License-Identifier: GPL-3.0-or-later
"""The colour of a uniform object: the pixels that surely show it in, its colour and spread out.

Light falls differently on each face and round a curved side, a shadow may lie on a part, a lamp may
be mirrored in it, and a cable may run over it. What all honest pixels share is the chromaticity:
its mode is found first, and brightness then face by face among the pixels that have it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array, Mask
from ..camera import Camera
from ..errors import InvalidValue
from ..picture.pictures import Light, Picture, check_size, linear_light
from ..primitives import Primitive
from ..robust import core_sigma, tukey_weights
from ..shape.hits import face_names
from .shading import best_lit, patch_levels, patches_of, smooth_light
from .sure_pixels import SIGMAS, Sight, edge_sigma_pixels, light_at
from .textures import eight_bit_srgb

# blur mixes an edge into the next two pixels, a JPEG block smears colour over its 8 and, where
# colour is stored at half the resolution, over 16; half of that reaches across an edge
RIM_PIXELS, JPEG_RIM_PIXELS = 2.0, 6.0
FEWEST_PIXELS = 30
# nearer to an edge than this, a pixel shows two things
LEAST_RIM_PIXELS = 1.0
# sRGB levels that one uniform surface spans under one light, noise included
SAME_LEVELS = 16.0
SMALLEST_UNIFORM_SHARE = 0.85
CLIPPED_LIGHT = 0.97
# chromaticities nearer than this are one colour
CHROMA_FLOOR = 0.008
DARKEST = 0.004
MODE_BIN = 0.02


@dataclass(frozen=True, eq=False)
class ColorSample:
    """The colour of a thing as the picture shows it.

    `color` (3,) is linear light: the chromaticity of all of it, at the brightness of its best lit
    part. `spread` (3,) is the 1 sigma of pixels about their own part's colour; `pixels` how many
    were sampled; `share` how many of them are of that colour. `uniform` tells whether one colour
    describes the surface; where it does not, a texture says more. Without a pixel `color` is None.
    """

    color: Array | None
    spread: Array
    pixels: int
    share: float
    uniform: bool
    warnings: tuple[str, ...] = ()


def color_of(
    thing: Primitive,
    things: Sequence[Primitive],
    picture: Picture,
    camera: Camera,
    *,
    hidden: Mask | None = None,
    jpeg: bool = False,
) -> ColorSample:
    """The colour of one of `things` from a picture (H, W, 3) BGR as `read_picture` gives it.

    `things` are all that may stand in front of it; `hidden` (H, W) marks pixels behind what is not
    modelled. `jpeg` keeps farther from edges. Raises NoPose, PictureError for a picture of another
    size, and InvalidValue where `thing` is none of `things`.
    """
    check_size(picture, camera.intrinsics, "picture")
    index = next((i for i, other in enumerate(things) if other is thing), None)
    if index is None:
        raise InvalidValue(f"{thing.name}: is none of the {len(things)} things it was given with")
    return sampled_color(Sight.of(things, camera, hidden), index, linear_light(picture), jpeg=jpeg)


def sampled_color(sight: Sight, index: int, light: Light, *, jpeg: bool = False) -> ColorSample:
    """`color_of` the thing `index` of a sight, from linear light (H, W, 3) BGR."""
    thing = sight.things[index]
    sure, doubts = _sampled_pixels(sight, index, jpeg)
    rows, columns = np.nonzero(sure)
    if not len(rows):
        return ColorSample(None, np.zeros(3), 0, 0.0, False, (*doubts, _unseen(sight, index)))
    rgb = light_at(light, rows, columns)
    kept = _not_clipped(rgb)
    rows, columns, rgb = rows[kept], columns[kept], rgb[kept]
    patches = patches_of(sight, index, rows, columns)
    chroma, alike = _chromaticity(rgb)
    brightness = rgb.sum(axis=1)
    levels = patch_levels(brightness, patches, alike)
    places = np.stack([columns, rows], axis=1).astype(float)
    expected = chroma * smooth_light(brightness, patches, levels, alike, places)[:, None]
    fits = alike & (_levels(rgb, expected) < SAME_LEVELS)
    share, spread = float(fits.mean()), _spread(rgb - expected, fits)
    uniform = share >= SMALLEST_UNIFORM_SHARE
    color = np.clip(chroma * best_lit(levels, patches, alike), 0.0, 1.0)
    if len(kept) - int(kept.sum()) > 0.2 * len(kept):
        doubts += (f"{thing.name}: {100 * (1 - kept.mean()):.0f} % of its pixels are overexposed",)
    return ColorSample(color, spread, len(rgb), share, uniform, doubts)


def _sampled_pixels(sight: Sight, index: int, jpeg: bool) -> tuple[Mask, tuple[str, ...]]:
    """Pixels clear of every edge; nearer to the edges where a thing is too small for that."""
    thing = sight.things[index]
    known = SIGMAS * edge_sigma_pixels(thing, sight.camera)
    wanted = known + (JPEG_RIM_PIXELS if jpeg else RIM_PIXELS)
    for rim in (wanted, wanted / 2, max(wanted / 4, LEAST_RIM_PIXELS)):
        sure = _off_inner_edges(sight, index, rim)
        count = int(sure.sum())
        if count >= FEWEST_PIXELS:
            break
    if 0 < count < FEWEST_PIXELS or rim < wanted / 2:
        return sure, (
            f"{thing.name}: its colour comes from {count} px, {rim:.1f} px off its edges, where "
            f"{wanted:.1f} px would be sure",
        )
    return sure, ()


def _off_inner_edges(sight: Sight, index: int, rim: float) -> Mask:
    """Clear of the outline by the rim, and by a pixel of where two faces meet."""
    sure = sight.sure(index, rim)
    inner = np.zeros_like(sure)
    for face in range(len(face_names(sight.things[index]))):
        inner |= sight.sure(index, min(rim, 1.0), face)
    return sure & inner


def _unseen(sight: Sight, index: int) -> str:
    shown = int((sight.seen.owner == index).sum())
    name = sight.things[index].name
    if not shown:
        return f"{name}: is not seen in the picture, so it keeps the colour it has"
    return f"{name}: only {shown} px of it are seen, too few for a colour"


def _not_clipped(rgb: Array) -> Mask:
    """Overexposed pixels have no colour; where most are, they are all there is."""
    clear: Mask = rgb.max(axis=1) < CLIPPED_LIGHT
    return clear if clear.mean() > 0.3 else np.ones(len(rgb), dtype=bool)


def _chromaticity(rgb: Array) -> tuple[Array, Mask]:
    """The chromaticity (3,) that most pixels have, of sum 1, and which have it.

    Started from the mode, as up to half may be something else, then Tukey's estimate.
    """
    total = rgb.sum(axis=1)
    lit = total > max(3 * DARKEST, 0.1 * float(np.median(total)))
    if lit.sum() < 3:
        return _normalised(rgb.mean(axis=0)), np.ones(len(rgb), dtype=bool)
    chroma = rgb / np.maximum(total, 3 * DARKEST)[:, None]
    centre = _mode(chroma[lit, :2], total[lit])
    for _ in range(12):
        away = np.linalg.norm(chroma[:, :2] - centre[:2], axis=1)
        # brighter pixels tell their colour better
        sigma = max(core_sigma(away[lit]), CHROMA_FLOOR)
        weights = tukey_weights(away, sigma) * total * lit
        if weights.sum() <= 0:
            break
        centre = (chroma[:, :2] * weights[:, None]).sum(axis=0) / weights.sum()
    away = np.linalg.norm(chroma[:, :2] - centre, axis=1)
    # noise of one level turns a dark pixel's colour more than a bright one's
    reach = 3 * sigma * np.maximum(1.0, np.sqrt(np.median(total[lit]) / np.maximum(total, 1e-6)))
    return np.array([*centre, 1 - centre.sum()]), away < np.minimum(reach, 0.15)


def _mode(chroma: Array, weight: Array) -> Array:
    """The middle of the fullest of overlapping bins of red and green chromaticity."""
    best, fullest = chroma.mean(axis=0), -1.0
    for shift in ((0.0, 0.0), (0.5, 0.0), (0.0, 0.5), (0.5, 0.5)):
        bins = np.floor(chroma / MODE_BIN + shift).astype(int)
        _, inverse = np.unique(bins, axis=0, return_inverse=True)
        mass = np.bincount(inverse.ravel(), weights=np.minimum(weight, np.median(weight)))
        if mass.max() > fullest:
            fullest = float(mass.max())
            best = np.median(chroma[inverse.ravel() == mass.argmax()], axis=0)
    return best


def _levels(rgb: Array, expected: Array) -> Array:
    """By how many sRGB levels of 255 pixels differ from what is expected, their worst channel."""
    a, b = eight_bit_srgb(rgb.astype(np.float32)), eight_bit_srgb(expected.astype(np.float32))
    worst: Array = np.abs(a.astype(int) - b.astype(int)).max(axis=1).astype(float)
    return worst


def _spread(residuals: Array, fits: Mask) -> Array:
    used = residuals[fits] if fits.sum() > 8 else residuals
    return np.array([core_sigma(channel) for channel in used.T])


def _normalised(rgb: Array) -> Array:
    total = float(rgb.sum())
    return np.full(3, 1 / 3) if total <= 0 else rgb / total
