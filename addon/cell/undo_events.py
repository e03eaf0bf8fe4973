# SPDX-License-Identifier: GPL-3.0-or-later
"""What a step back or forth does to the modelled objects: they are shown where they stand again."""

from __future__ import annotations

from typing import Any

import bpy
from bpy.app.handlers import persistent


@persistent
def stand_again(*_: Any) -> None:
    """Blender's call after undo and redo: let it compute anew where the modelled objects stand.

    Blender (4.5, 5.2) takes back a transform that was made in edit mode and goes on to show the
    object where it was, away from where the document has it.
    """
    from ...scene.objects import is_modelled

    for ob in bpy.data.objects:
        if is_modelled(ob):
            ob.update_tag(refresh={"OBJECT"})


def register() -> None:
    """Start listening."""
    bpy.app.handlers.undo_post.append(stand_again)
    bpy.app.handlers.redo_post.append(stand_again)


def unregister() -> None:
    """Stop listening."""
    bpy.app.handlers.redo_post.remove(stand_again)
    bpy.app.handlers.undo_post.remove(stand_again)
