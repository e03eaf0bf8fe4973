# SPDX-License-Identifier: GPL-3.0-or-later
"""What saving and loading a .blend file does to its cells: they remember where their pictures are.

A project folder may be moved or sent elsewhere as a whole: the pictures then lie where they did as
seen from the .blend file.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import bpy
from bpy.app.handlers import persistent


@persistent
def remember_folders(path: str) -> None:
    """Blender's call before a file is saved at `path`."""
    for stored in _cells():
        try:
            beside = os.path.relpath(stored.folder, Path(path).parent) if path else ""
        except ValueError:
            # another drive
            beside = ""
        stored.folder_beside = Path(beside).as_posix() if beside else ""


@persistent
def find_folders(path: str) -> None:
    """Blender's call after a file was loaded: what was moved along with it is found again."""
    # work does not go on in another session
    bpy.context.window_manager.property_unset("monocell_work")
    for stored in _cells():
        if path and stored.folder_beside:
            moved = Path(os.path.normpath(Path(path).parent / stored.folder_beside))
            _follow(stored, moved)


def register() -> None:
    """Start listening."""
    bpy.app.handlers.save_pre.append(remember_folders)
    bpy.app.handlers.load_post.append(find_folders)


def unregister() -> None:
    """Stop listening."""
    bpy.app.handlers.load_post.remove(find_folders)
    bpy.app.handlers.save_pre.remove(remember_folders)


def _cells() -> list[Any]:
    return [s.monocell_cell for s in bpy.data.scenes if s.monocell_cell.text]


def _follow(stored: Any, moved: Path) -> None:
    """Take the folder that moved along, where it has the picture and the old one has it no more."""
    before, picture = Path(stored.folder), stored.shown_picture
    if not picture or (before / picture).is_file() or not (moved / picture).is_file():
        return
    stored.folder = str(moved)
    try:
        document = moved / Path(bpy.path.abspath(stored.path)).relative_to(before)
    except ValueError:
        return
    if document.is_file():
        stored.path = str(document)
