# SPDX-License-Identifier: GPL-3.0-or-later
"""What a calibration solved for beside the camera's pose: told to a person, or as JSON values."""

from __future__ import annotations

from typing import Any

from ..core.calibration.calibrate import Calibration
from ..core.document.entries import pose_entry
from .told import millimetres, point_told


def unknowns_document(calibration: Calibration) -> dict[str, Any]:
    """The mount, the offsets and what was refined, as JSON values in metres."""
    fit, mount = calibration.fit, calibration.mount
    solved: dict[str, Any] = {}
    if mount is not None and mount.camera_from_flange is not None:
        solved["camera_from_flange"] = pose_entry(mount.camera_from_flange)
        solved["camera_from_flange_covariance"] = mount.covariance
    solved["offsets"] = [
        {"target": target, "offset": offset, "sigma": sigma}
        for target, offset, sigma in zip(fit.targets, fit.offsets, fit.offset_sigmas, strict=True)
    ]
    solved["refined"] = [
        {"name": refined.name, "factor": refined.factor, "sigma": refined.sigma}
        for refined in calibration.refined
    ]
    return solved


def unknowns_told(calibration: Calibration) -> list[str]:
    """One line for each thing solved for; none where only the pose was."""
    fit, mount, lines = calibration.fit, calibration.mount, []
    if mount is not None and mount.camera_from_flange is not None:
        seat = mount.camera_from_flange.inverse().translation
        lines.append(f"mounted   on the flange, the camera at {point_told(seat)} of it")
    what = "the target is in the world" if mount is not None else "the offset in the flange is"
    for target, offset, sigma in zip(fit.targets, fit.offsets, fit.offset_sigmas, strict=True):
        name = f"{target}: " if target else ""
        spread = millimetres(float((sigma**2).sum() ** 0.5))
        lines.append(f"solved    {name}{what} at {point_told(offset)} ± {spread}")
    for refined in calibration.refined:
        change, sigma = 100 * (refined.factor - 1), 100 * refined.sigma
        lines.append(f"refined   {refined.name} {change:+.3f} ± {sigma:.3f} % of what was stated")
    return lines
