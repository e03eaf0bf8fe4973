# SPDX-License-Identifier: GPL-3.0-or-later
"""PyBullet, quietly: the module and worlds of its own, without its chatter."""

from __future__ import annotations

import ctypes
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np

from ...core.errors import MissingPackage
from ...core.pose import Pose


def pybullet() -> Any:
    """The pybullet module. Raises MissingPackage when it is not installed."""
    with chatter_off():
        try:
            import pybullet as module
        except ImportError:
            raise MissingPackage(
                "pybullet is not installed; install it with: pip install 'monocell[robot]'"
            ) from None
    return module


@contextmanager
def chatter_off() -> Iterator[None]:
    """Drop what C code prints on standard output and standard error.

    PyBullet prints a banner on import and lines of its own on loading, past Python's `sys.stdout`;
    what went wrong is told by our own errors, in one line.
    """
    sys.stdout.flush()
    sys.stderr.flush()
    kept = os.dup(1), os.dup(2)
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    os.dup2(nowhere, 2)
    try:
        yield
    finally:
        # C keeps its own buffer: empty it while it still leads nowhere
        ctypes.CDLL("ucrtbase" if os.name == "nt" else None).fflush(None)
        os.dup2(kept[0], 1)
        os.dup2(kept[1], 2)
        for handle in (*kept, nowhere):
            os.close(handle)


def pose_of(position: tuple[float, ...], quaternion_xyzw: tuple[float, ...]) -> Pose:
    """Bullet's position and quaternion (x, y, z, w) as a Pose."""
    x, y, z, w = np.asarray(quaternion_xyzw, dtype=float) / np.linalg.norm(quaternion_xyzw)
    rotation = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    return Pose(np.array(rotation), np.array(position, dtype=float))


def position_and_quaternion(pose: Pose) -> tuple[list[float], list[float]]:
    """A Pose as Bullet's position and quaternion (x, y, z, w)."""
    vector = pose.rotation_vector()
    half = float(np.linalg.norm(vector)) / 2
    # sinc keeps the quaternion exact down to no rotation at all
    xyz = vector / 2 * np.sinc(half / np.pi)
    return pose.translation.tolist(), [*xyz.tolist(), float(np.cos(half))]
