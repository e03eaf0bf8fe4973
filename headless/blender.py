# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether Blender is there: asked before a verb that needs it imports `scene`."""

from __future__ import annotations

import importlib.util

from ..core.errors import MonocellError


class BlenderMissing(MonocellError):
    """The verb needs Blender's Python module, or to run inside Blender."""


def require_blender() -> None:
    """Raises BlenderMissing with the ways to get it."""
    if importlib.util.find_spec("bpy") is None:
        raise BlenderMissing(
            "needs Blender: pip install 'monocell[blender]', or run the same verb as "
            "blender --command monocell"
        )
