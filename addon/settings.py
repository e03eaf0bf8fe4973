# SPDX-License-Identifier: GPL-3.0-or-later
"""The preferences as plain values: what lines look like, how picks snap, and their defaults."""

from __future__ import annotations

from dataclasses import dataclass

from .overlay.drawing import GREEN, ORANGE, RED, SKY, VIOLET, YELLOW, Color


@dataclass(frozen=True)
class Settings:
    """Equal settings draw the same. Widths and radii are pixels at an interface scale of 1."""

    object_color: Color = SKY
    active_color: Color = YELLOW
    good_color: Color = GREEN
    doubtful_color: Color = ORANGE
    rejected_color: Color = RED
    advice_color: Color = VIOLET
    grid_color: Color = (0.62, 0.92, 0.95, 0.28)
    line_width: float = 1.6
    snap: bool = True
    snap_radius: float = 9.0
    loupe: bool = True
    loupe_zoom: int = 8
    unit: str = "mm"


DEFAULTS = Settings()
