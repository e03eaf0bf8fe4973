# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's progress chatter off stdout, which belongs to results."""

from __future__ import annotations

import ctypes
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stdout
from io import StringIO


@contextmanager
def quiet_stdout() -> Iterator[None]:
    """Send the process's stdout to nowhere for a while; errors still reach stderr.

    Blender prints from C, so the file descriptor itself has to go. Without one (Windows without a
    console) there is nothing to silence.
    """
    _flush()
    try:
        kept = os.dup(1)
    except OSError:
        yield
        return
    nowhere = os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(nowhere, 1)
        # whoever replaced sys.stdout (a notebook, pytest) does not write to descriptor 1
        with redirect_stdout(StringIO()):
            yield
    finally:
        _flush()
        os.dup2(kept, 1)
        os.close(nowhere)
        os.close(kept)


def _flush() -> None:
    """Python's buffer and that of the C library, where Blender's lines wait when piped."""
    sys.stdout.flush()
    if os.name == "posix":
        ctypes.CDLL(None).fflush(None)
