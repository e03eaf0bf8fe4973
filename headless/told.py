# SPDX-License-Identifier: GPL-3.0-or-later
"""How results are told: nouns in, lines for people or JSON for machines out."""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Sequence
from typing import Any

import numpy as np

from ..core.arrays import Array


def print_json(value: Any) -> None:
    """One JSON document on stdout; what is not finite becomes null."""
    print(json.dumps(_plain(value), indent=2, ensure_ascii=False))


def progress(text: str) -> None:
    """A line on stderr, so that stdout holds results alone."""
    print(text, file=sys.stderr, flush=True)


def warn(warnings: Sequence[str]) -> None:
    """Doubts, one a line, on stderr."""
    for warning in warnings:
        progress(f"warning: {warning}")


def millimetres(value: float, sigma: float | None = None, digits: int = 2) -> str:
    """Metres as `12.34 ± 0.05 mm`."""
    told = f"{1e3 * value:.{digits}f}"
    return f"{told} mm" if sigma is None else f"{told} ± {1e3 * sigma:.{digits}f} mm"


def point_told(point: Array, digits: int = 4) -> str:
    """A point (3,) in metres as `(x, y, z) m`."""
    return "(" + ", ".join(f"{v:.{digits}f}" for v in point) + ") m"


def table(header: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Aligned columns, the first to the left, numbers to the right."""
    widths = [max(len(str(row[i])) for row in (header, *rows)) for i in range(len(header))]
    lines = []
    for row in (header, *rows):
        cells = [
            str(c).ljust(w) if i == 0 else str(c).rjust(w)
            for i, (c, w) in enumerate(zip(row, widths, strict=True))
        ]
        lines.append("  ".join(cells).rstrip())
    lines.insert(1, "  ".join("-" * w for w in widths))
    return "\n".join(lines)


def pairs(rows: Sequence[tuple[str, str]]) -> str:
    """Names and what is said of each, in two columns."""
    width = max(len(name) for name, _ in rows)
    return "\n".join(f"{name.ljust(width)}  {said}" for name, said in rows)


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        return _plain(value.tolist())
    if isinstance(value, np.generic):
        return _plain(value.item())
    if isinstance(value, dict):
        return {key: _plain(v) for key, v in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(v) for v in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
