# SPDX-License-Identifier: GPL-3.0-or-later
"""The built zip in every Blender that pip has, from the oldest that the manifest allows."""

import json
import os
from concurrent.futures import ThreadPoolExecutor

import pytest
from bundled_wheels import ROOT, fetch_wheels
from pip_blenders import WANTED, NotToBeHad, pip_blender
from session_checks import STEPS, SessionChecks, write_job

pytestmark = [pytest.mark.blender, pytest.mark.slow]

SESSION = STEPS.with_name("pip_session.py")
# Blender's own fault: its 4.2 frees a part of the glTF exporter twice, when all is written
CRASH_AT_EXIT = {"4.2": (0, -11)}


@pytest.fixture(scope="module")
def sessions(request, tmp_path_factory):
    """The work of every version that is asked for, going on at the same time."""
    asked = {
        item.callspec.params["version"]
        for item in request.session.items
        if item.path == request.path and hasattr(item, "callspec")
    }
    trouble = fetch_wheels()
    if trouble:
        pytest.skip(trouble)
    folders = {version: tmp_path_factory.mktemp(f"bpy_{version}") for version in sorted(asked)}
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        yield {v: pool.submit(session_in, v, folder) for v, folder in folders.items()}


@pytest.fixture(scope="module", params=list(WANTED))
def version(request):
    return request.param


@pytest.fixture
def worked(sessions, version):
    """The folder in which one version left its work, and what it found."""
    try:
        return sessions[version].result()
    except NotToBeHad as reason:
        pytest.skip(f"no bpy {version}: {reason}")


def session_in(version, folder):
    """Build, validate and install the zip, and go through the session, all with one bpy."""
    blender = pip_blender(version)
    resources, extension_zip = folder / "settings", folder / "monocell.zip"
    resources.mkdir()
    build = ("build", "--source-dir", ROOT, "--output-filepath", extension_zip)
    for command in (build, ("validate", extension_zip), ("validate", ROOT)):
        done = blender.run(blender.builder, *command, "--valid-tags", "", resources=resources)
        assert done.returncode == 0, done.stdout + done.stderr
    job = write_job(folder)
    run = blender.run(SESSION, extension_zip, STEPS, "--", job, resources=resources)
    assert run.returncode in CRASH_AT_EXIT.get(version, (0,)), run.stdout + run.stderr
    assert "Traceback" not in run.stderr, run.stderr
    return folder, json.loads((folder / "found.json").read_text())


class TestSession(SessionChecks):
    def test_it_is_the_version_that_is_asked_for(self, worked, version):
        assert worked[1]["version"].startswith(f"{version}.")
