# SPDX-License-Identifier: GPL-3.0-or-later
"""ROS camera_info, as camera_calibration_parsers writes it: parsed YAML to a Camera, and back."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...arrays import Array
from ...camera import Camera
from ...distortion import Distortion
from ...errors import DocumentError
from ...intrinsics import Intrinsics
from ..fields import Fields, items, keyed, number
from .coefficients import from_matrix, named_model, padded

# what the ROS message and calibration tools write beside what is read here
OTHER_KEYS = (
    "camera_name",
    "rectification_matrix",
    "projection_matrix",
    "header",
    "binning_x",
    "binning_y",
    "roi",
)


def camera_from_ros(document: Any) -> Camera:
    """The camera of a parsed camera_info file. Raises DocumentError."""
    required = ("image_width", "image_height", "camera_matrix")
    optional = ("distortion_model", "distortion_coefficients", *OTHER_KEYS)
    fields = keyed(document, "", required, optional)
    k = _array(fields, "camera_matrix", 9).reshape(3, 3)
    width, height = fields.whole("image_width"), fields.whole("image_height")
    return Camera(from_matrix(width, height, k, _distortion(fields)))


def ros_text(lens: Intrinsics) -> str:
    """The camera_info YAML of a lens; every digit reads back."""
    model, coefficients = lens.distortion.model, lens.distortion.coefficients
    if model == "none":
        model, coefficients = "plumb_bob", np.zeros(5)
    k = lens.matrix()
    projection = np.hstack([k, np.zeros((3, 1))])
    return (
        f"image_width: {lens.width}\nimage_height: {lens.height}\ncamera_name: camera\n"
        f"camera_matrix:{_written(k)}"
        f"distortion_model: {model}\n"
        f"distortion_coefficients:{_written(coefficients[None])}"
        f"rectification_matrix:{_written(np.eye(3))}"
        f"projection_matrix:{_written(projection)}"
    )


def _written(matrix: Array) -> str:
    rows, columns = matrix.shape
    data = ", ".join(repr(float(v)) for v in matrix.ravel())
    return f"\n  rows: {rows}\n  cols: {columns}\n  data: [{data}]\n"


def _distortion(fields: Fields) -> Distortion:
    if not fields.has("distortion_coefficients"):
        return Distortion()
    name = fields.text("distortion_model") if fields.has("distortion_model") else "plumb_bob"
    return padded(named_model(name), _array(fields, "distortion_coefficients", None))


def _array(fields: Fields, key: str, length: int | None) -> Array:
    where = fields.path(key)
    inner = keyed(fields.raw(key), where, ("rows", "cols", "data"), ())
    values = [
        number(v, f"{where}.data[{i}]") for i, v in enumerate(items(inner.raw("data"), where))
    ]
    if length is not None and len(values) != length:
        raise DocumentError(f"{where}.data: expected {length} numbers, got {len(values)}")
    return np.array(values)
