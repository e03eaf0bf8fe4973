# SPDX-License-Identifier: GPL-3.0-or-later
"""monocell: one picture and the robot's joint angles in, a metric virtual environment out.

This file is the root of the Python package and of the Blender extension at once. It imports
nothing by itself: core works without Blender, and pytest imports this file under any name.
"""


def register():
    """Blender's entry: put the add-on's classes, panels and command in place."""
    from . import addon

    addon.register()


def unregister():
    """Blender's exit: take away what `register` put in place."""
    from . import addon

    addon.unregister()
