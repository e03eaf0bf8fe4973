# SPDX-License-Identifier: GPL-3.0-or-later
"""One version everywhere, every package listed, every example in a docstring true."""

from __future__ import annotations

import doctest
import importlib
import pkgutil
import re
import tomllib

import monocell.core
import pytest
from monocell.core.version import VERSION
from source_files import PACKAGE_ROOMS, ROOT, python_files

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
MANIFEST = tomllib.loads((ROOT / "blender_manifest.toml").read_text(encoding="utf-8"))
CHANGELOG = ROOT / "CHANGELOG.md"
CORE_MODULES = [
    f"monocell.core.{module.name}" for module in pkgutil.iter_modules(monocell.core.__path__)
]


def test_one_version_stands_everywhere():
    assert PROJECT["project"]["version"] == MANIFEST["version"] == VERSION


@pytest.mark.skipif(not CHANGELOG.is_file(), reason="no CHANGELOG.md yet")
def test_the_changelog_s_newest_section_is_this_version():
    sections = re.findall(r"^## \[?v?(\d+\.\d+\.\d+)", CHANGELOG.read_text("utf-8"), re.MULTILINE)
    assert sections and sections[0] == VERSION


def test_all_packages_on_disk_are_listed_and_no_others():
    on_disk = {
        ".".join(["monocell", *path.parent.relative_to(ROOT).parts])
        for path in python_files(*PACKAGE_ROOMS)
    }
    with_init = {
        ".".join(["monocell", *path.parent.relative_to(ROOT).parts])
        for path in python_files(*PACKAGE_ROOMS)
        if path.name == "__init__.py"
    }
    assert on_disk == with_init
    assert set(PROJECT["tool"]["setuptools"]["packages"]) == on_disk | {"monocell"}


def test_extension_and_package_carry_the_same_name_and_licence():
    assert MANIFEST["id"] == PROJECT["project"]["name"] == "monocell"
    assert MANIFEST["license"] == ["SPDX:" + PROJECT["project"]["license"]]


def test_the_console_script_leads_to_the_command_line():
    module, function = PROJECT["project"]["scripts"]["monocell"].split(":")
    assert callable(getattr(importlib.import_module(module), function))


@pytest.mark.parametrize("name", CORE_MODULES)
def test_the_examples_in_core_are_true(name):
    result = doctest.testmod(importlib.import_module(name), raise_on_error=False)
    assert result.failed == 0


def test_core_has_examples_at_all():
    finder = doctest.DocTestFinder(exclude_empty=True)
    found = [finder.find(importlib.import_module(name)) for name in CORE_MODULES]
    assert sum(len(test.examples) for tests in found for test in tests) >= 4


def test_everything_core_names_as_public_is_there():
    for name in monocell.core.__all__:
        assert getattr(monocell.core, name).__module__.startswith("monocell.core.")
