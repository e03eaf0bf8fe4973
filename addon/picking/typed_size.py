# SPDX-License-Identifier: GPL-3.0-or-later
"""A size typed while the mouse is busy: Blender's key events in, a text and its metres out."""

from __future__ import annotations

from typing import Any

UNITS = {"mm": 1e-3, "cm": 1e-2, "m": 1.0, "in": 0.0254}
# what a unit begins with while it is being typed
BEGUN = ("", "m", "mm", "c", "cm")
NAMED = (
    *("ZERO", "ONE", "TWO", "THREE", "FOUR"),
    *("FIVE", "SIX", "SEVEN", "EIGHT", "NINE"),
)
KEYS = {
    **{name: str(digit) for digit, name in enumerate(NAMED)},
    **{f"NUMPAD_{digit}": str(digit) for digit in range(10)},
    **dict.fromkeys(("PERIOD", "NUMPAD_PERIOD", "COMMA"), "."),
    "M": "m",
    "C": "c",
}


def typed_key(event: Any) -> str:
    """The sign that a key press adds to a size, empty for a key that means something else."""
    if event.value != "PRESS" or event.ctrl or event.alt or event.oskey or event.shift:
        return ""
    return KEYS.get(event.type, "")


def with_sign(text: str, sign: str) -> str:
    """The text with one sign more, or as it was where that makes no number."""
    if not text and not (sign.isdigit() or sign == "."):
        return text
    longer = text + sign
    unit = longer.lstrip("0123456789.")
    spoilt = longer.count(".") > 1 or unit not in BEGUN
    return text if spoilt else longer


def metres_of(text: str, usual: str = "mm") -> float | None:
    """The size in metres, in the `usual` unit where none is typed. None for no size above zero."""
    number = text.rstrip("cm")
    unit = text[len(number) :] or usual
    try:
        value = float(number) * UNITS[unit]
    except (ValueError, KeyError):
        return None
    return value if value > 0 else None
