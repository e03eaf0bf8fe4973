# SPDX-License-Identifier: GPL-3.0-or-later
"""`monocell compare`: a true and an estimated cell in, every error beside its sigma out."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import numpy as np

from ...core.comparison import Comparison, compare_cells
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
    warn(_one_sided(comparison))
    return 0


def told(comparison: Comparison) -> str:
    """A table: error and stated 1 sigma, millimetres and degrees."""
    rows = [] if comparison.pose is None else list(_pose_rows(comparison))
    for error in comparison.objects:
        rows.append((error.name, "position", *_length(error.position, error.position_sigma)))
        names = ("x", "y", "z") if error.kind == "box" else ("radius", "height")
        for i, name in enumerate(names):
            sigma = None if error.size_sigma is None else error.size_sigma[i]
            stated = "-" if sigma is None else f"{1e3 * sigma:.2f}"
            rows.append(
                ("", f"{name} of {1e3 * error.true_sizes[i]:.1f}", _signed(error.sizes[i]), stated)
            )
    return table(("what", "of it", "error mm", "1 sigma"), rows)


def document(comparison: Comparison) -> dict[str, Any]:
    """The whole comparison as JSON values, metres and radians."""
    pose = comparison.pose
    return {
        "pose": None if pose is None else vars(pose),
        "objects": [vars(error) for error in comparison.objects],
        "missing": comparison.missing,
        "surplus": comparison.surplus,
    }


def _pose_rows(comparison: Comparison) -> list[tuple[str, ...]]:
    pose = comparison.pose
    assert pose is not None
    degrees = np.degrees(np.linalg.norm(pose.rotation))
    stated = "-"
    if pose.rotation_sigma is not None:
        stated = f"{np.degrees(np.linalg.norm(pose.rotation_sigma)):.4f} deg"
    return [
        ("camera", "position", *_length(pose.centre, pose.centre_sigma)),
        ("", "rotation", f"{degrees:.4f} deg", stated),
    ]


def _length(error: Any, sigma: Any) -> tuple[str, str]:
    stated = "-" if sigma is None else f"{1e3 * np.linalg.norm(sigma):.2f}"
    return f"{1e3 * np.linalg.norm(error):.2f}", stated


def _signed(error: float) -> str:
    return f"{1e3 * error:+.2f}"


def _one_sided(comparison: Comparison) -> list[str]:
    return [f"{name} of the truth is not in the cell" for name in comparison.missing] + [
        f"{name} of the cell is not in the truth" for name in comparison.surplus
    ]
