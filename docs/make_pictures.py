# SPDX-License-Identifier: GPL-3.0-or-later
"""The demo's files in, the pictures of README and docs out: `python docs/make_pictures.py DEMO`."""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path

import cv2
from monocell.headless.cli import main as monocell

PICTURES = ("overlay", "sightings", "other_side", "robot")
QUALITY = 88
WIDTH = 960
HERE = Path(__file__).parent / "pictures"
SAMPLE = Path(__file__).parents[1] / "samples" / "01_table" / "table.cell.json"


def main() -> None:
    """Encode each picture as JPEG beside this script."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("demo", type=Path, help="folder that monocell demo wrote")
    args = parser.parse_args()
    HERE.mkdir(exist_ok=True)
    for name in PICTURES:
        _encode(args.demo / f"{name}.png", name)
    with tempfile.TemporaryDirectory() as folder:
        sigma_map = Path(folder) / "sigma.png"
        monocell(["calibrate", str(SAMPLE), "--sigma-map", str(sigma_map)])
        _encode(sigma_map, "sigma_map")


def _encode(picture: Path, name: str) -> None:
    large = cv2.imread(str(picture))
    size = (WIDTH, round(WIDTH * large.shape[0] / large.shape[1]))
    small = cv2.resize(large, size, interpolation=cv2.INTER_AREA)
    cv2.imwrite(str(HERE / f"{name}.jpg"), small, [cv2.IMWRITE_JPEG_QUALITY, QUALITY])


if __name__ == "__main__":
    main()
