# SPDX-License-Identifier: GPL-3.0-or-later
"""Camera files to a Camera: our own JSON, ROS camera_info YAML, OpenCV FileStorage, by content."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ..arrays import Array
from ..camera import Camera
from ..distortion import COEFFICIENTS, Distortion
from ..errors import DocumentError, InvalidValue
from ..intrinsics import Intrinsics
from .entries import camera_from_entry
from .fields import Fields, items, keyed, number
from .json_text import parse_json

# what the ROS message and calibration tools write beside what is read here
ROS_KEYS = ("camera_name", "rectification_matrix", "projection_matrix", "header", "binning_x")
ROS_MORE = ("binning_y", "roi")
ROS_MODELS = {
    "plumb_bob": "plumb_bob",
    "rational_polynomial": "rational_polynomial",
    "equidistant": "equidistant",
    "fisheye": "equidistant",
}
MATRIX_NAMES = ("camera_matrix", "Camera_Matrix", "cameraMatrix", "K")
COEFFICIENT_NAMES = ("distortion_coefficients", "Distortion_Coefficients", "distCoeffs", "D")
FORMS = "monocell JSON, ROS camera_info YAML or OpenCV FileStorage (.yml, .xml, .json)"


def read_camera(path: str | Path) -> Camera:
    """Read a camera file, told by what is in it. Raises DocumentError naming file and field."""
    file = Path(path)
    try:
        if file.suffix.lower() == ".json":
            return _from_json(file)
        start = _beginning(file)
        if start.startswith(("%YAML:1.0", "<?xml")) or "<opencv" in start:
            return _from_opencv(file)
        return _from_ros(_parse_yaml(file))
    except (DocumentError, InvalidValue) as error:
        if str(error).startswith(str(file)):
            raise
        raise DocumentError(f"{file}: {error}") from None


def _from_json(file: Path) -> Camera:
    document = parse_json(file)
    if isinstance(document, dict) and any(_is_opencv_matrix(v) for v in document.values()):
        return _from_opencv(file)
    if isinstance(document, dict) and "monocell" in document:
        return camera_from_entry(document.get("camera"))
    return camera_from_entry(document, "")


def _is_opencv_matrix(value: Any) -> bool:
    return isinstance(value, dict) and value.get("type_id") == "opencv-matrix"


def _beginning(file: Path) -> str:
    try:
        with file.open("rb") as stream:
            return stream.read(200).decode("utf-8", errors="replace").lstrip("\ufeff \n\r\t")
    except FileNotFoundError:
        raise DocumentError(f"{file}: there is no such camera file") from None
    except OSError as error:
        raise DocumentError(f"{file}: can't be read ({error.strerror})") from None


def _parse_yaml(file: Path) -> Any:
    from ruamel.yaml import YAML
    from ruamel.yaml.error import YAMLError

    try:
        return YAML(typ="safe", pure=True).load(file.read_text(encoding="utf-8"))
    except (YAMLError, UnicodeDecodeError) as error:
        reason = " ".join(str(error).split())[:120]
        raise DocumentError(f"{file}: is none of {FORMS} ({reason})") from None


def _from_ros(document: Any) -> Camera:
    """ROS camera_info, as camera_calibration_parsers writes it."""
    required = ("image_width", "image_height", "camera_matrix")
    optional = ("distortion_model", "distortion_coefficients", *ROS_KEYS, *ROS_MORE)
    if not isinstance(document, dict):
        raise DocumentError(f"is none of {FORMS}")
    fields = keyed(document, "", required, optional)
    k = _ros_array(fields, "camera_matrix", 9).reshape(3, 3)
    width, height = fields.whole("image_width"), fields.whole("image_height")
    return Camera(_intrinsics(width, height, k, _ros_distortion(fields)))


def _ros_distortion(fields: Fields) -> Distortion:
    if not fields.has("distortion_coefficients"):
        return Distortion()
    name = fields.text("distortion_model") if fields.has("distortion_model") else "plumb_bob"
    return _padded(_ros_model(name), _ros_array(fields, "distortion_coefficients", None))


def _ros_model(name: str) -> str:
    if name not in ROS_MODELS:
        known = ", ".join(ROS_MODELS)
        raise DocumentError(f"distortion_model: {name!r} is none of {known}")
    return ROS_MODELS[name]


def _ros_array(fields: Fields, key: str, length: int | None) -> Array:
    where = fields.path(key)
    inner = keyed(fields.raw(key), where, ("rows", "cols", "data"), ())
    values = [
        number(v, f"{where}.data[{i}]") for i, v in enumerate(items(inner.raw("data"), where))
    ]
    if length is not None and len(values) != length:
        raise DocumentError(f"{where}.data: expected {length} numbers, got {len(values)}")
    return np.array(values)


def _from_opencv(file: Path) -> Camera:
    """OpenCV FileStorage with the usual names: camera_matrix, distortion_coefficients, ..."""
    storage = _opened(file)
    sizes = [_node(storage, name) for name in ("image_width", "image_height")]
    matrix = _node(storage, *MATRIX_NAMES)
    if matrix is None or any(node is None for node in sizes):
        raise DocumentError("needs image_width, image_height and camera_matrix")
    width, height = (_opencv_whole(node) for node in sizes)
    k = _opencv_array(matrix)
    if k.shape != (3, 3):
        raise DocumentError(f"{matrix.name()}: must be 3 x 3, got {k.shape}")
    coefficients = _node(storage, *COEFFICIENT_NAMES)
    if coefficients is None:
        return Camera(_intrinsics(width, height, k, Distortion()))
    values = _opencv_array(coefficients).ravel()
    model = _opencv_model(_node(storage, "distortion_model"), values)
    return Camera(_intrinsics(width, height, k, _padded(model, values)))


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


def _opencv_whole(node: Any) -> int:
    value = node.real() if node.isInt() or node.isReal() else node.string()
    return Fields({node.name(): value}, "").whole(node.name())


def _opencv_array(node: Any) -> Array:
    import cv2

    try:
        return np.asarray(node.mat(), dtype=float)
    except (cv2.error, SystemError, TypeError):
        raise DocumentError(f"{node.name()}: expected a matrix of numbers") from None


def _opencv_model(node: Any, values: Array) -> str:
    if node is None:
        return "plumb_bob" if len(values) <= 5 else "rational_polynomial"
    return _ros_model(node.string() if node.isString() else "")


def _padded(model: str, values: Array) -> Distortion:
    """Files often leave out trailing zeros, or write more zeros than the model has."""
    wanted = COEFFICIENTS[model]
    if np.any(values[wanted:]):
        raise DocumentError(
            f"distortion_coefficients: {len(values)} numbers, but {model} has {wanted}; "
            "thin-prism and tilt terms are not supported"
        )
    kept = np.zeros(wanted)
    kept[: min(wanted, len(values))] = values[:wanted]
    return (
        Distortion("none") if not kept.any() and model != "equidistant" else Distortion(model, kept)
    )


def _intrinsics(width: int, height: int, k: Array, distortion: Distortion) -> Intrinsics:
    if abs(k[0, 1]) > 1e-6 * abs(k[0, 0]):
        raise DocumentError(f"camera_matrix: a skew of {k[0, 1]:g} px is not supported")
    return Intrinsics(width, height, k[0, 0], k[1, 1], k[0, 2], k[1, 2], distortion)
