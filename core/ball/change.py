# SPDX-License-Identifier: GPL-3.0-or-later
"""What changed between pictures of a fixed camera: pictures in, a map of changes out.

The light may have changed as a whole, and the arm may have moved as well as the ball: a change says
where a ball may be, not that there is one.
"""

from __future__ import annotations

from collections.abc import Sequence

import cv2
import numpy as np
from numpy.typing import NDArray

from ..arrays import Array, Mask
from ..errors import InvalidValue, PictureError
from ..picture.pictures import Picture, eight_bits
from .circle_votes import Circle
from .color import inside_of

# changes are looked for in blocks of so many pixels, from so many sigmas and grey levels on
BLOCK, SIGMAS, LEAST_LEVELS, MOST_LEVELS = 2, 6.0, 8.0, 30.0
# more of a picture changes only when the camera moves, or the light in one part of the cell
LARGEST_SHARE = 0.7
MOST_PICTURES = 9


def background_of(pictures: Sequence[Picture]) -> Picture:
    """What stays in pictures (H, W, 3) of a fixed camera: their median, pixel by pixel.

    Nine spread over the row are enough. Raises PictureError when they differ in size or number
    fewer than two.
    """
    if len(pictures) < 2 or len({picture.shape for picture in pictures}) > 1:
        raise PictureError(
            f"a background needs two or more pictures of one size, got {len(pictures)} of "
            f"{sorted({picture.shape[1::-1] for picture in pictures})} px"
        )
    chosen = np.unique(np.linspace(0, len(pictures) - 1, MOST_PICTURES).round().astype(int))
    row = [eight_bits(pictures[i]) for i in chosen]
    background = np.empty_like(row[0])
    # in strips, so that a row of large pictures does not double in memory
    for top in range(0, len(background), 64):
        strip = np.stack([picture[top : top + 64] for picture in row])
        background[top : top + 64] = np.median(strip, axis=0).astype(np.uint8)
    return background


def changed_mask(picture: Picture, background: Picture) -> Mask:
    """Which blocks of 2 x 2 pixels changed, (H / 2, W / 2), beyond noise and a change of all light.

    Raises PictureError for another size, InvalidValue when nothing changed or nearly everything.
    """
    if picture.shape[:2] != background.shape[:2]:
        raise PictureError(
            f"the background is {background.shape[1]} x {background.shape[0]} px, the picture "
            f"{picture.shape[1]} x {picture.shape[0]}; give one of the same camera"
        )
    now, before = _blocks(eight_bits(picture)), _blocks(eight_bits(background))
    difference = np.abs(now - _relit(before, now)).max(axis=2)
    # half of the picture stays as it was: the differences there are noise, unless the camera moved
    noise = float(np.median(difference[::3, ::3]))
    limit = float(np.clip(SIGMAS * noise, LEAST_LEVELS, MOST_LEVELS))
    changed: Mask = difference > limit
    share = float(changed.mean())
    if share > LARGEST_SHARE:
        raise InvalidValue(
            f"background: {100 * share:.0f} % of the picture changed; did the camera move? leave "
            "the background out, or give one of the same camera and light"
        )
    if not changed.any():
        raise InvalidValue(
            f"background: the picture does not differ from it (by {float(difference.max()):.1f} "
            "grey levels at most); give one without the ball, or with the ball elsewhere"
        )
    return changed


def change_shares(changed: Mask, circles: Sequence[Circle]) -> Array:
    """The share of each circle's inside that changed, 0 to 1, for `changed` by `changed_mask`."""
    shares = np.zeros(len(circles))
    for i, circle in enumerate(circles):
        middle = (BLOCK - 1) / 2
        small = Circle(
            (circle.u - middle) / BLOCK, (circle.v - middle) / BLOCK, circle.radius / BLOCK, 0.0
        )
        row, column = inside_of(changed.shape, small)
        shares[i] = changed[row, column].mean() if len(row) else 0.0
    return shares


def _blocks(picture: NDArray[np.uint8]) -> NDArray[np.float32]:
    height, width = picture.shape[0] // BLOCK, picture.shape[1] // BLOCK
    even = picture[: height * BLOCK, : width * BLOCK]
    blocks = cv2.resize(even, (width, height), interpolation=cv2.INTER_AREA)
    return np.asarray(cv2.blur(blocks, (3, 3)), dtype=np.float32)


def _relit(before: NDArray[np.float32], now: NDArray[np.float32]) -> NDArray[np.float32]:
    """The background under the light of now: each channel scaled by the median ratio."""
    sampled, seen = before[::4, ::4].reshape(-1, 3), now[::4, ::4].reshape(-1, 3)
    # what is black or burnt out tells nothing of the light
    good = ((sampled > 12) & (sampled < 245) & (seen > 12) & (seen < 245)).all(axis=1)
    if good.sum() < 50:
        return before
    gain = np.median(seen[good] / sampled[good], axis=0)
    return np.minimum(before * gain.astype(np.float32), 255)
