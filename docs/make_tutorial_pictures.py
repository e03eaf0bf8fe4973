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
from monocell.core.comparison import compare_cells
from monocell.core.document.cell_file import read_cell
from monocell.headless.verbs.compare import told
from sample_hand import SAMPLE, Hand

ROOT = Path(__file__).resolve().parents[1]
PICTURES = ROOT / "docs" / "pictures"
WIDTH, LARGEST_BYTES = 900, 90_000
# the part of the window that a step is about: left, top, right, bottom
PARTS = {
    "start": (0, 0, 1600, 1000),
    "sample": (0, 0, 1600, 1000),
    "calibrated": (260, 0, 1600, 960),
    "box": (0, 100, 1320, 925),
    "face": (0, 100, 1320, 925),
    "cylinder": (0, 100, 1320, 925),
    "typed": (0, 100, 1320, 925),
    "drawn": (260, 60, 1600, 980),
    "review": (0, 100, 1320, 1000),
    "aligned": (260, 60, 1600, 980),
    "side": (340, 270, 1140, 810),
}
# how far a size may be off once aligned, metres
SIZE_TOLERANCE = 1e-3
DRAWN = ("carton", "can", "block")


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
    # a careful hand: no error but the screen's pixels
    job = Hand(0.0, 0).job() | {"out": str(folder)}
    (folder / "job.json").write_text(json.dumps(job))
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


def _check(folder: Path) -> None:
    truth = read_cell(SAMPLE / "truth.cell.json")
    for stage in ("drawn", "aligned"):
        comparison = compare_cells(truth, read_cell(folder / f"{stage}.cell.json"))
        print(f"{stage}\n{told(comparison)}")
    off = {error.name: float(np.abs(error.sizes).max()) for error in comparison.objects}
    far = [f"{name} {1e3 * off[name]:.2f} mm" for name in DRAWN if off[name] > SIZE_TOLERANCE]
    if far:
        sys.exit(f"sizes off by more than {1e3 * SIZE_TOLERANCE:g} mm: {', '.join(far)}")


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
