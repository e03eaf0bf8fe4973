# SPDX-License-Identifier: GPL-3.0-or-later
"""Pixels and a curve in space in, their signed distances to its exact image out.

The distance is measured to the curve as the lens images it, not to an ellipse or a straight line
fitted to it, so it holds under any distortion.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..intrinsics import Intrinsics
from ..pose import Pose, point_jacobian

STEPS = 20
# in pixels along the curve: its square, over a radius of curvature, is left in the distance
SETTLED_PIXELS = 1e-7
# the image's bend is differenced over this part of a parameter unit
BEND_STEP = 1e-4

# parameters (..., N) to points and tangents (..., N, 3) of N curves
Curve = Callable[[Array], tuple[Array, Array]]


@dataclass(frozen=True, eq=False)
class Feet:
    """For every pixel the nearest point of its curve, at `parameters` (N,).

    `distances` (N,) are signed, in pixels; `by_point` (N, 3) is their derivative by the motion of
    the foot in the curve's frame, `by_twist` (N, 6) by the twist of `camera_from_frame`. Both are
    exact: where the foot slides along its curve the distance does not change (envelope theorem).
    """

    parameters: Array
    distances: Array
    by_point: Array
    by_twist: Array


def nearest_feet(
    intrinsics: Intrinsics,
    camera_from_frame: Pose,
    curve: Curve,
    starts: Array,
    pixels: Array,
    longest_step: Array | float,
) -> Feet:
    """The nearest points of N imaged curves to N pixels (N, 2), one each.

    `starts` (N,) are parameters to descend from; no step is longer than `longest_step` (of each).
    Parts of the result are NaN where a curve is not imaged.
    """
    feet, here = starts.copy(), BEND_STEP * np.array([[0.0], [1.0], [-1.0]])
    for _ in range(STEPS):
        images, (tangents, ahead, behind) = _image(
            intrinsics, camera_from_frame, curve, feet + here
        )
        bend = (ahead - behind) / (2 * BEND_STEP)
        offset = images[0] - pixels
        slope = (offset * tangents).sum(1)
        flat = (tangents * tangents).sum(1)
        curvature = flat + (offset * bend).sum(1)
        # beyond the centre of curvature Newton would climb: there the Gauss-Newton step goes down
        step = -slope / np.where(curvature > 0.1 * flat, curvature, flat)
        feet = feet + np.clip(step, -longest_step, longest_step)
        if not (np.abs(step) * np.sqrt(flat) > SETTLED_PIXELS).any():
            break
    return _measured(intrinsics, camera_from_frame, curve, feet, pixels)


def nearest_samples(
    intrinsics: Intrinsics, camera_from_frame: Pose, curve: Curve, samples: Array, pixels: Array
) -> Array:
    """Of the parameters `samples` (K,) the one whose image is nearest to each pixel, (N,)."""
    parameters = np.broadcast_to(samples[:, None], (len(samples), len(pixels)))
    points, _ = curve(parameters)
    points_camera = camera_from_frame.apply(points.reshape(-1, 3))
    image = intrinsics.project(points_camera).reshape(*parameters.shape, 2)
    distance = ((image - pixels) ** 2).sum(-1)
    nearest = np.where(np.isnan(distance), np.inf, distance).argmin(axis=0)
    chosen: Array = samples[nearest]
    return chosen


def _image(
    intrinsics: Intrinsics, camera_from_frame: Pose, curve: Curve, parameters: Array
) -> tuple[Array, Array]:
    """Pixels and the derivative of each along its curve, (..., N, 2)."""
    points, tangents = curve(parameters)
    flat = camera_from_frame.apply(points.reshape(-1, 3))
    image, by_point = intrinsics.project_with_jacobian(flat)
    along = by_point @ camera_from_frame.rotate(tangents.reshape(-1, 3))[:, :, None]
    shape = (*parameters.shape, 2)
    return image.reshape(shape), along.reshape(shape)


def _measured(
    intrinsics: Intrinsics, camera_from_frame: Pose, curve: Curve, feet: Array, pixels: Array
) -> Feet:
    points, tangents = curve(feet)
    points_camera = camera_from_frame.apply(points)
    image, by_point = intrinsics.project_with_jacobian(points_camera)
    along = (by_point @ camera_from_frame.rotate(tangents)[:, :, None])[:, :, 0]
    across = along @ [[0.0, 1.0], [-1.0, 0.0]]
    across /= np.linalg.norm(across, axis=1)[:, None]
    by_camera_point = across[:, None, :] @ by_point
    return Feet(
        feet,
        (across * (image - pixels)).sum(1),
        (by_camera_point @ camera_from_frame.rotation)[:, 0],
        (by_camera_point @ point_jacobian(points_camera))[:, 0],
    )
