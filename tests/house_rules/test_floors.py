# SPDX-License-Identifier: GPL-3.0-or-later
"""The floors of the house: which room may import what."""

from __future__ import annotations

import ast
import subprocess
import sys

import pytest
from source_files import (
    ROOT,
    absolute_imports,
    name_of,
    python_files,
    rooms_reached,
    tree_of,
)

STDLIB = set(sys.stdlib_module_names)
BLENDER = {"bpy", "mathutils", "bmesh", "bpy_extras", "gpu", "gpu_extras", "blf", "bl_ui"}
ROBOT = {"pybullet", "pybullet_data", "trimesh", "ompl"}
# what each room may import beside the standard library, and which rooms it may reach
ALLOWED = {
    "core": ({"numpy", "cv2"}, {"core"}),
    "scene": ({"numpy", "cv2", "bpy", "bmesh", "mathutils"}, {"core", "scene"}),
    "addon": ({"numpy", "cv2"} | BLENDER, {"core", "scene", "addon"}),
    "headless": ({"numpy", "cv2"} | ROBOT, {"core", "scene", "headless"}),
}
# the one reader of YAML
MORE = {"core/document/camera_file.py": {"ruamel"}}
# a script started by Blender, not a module of the package: it makes the package importable
SCRIPTS = ("headless/run.py",)


def modules_of(room):
    return [path for path in python_files(room) if name_of(path) not in SCRIPTS]


@pytest.mark.parametrize("room", ALLOWED)
def test_a_room_imports_only_what_its_floor_allows(room):
    foreign, reachable = ALLOWED[room]
    for path in modules_of(room):
        allowed = STDLIB | foreign | MORE.get(name_of(path), set())
        assert absolute_imports(path) <= allowed, name_of(path)
        assert {reached.split("/")[0] for reached in rooms_reached(path)} <= reachable, name_of(
            path
        )


def test_every_room_was_looked_at():
    assert all(len(modules_of(room)) > 5 for room in ALLOWED)


def test_only_the_robot_room_imports_pybullet_trimesh_and_ompl():
    for path in python_files("core", "scene", "addon", "headless"):
        if not name_of(path).startswith("headless/robot/"):
            assert not absolute_imports(path) & ROBOT, name_of(path)


def test_the_robot_room_imports_no_blender_and_nothing_that_does():
    for path in python_files("headless/robot"):
        assert not absolute_imports(path) & BLENDER, name_of(path)
        for reached in rooms_reached(path):
            assert reached.startswith(("core", "headless/robot")), f"{name_of(path)}: {reached}"


def test_imports_inside_the_package_are_relative():
    # Blender calls the package bl_ext.<repository>.monocell; scripts beside it call it by its name
    for room in ALLOWED:
        for path in modules_of(room):
            assert "monocell" not in absolute_imports(path), name_of(path)


def test_a_room_s_init_brings_in_nothing_heavy():
    for path in python_files("core", "scene", "headless"):
        if path.name == "__init__.py":
            assert not absolute_imports(path) & (BLENDER | ROBOT | {"cv2"}), name_of(path)


def test_the_root_imports_nothing_and_does_nothing_when_imported():
    statements = tree_of(ROOT / "__init__.py").body
    assert isinstance(statements[0], ast.Expr)
    assert all(isinstance(statement, ast.FunctionDef) for statement in statements[1:])
    assert {s.name for s in statements[1:]} >= {"register", "unregister"}


@pytest.mark.parametrize(
    ("module", "unwanted"),
    [
        ("monocell", BLENDER | ROBOT | {"numpy", "cv2", "ruamel"}),
        ("monocell.core", BLENDER | ROBOT | {"cv2", "ruamel"}),
        ("monocell.headless.cli", BLENDER | ROBOT | {"cv2", "ruamel"}),
        ("monocell.headless.robot", BLENDER | ROBOT),
    ],
)
def test_importing_brings_in_nothing_heavy(module, unwanted):
    script = f"import sys, {module}; print(*{{name.split('.')[0] for name in sys.modules}})"
    told = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, cwd="/")
    assert told.returncode == 0, told.stderr
    assert "monocell" in told.stdout.split()
    assert not set(told.stdout.split()) & unwanted
