# SPDX-License-Identifier: GPL-3.0-or-later
"""What a writer hands back: a file's text, the files beside it, what could not be kept."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True)
class Written:
    """`text` of the file; `beside`, more files by their relative names; `warnings`, one line each.

    `warnings` tell what was assumed, or stood in the cell and is not in the file.
    """

    text: str
    beside: Mapping[str, str] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()
