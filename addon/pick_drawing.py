# SPDX-License-Identifier: GPL-3.0-or-later
"""What is drawn over the picture while an object is being picked."""

from __future__ import annotations

from typing import Any

import numpy as np

from .drawing import ORANGE, SKY, WHITE, YELLOW, LineBatch, draw_crosses, draw_lines, draw_words
from .pick_session import PickSession, Preview
from .picture_frame import PictureFrame

HIDDEN = (*SKY[:3], 0.45)


def draw_session(
    context: Any,
    frame: PictureFrame,
    session: PickSession,
    preview: Preview,
    cursor: tuple[float, float],
) -> None:
    """The live wire-frame, crosses at the picks and the cursor, and words beside it."""
    scale = context.preferences.system.ui_scale
    lines = [(frame.region_points(line.pixels), line.visible) for line in preview.lines]
    hidden = [pixels for pixels, visible in lines if not visible]
    LineBatch(hidden, HIDDEN, 1.0).draw(scale)
    draw_lines([pixels for pixels, visible in lines if visible], SKY, 1.8, scale)
    draw_crosses(frame.region_points(session.view_pixels()), YELLOW, scale)
    draw_crosses(np.array([cursor]), WHITE, scale)
    rows = [
        (session.prompt, WHITE),
        (preview.words, YELLOW),
        (session.typed_words, SKY),
        (preview.complaint, ORANGE),
    ]
    size = (context.region.width, context.region.height)
    draw_words(rows, *cursor, size, scale)
