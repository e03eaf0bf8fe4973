# SPDX-License-Identifier: GPL-3.0-or-later
"""`monocell compare`: a true and an estimated cell in, every error beside its sigma out."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from ...core.comparison import Comparison, ObjectError, compare_cells
from ...core.document.cell_file import read_cell
from ..told import print_json, table, warn


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's own arguments."""
    parser.add_argument("truth", type=Path, help="cell document that holds the truth")
    parser.add_argument("cell", type=Path, help="cell document that was estimated")
    parser.add_argument("--json", action="store_true", help="print JSON")


def run(args: argparse.Namespace) -> int:
    """Compare and tell."""
    comparison = compare_cells(read_cell(args.truth), read_cell(args.cell))
    if args.json:
        print_json(document(comparison))
    else:
        print(told(comparison))
    warn([*_one_sided(comparison), *comparison.warnings])
    return 0


def told(comparison: Comparison) -> str:
    """A table: error and stated 1 sigma, millimetres and degrees."""
    rows = [] if comparison.pose is None else list(_pose_rows(comparison))
    for error in comparison.objects:
        rows += _object_rows(error)
    return table(("what", "of it", "error mm", "1 sigma"), rows)


def document(comparison: Comparison) -> dict[str, Any]:
    """The whole comparison as JSON values, metres and radians."""
    pose = comparison.pose
    return {
        "pose": None if pose is None else vars(pose),
        "objects": [vars(error) | {"size_names": error.size_names} for error in comparison.objects],
        "missing": comparison.missing,
        "surplus": comparison.surplus,
        "warnings": comparison.warnings,
    }


def _pose_rows(comparison: Comparison) -> list[tuple[str, ...]]:
    pose = comparison.pose
    assert pose is not None
    sigma = None if pose.rotation_sigma is None else float(np.linalg.norm(pose.rotation_sigma))
    return [
        ("camera", "position", *_length(pose.centre, pose.centre_sigma)),
        ("", "rotation", *_degrees(float(np.linalg.norm(pose.rotation)), sigma)),
    ]


def _object_rows(error: ObjectError) -> Iterator[tuple[str, ...]]:
    yield error.name, "position", *_length(error.position, error.position_sigma)
    for i, name in enumerate(error.size_names):
        sigma = None if error.size_sigma is None else error.size_sigma[i]
        stated = "-" if sigma is None else f"{1e3 * sigma:.2f}"
        told = name.removeprefix("size_").replace("_", " ")
        yield "", f"{told} of {1e3 * error.true_sizes[i]:.1f}", _signed(error.sizes[i]), stated
    if error.corners is not None:
        yield "", "worst corner", f"{1e3 * error.corners.max():.2f}", "-"
    if error.rotation is not None:
        yield "", "rotation", *_degrees(error.rotation, error.rotation_sigma)
    elif error.kind != "sphere":
        yield "", "tilt", *_degrees(error.tilt, error.tilt_sigma)


def _degrees(angle: float, sigma: float | None) -> tuple[str, str]:
    stated = "-" if sigma is None else f"{np.degrees(sigma):.4f} deg"
    return f"{np.degrees(angle):.4f} deg", stated


def _length(error: Any, sigma: Any) -> tuple[str, str]:
    stated = "-" if sigma is None else f"{1e3 * np.linalg.norm(sigma):.2f}"
    return f"{1e3 * np.linalg.norm(error):.2f}", stated


def _signed(error: float) -> str:
    return f"{1e3 * error:+.2f}"


def _one_sided(comparison: Comparison) -> list[str]:
    return [f"{name} of the truth is not in the cell" for name in comparison.missing] + [
        f"{name} of the cell is not in the truth" for name in comparison.surplus
    ]
