# SPDX-License-Identifier: GPL-3.0-or-later
"""How balls that were found are told: outlines in; lines, JSON values and an overlay out."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..core.ball.outline import SphereOutline
from ..core.intrinsics import Intrinsics
from ..core.picture.pictures import Picture, eight_bits
from .find_job import Seen, Vote
from .told import millimetres, point_told, table


def told(balls: Sequence[SphereOutline], vote: Vote | None) -> str:
    """Every ball in three lines, and the baseline's answer in one."""
    lines = [line for ball in balls for line in _lines(ball)]
    if vote is not None:
        way = "deeper" if vote.deeper > 0 else "nearer"
        lines.append(
            f"vote     {point_told(vote.centre_camera)}: {vote.aside_pixels:.2f} px aside of the "
            f"outline's, {millimetres(abs(vote.deeper), digits=1)} {way}"
        )
    return "\n".join(lines)


def found_document(
    balls: Sequence[SphereOutline], only_one: bool, vote: Vote | None
) -> dict[str, Any]:
    """The balls as JSON values; one that was asked for alone stands at the top."""
    entries = [_entry(ball) for ball in balls]
    document: dict[str, Any] = entries[0] if only_one else {"balls": entries}
    if vote is not None:
        document["vote"] = {
            "center_camera": vote.centre_camera,
            "aside_pixels": vote.aside_pixels,
            "deeper": vote.deeper,
        }
    return document


def cell_told(found: Sequence[Seen]) -> str:
    """A line of each sighting."""
    header = ("picture", "centre in the camera", "1 sigma", "seen", "aside of the pose")
    return table(header, [_row(seen) for seen in found])


def cell_document(found: Sequence[Seen]) -> dict[str, Any]:
    """The sightings as JSON values; `ball` is null where none was found, and warnings say why."""
    return {
        "sightings": [
            {
                "picture": seen.sighting.picture,
                "center": seen.sighting.center_world,
                "ball": None if seen.ball is None else _entry(seen.ball),
                "aside": seen.aside,
                "warnings": seen.warnings,
            }
            for seen in found
        ]
    }


def draw_balls(
    path: Path, picture: Picture, intrinsics: Intrinsics, balls: Sequence[SphereOutline]
) -> None:
    """Write the picture with the outlines on it."""
    from ..core.ball.sphere import outline_pixels
    from ..core.camera import Camera
    from ..core.picture.overlay import BallOutline, draw_overlay
    from ..core.pose import Pose
    from .pictures import write_picture

    camera = Camera(intrinsics, Pose.identity())
    outlines = [
        BallOutline(outline_pixels(intrinsics, ball.centre_camera, ball.radius)) for ball in balls
    ]
    write_picture(path, draw_overlay(eight_bits(picture), camera, (), outlines))


def _lines(ball: SphereOutline) -> tuple[str, str, str]:
    middle = ball.pixels[ball.used].mean(axis=0)
    sigma = ", ".join(millimetres(s) for s in _sigma(ball))
    return (
        f"ball at {point_told(ball.centre_camera)} in the camera frame (x right, y down)",
        f"1 sigma  {sigma}",
        f"outline  around pixel ({middle[0]:.1f}, {middle[1]:.1f}), {ball.used.sum()} points, "
        f"{100 * ball.coverage:.0f} % of it seen, {ball.rms_pixels:.2f} px rms",
    )


def _row(seen: Seen) -> tuple[str, ...]:
    if seen.ball is None:
        return seen.sighting.picture, "not found", "", "", ""
    sigma = np.linalg.norm(_sigma(seen.ball))
    return (
        seen.sighting.picture,
        point_told(seen.ball.centre_camera),
        millimetres(float(sigma)),
        f"{100 * seen.ball.coverage:.0f} %",
        "" if seen.aside is None else millimetres(seen.aside, digits=1),
    )


def _sigma(ball: SphereOutline) -> np.ndarray:
    return np.sqrt(np.diag(ball.covariance))


def _entry(ball: SphereOutline) -> dict[str, Any]:
    return {
        "center_camera": ball.centre_camera,
        "sigma": _sigma(ball),
        "covariance": ball.covariance,
        "radius": ball.radius,
        "coverage": ball.coverage,
        "cut": ball.cut,
        "rms_pixels": ball.rms_pixels,
        "blur_pixels": ball.blur_pixels,
        "outline_pixels": ball.pixels[ball.used],
        "warnings": ball.warnings,
    }
