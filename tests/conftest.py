# SPDX-License-Identifier: GPL-3.0-or-later
"""Every test its own Blender settings, and an honest reason where a machine lacks something."""

from __future__ import annotations

import gc
import importlib.util
import os
import shutil
import tempfile

import pytest

NEEDS = {
    "blender": ("bpy", "pip install 'monocell[blender]'"),
    "robot": ("pybullet", "pip install 'monocell[robot]'"),
}


def pytest_configure(config):
    # before anything imports bpy: the settings of whoever runs the tests stay out of the way
    folder = tempfile.mkdtemp(prefix="monocell-tests-")
    os.environ["BLENDER_USER_RESOURCES"] = folder
    config.add_cleanup(lambda: shutil.rmtree(folder, ignore_errors=True))
    from hypothesis import settings

    # a loaded machine is no fault; and a check of a commit says the same each time, while new
    # examples are sought at a desk
    settings.register_profile("here", deadline=None, derandomize=bool(os.environ.get("CI")))
    settings.load_profile("here")


def pytest_unconfigure():
    # hypothesis leaves a callback that keeps bpy's module alive past Python's end; Blender then
    # frees nothing, and its thread that closes .blend files waits for ever
    gc.callbacks.clear()


def pytest_collection_modifyitems(items):
    for item in items:
        for marker, (module, remedy) in NEEDS.items():
            if marker in item.keywords and importlib.util.find_spec(module) is None:
                item.add_marker(pytest.mark.skip(reason=f"no {module} here: {remedy}"))
        if "real_blender" in item.keywords and not real_blender():
            item.add_marker(pytest.mark.skip(reason="no Blender: set MONOCELL_BLENDER to one"))


def real_blender() -> str | None:
    """The command that starts an installed Blender, which may have arguments of its own."""
    return os.environ.get("MONOCELL_BLENDER") or shutil.which("blender")


@pytest.fixture
def blender():
    """bpy with an empty scene."""
    import bpy

    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    return bpy
