# SPDX-License-Identifier: GPL-3.0-or-later
"""The session of steps.py: what it works on, and what has to be true of what it left.

A test module has a fixture `worked`, the folder of its work and what it found, and a class that
inherits the checks.
"""

import json
from pathlib import Path

import bench_cell
import numpy as np
import pytest
from monocell.core.document.cell_file import read_cell

STEPS = Path(__file__).with_name("steps.py")


def write_job(folder):
    """The bench, its camera and the picks in a folder; the file that steps.py is given."""
    document = bench_cell.write_bench(folder, calibrated=False)
    camera = folder / "camera.yaml"
    camera.write_text(bench_cell.ros_camera())
    job = {
        "document": str(document),
        "picture": str(folder / "bench.png"),
        "camera": str(camera),
        "box": bench_cell.box_picks(),
        "drum": bench_cell.drum_picks(),
        "out": str(folder),
    }
    (folder / "job.json").write_text(json.dumps(job))
    return folder / "job.json"


def objects_of(folder, name):
    return {thing.name: thing for thing in read_cell(folder / f"{name}.cell.json").objects}


class SessionChecks:
    def test_it_registers_without_opencv(self, worked):
        assert worked[1]["enabled"]
        assert worked[1]["heavy"] == []

    def test_the_camera_is_calibrated_to_the_truth(self, worked):
        camera = read_cell(worked[0] / "calibrated.cell.json").camera
        assert np.linalg.norm(camera.centre_world - bench_cell.CAMERA.centre_world) < 1e-3

    def test_picks_become_the_true_objects(self, worked):
        things = objects_of(worked[0], "modelled")
        assert np.allclose(sorted(things["box"].size), sorted(bench_cell.BOX.size), atol=1e-3)
        assert things["drum"].radius == pytest.approx(bench_cell.DRUM.radius, abs=1e-3)

    def test_undo_and_redo_agree_with_the_document(self, worked):
        folder, _ = worked
        assert list(objects_of(folder, "undone")) == ["box"]
        modelled, redone = (folder / f"{n}.cell.json" for n in ("modelled", "redone"))
        assert redone.read_text() == modelled.read_text()

    def test_the_gltf_has_every_object(self, worked):
        data = (worked[0] / "cell.glb").read_bytes()
        length = int.from_bytes(data[12:16], "little")
        nodes = json.loads(data[20 : 20 + length])["nodes"]
        assert {"box", "drum"} <= {node["name"] for node in nodes}

    def test_a_refusal_is_one_line_without_a_traceback(self, worked):
        refusal = worked[1]["refusal"]
        assert "base" in refusal and "Traceback" not in refusal

    def test_a_ros_camera_file_is_read_with_the_bundled_yaml(self, worked):
        camera = read_cell(worked[0] / "from_picture.cell.json").camera
        assert camera.intrinsics.matrix().tolist() == bench_cell.INTRINSICS.matrix().tolist()

    def test_unregistering_leaves_nothing_and_registering_works_again(self, worked):
        assert worked[1]["left"] == []
        assert worked[1]["again"]
