# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures to disk: pixels in, a PNG or JPEG written whole or not at all."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import cv2

from ..core.atomic import atomic_path
from ..core.errors import PictureError

ENDINGS = (".png", ".jpg", ".jpeg")


def write_picture(path: Path, picture: Any) -> None:
    """Write (H, W, 3) blue, green, red. Raises PictureError for an ending that is no picture's."""
    if path.suffix.lower() not in ENDINGS:
        raise PictureError(f"{path}: a picture ends in {', '.join(ENDINGS)}")
    with atomic_path(path) as temporary:
        done, data = cv2.imencode(path.suffix, picture)
        if not done:
            raise PictureError(f"{path}: the picture could not be encoded")
        temporary.write_bytes(data.tobytes())
