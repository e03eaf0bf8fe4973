# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers, colours and errors as text: what a format's line holds, what its comment tells."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from ..appearance import Appearance
from ..arrays import Array
from ..primitives import Primitive

# what an object without appearance looks like, in linear light
UNPAINTED = (0.6, 0.6, 0.62)


def numbers(values: Iterable[float]) -> str:
    """The numbers in a row: a nanometre at a thousand kilometres, and no minus before a zero."""
    return " ".join(f"{float(value) + 0.0:.12g}" for value in values)


def rgba(appearance: Appearance | None) -> str:
    """`r g b a`, sRGB-encoded from 0 to 1 (IEC 61966-2-1), as programs show colours."""
    light = np.array(UNPAINTED) if appearance is None else np.asarray(appearance.color)
    encoded = np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
    return f"{' '.join(f'{part:.4g}' for part in encoded)} 1"


def errors_of(thing: Primitive) -> str:
    """What an object is called and how far it may be off, for a reader of the file."""
    at, sizes = thing.position_sigma(), thing.size_sigma()
    told = f"{thing.name}, a {thing.kind}"
    if at is None or sizes is None or thing.covariance is None:
        return f"{told}; its error is not known"
    turned = np.degrees(np.sqrt(np.diag(thing.covariance)[:3]))
    parts = [f"position ± {_short(1e3 * at)} mm", f"rotation ± {_short(turned)} degrees"]
    parts += [
        f"{name} {1e3 * size:.1f} ± {1e3 * sigma:.2g} mm"
        for name, size, sigma in zip(thing.size_names, thing.sizes, sizes, strict=True)
    ]
    return f"{told}; 1 sigma: {', '.join(parts)}"


def plain(text: str) -> str:
    """The text on one line, without what is not to be printed."""
    return " ".join("".join(c if c.isprintable() else " " for c in text).split())


def _short(values: Array) -> str:
    return " ".join(f"{value:.2g}" for value in values)
