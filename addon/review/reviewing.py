# SPDX-License-Identifier: GPL-3.0-or-later
"""Background work whose result is an offer: shown on the picture first, then taken or left."""

from ..background_job import WorksInBackground
from ..on_picture.on_picture import CONFIRM_EVENTS, OnPicture
from ..preferences import settings


class Reviewed(OnPicture):
    """A mixin for operators with `prepare`, `offered(context, result)` and `take(context, result)`.

    `offered` gives the `Offer`, `take(context, result, offer)` does what is left of it. Called by a
    script all that is believed is taken; by hand the picture shows what would change, until Enter
    takes it or Esc leaves all as it was.
    """

    snaps = False
    # Blender's operators have no constructor of ours; None while the work is not done
    _offer = None

    def finish(self, context, result):
        """Take all that the offer takes by itself."""
        return self.take(context, result, self.offered(context, result))

    def state_of(self, scene):
        """With where the objects stand: in Blender they move without the scene's text."""
        from ...core.document.cell_file import document_from_cell
        from ..cell.document import read_scene

        cell = read_scene(scene)
        return *super().state_of(scene), document_from_cell(cell, cell.folder)

    def arrived(self, context, event, result):
        """Show what would change, if the view looks at the picture and there is a choice."""
        from ..cell.document import read_scene
        from .offer_drawing import OfferFrames

        offer = self.offered(context, result)
        if not offer.open or not _can_look(context, event):
            return self.take(context, result, offer)
        self._camera = read_scene(context.scene).standing_camera()
        self._frames = OfferFrames.of(offer, self._camera)
        self._offer, self._result, self._before = offer, result, False
        context.window_manager.monocell_work.reviewing = True
        self.enter(context, event)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        """The work's progress first, then the choice."""
        if self._offer is None:
            return WorksInBackground.modal(self, context, event)
        return OnPicture.modal(self, context, event)

    def cancel(self, context):
        """Blender's own way out."""
        if self._offer is None:
            WorksInBackground.cancel(self, context)
        else:
            self.end(context)

    def end(self, context):
        """Let the model be seen again."""
        context.window_manager.monocell_work.reviewing = False
        super().end(context)

    def handle(self, context, area, event):
        """A click turns one, Enter ends; B shows what is, without what would be."""
        if event.type == "B":
            self._before = event.value == "PRESS"
        if event.value != "PRESS":
            return None
        if event.type in CONFIRM_EVENTS:
            self.end(context)
            return self.take(context, self._result, self._offer)
        if event.type == "LEFTMOUSE":
            at = self._pointed(context, area)
            if at is not None:
                self._offer = self._offer.toggled(at)
        return None

    def paint(self, context, frame):
        """What is and what would be, and of the one under the cursor all that is known."""
        from ..overlay.drawing import LineBatch, draw_labels
        from .offer_drawing import rows_of

        scale = context.preferences.system.ui_scale
        for stroke in self._frames.strokes(self._offer, self.settings, self._before):
            lines = [frame.region_points(line) for line in stroke.lines]
            LineBatch(lines, stroke.color, stroke.width).draw(scale)
        labels = list(self._frames.labels(self._offer, self.settings))
        places = frame.region_points([label.pixel for label in labels]) if labels else ()
        draw_labels(
            [(at, one.text, one.color) for at, one in zip(places, labels, strict=True)], scale
        )
        at, self._loupe = self._pointed(context, context.area), None
        if at is not None:
            lines = [] if self._before else self._frames.near(self._offer, self.settings)
            centre = frame.view_pixels([self.pixel(context, context.area)])[0]
            self.paint_loupe(context, centre, lines)
            rows = rows_of(self._offer.candidates[at], settings(context).unit)
            self.paint_words(context, rows)

    def keys(self):
        """What the status bar tells."""
        return (
            ("EVENT_RETURN", f"    Take {len(self._offer.taken)} of {len(self._offer.candidates)}"),
            ("EVENT_ESC", "   Leave all as it was"),
            ("MOUSE_LMB", "Take or leave one"),
            ("EVENT_B", "Hold to see it as it is"),
        )

    def _pointed(self, context, area):
        pixel = self.pixel(context, area)
        return None if pixel is None else self._offer.at(self._camera, pixel)


def _can_look(context, event):
    """Whether the operator stands in a viewport that shows the picture."""
    from ...core.errors import InvalidValue
    from ..on_picture.camera_view import picking_region

    try:
        picking_region(context, (event.mouse_x, event.mouse_y))
    except InvalidValue:
        return False
    return True
