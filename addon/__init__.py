# SPDX-License-Identifier: GPL-3.0-or-later
"""The face in Blender's viewport: properties, operators, panels, menus and the overlay."""


def register():
    """Put all of it in place. OpenCV and the graphics module wait until they are needed."""
    import bpy

    from . import keymap, menus, properties, tools
    from .cell import file_events, undo_events
    from .overlay import overlay

    properties.register()
    for cls in _classes():
        bpy.utils.register_class(cls)
    menus.register()
    overlay.register()
    file_events.register()
    undo_events.register()
    keymap.register()
    tools.register()


def unregister():
    """Take it away, in reverse."""
    import bpy

    from . import keymap, menus, properties, tools
    from .cell import file_events, undo_events
    from .overlay import overlay

    tools.unregister()
    keymap.unregister()
    undo_events.unregister()
    file_events.unregister()
    overlay.unregister()
    menus.unregister()
    for cls in reversed(_classes()):
        bpy.utils.unregister_class(cls)
    properties.unregister()


def _classes():
    from . import drops, menus, operators
    from .panels import lists, panel_camera, panel_model, panel_object, panel_picture, panel_use
    from .preferences import Preferences

    return (
        Preferences,
        *operators.classes(),
        *drops.CLASSES,
        *lists.CLASSES,
        panel_picture.PicturePanel,
        panel_picture.LensPanel,
        panel_camera.CameraPanel,
        panel_camera.AccuracyPanel,
        panel_camera.SightingsPanel,
        panel_model.ReferenceMenu,
        panel_model.ModelPanel,
        panel_object.ObjectPanel,
        panel_model.ReferencesPanel,
        panel_model.AllObjectsPanel,
        menus.ExportMenu,
        panel_use.UsePanel,
    )
