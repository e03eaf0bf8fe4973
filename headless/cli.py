# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line: arguments in, one verb run, an exit code out.

0 done; 2 the user's input is at fault (one line on stderr); 3 solved, but not to be trusted.
"""

from __future__ import annotations

import argparse
import importlib
import os
import re
import sys
from collections.abc import Sequence
from typing import Any, NoReturn

from ..core.errors import MonocellError

DONE, INPUT_AT_FAULT, NOT_TRUSTED = 0, 2, 3

# name, what it does; each lives in the module of its name under `verbs`
VERBS = {
    "demo": "the whole job on a synthetic cell, with errors against truth",
    "render": "pictures of a cell through Blender's Cycles, with exact truth beside them",
    "lens": "a camera's intrinsics from pictures of a chessboard or ChArUco board",
    "find": "the ball in a picture: its centre in the camera frame with 1 sigma",
    "calibrate": "ball sightings to the camera's pose",
    "model": "picked pixels to metric objects",
    "propose": "boxes and cylinders that may stand on a plane, for you to accept",
    "map": "pixels to points of a reference plane or line, with their errors",
    "appearance": "colours and textures of the objects, from the picture",
    "export": "the virtual environment as glTF, USD, URDF, SDF, MJCF, OBJ and more",
    "compare": "errors of pose and of every object against the truth",
    "robot": "the robot scene in PyBullet: collision check, path planning, picture",
}


class OneLineParser(argparse.ArgumentParser):
    """argparse with refusals of one line, as all of ours are, that reads -1e-3 as a number."""

    def __init__(self, *args: Any, **options: Any) -> None:
        super().__init__(*args, **options)
        # before Python 3.13 argparse takes a negative number with an exponent for an option
        self._negative_number_matcher = re.compile(r"-\.?\d.*")

    def error(self, message: str) -> NoReturn:
        """What is wrong and where the usage stands; exit 2."""
        told = " ".join(message.split())
        self.exit(INPUT_AT_FAULT, f"{self.prog}: {told}; see {self.prog} --help\n")


def main(argv: Sequence[str] | None = None) -> int:
    """Run one verb; `argv` are the arguments after the program's name. Returns the exit code."""
    arguments = list(sys.argv[1:] if argv is None else argv)
    parser = _parser(arguments)
    try:
        parsed = parser.parse_args(arguments)
    except SystemExit as leave:
        # argparse has said why; a caller inside Blender wants the code, not the exit
        return int(leave.code or 0)
    if parsed.verb is None:
        parser.print_help()
        return DONE
    try:
        return int(parsed.run(parsed))
    except MonocellError as error:
        print(f"monocell {parsed.verb}: {' '.join(str(error).split())}", file=sys.stderr)
        return INPUT_AT_FAULT
    except BrokenPipeError:
        # the reader of a pipe has left; nothing of ours went wrong
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return DONE


def _parser(arguments: Sequence[str]) -> argparse.ArgumentParser:
    from ..core.version import VERSION

    parser = OneLineParser(
        prog="monocell",
        description="One picture and the robot's joint angles in, a metric environment out.",
        epilog="Exit codes: 0 done, 2 the input is at fault, 3 solved but not to be trusted.",
    )
    parser.add_argument("--version", action="version", version=f"monocell {VERSION}")
    parser.set_defaults(verb=None)
    verbs = parser.add_subparsers(title="verbs", metavar="VERB", dest="verb")
    for name, told in VERBS.items():
        verb = verbs.add_parser(name, help=told, description=told[0].upper() + told[1:] + ".")
        # only the verb that is asked for is imported: Blender and PyBullet are slow to load
        if name in arguments:
            module = importlib.import_module(f".verbs.{name}", __package__)
            module.add_arguments(verb)
            verb.set_defaults(run=module.run)
    return parser
