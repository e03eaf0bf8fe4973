# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the fit of a lens begins: views and a model in, a rough lens and board poses out."""

from __future__ import annotations

import contextlib
from collections.abc import Sequence
from typing import Any

import cv2
import numpy as np

from ..arrays import Array
from ..distortion import COEFFICIENTS, Distortion
from ..errors import InvalidValue, NotConverged
from ..intrinsics import Intrinsics
from ..pose import Pose
from .bundle import LensFit, fit_lens
from .parameters import WITHOUT_K3, in_model, parameters_of, with_parameters
from .view import BoardView

# focal lengths to begin a fisheye with, in widths of the picture: 60 to 220 degrees across
FISHEYE_FOCALS = (0.9, 0.6, 0.42, 0.32, 0.26)
# directions beyond it have no place on a flat image plane
WIDEST = np.cos(np.radians(82))
ROUGH_STEPS = 12
# a start that leads this near in pixels needs no other beside it
GOOD_START = 0.5
FLAGS = {
    "none": cv2.CALIB_ZERO_TANGENT_DIST | cv2.CALIB_FIX_K1 | cv2.CALIB_FIX_K2 | cv2.CALIB_FIX_K3,
    "plumb_bob": 0,
    "rational_polynomial": cv2.CALIB_RATIONAL_MODEL,
}


def first_fit(views: Sequence[BoardView], size: tuple[int, int], model: str) -> LensFit:
    """The best fit of `model` to all views of pictures of `size` (width, height).

    Raises NotConverged where no start leads to a lens that images every corner.
    """
    starts = _fisheye_starts(views, size) if model == "equidistant" else _flat(views, size, model)
    fits: list[LensFit] = []
    for start in starts:
        try:
            fits.append(fit_lens(start, steps=ROUGH_STEPS))
        except InvalidValue:
            continue
        if fits[-1].rms_pixels < GOOD_START:
            break
    if not fits:
        raise NotConverged(f"no {model} lens images all corners of all pictures; try another model")
    return fit_lens(min(fits, key=lambda fit: fit.rms_pixels))


def without_k3(fit: LensFit) -> LensFit:
    """The fit of a plumb_bob lens with k3 held at zero. Raises NotConverged as `first_fit` does."""
    parameters = parameters_of(fit.lens)
    parameters[list(WITHOUT_K3)] = 0.0
    lens = with_parameters(fit.lens, parameters)
    try:
        poses = tuple(pose_under(lens, view) for view in fit.views)
        return fit_lens(LensFit(lens, poses, fit.views, held=WITHOUT_K3))
    except InvalidValue:
        raise NotConverged("no plumb_bob lens without k3 images all corners") from None


def pose_under(lens: Intrinsics, view: BoardView) -> Pose:
    """The pose of a board by a homography of undistorted corners. Raises InvalidValue."""
    rays = lens.rays(view.pixels)
    forward = rays[:, 2] > WIDEST
    if forward.sum() < 4:
        raise InvalidValue(f"{view.picture}: the lens images too few of the corners")
    plane = rays[forward, :2] / rays[forward, 2:]
    found, turned, moved = cv2.solvePnP(
        view.points[forward], plane, np.eye(3), np.zeros(4), flags=cv2.SOLVEPNP_IPPE
    )
    if not found or not np.isfinite(turned).all():
        raise InvalidValue(f"{view.picture}: the corners are no picture of the board")
    return Pose.from_rotation_vector(turned.ravel(), moved.ravel())


def _flat(views: Sequence[BoardView], size: tuple[int, int], model: str) -> list[LensFit]:
    """OpenCV's calibration as a start (Zhang 2000), and a plain lens of its focal length."""
    points = [view.points.astype(np.float32) for view in views]
    pixels = [view.pixels.astype(np.float32) for view in views]
    try:
        _, k, found, turned, moved = cv2.calibrateCamera(
            points, pixels, size, np.eye(3), np.zeros(5), flags=FLAGS[model]
        )
    except cv2.error:
        return _guessed(views, size, model)
    starts = []
    # what OpenCV ends in may be no lens at all: then the plain starts are left
    with contextlib.suppress(InvalidValue):
        starts.append(_from_opencv(views, size, model, (k, found.ravel(), turned, moved)))
    return [*starts, *_guessed(views, size, model, float(k[0, 0]))]


def _from_opencv(
    views: Sequence[BoardView], size: tuple[int, int], model: str, found: tuple[Any, ...]
) -> LensFit:
    k, coefficients, turned, moved = found
    count = COEFFICIENTS[model]
    lens = Intrinsics(
        *size, k[0, 0], k[1, 1], k[0, 2], k[1, 2], Distortion(model, coefficients[:count])
    )
    poses = [
        Pose.from_rotation_vector(r.ravel(), t.ravel()) for r, t in zip(turned, moved, strict=True)
    ]
    return LensFit(lens, tuple(poses), tuple(views))


def _guessed(
    views: Sequence[BoardView], size: tuple[int, int], model: str, *focals: float
) -> list[LensFit]:
    middle: Array = (np.array(size) - 1) / 2
    starts = []
    for focal in (*focals, 1.0 * size[0], 0.6 * size[0]):
        try:
            plain = Intrinsics(*size, focal, focal, middle[0], middle[1])
            lens = in_model(plain, model)
            poses = tuple(pose_under(lens, view) for view in views)
        except InvalidValue:
            continue
        starts.append(LensFit(lens, poses, tuple(views)))
    return starts


def _fisheye_starts(views: Sequence[BoardView], size: tuple[int, int]) -> list[LensFit]:
    widths = [focal * max(size) for focal in FISHEYE_FOCALS]
    return _guessed(views, size, "equidistant", *widths)
