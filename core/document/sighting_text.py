# SPDX-License-Identifier: GPL-3.0-or-later
"""Sightings as people hand them over: pasted text, CSV rows or JSON in, sightings out.

A row is `x y z`, with blanks, tabs, commas or semicolons between, a picture's name before or after
it; a heading may name the columns (x, y, z, picture, radius, u, v), and their unit: `x_mm`.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from ..arrays import Array
from ..errors import DocumentError, InvalidValue
from ..sighting import PointSighting, Sighting, SphereSighting
from .fields import items, keyed, shown, vector
from .json_text import parsed_json
from .sighting_entries import sighting_from_entry

UNITS = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "in": 0.0254}
PICTURE_NAMES = ("picture", "image", "file", "filename", "photo")
COLUMNS = ("x", "y", "z", "radius", "u", "v", "picture")
# no arm reaches so far, and none holds a ball in so small a room
FARTHEST, SMALLEST = 100.0, 5e-3


@dataclass(frozen=True)
class Unsaid:
    """What the text leaves unsaid: the pictures, of which one may show all, and the ball's radius.

    `unit` is that of rows whose heading names none; JSON is in metres, as documents are.
    """

    pictures: Sequence[str]
    radius: float
    unit: str = "m"


def sightings_from_text(text: str, unsaid: Unsaid) -> tuple[Sighting, ...]:
    """The sightings a text tells of, in its order.

    Raises DocumentError naming the row that can't be read, positions whose unit can't be meant, and
    a number of pictures that does not fit that of positions.
    """
    stripped = text.strip().lstrip("\ufeff")
    if not stripped:
        raise DocumentError("there is no text: copy positions first, such as 0.62 -0.42 0.18")
    if stripped[0] in "[{":
        rows, unit = _json_rows(stripped), 1.0
    else:
        rows, unit = _table_rows(stripped), UNITS[unsaid.unit]
    whole = [row for row in rows if not isinstance(row, _Row)]
    given = [row.scaled(unit) for row in rows if isinstance(row, _Row)]
    _check_span([row.center for row in given])
    sightings = _completed(given, unsaid)
    return (*whole, *sightings)


def read_sighting_file(file: Path, unsaid: Unsaid) -> tuple[Sighting, ...]:
    """The sightings of a CSV, text or JSON file. Raises DocumentError naming the file."""
    try:
        text = file.read_text(encoding="utf-8-sig")
    except FileNotFoundError:
        raise DocumentError(f"{file}: there is no such file") from None
    except OSError as error:
        raise DocumentError(f"{file}: can't be read ({error.strerror})") from None
    except UnicodeDecodeError:
        raise DocumentError(f"{file}: is not a text file") from None
    try:
        return sightings_from_text(text, unsaid)
    except (DocumentError, InvalidValue) as error:
        raise DocumentError(f"{file}: {error}") from None


@dataclass(frozen=True, eq=False)
class _Row:
    """A position (3,) and what else its row tells; `unit` metres where the heading says so."""

    where: str
    center: Array
    picture: str | None = None
    radius: float | None = None
    pixel: Array | None = None
    unit: float | None = None

    def scaled(self, unit: float) -> _Row:
        size = self.unit or unit
        radius = None if self.radius is None else self.radius * size
        return replace(self, center=self.center * size, radius=radius)


def _completed(rows: Sequence[_Row], unsaid: Unsaid) -> list[Sighting]:
    named = [row.picture for row in rows]
    missing = named.count(None)
    if missing and len(unsaid.pictures) == 1:
        named = [name or unsaid.pictures[0] for name in named]
    elif missing:
        if missing != len(unsaid.pictures):
            raise DocumentError(
                f"{missing} positions name no picture, and {len(unsaid.pictures)} pictures are "
                "given: choose as many, or the one that shows all"
            )
        rest = iter(unsaid.pictures)
        named = [name or next(rest) for name in named]
    return [_sighting(row, str(name), unsaid.radius) for row, name in zip(rows, named, strict=True)]


def _sighting(row: _Row, picture: str, radius: float) -> Sighting:
    try:
        if row.pixel is not None:
            return PointSighting(picture, row.center, row.pixel)
        return SphereSighting(picture, row.center, row.radius or radius)
    except InvalidValue as error:
        raise DocumentError(f"{row.where}: {error}") from None


def _check_span(centers: Sequence[Array]) -> None:
    """A wrong unit shows: nothing is so far away, nor are several positions so near each other."""
    if not centers:
        return
    places = np.array(centers)
    far = float(np.abs(places).max())
    if far > FARTHEST:
        raise DocumentError(
            f"a position lies {far:.4g} m from the origin; are these millimetres? Choose the unit"
        )
    span = float(np.ptp(places, axis=0).max())
    if len(places) > 1 and span < SMALLEST:
        raise DocumentError(
            f"{len(places)} positions within {1e3 * span:.3g} mm of each other; are these metres? "
            "Choose the unit"
        )


def _json_rows(text: str) -> list[Any]:
    value = parsed_json(text, "the text")
    if isinstance(value, dict):
        if "sightings" not in value:
            raise DocumentError(
                "the JSON has no sightings; give a cell document or a list of [x, y, z]"
            )
        listed = items(value["sightings"], "sightings")
        return [sighting_from_entry(one, f"sightings[{i}]") for i, one in enumerate(listed)]
    if len(value) == 3 and all(isinstance(one, int | float) for one in value):
        value = [value]
    return [_json_row(one, f"[{i}]") for i, one in enumerate(value)]


def _json_row(value: Any, where: str) -> _Row:
    if isinstance(value, list):
        return _Row(where, vector(value, where, 3))
    fields = keyed(value, where, ("center",), ("picture", "radius", "pixel"))
    return _Row(
        where,
        fields.vector("center", 3),
        fields.text("picture") if fields.has("picture") else None,
        fields.number("radius") if fields.has("radius") else None,
        fields.vector("pixel", 2) if fields.has("pixel") else None,
    )


def _table_rows(text: str) -> list[_Row]:
    lines = [
        (i, _cells(line))
        for i, line in enumerate(text.splitlines(), 1)
        if line.strip() and not line.lstrip().startswith(("#", "//"))
    ]
    if not lines:
        raise DocumentError("there are only comments: give rows such as 0.62 -0.42 0.18")
    heading = _heading(lines[0][1])
    if heading is None:
        return [_bare_row(f"row {i}", cells) for i, cells in lines]
    return [_named_row(f"row {i}", cells, *heading) for i, cells in lines[1:]]


def _cells(line: str) -> list[str]:
    line = line.strip().strip("()")
    for between in (";", "\t"):
        if between in line:
            # where something else parts the numbers, a comma is a decimal one
            return [_point(cell.strip()) for cell in line.split(between)]
    parts = line.split(",") if "," in line else line.split()
    return [cell.strip().strip("\"'") for cell in parts]


def _point(cell: str) -> str:
    bare = cell.strip("\"'")
    return bare.replace(",", ".") if re.fullmatch(r"[-+]?\d*,\d+(e[-+]?\d+)?", bare, re.I) else bare


def _heading(cells: Sequence[str]) -> tuple[list[str], float | None] | None:
    """The columns' names and their unit in metres; None for a row of numbers."""
    found = [re.fullmatch(r"([a-z]+)[\s_(\[]*(mm|cm|m|in)?[)\]]*", c.lower()) for c in cells]
    names = [one[1] if one else "" for one in found]
    names = ["picture" if name in PICTURE_NAMES else name for name in names]
    if not {"x", "y", "z"} <= set(names):
        return None
    units = {one[2] for one, name in zip(found, names, strict=True) if one and name in "xyz"}
    if len(units) > 1:
        told = ", ".join(sorted(unit or "none" for unit in units))
        raise DocumentError(f"the heading gives x, y and z different units: {told}")
    unit = units.pop()
    return names, None if unit is None else UNITS[unit]


def _named_row(where: str, cells: Sequence[str], names: list[str], unit: float | None) -> _Row:
    if len(cells) != len(names):
        raise DocumentError(f"{where}: has {len(cells)} columns, the heading {len(names)}")
    told = {n: c for n, c in zip(names, cells, strict=True) if n in COLUMNS and c}
    center = np.array([_number(where, told.get(axis, "nothing")) for axis in "xyz"])
    pixel = None
    if "u" in told and "v" in told:
        pixel = np.array([_number(where, told["u"]), _number(where, told["v"])])
    radius = _number(where, told["radius"]) if "radius" in told else None
    return _Row(where, center, told.get("picture"), radius, pixel, unit)


def _bare_row(where: str, cells: Sequence[str]) -> _Row:
    words = [cell for cell in cells if cell and _float(cell) is None]
    numbers = [cell for cell in cells if _float(cell) is not None]
    if len(numbers) != 3 or len(words) > 1:
        told = " ".join(cells)
        raise DocumentError(f"{where}: expected x y z, got {told!r:.60}")
    return _Row(where, np.array([float(n) for n in numbers]), words[0] if words else None)


def _number(where: str, cell: str) -> float:
    value = _float(cell)
    if value is None:
        raise DocumentError(f"{where}: expected a number, got {shown(cell)}")
    return value


def _float(cell: str) -> float | None:
    try:
        value = float(cell)
    except ValueError:
        return None
    return value if np.isfinite(value) else None
