# SPDX-License-Identifier: GPL-3.0-or-later
"""The sigma map of a calibrated cell: its photograph and accuracy in, the drawn map out."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..core.calibration.accuracy import SurfaceAccuracy
from ..core.calibration.calibrate import Calibration
from ..core.cell import Cell
from ..core.errors import InvalidValue
from ..core.sighting import SphereSighting
from .pictures import ENDINGS

if TYPE_CHECKING:
    from ..core.picture.overlay import BallOutline

# as an eye takes them: white as it should be, orange with a doubt, red left out (blue, green, red)
STATUS_COLORS = {"used": (245, 245, 245), "doubtful": (0, 190, 255), "rejected": (80, 80, 255)}


def check_map_name(path: Path, cell: Cell) -> None:
    """Raises InvalidValue for a name that is no picture's, or that of one of the cell's own,
    and for a folder that is not there.
    """
    if path.suffix.lower() not in ENDINGS:
        raise InvalidValue(f"{path}: a picture ends in {', '.join(ENDINGS)}")
    if not path.parent.is_dir():
        raise InvalidValue(f"{path}: the folder {path.parent} is not there; make it first")
    own = [sighting.picture for sighting in cell.sightings] + [cell.picture or ""]
    if any(name and cell.path_of(name).resolve() == path.resolve() for name in own):
        raise InvalidValue(f"{path}: the map would replace a picture of the cell; name another")


def drawn_map(cell: Cell, calibration: Calibration, surface: SurfaceAccuracy) -> Any:
    """The map over the cell's picture, or over the first used sighting's where it has none."""
    from ..core.calibration.sigma_map import sigma_field
    from ..core.picture.pictures import read_picture
    from ..core.picture.sigma_overlay import draw_sigma_map

    camera = calibration.camera
    first = cell.in_use().sightings[calibration.used_indices[0]].picture
    photograph = read_picture(cell.path_of(cell.picture or first), camera.intrinsics)
    if photograph.dtype == np.uint16:
        photograph = (photograph >> 8).astype(np.uint8)
    balls = _balls(cell, calibration)
    frame = surface.area.frame_pixels(camera)
    where = surface.area.told.split(" (")[0] + (" (framed)" if frame is not None else "")
    caption = f"1 sigma of a point on {surface.plane.name}: {1e3 * surface.at_work:.2f} mm {where}"
    field = sigma_field(camera, surface.plane)
    return draw_sigma_map(photograph, camera, field, caption, balls, frame)


def _balls(cell: Cell, calibration: Calibration) -> list[BallOutline]:
    """Where the balls were; none for a carried camera, which saw each from elsewhere."""
    from ..core.ball.sphere import outline_pixels
    from ..core.picture.overlay import BallOutline

    camera, balls = calibration.camera, []
    if calibration.mount is not None:
        return balls
    for report, sighting in zip(calibration.sightings, cell.in_use().sightings, strict=True):
        centre = camera.pose.apply(report.center_world)
        if isinstance(sighting, SphereSighting) and centre[2] > sighting.radius:
            pixels = outline_pixels(camera.intrinsics, centre, sighting.radius)
            balls.append(BallOutline(pixels, STATUS_COLORS[report.status]))
    return balls
