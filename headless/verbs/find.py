# SPDX-License-Identifier: GPL-3.0-or-later
"""`monocell find`: a picture, its camera and the ball's radius in, the ball's centre out."""

from __future__ import annotations

import argparse
from pathlib import Path

from ...core.errors import InvalidValue
from ..cli import DONE, NOT_TRUSTED
from ..find_job import Job, check_together, find_balls, find_in_cell, vote_beside
from ..found import cell_document, cell_told, draw_balls, found_document, told
from ..told import print_json, warn

METHODS = ("outline", "vote")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's own arguments."""
    parser.add_argument(
        "picture",
        type=Path,
        help="a picture as the camera gave it; or a cell document, all of whose sightings are "
        "looked for, where the camera's pose puts them if it has one",
    )
    parser.add_argument("--camera", type=Path, help="camera file or cell document")
    parser.add_argument("--radius", type=float, help="the ball's radius in metres")
    parser.add_argument(
        "--window",
        type=float,
        nargs=4,
        metavar=("X", "Y", "W", "H"),
        help="where the whole ball is, in pixels; the whole picture without it",
    )
    _add_hints(parser)
    _add_prediction(parser)
    parser.add_argument(
        "--method",
        choices=METHODS,
        default=METHODS[0],
        help="vote: also the baseline, a vote of edge points for the three numbers of the centre",
    )
    parser.add_argument("--overlay", type=Path, help="write the picture with the outline on it")
    parser.add_argument("--json", action="store_true", help="print JSON")


def run(args: argparse.Namespace) -> int:
    """Find the balls, print them, draw them."""
    check_together(args)
    return _run_cell(args) if args.picture.suffix.lower() == ".json" else _run_picture(args)


def _run_picture(args: argparse.Namespace) -> int:
    if args.overlay is not None and args.overlay.resolve() == args.picture.resolve():
        raise InvalidValue(f"{args.overlay}: the overlay would replace the picture; name another")
    job = Job.of(args)
    balls = find_balls(job, args.count)
    vote = vote_beside(job, balls[0]) if args.method == "vote" else None
    if args.overlay is not None:
        draw_balls(args.overlay, job.picture, job.camera.intrinsics, balls)
    if args.json:
        print_json(found_document(balls, args.count is None, vote))
    else:
        print(told(balls, vote))
    for ball in balls:
        warn((*ball.warnings, *job.doubts(ball)))
    if args.count not in (None, "all") and len(balls) < args.count:
        warn([f"{len(balls)} of {args.count} balls were found"])
        return NOT_TRUSTED
    return DONE


def _run_cell(args: argparse.Namespace) -> int:
    found = find_in_cell(args)
    if args.json:
        print_json(cell_document(found))
    else:
        print(cell_told(found))
    for seen in found:
        warn([f"{seen.sighting.picture}: {told}" for told in seen.warnings])
    return DONE if all(seen.ball is not None for seen in found) else NOT_TRUSTED


def _add_hints(parser: argparse.ArgumentParser) -> None:
    hints = parser.add_argument_group("what is known of the ball")
    hints.add_argument(
        "--rough-radius", type=float, metavar="PX", help="its radius in the picture, in pixels"
    )
    hints.add_argument(
        "--color",
        nargs="+",
        metavar="NAME",
        help="its colour, by name or as R G B from 0 to 255; weighs what is found",
    )
    hints.add_argument(
        "--background",
        type=Path,
        metavar="PICTURE",
        help="another picture of the same fixed camera: empty, or with the ball elsewhere",
    )
    hints.add_argument("--count", type=_count, metavar="N", help="how many balls there are, or all")
    hints.add_argument(
        "--linear", action="store_true", help="the pixels are amounts of light, as raw ones are"
    )


def _add_prediction(parser: argparse.ArgumentParser) -> None:
    where = parser.add_argument_group("where the ball should be, instead of a window")
    where.add_argument(
        "--near-pose",
        type=Path,
        metavar="CELL",
        help="a cell whose camera's pose is nearly right; the ball's place is --center, that of "
        "--joints, or the one its sighting of this picture states",
    )
    where.add_argument(
        "--within", type=float, metavar="MM", help="how far the ball may be from there (50 mm)"
    )
    where.add_argument(
        "--center", type=float, nargs=3, metavar=("X", "Y", "Z"), help="in the world, metres"
    )
    where.add_argument(
        "--joints", type=float, nargs="+", metavar="Q", help="the arm's joint angles, radians"
    )
    where.add_argument("--urdf", type=Path, help="the arm (default: KUKA LBR iiwa from PyBullet)")
    where.add_argument("--flange", help="the URDF link that is the flange (default: the last)")
    where.add_argument(
        "--offset",
        type=float,
        nargs=3,
        metavar=("X", "Y", "Z"),
        help="the ball's centre in the flange, metres (default 0 0 0)",
    )


def _count(text: str) -> int | str:
    if text == "all":
        return text
    if not text.isdigit() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"{text!r} is neither a number above zero nor all")
    return int(text)
