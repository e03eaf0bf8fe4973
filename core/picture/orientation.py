# SPDX-License-Identifier: GPL-3.0-or-later
"""How a phone held its sensor: a picture file's bytes in, its EXIF orientation and turning it out.

Exif 2.32, tag 0x0112 (274) of IFD0: 1 as stored, 3 half a turn, 6 and 8 quarters, 2, 4, 5 and 7
mirrored.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

TAG = 0x0112
AS_STORED = 1
# those that make a lying picture a standing one
SWAPPING = (5, 6, 7, 8)
TURNS = {
    2: "mirrors it",
    3: "turns it by 180 degrees",
    4: "mirrors it upside down",
    5: "turns and mirrors it",
    6: "turns it by 90 degrees to the right",
    7: "turns and mirrors it",
    8: "turns it by 90 degrees to the left",
}
EXIF = b"Exif\x00\x00"


def orientation_of(content: bytes) -> int:
    """The orientation, 1 to 8, that a JPEG or PNG file states; 1 where it states none."""
    if content.startswith(b"\xff\xd8"):
        block = _jpeg_block(content)
    elif content.startswith(b"\x89PNG\r\n\x1a\n"):
        block = _png_block(content)
    else:
        block = b""
    found = _tag_of(block)
    return found if found in TURNS else AS_STORED


def upright(picture: NDArray[Any], orientation: int) -> NDArray[Any]:
    """A picture (H, W, 3) as stored, turned as its orientation says."""
    if orientation in SWAPPING:
        picture = picture.swapaxes(0, 1)
    # transposing mirrors: 5 is that alone
    if orientation in (2, 3, 6, 7):
        picture = picture[:, ::-1]
    if orientation in (3, 4, 7, 8):
        picture = picture[::-1]
    return np.ascontiguousarray(picture)


def _jpeg_block(content: bytes) -> bytes:
    at = 2
    while at + 4 <= len(content) and content[at] == 0xFF and content[at + 1] != 0xDA:
        length = int.from_bytes(content[at + 2 : at + 4], "big")
        segment = content[at + 4 : at + 2 + length]
        if content[at + 1] == 0xE1 and segment.startswith(EXIF):
            return segment[len(EXIF) :]
        at += 2 + length
    return b""


def _png_block(content: bytes) -> bytes:
    at = 8
    while at + 8 <= len(content):
        length = int.from_bytes(content[at : at + 4], "big")
        if content[at + 4 : at + 8] == b"eXIf":
            return content[at + 8 : at + 8 + length]
        at += 12 + length
    return b""


def _tag_of(block: bytes) -> int:
    """The orientation in a TIFF structure; 0 for none, or for bytes that are none."""
    if block[:4] not in (b"II*\x00", b"MM\x00*"):
        return 0

    def number(at: int, size: int) -> int:
        return int.from_bytes(block[at : at + size], "little" if block[:1] == b"I" else "big")

    start = number(4, 4)
    for i in range(number(start, 2)):
        entry = start + 2 + 12 * i
        if entry + 12 > len(block):
            break
        if number(entry, 2) == TAG:
            return number(entry + 8, 2)
    return 0
