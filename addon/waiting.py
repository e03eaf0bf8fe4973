# SPDX-License-Identifier: GPL-3.0-or-later
"""Work that Blender can't put off to a thread: a context in, the wait cursor while it lasts."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any


@contextmanager
def waiting(context: Any) -> Iterator[None]:
    """Show the wait cursor in the context's window, where there is one."""
    window = context.window
    if window is None:
        yield
        return
    window.cursor_modal_set("WAIT")
    try:
        yield
    finally:
        window.cursor_modal_restore()
