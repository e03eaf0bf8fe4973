# SPDX-License-Identifier: GPL-3.0-or-later
"""monocell: one picture and the robot's joint angles in, a metric virtual environment out.

This file is the root of the Python package and of the Blender extension at once. It imports
nothing by itself: core works without Blender, and pytest imports this file under any name.
"""


def register():
    """Blender's entry: put the add-on's classes, panels and command in place."""
    import bpy

    from . import addon

    addon.register()
    # `blender --command monocell VERB`; the handle is kept where `unregister` takes it from again
    handle = bpy.utils.register_cli_command("monocell", _command)
    bpy.types.WindowManager.monocell_command = handle


def unregister():
    """Blender's exit: take away what `register` put in place."""
    import bpy

    from . import addon

    bpy.utils.unregister_cli_command(bpy.types.WindowManager.monocell_command)
    del bpy.types.WindowManager.monocell_command
    addon.unregister()


def _command(arguments):
    """The command line's verbs, the one place where the two faces meet. Returns the exit code."""
    from .headless.cli import main

    return main(arguments)
