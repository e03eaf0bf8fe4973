# SPDX-License-Identifier: GPL-3.0-or-later
"""What is drawn over the picture while an object is being picked."""

from __future__ import annotations

from typing import Any

from .drawing import ORANGE, WHITE, YELLOW, LineBatch, draw_crosses, draw_lines, draw_words
from .pick_session import PickSession, Preview
from .picture_frame import PictureFrame
from .preferences import Settings

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
    context: Any,
    session: PickSession,
    preview: Preview,
    snapped: str,
    cursor: tuple[float, float],
) -> None:
    """Words beside the cursor: what the click is for, where it is, what is wrong."""
    rows = [
        (session.prompt, WHITE),
        (preview.words, YELLOW),
        (snapped, WHITE),
        (preview.complaint, ORANGE),
    ]
    size = (context.region.width, context.region.height)
    draw_words(rows, *cursor, size, context.preferences.system.ui_scale)
