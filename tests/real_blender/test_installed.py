# SPDX-License-Identifier: GPL-3.0-or-later
import json
from pathlib import Path

import bench_cell
import numpy as np
import pytest
from monocell.core.document.cell_file import read_cell

pytestmark = [pytest.mark.real_blender, pytest.mark.slow]

ROOT = Path(__file__).resolve().parents[2]
STEPS = Path(__file__).with_name("steps.py")


@pytest.fixture(scope="session")
def worked(real_blender, tmp_path_factory):
    """The folder in which one Blender left its work, and what it found."""
    folder = tmp_path_factory.mktemp("work")
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
    run = real_blender.run(
        *("--background", "--python-exit-code", 3, "--python", STEPS, "--", folder / "job.json")
    )
    assert run.returncode == 0, run.stdout + run.stderr
    return folder, json.loads((folder / "found.json").read_text())


def objects_of(folder, name):
    return {thing.name: thing for thing in read_cell(folder / f"{name}.cell.json").objects}


def test_it_registers_without_opencv(worked):
    assert worked[1]["enabled"]
    assert worked[1]["heavy"] == []


def test_the_camera_is_calibrated_to_the_truth(worked):
    camera = read_cell(worked[0] / "calibrated.cell.json").camera
    assert np.linalg.norm(camera.centre_world - bench_cell.CAMERA.centre_world) < 1e-3


def test_picks_become_the_true_objects(worked):
    things = objects_of(worked[0], "modelled")
    assert np.allclose(sorted(things["box"].size), sorted(bench_cell.BOX.size), atol=1e-3)
    assert things["drum"].radius == pytest.approx(bench_cell.DRUM.radius, abs=1e-3)


def test_undo_and_redo_agree_with_the_document(worked):
    folder, _ = worked
    assert list(objects_of(folder, "undone")) == ["box"]
    modelled, redone = (folder / f"{n}.cell.json" for n in ("modelled", "redone"))
    assert redone.read_text() == modelled.read_text()


def test_the_gltf_has_every_object(worked):
    data = (worked[0] / "cell.glb").read_bytes()
    length = int.from_bytes(data[12:16], "little")
    nodes = json.loads(data[20 : 20 + length])["nodes"]
    assert {"box", "drum"} <= {node["name"] for node in nodes}


def test_a_refusal_is_one_line_without_a_traceback(worked):
    refusal = worked[1]["refusal"]
    assert "base" in refusal and "Traceback" not in refusal


def test_a_ros_camera_file_is_read_with_the_bundled_yaml(worked):
    camera = read_cell(worked[0] / "from_picture.cell.json").camera
    assert camera.intrinsics.matrix().tolist() == bench_cell.INTRINSICS.matrix().tolist()


def test_unregistering_leaves_nothing_and_registering_works_again(worked):
    assert worked[1]["left"] == []
    assert worked[1]["again"]


def test_the_command_tells_its_verbs(real_blender):
    run = real_blender.run("--command", "monocell", "--help")
    assert run.returncode == 0, run.stderr
    assert "calibrate" in run.stdout


@pytest.mark.parametrize("way", ["command", "script"])
def test_a_ball_is_found_by_command_and_by_script(real_blender, tmp_path, way):
    bench_cell.write_bench(tmp_path)
    (tmp_path / "camera.yaml").write_text(bench_cell.ros_camera())
    start = {
        "command": ("--command", "monocell"),
        "script": ("--background", "--python", ROOT / "headless" / "run.py", "--"),
    }[way]
    run = real_blender.run(
        *(*start, "find", tmp_path / "ball_0.png", "--camera", tmp_path / "camera.yaml"),
        *("--radius", bench_cell.RADIUS, "--json"),
    )
    assert run.returncode == 0, run.stderr
    # Blender prints its own name first
    told = json.JSONDecoder().raw_decode(run.stdout[run.stdout.index("{") :])[0]
    truth = bench_cell.POSE.apply(bench_cell.CENTRES[0])
    assert np.allclose(told["center_camera"], truth, atol=3e-3)


@pytest.mark.parametrize("way", ["command", "script"])
def test_bad_input_ends_with_2_and_one_line(real_blender, tmp_path, way):
    start = {
        "command": ("--command", "monocell"),
        "script": ("--background", "--python", ROOT / "headless" / "run.py", "--"),
    }[way]
    run = real_blender.run(*start, "calibrate", tmp_path / "none.cell.json")
    assert run.returncode == 2
    assert "there is no such file" in run.stderr and "Traceback" not in run.stderr
