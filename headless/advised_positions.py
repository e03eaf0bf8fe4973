# SPDX-License-Identifier: GPL-3.0-or-later
"""Positions to choose the next sighting from: a JSON or CSV file in, points in metres out."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np

from ..core.arrays import Array
from ..core.document.fields import items, vector
from ..core.document.json_text import parse_json
from ..core.errors import DocumentError


def read_positions(file: Path) -> Array:
    """Positions (N, 3): a JSON list of [x, y, z], or rows x, y, z of a CSV, header or none.

    Raises DocumentError naming the file and the row that is not three numbers.
    """
    suffix = file.suffix.lower()
    if suffix not in (".json", ".csv"):
        raise DocumentError(f"{file}: positions come as .json or .csv")
    rows = _json_rows(file) if suffix == ".json" else _csv_rows(file)
    if not rows:
        raise DocumentError(f"{file}: holds no positions; give rows of x, y, z in metres")
    return np.array(rows)


def _json_rows(file: Path) -> list[Array]:
    try:
        listed = items(parse_json(file), "positions")
        return [vector(row, f"positions[{i}]", 3) for i, row in enumerate(listed)]
    except DocumentError as error:
        told = str(error)
        raise DocumentError(told if told.startswith(str(file)) else f"{file}: {told}") from None


def _csv_rows(file: Path) -> list[Array]:
    try:
        with file.open(encoding="utf-8-sig", newline="") as text:
            rows = [(i, row) for i, row in enumerate(csv.reader(text), 1) if any(row)]
    except FileNotFoundError:
        raise DocumentError(f"{file}: there is no such file") from None
    except OSError as error:
        raise DocumentError(f"{file}: can't be read ({error.strerror})") from None
    except (UnicodeDecodeError, csv.Error):
        raise DocumentError(f"{file}: is not a text file of comma-separated values") from None
    # a header names what the columns are
    if rows and _floats(rows[0][1]) is None and any(c.isalpha() for c in rows[0][1][0]):
        rows = rows[1:]
    return [_csv_row(file, i, row) for i, row in rows]


def _csv_row(file: Path, number: int, row: list[str]) -> Array:
    values = _floats(row)
    if values is None or values.shape != (3,) or not np.isfinite(values).all():
        told = ", ".join(row)
        raise DocumentError(f"{file}: row {number}: expected x, y, z in metres, got {told!r:.60}")
    return values


def _floats(cells: list[str]) -> Array | None:
    try:
        return np.array([float(cell) for cell in cells])
    except ValueError:
        return None
