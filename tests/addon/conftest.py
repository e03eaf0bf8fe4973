# SPDX-License-Identifier: GPL-3.0-or-later
"""The checkout as an installed extension of pip's bpy, as it is for a user."""

from __future__ import annotations

import importlib
from pathlib import Path

import pytest

EXTENSION = "bl_ext.user_default.monocell"
ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def extension():
    """The extension's name, enabled for the session."""
    # bpy brings addon_utils' folder onto the path
    import bpy  # isort: skip
    import addon_utils

    folder = Path(bpy.utils.user_resource("EXTENSIONS")) / "user_default"
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "monocell").symlink_to(ROOT, target_is_directory=True)
    addon_utils.extensions_refresh(ensure_wheels=False)
    errors = []
    addon_utils.enable(EXTENSION, default_set=True, handle_error=errors.append)
    if errors:
        raise errors[0]
    return EXTENSION


@pytest.fixture
def addon(extension, blender):
    """bpy with the extension and a fresh, empty file."""
    return blender


@pytest.fixture
def module(extension):
    """A module of the extension by its path, `module("addon.cell.document")`."""
    return lambda name: importlib.import_module(f"{extension}.{name}")


@pytest.fixture(scope="session")
def bench(tmp_path_factory):
    """The path of a calibrated document with its pictures."""
    from bench_cell import write_bench

    return write_bench(tmp_path_factory.mktemp("bench"))


@pytest.fixture(scope="session")
def raw_bench(tmp_path_factory):
    """The same without a camera pose."""
    from bench_cell import write_bench

    return write_bench(tmp_path_factory.mktemp("raw"), calibrated=False)
