# SPDX-License-Identifier: GPL-3.0-or-later
"""The built extension, installed from its zip into every real Blender that is named.

MONOCELL_BLENDER holds the shell commands that start a Blender, one a line (or separated as a path
list is); without it `blender` on the path is taken. MONOCELL_BLENDER_WINDOW holds those that start
one with a window where it takes another command, such as one with a virtual screen of its own.
"""

from __future__ import annotations

import os
import re
import shlex
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest
from bundled_wheels import ROOT, fetch_wheels

# the bench of the add-on's tests is built here as well
sys.path.insert(0, str(ROOT / "tests" / "addon"))


@dataclass(frozen=True)
class Blender:
    """An installed Blender with settings of its own."""

    command: tuple[str, ...]
    resources: Path

    def run(self, *arguments, timeout=300):
        """Run it in the checkout; the finished process, its output as text."""
        return subprocess.run(
            [*self.command, *map(str, arguments)],
            cwd=ROOT,
            env=os.environ | {"BLENDER_USER_RESOURCES": str(self.resources)},
            capture_output=True,
            text=True,
            timeout=timeout,
            check=False,
        )


def commands_of(variable):
    listed = re.split(rf"[\n{os.pathsep}]", os.environ.get(variable, ""))
    return [tuple(shlex.split(command)) for command in listed if command.strip()]


def blender_commands():
    found = shutil.which("blender")
    return commands_of("MONOCELL_BLENDER") or ([(found,)] if found else [])


def window_commands():
    listed = commands_of("MONOCELL_BLENDER_WINDOW")
    if listed or os.environ.get("DISPLAY"):
        return listed or blender_commands()
    xvfb = shutil.which("xvfb-run")
    if xvfb is None:
        return []
    return [(xvfb, "-a", "-s", "-screen 0 1600x1000x24", *c) for c in blender_commands()]


def pytest_generate_tests(metafunc):
    for fixture, commands, reason in (
        ("real_blender", blender_commands(), "no Blender: set MONOCELL_BLENDER to one"),
        ("window_blender", window_commands(), "no window: needs Xvfb or MONOCELL_BLENDER_WINDOW"),
    ):
        if fixture in metafunc.fixturenames:
            nothing = pytest.param(None, marks=pytest.mark.skip(reason=reason))
            given = [pytest.param(c, id=" ".join(c[-2:])) for c in commands] or [nothing]
            metafunc.parametrize(fixture, given, indirect=True, scope="session")


@pytest.fixture(scope="session")
def extension_zip(tmp_path_factory):
    """The extension as users get it, built by Blender itself."""
    trouble = fetch_wheels()
    if trouble:
        pytest.skip(trouble)
    path = tmp_path_factory.mktemp("built") / "monocell.zip"
    builder = Blender(blender_commands()[0], tmp_path_factory.mktemp("builder"))
    built = builder.run(
        *("--command", "extension", "build"), "--source-dir", ROOT, "--output-filepath", path
    )
    assert path.is_file(), built.stdout + built.stderr
    return path


@pytest.fixture(scope="session")
def real_blender(request, extension_zip, tmp_path_factory):
    """A Blender without a window that has the extension."""
    return installed(request.param, extension_zip, tmp_path_factory.mktemp("settings"))


@pytest.fixture(scope="session")
def window_blender(request, extension_zip, tmp_path_factory):
    """A Blender with a window that has the extension."""
    return installed(request.param, extension_zip, tmp_path_factory.mktemp("settings"))


def installed(command, extension_zip, resources):
    blender = Blender(command, resources)
    done = blender.run(
        *("--command", "extension", "install-file", "-r", "user_default", "-e", extension_zip)
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return blender
