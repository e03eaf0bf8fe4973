# SPDX-License-Identifier: GPL-3.0-or-later
"""Camera files to a Camera, told by their content, and back: a file a format in `cameras`."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from ..atomic import atomic_path
from ..camera import Camera
from ..errors import DocumentError, InvalidValue
from ..intrinsics import Intrinsics
from .cameras.colmap import camera_from_colmap, is_colmap
from .cameras.fspy import camera_from_fspy, is_fspy
from .cameras.kalibr import camera_from_kalibr, is_kalibr
from .cameras.nerfstudio import camera_from_nerfstudio, is_nerfstudio
from .cameras.opencv import camera_from_opencv, is_opencv_matrix, opencv_text
from .cameras.ros import camera_from_ros, ros_text
from .cameras.visp import camera_from_visp, is_visp
from .entries import camera_entry, camera_from_entry
from .json_text import dumped, parse_json

FORMS = (
    "monocell JSON, ROS camera_info YAML, OpenCV FileStorage (.yml, .xml, .json), Kalibr camchain, "
    "COLMAP cameras.txt, fSpy JSON, ViSP XML, nerfstudio transforms.json"
)
# a picture given by mistake is not read to its end
LONGEST = 1 << 24
WRITERS: dict[str, Callable[[Intrinsics], str]] = {"ros": ros_text, "opencv": opencv_text}
ENDINGS = {".json": "json", ".yaml": "ros", ".yml": "opencv"}


def read_camera(path: str | Path) -> Camera:
    """Read a camera file, told by what is in it. Raises DocumentError naming file and field."""
    file = Path(path)
    try:
        if file.suffix.lower() == ".json":
            return _from_json(file)
        return _from_text(file, _text(file))
    except (DocumentError, InvalidValue) as error:
        if str(error).startswith(str(file)):
            raise
        raise DocumentError(f"{file}: {error}") from None


def write_camera(camera: Camera, path: str | Path, form: str | None = None) -> None:
    """Write a camera file whole or not at all, in every digit.

    `form` is `json` (ours), `ros` (camera_info YAML) or `opencv` (FileStorage YAML); without it the
    ending tells: .json, .yaml for ROS, .yml for OpenCV. Raises DocumentError for another ending,
    and for a pose in a form that has no place for it.
    """
    file = Path(path)
    form = check_camera_path(file, form)
    if form == "json":
        text = dumped(camera_entry(camera))
    elif camera.camera_from_world is not None:
        raise DocumentError(f"{file}: a {form} camera file can't hold the pose; write .json")
    else:
        text = WRITERS[form](camera.intrinsics)
    with atomic_path(file) as temporary:
        temporary.write_text(text, encoding="utf-8")


def check_camera_path(path: str | Path, form: str | None = None) -> str:
    """The form in which a camera is written to `path`. Raises DocumentError."""
    file = Path(path)
    if form is None:
        form = ENDINGS.get(file.suffix.lower())
        if form is None:
            raise DocumentError(
                f"{file}: a camera file ends in .json (monocell), .yaml (ROS) or .yml (OpenCV)"
            )
    if form not in ENDINGS.values():
        raise DocumentError(f"{form!r} is no form of a camera file: json, ros or opencv")
    # a JSON document is told by its ending when it is read
    if (form == "json") != (file.suffix.lower() == ".json"):
        raise DocumentError(f"{file}: a camera file of the form {form} can't end like this")
    return form


def _from_json(file: Path) -> Camera:
    document = parse_json(file)
    if isinstance(document, dict) and any(is_opencv_matrix(v) for v in document.values()):
        return camera_from_opencv(file)
    if isinstance(document, dict) and "monocell" in document:
        return camera_from_entry(document.get("camera"))
    if isinstance(document, dict) and "board" in document and "camera" in document:
        return _of_lens_report(document)
    if is_fspy(document):
        return camera_from_fspy(document)
    if is_nerfstudio(document):
        return camera_from_nerfstudio(document)
    return camera_from_entry(document, "")


def _of_lens_report(document: dict[str, Any]) -> Camera:
    """The camera in what `monocell lens --json` told, unless it told not to believe it."""
    if document.get("verdict") == "failed":
        raise DocumentError("verdict: this calibration of the lens failed; take better pictures")
    return camera_from_entry(document["camera"])


def _from_text(file: Path, text: str) -> Camera:
    start = text[:200]
    if start.startswith("<") and is_visp(text):
        return camera_from_visp(text)
    if start.startswith(("%YAML:1.0", "<?xml")) or "<opencv" in start:
        return camera_from_opencv(file)
    if is_colmap(text):
        return camera_from_colmap(text)
    document = _parse_yaml(file, text)
    if is_kalibr(document):
        return camera_from_kalibr(document)
    if not isinstance(document, dict):
        raise DocumentError(f"is none of {FORMS}")
    return camera_from_ros(document)


def _text(file: Path) -> str:
    try:
        with file.open("rb") as stream:
            data = stream.read(LONGEST)
    except FileNotFoundError:
        raise DocumentError(f"{file}: there is no such camera file") from None
    except OSError as error:
        raise DocumentError(f"{file}: can't be read ({error.strerror})") from None
    return data.decode("utf-8", errors="replace").lstrip("\ufeff \n\r\t")


def _parse_yaml(file: Path, text: str) -> Any:
    from ruamel.yaml import YAML
    from ruamel.yaml.error import YAMLError

    if "\ufffd" in text or "\0" in text:
        raise DocumentError(f"{file}: is none of {FORMS} (not a text file)")
    try:
        return YAML(typ="safe", pure=True).load(text)
    except YAMLError as error:
        reason = " ".join(str(error).split())[:120]
        raise DocumentError(f"{file}: is none of {FORMS} ({reason})") from None
