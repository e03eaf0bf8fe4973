# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's versions as pip's bpy, each in an environment of its own that is kept.

They lie in the checkout, or in the folder that MONOCELL_PIP_BLENDERS names.
"""

import os
import subprocess
import sys
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
# bpy 4.2 leaves its numpy open, and pip would take one that its glTF exporter was never tried with
WANTED = {
    "4.2": ("3.11", ("bpy==4.2.*", "numpy==1.26.*")),
    "4.5": ("3.11", ("bpy==4.5.*",)),
    "5.0": ("3.11", ("bpy==5.0.*",)),
    "5.2": ("3.13", ("bpy==5.2.*",)),
}


class NotToBeHad(Exception):
    """Why a version can't be had on this machine."""


@dataclass(frozen=True)
class PipBlender:
    """A Python that has a bpy."""

    python: Path

    def run(self, *arguments, resources, timeout=240):
        """Run it on its own, outside this checkout's reach; the finished process."""
        kept = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
        return subprocess.run(
            [self.python, *map(str, arguments)],
            cwd=resources,
            env=kept | {"BLENDER_USER_RESOURCES": str(resources)},
            capture_output=True,
            text=True,
            timeout=timeout,
            check=False,
        )

    @property
    def builder(self):
        """Blender's own builder of extensions, which every bpy brings along."""
        return next(
            self.python.parents[1].glob(
                "lib/python*/site-packages/bpy/*/scripts/addons_core/bl_pkg/cli/blender_ext.py"
            )
        )


def pip_blender(version):
    """The Blender of a version, installed if it is not there yet. Raises NotToBeHad."""
    number, packages = WANTED[version]
    if _has_it(version):
        return PipBlender(Path(sys.executable))
    folder = Path(os.environ.get("MONOCELL_PIP_BLENDERS") or ROOT) / f".venv-bpy-{version}"
    there, python = folder / "installed", folder / "bin" / "python"
    if not there.is_file():
        _run(_python(number), "-m", "venv", "--clear", folder)
        _run(python, "-m", "pip", "install", "--quiet", "--no-compile", *packages)
        there.write_text("\n".join(packages))
    return PipBlender(python)


def _has_it(version):
    """Whether the Python of this test has that version."""
    try:
        return metadata.version("bpy").startswith(f"{version}.")
    except metadata.PackageNotFoundError:
        return False


def _python(number):
    """The first Python of that number on the path that starts: a shim may be there for nothing."""
    if sys.version_info[:2] == tuple(map(int, number.split("."))):
        return Path(sys.executable)
    for folder in os.environ.get("PATH", "").split(os.pathsep):
        python = Path(folder) / f"python{number}"
        if python.is_file() and subprocess.run([python, "-V"], capture_output=True).returncode == 0:
            return python
    raise NotToBeHad(f"no python{number} on the path")


def _run(*command):
    done = subprocess.run(
        list(map(str, command)), capture_output=True, text=True, timeout=600, check=False
    )
    if done.returncode != 0:
        raise NotToBeHad(f"{' '.join(map(str, command))}: {done.stderr.strip()[-300:]}")
