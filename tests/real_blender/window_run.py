# SPDX-License-Identifier: GPL-3.0-or-later
"""A script of steps and what it works on in; run in a Blender with a window, what it found out."""

import json
import os
import shutil
import subprocess
from pathlib import Path

import pytest


def in_window(blender, folder, steps, job, timeout=600, size=(1600, 1000)):
    """Run a script of steps in the window; the folder, what it found, and the finished process.

    MONOCELL_SCREENSHOTS names a folder that the screenshots are kept in.
    """
    (folder / "job.json").write_text(json.dumps(job | {"out": str(folder)}))
    script = Path(__file__).with_name(steps)
    try:
        run = blender.run(
            *("--enable-event-simulate", "--window-geometry", 0, 0, *size),
            *("--python", script, "--", folder / "job.json"),
            timeout=timeout,
        )
    except subprocess.TimeoutExpired as late:
        pytest.fail(f"the window never finished: {late.stdout}")
    kept = os.environ.get("MONOCELL_SCREENSHOTS")
    if kept:
        place = Path(kept) / folder.name
        place.mkdir(parents=True, exist_ok=True)
        for picture in folder.glob("[0-9]_*.png"):
            shutil.copy(picture, place)
    assert (folder / "found.json").is_file(), run.stdout + run.stderr
    return folder, json.loads((folder / "found.json").read_text()), run
