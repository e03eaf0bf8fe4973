# SPDX-License-Identifier: GPL-3.0-or-later
"""A folder with a synthetic job, and the command line run inside it."""

from __future__ import annotations

import shutil
import subprocess
import sys

import pytest
import synthetic_cell
from edited_job import state_of
from monocell.headless.cli import main


@pytest.fixture(scope="session")
def pristine(tmp_path_factory):
    folder = tmp_path_factory.mktemp("job")
    synthetic_cell.write_job(folder)
    return folder


@pytest.fixture
def job(pristine, tmp_path):
    """The job's files in a folder of the test's own."""
    return shutil.copytree(pristine, tmp_path / "job")


@pytest.fixture
def run(job, monkeypatch, capfd):
    """Run a verb in this process: exit code, stdout and stderr as a shell would see them."""
    monkeypatch.chdir(job)

    def in_process(*arguments):
        capfd.readouterr()
        code = main([str(argument) for argument in arguments])
        told = capfd.readouterr()
        return code, told.out, told.err

    return in_process


@pytest.fixture
def shell(job):
    """Run a verb as a process of its own, as a user does."""

    def as_process(*arguments):
        command = [sys.executable, "-m", "monocell.headless", *map(str, arguments)]
        done = subprocess.run(command, cwd=job, capture_output=True, text=True, timeout=120)
        return done.returncode, done.stdout, done.stderr

    return as_process


@pytest.fixture
def refused(run, job):
    """Run a verb that must be refused; returns its one line."""

    def check(*arguments):
        before = state_of(job)
        code, out, err = run(*arguments)
        assert code == 2, (code, out, err)
        assert out == ""
        assert err.count("\n") == 1, err
        assert err.startswith(f"monocell {arguments[0]}: ")
        assert state_of(job) == before
        return err

    return check
