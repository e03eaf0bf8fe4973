# SPDX-License-Identifier: GPL-3.0-or-later
"""The tutorial followed in a real window, its pictures out.

    MONOCELL_BLENDER_WINDOW="..." python docs/make_tutorial_pictures.py FOLDER

The variable is the command that starts a Blender with a window, as for the tests; FOLDER keeps what
came of it. What was clicked has to come out near the truth, or no picture is written.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from pathlib import Path

import cv2
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests" / "real_blender"))
import conftest
from monocell.core.document.cell_file import read_cell

ROOT = Path(__file__).resolve().parents[1]
PICTURES = ROOT / "docs" / "pictures"
SAMPLE = ROOT / "samples" / "01_table"
WIDTH, LARGEST_BYTES = 900, 90_000
# the part of the window that a step is about: left, top, right, bottom
PARTS = {
    "start": (0, 0, 1600, 1000),
    "sample": (0, 0, 1600, 1000),
    "calibrated": (260, 0, 1600, 960),
    "box": (0, 230, 1250, 1000),
    "cylinder": (230, 230, 1190, 900),
    "solved": (260, 60, 1600, 980),
    "face": (0, 430, 950, 1000),
    "aligned": (260, 60, 1600, 980),
    "side": (340, 270, 1140, 810),
}
# corners of a box in order round its base
ROUND = (0, 1, 3, 2)
# names in the tutorial and in the truth, and how far a size may be off once aligned, metres
FOLLOWED = {"box": "crate", "cylinder": "drum"}
SIZE_TOLERANCE = 2e-3


def main() -> None:
    """Follow the tutorial, hold the result against the truth, write its pictures."""
    commands = conftest.window_commands()
    if not commands:
        sys.exit("no window: set MONOCELL_BLENDER_WINDOW to a command that starts Blender in one")
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else tempfile.mkdtemp()).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    _follow(_blender(commands[0], folder), folder)
    _check(folder)
    _robot(folder)
    for shown, part in PARTS.items():
        _write(shown, cv2.imread(str(folder / f"{shown}.png")), part)
    robot = cv2.imread(str(folder / "robot.png"))
    _write("robot", robot, (0, 0, robot.shape[1], robot.shape[0]))


def _follow(blender: conftest.Blender, folder: Path) -> None:
    """The tutorial's steps; what the window shows and saves lies in the folder."""
    (folder / "job.json").write_text(json.dumps(_job() | {"out": str(folder)}))
    (folder / "found.json").unlink(missing_ok=True)
    run = blender.run(
        *("--enable-event-simulate", "--window-geometry", 0, 0, 1600, 1000),
        *("--python", Path(__file__).with_name("tutorial_steps.py"), "--", folder / "job.json"),
        timeout=900,
    )
    told = folder / "found.json"
    found = json.loads(told.read_text()) if told.is_file() else {"error": "no end was reached"}
    if "error" in found or found["left_over"] or "Traceback" in run.stdout + run.stderr:
        sys.exit(f"{found.get('error', '')}\n{run.stdout}\n{run.stderr}")


def _blender(command: tuple[str, ...], folder: Path) -> conftest.Blender:
    """The Blender with the extension built and installed as a user does it."""
    conftest.fetch_wheels()
    zipped = folder / "monocell.zip"
    builder = conftest.Blender(command, folder / "builder")
    builder.resources.mkdir(exist_ok=True)
    build = ("--command", "extension", "build", "--source-dir", ROOT, "--output-filepath", zipped)
    builder.run(*build)
    resources = folder / "settings"
    resources.mkdir(exist_ok=True)
    return conftest.installed(command, zipped, resources)


def _job() -> dict[str, object]:
    """Where a careful hand clicks: pixels of the undistorted view."""
    truth = read_cell(SAMPLE / "truth.cell.json")
    things = {thing.name: thing for thing in truth.objects}
    camera, pinhole = truth.camera, truth.camera.intrinsics.undistorted()
    # the three corners of the foot that are seen, and the front one's above it
    corners = things["crate"].corners_world()
    seen = _view(camera, corners[:4])
    front = int(np.argmax(seen[:, 1]))
    at = ROUND.index(front)
    ring = [ROUND[(at + step) % 4] for step in (-1, 0, 1)]
    drum = things["drum"]
    eye = camera.centre_world - drum.world_from_object.translation
    at = np.arctan2(eye[1], eye[0]) + np.array([-1.25, 0.0, 1.25])
    rim = drum.radius * np.stack([np.cos(at), np.sin(at)], axis=1)
    foot = drum.world_from_object.apply(np.column_stack([rim, np.full(3, -drum.height / 2)]))
    return {
        "width": pinhole.width,
        "height": pinhole.height,
        "box": _view(camera, corners[[*ring, front + 4]]).tolist(),
        "cylinder": _view(camera, foot).tolist(),
        "aside": (_view(camera, foot)[1] + [-54, 110]).tolist(),
        "zoom_at": _view(camera, corners[[ring[2]]])[0].tolist(),
        "face": _view(camera, corners[4:].mean(axis=0)[None])[0].tolist(),
    }


def _view(camera, points):
    inner = camera.intrinsics
    return inner.undistorted().project(inner.rays(camera.project(points)))


def _check(folder: Path) -> None:
    truth = {thing.name: thing for thing in read_cell(SAMPLE / "truth.cell.json").objects}
    made = {thing.name: thing for thing in read_cell(folder / "aligned.cell.json").objects}
    for name, true_name in FOLLOWED.items():
        sizes, true_sizes = (np.sort(thing.sizes) for thing in (made[name], truth[true_name]))
        off = float(np.abs(sizes - true_sizes).max())
        print(f"{name}: sizes off by {off * 1e3:.2f} mm at most")
        if off > SIZE_TOLERANCE:
            sys.exit(f"{name} came out as {sizes * 1e3} mm, in truth {true_sizes * 1e3}")


def _robot(folder: Path) -> None:
    command = [sys.executable, "-m", "monocell.headless", "robot", folder / "environment.glb"]
    subprocess.run([*command, "--picture", folder / "robot.png"], check=True)


def _write(name: str, picture, part: tuple[int, int, int, int]) -> None:
    left, top, right, bottom = part
    cut = picture[top:bottom, left:right]
    size = (WIDTH, round(cut.shape[0] * WIDTH / cut.shape[1]))
    small = cv2.resize(cut, size, interpolation=cv2.INTER_AREA)
    for quality in range(92, 40, -4):
        _, coded = cv2.imencode(".jpg", small, [cv2.IMWRITE_JPEG_QUALITY, quality])
        if len(coded) <= LARGEST_BYTES:
            break
    (PICTURES / f"tutorial_{name}.jpg").write_bytes(coded.tobytes())
    print(json.dumps({"picture": name, "size": size, "bytes": len(coded), "quality": quality}))


if __name__ == "__main__":
    main()
