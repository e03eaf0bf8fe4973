# SPDX-License-Identifier: GPL-3.0-or-later
"""What is printed on the things of sample 03: a thing goes in, pictures of its faces come out."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
from monocell.core.appearance import Appearance, Texture
from monocell.core.primitives import Primitive
from monocell.core.shape.charts import chart_of
from monocell.core.shape.hits import face_names
from numpy.typing import NDArray

TEXELS_PER_METRE = 2400.0
Print = NDArray[np.uint8]
FONT = cv2.FONT_HERSHEY_DUPLEX
# blue green red, sRGB, as OpenCV paints
BROWN_INK, TAPE = (38, 52, 74), (132, 170, 196)
CREAM = (196, 214, 222)


def printed(thing: Primitive, color: tuple[float, float, float], folder: Path) -> Primitive:
    """The thing with a picture for each of its faces, PNG files in `folder` named absolutely."""
    textures = {}
    for face in face_names(thing):
        path = (folder / f"{thing.name}.{face}.png").resolve()
        cv2.imwrite(str(path), _face(thing, face, color))
        textures[face] = Texture(str(path))
    return replace(thing, appearance=Appearance(np.array(color), textures))


def _face(thing: Primitive, face: str, color: tuple[float, float, float]) -> Print:
    columns, rows = _texels(thing, face)
    rng = np.random.default_rng([len(thing.name), len(face), rows])
    painters: dict[str, Callable[..., Print]] = {
        "carton": _carton,
        "can": _can,
        "block": _block,
        "cone": _cone,
        "ball": _ball,
    }
    encoded = 255 * np.array(color[::-1]) ** (1 / 2.2)
    return painters[thing.name](face, np.tile(encoded, (rows, columns, 1)), rng)


def _texels(thing: Primitive, face: str) -> tuple[int, int]:
    """Columns and rows so that a texel is about as wide as high."""
    middle, chart = np.array([[0.5, 0.5]]), chart_of(thing, face)
    lengths = [
        float(np.linalg.norm(chart.points(middle + step) - chart.points(middle - step))) / 2e-3
        for step in ([[1e-3, 0]], [[0, 1e-3]])
    ]
    columns, rows = (max(64, round(TEXELS_PER_METRE * length)) for length in lengths)
    return columns, rows


def _carton(face: str, paper: NDArray, rng: np.random.Generator) -> Print:
    """Board: a tape along the top, a print on the sides."""
    rows, columns = paper.shape[:2]
    label = _whole(paper + _clouds(rng, rows, columns, 60, 4.0))
    if face in ("top", "base"):
        half = rows // 9
        cv2.rectangle(label, (0, rows // 2 - half), (columns, rows // 2 + half), TAPE, -1)
        return label
    if face in ("y+", "y-"):
        _text(label, "MONOCELL", (0.10, 0.62), 0.46, BROWN_INK)
    else:
        for left in (0.38, 0.54):
            _arrow_up(label, left, BROWN_INK)
    return label


def _can(face: str, paint: NDArray, rng: np.random.Generator) -> Print:
    """A tin: a lid of metal, and pale letters round it."""
    rows, columns = paint.shape[:2]
    if face != "side":
        return _whole(np.full_like(paint, 172.0) + _clouds(rng, rows, columns, 30, 3.0))
    label = _whole(paint + _clouds(rng, rows, columns, 40, 3.0))
    # a band round it would look like a rim
    for left in (0.0, 0.333, 0.667):
        _text(label, "COFFEE", (left, 0.50), 0.22, CREAM)
    return label


def _block(face: str, timber: NDArray, rng: np.random.Generator) -> Print:
    """Planed timber: fibres along its x, rings of years on its ends."""
    rows, columns = timber.shape[:2]
    v, u = np.mgrid[:rows, :columns] / TEXELS_PER_METRE
    if face in ("x-", "x+"):
        rings = np.hypot(u - 0.02, v - 0.11)
    else:
        knots = 0.0006 * _clouds(rng, rows, columns, 90, 1.0)[..., 0]
        rings = v + 0.004 * np.sin(9 * u + v * 20) + knots
    years = np.sin(2 * np.pi * rings / 0.0065)
    fine = _clouds(rng, rows, max(2, columns // 24), 3, 6.0)
    fibres = cv2.resize(fine[..., 0].astype(np.float32), (columns, rows))[..., None]
    return _whole(timber * (1 + 0.035 * years[..., None]) + fibres)


def _cone(face: str, plastic: NDArray, rng: np.random.Generator) -> Print:
    """A marking cone with two white rings."""
    rows, columns = plastic.shape[:2]
    label = _whole(plastic + _clouds(rng, rows, columns, 50, 3.0))
    if face == "side":
        for low, high in ((0.30, 0.48), (0.64, 0.80)):
            cv2.rectangle(label, (0, int(low * rows)), (columns, int(high * rows)), (226,) * 3, -1)
    return label


def _ball(face: str, rubber: NDArray, rng: np.random.Generator) -> Print:
    """A rubber ball with one pale ring round it."""
    rows, columns = rubber.shape[:2]
    label = _whole(rubber + _clouds(rng, rows, columns, 50, 4.0))
    wave = (0.5 + 0.16 * np.sin(2 * np.pi * np.arange(columns) / columns)) * rows
    v = np.arange(rows)[:, None]
    label[np.abs(v - wave[None]) < 0.05 * rows] = CREAM
    return label


def _arrow_up(label: Print, left: float, ink: tuple[int, int, int]) -> None:
    rows, columns = label.shape[:2]
    x, top, foot, half = (left + 0.04) * columns, 0.22 * rows, 0.68 * rows, 0.035 * columns
    shape = [(x, top), (x + half, top + 1.6 * half), (x + 0.35 * half, top + 1.6 * half),
             (x + 0.35 * half, foot), (x - 0.35 * half, foot),
             (x - 0.35 * half, top + 1.6 * half), (x - half, top + 1.6 * half)]  # fmt: skip
    cv2.fillPoly(label, [np.round(shape).astype(np.int32)], ink, cv2.LINE_AA)
    cv2.rectangle(label, (round(x - half), round(0.72 * rows)),
                  (round(x + half), round(0.75 * rows)), ink, -1)  # fmt: skip


def _text(
    label: Print, words: str, at: tuple[float, float], width: float, ink: tuple[int, int, int]
) -> None:
    """Words from the lower left corner `at` on, `width` wide, both as shares of the picture."""
    rows, columns = label.shape[:2]
    (natural, _), _ = cv2.getTextSize(words, FONT, 1.0, 2)
    scale = width * columns / natural
    place = (round(at[0] * columns), round(at[1] * rows))
    cv2.putText(label, words, place, FONT, scale, ink, max(2, round(2.2 * scale)), cv2.LINE_AA)


def _clouds(
    rng: np.random.Generator, rows: int, columns: int, coarse: int, depth: float
) -> NDArray:
    """Smooth changes of brightness, (rows, columns, 1), `coarse` texels across."""
    few = rng.normal(0, depth, (rows // coarse + 2, columns // coarse + 2)).astype(np.float32)
    smooth: NDArray = cv2.resize(few, (columns, rows), interpolation=cv2.INTER_CUBIC)
    return smooth[..., None]


def _whole(values: NDArray) -> Print:
    return np.ascontiguousarray(np.clip(np.round(values), 0, 255).astype(np.uint8))
