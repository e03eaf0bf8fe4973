# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's news that something changed in, a number that grows with it out."""

from __future__ import annotations

from typing import Any

import bpy
from bpy.app.handlers import persistent

# an edit, a step back or forth, another frame, another file: whatever may move or hide an object
NEWS = ("depsgraph_update_post", "undo_post", "redo_post", "frame_change_post", "load_post")


class SceneChanges:
    """Counts what happens to any scene while it listens.

    As long as `count` is the same, no object has moved, changed, come, gone or been hidden.
    """

    def __init__(self) -> None:
        self.count = 0

        # of a method Blender would forget the mark that lets it outlive the file
        @persistent
        def heard(*_: Any) -> None:
            self.count += 1

        self._heard = heard

    def listen(self) -> None:
        """Be told by Blender from now on."""
        for news in NEWS:
            getattr(bpy.app.handlers, news).append(self._heard)

    def end(self) -> None:
        """Be told no more."""
        for news in NEWS:
            getattr(bpy.app.handlers, news).remove(self._heard)
