# SPDX-License-Identifier: GPL-3.0-or-later
"""The demo's files in, the pictures of README and docs out: `python docs/make_pictures.py DEMO`."""

from __future__ import annotations

import argparse
from pathlib import Path

import cv2

PICTURES = ("overlay", "sightings", "other_side", "robot")
QUALITY = 88
HERE = Path(__file__).parent / "pictures"


def main() -> None:
    """Encode each picture as JPEG beside this script."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("demo", type=Path, help="folder that monocell demo wrote")
    args = parser.parse_args()
    HERE.mkdir(exist_ok=True)
    for name in PICTURES:
        picture = cv2.imread(str(args.demo / f"{name}.png"))
        small = cv2.resize(picture, (960, 720), interpolation=cv2.INTER_AREA)
        cv2.imwrite(str(HERE / f"{name}.jpg"), small, [cv2.IMWRITE_JPEG_QUALITY, QUALITY])


if __name__ == "__main__":
    main()
