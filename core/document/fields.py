# SPDX-License-Identifier: GPL-3.0-or-later
"""Strict reading of JSON values: a parsed value and its path in, the typed value or a refusal out.

Every refusal names the field as a person would write it: `objects[2].size[1]: expected a number,
got 'x'`.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from ..arrays import Array
from ..errors import DocumentError


def keyed(value: Any, where: str, required: tuple[str, ...], optional: tuple[str, ...]) -> Fields:
    """The keys of a JSON object, none missing and none unknown. Raises DocumentError."""
    if not isinstance(value, Mapping):
        raise DocumentError(
            f"{where or 'document'}: expected an object {{...}}, got {shown(value)}"
        )
    for key in value:
        if key not in required and key not in optional:
            known = ", ".join((*required, *optional))
            raise DocumentError(f"{joined(where, str(key))}: unknown key; known here are {known}")
    for key in required:
        if key not in value:
            raise DocumentError(f"{joined(where, key)}: is missing")
    return Fields(value, where)


class Fields:
    """The fields of one JSON object, each read by the type it must have."""

    def __init__(self, value: Mapping[str, Any], where: str) -> None:
        self._value = value
        self.where = where

    def has(self, key: str) -> bool:
        """Whether the key is there with a value other than null."""
        return self._value.get(key) is not None

    def raw(self, key: str) -> Any:
        """The value as it was parsed."""
        return self._value.get(key)

    def path(self, key: str) -> str:
        """The key's path from the top of the document."""
        return joined(self.where, key)

    def text(self, key: str) -> str:
        """A string that is not empty."""
        return text(self._value[key], self.path(key))

    def number(self, key: str) -> float:
        """A finite number."""
        return number(self._value[key], self.path(key))

    def whole(self, key: str) -> int:
        """A whole number."""
        value = self.number(key)
        if value != int(value):
            raise DocumentError(f"{self.path(key)}: expected a whole number, got {value:g}")
        return int(value)

    def vector(self, key: str, length: int) -> Array:
        """`length` finite numbers."""
        return vector(self._value[key], self.path(key), length)

    def matrix(self, key: str, rows: int, columns: int) -> Array:
        """`rows` lists of `columns` finite numbers."""
        lists = items(self._value[key], self.path(key))
        if len(lists) != rows:
            raise DocumentError(f"{self.path(key)}: expected {rows} rows, got {len(lists)}")
        return np.array([vector(v, f"{self.path(key)}[{i}]", columns) for i, v in enumerate(lists)])

    def items(self, key: str) -> list[Any]:
        """A list, empty where the key is absent."""
        return items(self._value[key], self.path(key)) if self.has(key) else []


def joined(where: str, key: str) -> str:
    """`objects[2]` and `size` make `objects[2].size`."""
    return f"{where}.{key}" if where else key


def text(value: Any, where: str) -> str:
    """A string that is not empty and can be written and be a file's name. Raises DocumentError."""
    if not isinstance(value, str) or not value:
        raise DocumentError(f"{where}: expected a text, got {shown(value)}")
    # JSON can spell a zero character and half a character pair; no file and no UTF-8 can
    if any(c == "\0" or "\ud800" <= c <= "\udfff" for c in value):
        raise DocumentError(
            f"{where}: {shown(ascii(value))} holds a character that can't be written"
        )
    return value


def number(value: Any, where: str) -> float:
    """A finite number; true and false are none. Raises DocumentError."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise DocumentError(f"{where}: expected a number, got {shown(value)}")
    try:
        as_float = float(value)
    except OverflowError:
        raise DocumentError(f"{where}: expected a number, got {shown(value)}") from None
    if not math.isfinite(as_float):
        raise DocumentError(f"{where}: expected a finite number, got {value}")
    return as_float


def items(value: Any, where: str) -> list[Any]:
    """A list. Raises DocumentError."""
    if not isinstance(value, list | tuple):
        raise DocumentError(f"{where}: expected a list, got {shown(value)}")
    return list(value)


def vector(value: Any, where: str, length: int) -> Array:
    """`length` finite numbers. Raises DocumentError."""
    values = items(value, where)
    if len(values) != length:
        raise DocumentError(f"{where}: expected {length} numbers, got {len(values)}")
    return np.array([number(v, f"{where}[{i}]") for i, v in enumerate(values)])


def shown(value: Any) -> str:
    """A value as it stood in the document, short enough for one line."""
    try:
        written = json.dumps(value)
    except (TypeError, ValueError):
        written = repr(value)
    written = repr(value) if isinstance(value, str) else written
    return written if len(written) <= 40 else written[:37] + "..."
