# SPDX-License-Identifier: GPL-3.0-or-later
"""Files written whole or not at all: a temporary neighbour takes the name only on success."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from .errors import DocumentError


@contextmanager
def atomic_path(path: str | Path) -> Iterator[Path]:
    """Yield a temporary path beside `path`, with its ending, that replaces it on success.

    On any error the temporary file goes and `path` stays as it was. Raises DocumentError when the
    folder is missing, the disk refuses, or `path` is a folder itself.
    """
    target = Path(path)
    try:
        if not target.parent.is_dir():
            raise DocumentError(f"{target}: the folder {target.parent} is not there; make it first")
        if target.is_dir():
            raise DocumentError(f"{target}: is a folder; give the name of a file")
        handle, name = tempfile.mkstemp(
            prefix=f".{target.stem}-", suffix=target.suffix, dir=target.parent
        )
    except OSError as error:
        raise DocumentError(f"{target}: can't be written ({error.strerror})") from None
    os.close(handle)
    temporary = Path(name)
    try:
        yield temporary
        # mkstemp makes private files; a document has the rights any new file would have
        temporary.chmod(0o666 & ~_umask())
        temporary.replace(target)
    except OSError as error:
        # a full disk, or rights that changed meanwhile
        raise DocumentError(f"{target}: can't be written ({error.strerror or error})") from error
    finally:
        temporary.unlink(missing_ok=True)


def made_folder(path: str | Path) -> Path:
    """The folder, made with its parents if it is not there. Raises DocumentError where it can't."""
    folder = Path(path)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise DocumentError(
            f"{folder}: can't be made a folder ({error.strerror}); name another"
        ) from None
    return folder


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
