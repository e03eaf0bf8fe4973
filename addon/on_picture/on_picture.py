# SPDX-License-Identifier: GPL-3.0-or-later
"""Being modal on the picture: mouse and keys in a view of it in, an operator's own steps called."""

import bpy

from ..cell.document import bare_cell
from ..preferences import settings
from .camera_view import camera_region, picking_region, region_under, view_of
from .picture_frame import free_part, picture_frame

# what moves the view goes to Blender, so that zoom and pan work as ever
VIEW_EVENTS = frozenset(
    {
        "MOUSEMOVE",
        "INBETWEEN_MOUSEMOVE",
        "MIDDLEMOUSE",
        "WHEELUPMOUSE",
        "WHEELDOWNMOUSE",
        "WHEELINMOUSE",
        "WHEELOUTMOUSE",
        "TRACKPADPAN",
        "TRACKPADZOOM",
        "NDOF_MOTION",
        "HOME",
        "NUMPAD_PLUS",
        "NUMPAD_MINUS",
        "TIMER",
        "WINDOW_DEACTIVATE",
    }
)
CANCEL_EVENTS = frozenset({"ESC", "RIGHTMOUSE"})
CONFIRM_EVENTS = frozenset({"RET", "NUMPAD_ENTER"})
PAN_KEYS = (("MOUSE_MMB", "Pan, wheel zooms"),)


class OnPicture:
    """A mixin for operators that are worked with the mouse on the picture.

    `begin` starts it from `invoke`. The operator has `handle(context, area, event)`, which returns
    what a modal operator returns, or None to go on; `paint(context, frame)`, which draws; and
    `keys()`, the icons and words of the status bar. Cancelling leaves nothing behind.
    """

    # whether a click means the corner or edge near it
    snaps = True

    def begin(self, context, event):
        """Become modal where a viewport looks through the cell's camera. Raises InvalidValue."""
        picking_region(context, (event.mouse_x, event.mouse_y))
        self.enter(context, event)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def enter(self, context, event):
        """Begin to draw and to follow the mouse; for an operator that is modal already."""
        from .aiming import Aiming

        scene, self._mouse = context.scene, (event.mouse_x, event.mouse_y)
        self.settings = settings(context)
        self._area, self._scene = context.area.as_pointer(), scene.session_uid
        self._intrinsics = bare_cell(scene).camera.intrinsics
        self._aiming = Aiming.of(scene, context.space_data) if self.snaps else None
        self._aimed = None
        self.cursor, self._turned, self._loupe = None, False, None
        self._follow(context, context.area, event)
        self._handle = bpy.types.SpaceView3D.draw_handler_add(
            self._draw, (context,), "WINDOW", "POST_PIXEL"
        )
        self.tell(context)
        context.area.tag_redraw()

    def modal(self, context, event):
        """One event: the operator's own, or something for Blender."""
        area = self._its_area(context)
        if area is None or (event.type in CANCEL_EVENTS and event.value == "PRESS"):
            self.end(context)
            if area is None:
                self.report({"WARNING"}, "The view was left: nothing was changed")
            return {"CANCELLED"}
        self._turned = event.ctrl
        if event.type == "MOUSEMOVE":
            self._follow(context, area, event)
        if event.type == "MIDDLEMOUSE" and not (event.shift or event.ctrl or event.alt):
            # turning would leave the camera, and with it the picture
            return self._pan(context, area, event)
        if event.type in VIEW_EVENTS:
            area.tag_redraw()
            return {"PASS_THROUGH"}
        if event.type == "LEFTMOUSE":
            self._follow(context, area, event)
        ended = self.handle(context, area, event)
        if ended is not None:
            return ended
        self.tell(context)
        area.tag_redraw()
        return {"RUNNING_MODAL"}

    def cancel(self, context):
        """Blender's own way out, when a file is loaded or the window closes."""
        self.end(context)

    def end(self, context):
        """Stop drawing and give the status bar back."""
        bpy.types.SpaceView3D.draw_handler_remove(self._handle, "WINDOW")
        # while a file is loaded there is none in the context
        (context.workspace or bpy.data.workspaces[0]).status_text_set(None)
        area = self._its_area(context)
        if area is not None:
            area.tag_redraw()

    def frame(self, context, area):
        """The picture's frame in the area; None while the view looks elsewhere."""
        region = self._region(context, area)
        if region is None:
            return None
        view = view_of(area.spaces.active, region)
        return picture_frame(context.scene, region, view, self._intrinsics)

    def pixel(self, context, area):
        """The pixel under the cursor; None beside the picture or under a sidebar."""
        frame = self.frame(context, area)
        if frame is None:
            return None
        x, y = self.cursor
        left, bottom, right, top = free_part(area, self._region(context, area))
        if not (left <= x <= right and bottom <= y <= top):
            return None
        return frame.picture_pixel(x, y) if frame.contains(x, y) else None

    def aim(self, context, area):
        """What a click here would mean, an `Aim`; None beside the picture. Ctrl turns snapping."""
        from .aiming import Aim

        pixel = self.pixel(context, area)
        if pixel is None:
            return None
        if self.settings.snap == self._turned:
            return Aim(pixel, "")
        frame = self.frame(context, area)
        scale = context.preferences.system.ui_scale
        screen_pixel = self._intrinsics.width / (frame.right - frame.left)
        radius = self.settings.snap_radius * scale * screen_pixel
        key = (*pixel, radius)
        # Blender redraws more often than the mouse moves
        if self._aimed is None or self._aimed[0] != key:
            self._aimed = key, self._aiming.aimed(pixel, radius)
        return self._aimed[1]

    def paint_aim(self, context, frame, lines=()):
        """The cursor where a click would go, what it snaps to, and the loupe. Returns the words."""
        from ..overlay.drawing import WHITE, draw_crosses, draw_ring

        scale = context.preferences.system.ui_scale
        aim, self._loupe = self.aim(context, context.area), None
        if aim is None:
            draw_crosses([self.cursor], WHITE, scale)
            return ""
        centre = frame.view_pixels([aim.pixel])
        at = frame.region_points(centre)
        draw_crosses(at, WHITE, scale)
        if aim.told:
            draw_ring(at[0], self.settings.active_color, scale)
        self.paint_loupe(context, centre[0], lines)
        return f"snapped to {aim.told}" if aim.told else ""

    def paint_loupe(self, context, centre, lines):
        """The picture's pixels round `centre` (2,) of the view, enlarged, with lines over them."""
        from .loupe import Loupe
        from .shown_picture import view_pixels

        # read once and kept, whoever asks
        pixels = view_pixels(context.scene) if self.settings.loupe else None
        if pixels is None:
            return

        scale, free = context.preferences.system.ui_scale, free_part(context.area, context.region)
        loupe = Loupe(self.cursor, free, self.settings.loupe_zoom, scale)
        self._loupe = loupe.box
        loupe.draw(pixels, centre, lines, scale)

    def paint_words(self, context, rows):
        """Words and their colours beside the cursor, where no sidebar and no loupe is."""
        from ..overlay.drawing import draw_words

        scale, free = context.preferences.system.ui_scale, free_part(context.area, context.region)
        draw_words(rows, self.cursor, free, scale, self._loupe)

    def tell(self, context):
        """Name the keys in the status bar."""
        snapping = "Do not snap" if self.settings.snap else "Snap"
        turns = (("EVENT_CTRL", f"   {snapping}"),) if self.snaps else ()
        keys = (*self.keys(), *turns, *PAN_KEYS)

        def draw(header, context):
            row = header.layout.row(align=True)
            for icon, text in keys:
                row.label(text=text, icon=icon)
                row.separator(factor=2.0)

        context.workspace.status_text_set(draw)

    def _region(self, context, area):
        return camera_region(context.scene, area, self._mouse)

    def _follow(self, context, area, event):
        """Keep where the mouse is in the region: events count pixels, so its middle is meant."""
        self._mouse = event.mouse_x, event.mouse_y
        region = self._region(context, area) or region_under(area, self._mouse)
        self.cursor = (event.mouse_x - region.x + 0.5, event.mouse_y - region.y + 0.5)

    def _pan(self, context, area, event):
        if event.value == "PRESS":
            with context.temp_override(area=area, region=region_under(area, self._mouse)):
                bpy.ops.view3d.move("INVOKE_DEFAULT")
        return {"RUNNING_MODAL"}

    def _its_area(self, context):
        """The viewport that it was begun in, while that shows the scene that it was begun for."""
        areas = context.window.screen.areas if context.window else ()
        area = next((area for area in areas if area.as_pointer() == self._area), None)
        if area is None or area.type != "VIEW_3D" or context.scene.session_uid != self._scene:
            return None
        return area

    def _draw(self, context):
        area = self._its_area(context)
        if area is None or context.area != area or context.region != self._region(context, area):
            return
        self.paint(context, self.frame(context, area))
