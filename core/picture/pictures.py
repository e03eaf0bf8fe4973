# SPDX-License-Identifier: GPL-3.0-or-later
"""Picture files to arrays: decoded as they are, checked against the camera, in linear light."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from ..errors import PictureError
from ..intrinsics import Intrinsics
from .orientation import AS_STORED, SWAPPING, TURNS, orientation_of, upright

# some programs append data of their own after a PNG's end
LONGEST_TRAILER = 1 << 16
Picture = NDArray[Any]
Light = NDArray[np.float32]


def read_picture(
    path: str | Path, intrinsics: Intrinsics | None = None, *, linear: bool = False
) -> Picture:
    """Read a picture as (H, W, 3) blue, green, red, 8 or 16 bits, its values exactly as stored.

    `linear` tells that the file holds amounts of light, as raw ones do: it is then encoded as all
    others are, at 16 bits. Intrinsics belong to the pixels as the sensor gave them, and a phone's
    rotation tag is ignored, unless it alone makes the picture as wide and high as they state.

    Raises PictureError when the file is missing, truncated, no picture, or not of the size that
    `intrinsics` state.
    """
    return read_picture_told(path, intrinsics, linear=linear)[0]


def read_picture_told(
    path: str | Path, intrinsics: Intrinsics | None = None, *, linear: bool = False
) -> tuple[Picture, tuple[str, ...]]:
    """The same, and words on a rotation tag that was followed, or that leaves a doubt."""
    file = Path(path)
    data = _content(file)
    flags = cv2.IMREAD_COLOR | cv2.IMREAD_ANYDEPTH | cv2.IMREAD_IGNORE_ORIENTATION
    picture = cv2.imdecode(data, flags) if len(data) else None
    if picture is None or picture.dtype not in (np.uint8, np.uint16):
        raise PictureError(f"{file}: {len(data)} bytes that are no picture OpenCV can read")
    pixels, told = _as_stated(file, np.asarray(picture), orientation_of(data.tobytes()), intrinsics)
    return encoded_light(pixels) if linear else pixels, told


def upright_size(path: str | Path) -> tuple[int, int]:
    """Width and height of a picture as viewers show it, its rotation tag followed."""
    height, width = read_picture(path).shape[:2]
    swaps = orientation_of(_content(Path(path)).tobytes()) in SWAPPING
    return (height, width) if swaps else (width, height)


def encoded_light(picture: Picture) -> Picture:
    """Pixels of linear light, 8 or 16 bits, sRGB-encoded at 16 bits; `linear_light` undoes it."""
    top = np.iinfo(picture.dtype).max
    light = np.arange(top + 1) / top
    encoded = np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
    table = np.rint(encoded * 65535).astype(np.uint16)
    return table[picture]


def eight_bits(picture: Picture) -> NDArray[np.uint8]:
    """The picture at 8 bits, stretched where 16 bits use the dark part of their range alone."""
    if picture.dtype == np.uint8:
        return np.asarray(picture, dtype=np.uint8)
    brightest = float(picture[::4, ::4].max())
    top = 65535.0 if brightest > 32767 else max(1.1 * brightest, 255.0)
    return np.asarray(cv2.convertScaleAbs(picture, alpha=255.0 / top), dtype=np.uint8)


def check_size(picture: Picture, intrinsics: Intrinsics, name: str) -> None:
    """Raises PictureError when a picture is not of the camera's size."""
    height, width = picture.shape[:2]
    if (width, height) != (intrinsics.width, intrinsics.height):
        raise PictureError(
            f"{name}: the picture is {width} x {height} px, the camera file says "
            f"{intrinsics.width} x {intrinsics.height}; use the camera file of this picture"
        )


def linear_light(picture: Picture) -> Light:
    """sRGB-encoded pixels to amounts of light from 0 to 1, float32 (IEC 61966-2-1).

    Edges are measured on light, because blur mixes light: on encoded values every edge moves
    towards its dark side. Raises PictureError for anything but 8 or 16 bits.
    """
    if picture.dtype not in (np.uint8, np.uint16):
        raise PictureError(
            f"the picture holds {picture.dtype} values; give it as it was encoded, 8 or 16 bits"
        )
    table = _decoding(picture.dtype.name)
    if picture.dtype == np.uint8:
        return np.asarray(cv2.LUT(picture, table), dtype=np.float32)
    return table[picture]


@cache
def _decoding(dtype: str) -> Light:
    top = np.iinfo(dtype).max
    encoded = np.arange(top + 1) / top
    light = np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)
    return light.astype(np.float32)


def _content(file: Path) -> NDArray[np.uint8]:
    try:
        data = np.fromfile(file, dtype=np.uint8)
    except FileNotFoundError:
        raise PictureError(f"{file}: there is no such picture") from None
    except OSError as error:
        raise PictureError(f"{file}: can't be read ({error.strerror})") from None
    if _truncated(data):
        raise PictureError(f"{file}: the picture breaks off after {len(data)} bytes; copy it again")
    return data


def _as_stated(
    file: Path, stored: Picture, orientation: int, intrinsics: Intrinsics | None
) -> tuple[Picture, tuple[str, ...]]:
    """The pixels that the intrinsics are of, as stored or turned."""
    if intrinsics is None or orientation == AS_STORED:
        if intrinsics is not None:
            check_size(stored, intrinsics, str(file))
        return stored, ()
    wanted, turn = (intrinsics.height, intrinsics.width), TURNS[orientation]
    turned = upright(stored, orientation)
    size = f"{intrinsics.width} x {intrinsics.height} px"
    if turned.shape[:2] == wanted != stored.shape[:2]:
        return turned, (f"{file.name}: its EXIF tag {turn}, and so it is used: {size}",)
    check_size(stored, intrinsics, f"{file} (its EXIF tag {turn})")
    if turned.shape != stored.shape:
        return stored, ()
    return stored, (
        f"{file.name}: its EXIF tag {turn}, and {size} it is either way; it is used as stored. "
        "If the camera was calibrated on upright pictures, save it upright without the tag",
    )


def _truncated(data: NDArray[np.uint8]) -> bool:
    """Whether a JPEG or PNG lacks its end: OpenCV fills the missing rows with grey."""
    content = data.tobytes()
    if content.startswith(b"\xff\xd8"):
        # the end marker can't occur inside the scan, but can in a thumbnail before it
        return content.find(b"\xff\xd9", _scan_start(content)) < 0
    return content.startswith(b"\x89PNG\r\n\x1a\n") and b"IEND" not in content[-LONGEST_TRAILER:]


def _scan_start(jpeg: bytes) -> int:
    """Where the first scan of a JPEG begins, past the header's segments."""
    at = 2
    while at + 4 <= len(jpeg) and jpeg[at] == 0xFF and jpeg[at + 1] != 0xDA:
        at += 2 + int.from_bytes(jpeg[at + 2 : at + 4], "big")
    return at
