# SPDX-License-Identifier: GPL-3.0-or-later
"""Intrinsics and pose into a Blender camera, and back: the only file that knows Blender's axes.

Blender's camera looks along -z with y up, and its frame counts from the corner of the picture, so
that the centre of the top-left pixel is (0.5, 0.5) there and (0, 0) everywhere else.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ..core.camera import Camera
from ..core.distortion import Distortion
from ..core.errors import InvalidValue
from ..core.intrinsics import Intrinsics
from ..core.pose import Pose
from .transforms import pose_and_scale, stand

# Blender silently clamps a shorter lens
SHORTEST_LENS_MM = 1.0
SENSOR_MM = 36.0
# the lens distortion, which a Blender camera can't hold
DISTORTION = "monocell_distortion"
OPENCV_FROM_BLENDER = Pose(np.diag([1.0, -1.0, -1.0]), np.zeros(3))


def place_camera(
    camera_object: Any, render_settings: Any, intrinsics: Intrinsics, camera_from_world: Pose
) -> None:
    """Give a Blender camera and the render settings the picture, lens and place of a real one.

    `lens = fx sensor / width`, `shift_x = (width/2 - cx - 1/2) / width`, `shift_y = (cy + 1/2 -
    height/2) (fx/fy) / width`; pixel aspect carries fx != fy. Distortion goes along as an ID
    property of the camera's data and has no effect in Blender. Raises InvalidValue when the focal
    length is too short for Blender (a field of view above 173 degrees).
    """
    i, camera = intrinsics, camera_object.data
    lens = i.fx * SENSOR_MM / i.width
    if lens < SHORTEST_LENS_MM:
        raise InvalidValue(
            f"fx: {i.fx:g} px for a width of {i.width} px is below Blender's shortest lens; "
            f"it needs at least {i.width * SHORTEST_LENS_MM / SENSOR_MM:.1f} px"
        )
    render_settings.resolution_x, render_settings.resolution_y = i.width, i.height
    render_settings.resolution_percentage = 100
    # both must be at least 1, so the longer side of a pixel is the one that is written
    render_settings.pixel_aspect_x = max(1.0, i.fy / i.fx)
    render_settings.pixel_aspect_y = max(1.0, i.fx / i.fy)
    camera.type, camera.lens_unit = "PERSP", "MILLIMETERS"
    camera.sensor_fit, camera.sensor_width = "HORIZONTAL", SENSOR_MM
    camera.lens = lens
    camera.shift_x = (i.width / 2 - i.cx - 0.5) / i.width
    camera.shift_y = (i.cy + 0.5 - i.height / 2) * (i.fx / i.fy) / i.width
    camera[DISTORTION] = {
        "model": i.distortion.model,
        "coefficients": i.distortion.coefficients.tolist(),
    }
    stand(camera_object, camera_from_world.inverse() @ OPENCV_FROM_BLENDER)


def read_camera(camera_object: Any, render_settings: Any) -> Camera:
    """The camera that `place_camera` set, or any perspective camera that a user made.

    To float32: 1e-4 px and 1e-7 m at the usual sizes. No covariance. Raises InvalidValue for an
    orthographic or panoramic camera.
    """
    camera = camera_object.data
    if camera.type != "PERSP":
        raise InvalidValue(
            f"{camera_object.name}: a camera of type {camera.type} is not a pinhole; "
            "set its type to Perspective"
        )
    width, height = _picture_size(render_settings)
    # a pixel's height in units of its width
    stretch = render_settings.pixel_aspect_y / render_settings.pixel_aspect_x
    horizontal = camera.sensor_fit == "HORIZONTAL" or (
        camera.sensor_fit == "AUTO" and width >= height * stretch
    )
    span = width if horizontal else height * stretch
    sensor = camera.sensor_height if camera.sensor_fit == "VERTICAL" else camera.sensor_width
    fx = camera.lens / sensor * span
    intrinsics = Intrinsics(
        width,
        height,
        fx,
        fx / stretch,
        width / 2 - camera.shift_x * span - 0.5,
        height / 2 + camera.shift_y * span / stretch - 0.5,
        _distortion(camera),
    )
    world_from_blender, _ = pose_and_scale(camera_object)
    return Camera(intrinsics, OPENCV_FROM_BLENDER @ world_from_blender.inverse())


def _picture_size(render_settings: Any) -> tuple[int, int]:
    part = render_settings.resolution_percentage / 100
    return int(render_settings.resolution_x * part), int(render_settings.resolution_y * part)


def _distortion(camera: Any) -> Distortion:
    if DISTORTION not in camera:
        return Distortion()
    entry = camera[DISTORTION]
    return Distortion(entry["model"], np.array(list(entry["coefficients"]), dtype=float))
