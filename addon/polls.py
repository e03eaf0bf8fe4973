# SPDX-License-Identifier: GPL-3.0-or-later
"""When an operator can run, and what to do first when it can't: mixins for `poll`."""

from .cell.document import bare_cell, has_cell


class NeedsCell:
    """For operators that work on the scene's cell."""

    @classmethod
    def poll(cls, context):
        """Blender's question whether the operator can run now."""
        library = context.scene.library
        if library is not None:
            cls.poll_message_set(f"This scene is linked: open {library.filepath} to change it")
            return False
        if has_cell(context.scene):
            return True
        cls.poll_message_set("This scene holds no cell: open a cell document or a picture first")
        return False


class NeedsSighting(NeedsCell):
    """For operators that work on the active sighting."""

    @classmethod
    def poll(cls, context):
        """Blender's question whether the operator can run now."""
        if not super().poll(context):
            return False
        stored = context.scene.monocell_cell
        if 0 <= stored.sighting_index < len(stored.sightings):
            return True
        cls.poll_message_set("No sighting is active: add one, or choose one in the list")
        return False


class NeedsPose(NeedsCell):
    """For operators that need to know where the camera is."""

    @classmethod
    def poll(cls, context):
        """Blender's question whether the operator can run now."""
        if not super().poll(context):
            return False
        if bare_cell(context.scene).camera.camera_from_world is not None:
            return True
        cls.poll_message_set("The camera has no pose yet: calibrate it first")
        return False
