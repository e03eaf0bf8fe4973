# SPDX-License-Identifier: GPL-3.0-or-later
"""What is drawn over the picture while an object is being picked."""

from __future__ import annotations

from typing import Any

from ..on_picture.picture_frame import PictureFrame
from ..overlay.drawing import (
    ORANGE,
    SKY,
    WHITE,
    YELLOW,
    LineBatch,
    draw_crosses,
    draw_lines,
    draw_ring,
)
from ..preferences import Settings
from .pick_session import PickSession, Preview

HIDDEN_SHARE = 0.45


def draw_preview(
    frame: PictureFrame, session: PickSession, preview: Preview, settings: Settings, scale: float
) -> None:
    """The live wire-frame, and crosses at the picks."""
    color = settings.object_color
    lines = [(frame.region_points(line.pixels), line.visible) for line in preview.lines]
    hidden = [pixels for pixels, visible in lines if not visible]
    LineBatch(hidden, (*color[:3], HIDDEN_SHARE * color[3]), 1.0).draw(scale)
    seen = [pixels for pixels, visible in lines if visible]
    draw_lines(seen, color, settings.line_width, scale)
    draw_crosses(frame.region_points(session.view_pixels()), settings.active_color, scale)


def draw_prompt(
    context: Any, operator: Any, session: PickSession, preview: Preview, snapped: str
) -> None:
    """Words beside the cursor: what the click is for, where it is, what is wrong."""
    rows = [
        (session.prompt, WHITE),
        (preview.words, YELLOW),
        (session.typed_words, SKY),
        (snapped, WHITE),
        (preview.complaint, ORANGE),
    ]
    operator.paint_words(context, rows)


def draw_handles(
    context: Any, frame: PictureFrame, operator: Any, handles: Any, held: Any, aim: Any
) -> None:
    """The picks of an object as rings; while one is dragged, the object that it would make."""
    from .pick_handles import view_pixels

    scale, look = context.preferences.system.ui_scale, operator.settings
    inner = frame.intrinsics
    places = frame.region_points(view_pixels(handles.cell.camera, handles.thing))
    for (handle, _), at in zip(handles.places.items(), places, strict=True):
        if handle != held:
            draw_ring(at, look.active_color, scale)
    if held is None or aim is None:
        operator.paint_words(context, [("drag a pick", WHITE)])
        return
    preview = handles.moved(held, aim.pixel)
    lines = [frame.region_points(line.pixels) for line in preview.lines if line.visible]
    draw_lines(lines, look.object_color, look.line_width, scale)
    at = frame.region_points(inner.undistorted().project(inner.rays(aim.pixel[None])))
    draw_ring(at[0], look.active_color, scale)
    loupe_lines = [(line.pixels, look.object_color) for line in preview.lines]
    snapped = operator.paint_aim(context, frame, loupe_lines)
    rows = [
        (f"{held[0]} {held[1] + 1}", WHITE),
        (preview.words, YELLOW),
        (snapped, WHITE),
        (preview.complaint, ORANGE),
    ]
    operator.paint_words(context, rows)
