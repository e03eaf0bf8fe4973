# SPDX-License-Identifier: GPL-3.0-or-later
"""Files written whole or not at all: temporary neighbours take the names only on success."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
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
        _check_place(target)
        handle, name = tempfile.mkstemp(
            prefix=f".{target.stem}-", suffix=target.suffix, dir=target.parent
        )
    except OSError as error:
        raise _refused(target, error) from None
    os.close(handle)
    temporary = Path(name)
    try:
        yield temporary
        # mkstemp makes private files; a document has the rights any new file would have
        temporary.chmod(0o666 & ~_umask())
        temporary.replace(target)
    except OSError as error:
        # a full disk, or rights that changed meanwhile
        raise _refused(target, error) from error
    finally:
        temporary.unlink(missing_ok=True)


@contextmanager
def atomic_files(path: str | Path) -> Iterator[Path]:
    """Yield the path of the same name in a temporary folder, for files that belong together.

    On success all that was put into that folder, folders in it too, takes its place beside `path`,
    itself last; other files there stay. On any error all is as it was. Raises DocumentError as
    `atomic_path` does.
    """
    target = Path(path)
    try:
        _check_place(target)
        folder = Path(tempfile.mkdtemp(prefix=f".{target.stem}-", dir=target.parent))
    except OSError as error:
        raise _refused(target, error) from None
    try:
        yield folder / target.name
        _move_all(folder, target)
    except OSError as error:
        raise _refused(target, error) from error
    finally:
        shutil.rmtree(folder, ignore_errors=True)


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


def _check_place(target: Path) -> None:
    if not target.parent.is_dir():
        raise DocumentError(f"{target}: the folder {target.parent} is not there; make it first")
    if target.is_dir():
        raise DocumentError(f"{target}: is a folder; give the name of a file")


def _refused(target: Path, error: OSError) -> DocumentError:
    return DocumentError(f"{target}: can't be written ({error.strerror or error})")


def _move_all(folder: Path, target: Path) -> None:
    """Every file to its place, what stood there kept until all of them are."""
    files = sorted(file for file in folder.rglob("*") if file.is_file())
    # who opens the document finds what it names
    files.sort(key=lambda file: file == folder / target.name)
    kept_in = Path(tempfile.mkdtemp(dir=folder))
    with ExitStack() as undone:
        for number, file in enumerate(files):
            place = target.parent / file.relative_to(folder)
            if not place.parent.is_dir():
                place.parent.mkdir()
                undone.callback(place.parent.rmdir)
            if place.is_file():
                kept = kept_in / str(number)
                place.replace(kept)
                undone.callback(kept.replace, place)
            file.replace(place)
            undone.callback(place.unlink)
        undone.pop_all()


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
