# SPDX-License-Identifier: GPL-3.0-or-later
"""OpenCV FileStorage with the usual names (.yml, .xml, .json): a file to a Camera, and back."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ...arrays import Array
from ...camera import Camera
from ...distortion import Distortion
from ...errors import DocumentError
from ...intrinsics import Intrinsics
from ..fields import Fields
from .coefficients import from_matrix, named_model, padded

MATRIX_NAMES = ("camera_matrix", "Camera_Matrix", "cameraMatrix", "K")
COEFFICIENT_NAMES = ("distortion_coefficients", "Distortion_Coefficients", "distCoeffs", "D")


def camera_from_opencv(file: Path) -> Camera:
    """The camera of a FileStorage. Raises DocumentError."""
    storage = _opened(file)
    sizes = [_node(storage, name) for name in ("image_width", "image_height")]
    matrix = _node(storage, *MATRIX_NAMES)
    if matrix is None or any(node is None for node in sizes):
        raise DocumentError("needs image_width, image_height and camera_matrix")
    width, height = (_whole(node) for node in sizes)
    k = _array(matrix)
    if k.shape != (3, 3):
        raise DocumentError(f"{matrix.name()}: must be 3 x 3, got {k.shape}")
    coefficients = _node(storage, *COEFFICIENT_NAMES)
    if coefficients is None:
        return Camera(from_matrix(width, height, k, Distortion()))
    values = _array(coefficients).ravel()
    model = _model(_node(storage, "distortion_model"), values)
    return Camera(from_matrix(width, height, k, padded(model, values)))


def opencv_text(lens: Intrinsics) -> str:
    """The FileStorage YAML of a lens; every digit reads back."""
    model, coefficients = lens.distortion.model, lens.distortion.coefficients
    if model == "none":
        model, coefficients = "plumb_bob", np.zeros(5)
    return (
        f"%YAML:1.0\n---\nimage_width: {lens.width}\nimage_height: {lens.height}\n"
        f"camera_matrix: {_written(lens.matrix())}"
        f"distortion_model: {model}\n"
        f"distortion_coefficients: {_written(coefficients[None])}"
    )


def is_opencv_matrix(value: Any) -> bool:
    """Whether a parsed JSON value is a matrix as FileStorage writes one."""
    return isinstance(value, dict) and value.get("type_id") == "opencv-matrix"


def _written(matrix: Array) -> str:
    rows, columns = matrix.shape
    data = ", ".join(repr(float(v)) for v in matrix.ravel())
    return f"!!opencv-matrix\n   rows: {rows}\n   cols: {columns}\n   dt: d\n   data: [ {data} ]\n"


def _opened(file: Path) -> Any:
    import cv2

    try:
        return cv2.FileStorage(str(file), cv2.FILE_STORAGE_READ)
    except (cv2.error, SystemError) as error:
        # the binding wraps OpenCV's own error, which ends in `file.yml(3): what is wrong`
        reason = " ".join(str(error.__cause__ or error).split()).rsplit("/", 1)[-1]
        raise DocumentError(f"OpenCV can't read it ({reason.rstrip(chr(39))[:120]})") from None


def _node(storage: Any, *names: str) -> Any:
    found = (storage.getNode(name) for name in names)
    return next((node for node in found if not node.empty()), None)


def _whole(node: Any) -> int:
    value = node.real() if node.isInt() or node.isReal() else node.string()
    return Fields({node.name(): value}, "").whole(node.name())


def _array(node: Any) -> Array:
    import cv2

    try:
        return np.asarray(node.mat(), dtype=float)
    except (cv2.error, SystemError, TypeError):
        raise DocumentError(f"{node.name()}: expected a matrix of numbers") from None


def _model(node: Any, values: Array) -> str:
    if node is None:
        return "plumb_bob" if len(values) <= 5 else "rational_polynomial"
    return named_model(node.string() if node.isString() else "")
