# SPDX-License-Identifier: GPL-3.0-or-later
"""The wheels that the extension brings along: the manifest in, the files in `wheels/`."""

import subprocess
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
WHEELS = ROOT / "wheels"


def fetch_wheels():
    """Download those that are not there yet; what went wrong, empty where all are there."""
    manifest = tomllib.loads((ROOT / "blender_manifest.toml").read_text())
    missing = [Path(wheel).name for wheel in manifest["wheels"] if not (ROOT / wheel).is_file()]
    if not missing:
        return ""
    named = ["==".join(wheel.split("-")[:2]) for wheel in missing]
    options = (
        "--quiet --no-deps --only-binary=:all: --python-version 3.13 --abi abi3 --abi none "
        "--platform manylinux2014_x86_64 --platform any"
    )
    fetched = subprocess.run(
        [sys.executable, "-m", "pip", "download", *options.split(), "--dest", WHEELS, *named],
        capture_output=True,
        text=True,
        check=False,
    )
    there = fetched.returncode == 0 and all((WHEELS / wheel).is_file() for wheel in missing)
    return "" if there else f"the wheels can't be fetched: {fetched.stderr.strip()[-300:]}"
