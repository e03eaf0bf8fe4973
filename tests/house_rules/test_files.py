# SPDX-License-Identifier: GPL-3.0-or-later
"""How every file looks: its first lines, its length, the length of its functions, its names."""

from __future__ import annotations

import ast
import re

import pytest
from source_files import PACKAGE_ROOMS, all_python_files, name_of, python_files, text_files, tree_of

SPDX = "# SPDX-License-Identifier: GPL-3.0-or-later"
MOST_LINES, MOST_FUNCTION_LINES = 300, 45
# put together here, so that this file does not name them itself
MACHINE_PATHS = re.compile(
    r"(?<![\w./$<-])/(?:" + "|".join(["work", "root", "tmp/" + "dev"]) + r")(?![\w-])|\b"
    r"share" + r"d/"
)
EVERY_FILE = pytest.mark.parametrize("path", all_python_files(), ids=name_of)


@EVERY_FILE
def test_a_file_begins_with_its_licence_and_says_what_it_is(path):
    text = path.read_text(encoding="utf-8")
    assert text.splitlines()[0] == SPDX
    # the names of tests tell what they show, and an empty package file has nothing to tell
    if not path.name.startswith("test_") and text.strip() != SPDX:
        assert ast.get_docstring(tree_of(path))


@EVERY_FILE
def test_a_file_is_short_enough_to_read(path):
    assert len(path.read_text(encoding="utf-8").splitlines()) <= MOST_LINES


@pytest.mark.parametrize("path", python_files(*PACKAGE_ROOMS, "benchmarks"), ids=name_of)
def test_functions_are_short(path):
    for node in ast.walk(tree_of(path)):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            lines = (node.end_lineno or 0) - node.lineno + 1
            assert lines <= MOST_FUNCTION_LINES, f"{node.name}: {lines} lines"


def test_no_module_is_a_drawer_for_everything():
    names = {path.stem for path in python_files(*PACKAGE_ROOMS)}
    assert not names & {"utils", "util", "helpers", "common", "misc"}


def test_no_file_names_a_place_on_the_machine_it_was_written_on():
    told = [
        f"{name_of(path)}:{number}"
        for path in text_files()
        for number, line in enumerate(
            path.read_text(encoding="utf-8", errors="replace").split("\n"), 1
        )
        if MACHINE_PATHS.search(line)
    ]
    assert told == []


@pytest.mark.parametrize("line", ["see /" + "work/x", "'/" + "root/x'", "../share" + "d/x"])
def test_a_place_on_the_machine_would_be_seen(line):
    assert MACHINE_PATHS.search(line)


@pytest.mark.parametrize(
    "line", ["a/work/b", "</root>", "scene/work_cell.py", "/workspace", "unshared"]
)
def test_a_harmless_path_is_none(line):
    assert not MACHINE_PATHS.search(line)
