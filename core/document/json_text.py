# SPDX-License-Identifier: GPL-3.0-or-later
"""JSON files to values, refused by line and column; values to JSON that a person can read."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from ..errors import DocumentError


def parse_json(file: Path) -> Any:
    """Parsed JSON. Raises DocumentError naming the file, and line and column where it breaks."""
    try:
        text = file.read_text(encoding="utf-8-sig")
    except FileNotFoundError:
        raise DocumentError(f"{file}: there is no such file") from None
    except OSError as error:
        raise DocumentError(f"{file}: can't be read ({error.strerror})") from None
    except UnicodeDecodeError:
        raise DocumentError(f"{file}: is not a text file, so it is no JSON document") from None
    return parsed_json(text, str(file))


def parsed_json(text: str, name: str) -> Any:
    """Parsed JSON. Raises DocumentError with `name`, and line and column where it breaks."""
    try:
        return json.loads(text, object_pairs_hook=_once_each)
    except json.JSONDecodeError as error:
        at = f"line {error.lineno}, column {error.colno}"
        raise DocumentError(f"{name}: is not JSON ({error.msg} at {at})") from None
    except RecursionError:
        raise DocumentError(f"{name}: is nested too deeply to be a cell document") from None
    except DocumentError as error:
        raise DocumentError(f"{name}: {error}") from None
    except ValueError as error:
        # a whole number of thousands of digits
        raise DocumentError(f"{name}: is not JSON that can be read ({error})") from None


def dumped(document: Any) -> str:
    """JSON a person can read: one line a number list, shortest digits that read back exactly."""
    return _laid_out(document, 0) + "\n"


def _once_each(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """A JSON object's keys; JSON would silently take the last of two equal ones."""
    value = dict(pairs)
    if len(value) < len(pairs):
        keys = [key for key, _ in pairs]
        twice = next(key for key in keys if keys.count(key) > 1)
        raise DocumentError(f"{twice}: stands there twice; leave one of them")
    return value


def _laid_out(value: Any, depth: int) -> str:
    flat = json.dumps(value, ensure_ascii=False, allow_nan=False)
    if depth > 0 and len(flat) + 2 * depth <= 100 and not _holds_objects(value):
        return flat
    inner, outer = "  " * (depth + 1), "  " * depth
    if isinstance(value, dict) and value:
        rows = (f"{json.dumps(k)}: {_laid_out(v, depth + 1)}" for k, v in value.items())
        return "{\n" + ",\n".join(inner + row for row in rows) + f"\n{outer}}}"
    if isinstance(value, list) and value:
        return "[\n" + ",\n".join(inner + _laid_out(v, depth + 1) for v in value) + f"\n{outer}]"
    return flat


def _holds_objects(value: Any) -> bool:
    parts = value.values() if isinstance(value, dict) else value if isinstance(value, list) else ()
    return any(isinstance(part, dict) for part in parts)
