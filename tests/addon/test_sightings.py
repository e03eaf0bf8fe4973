# SPDX-License-Identifier: GPL-3.0-or-later
import json
from functools import partial

import bench_cell
import numpy as np
import pytest
from monocell.core.document.cell_file import read_cell
from monocell.core.sighting import PointSighting

pytestmark = pytest.mark.blender

URDF = """<robot name="r"><link name="base"/><link name="tip"/>
<joint name="turn" type="revolute"><parent link="base"/><child link="tip"/>
<origin xyz="0.3 0 0.2"/><axis xyz="0 0 1"/><limit lower="-2" upper="2"/></joint></robot>"""


@pytest.fixture
def scene(addon, raw_bench):
    addon.ops.monocell.open_cell(filepath=str(raw_bench))
    return addon.context.scene


@pytest.fixture
def sightings(addon, tmp_path):
    """The sightings as the document has them now."""

    def read():
        addon.ops.monocell.save_cell(filepath=str(tmp_path / "x.cell.json"))
        return read_cell(tmp_path / "x.cell.json").sightings

    return read


def rows(places):
    return "\n".join(" ".join(f"{1e3 * v:.1f}" for v in place) for place in places)


def test_a_ball_is_added_where_it_was_typed(addon, scene, sightings):
    scene.monocell_inputs.place = (0.62, -0.42, 0.18)
    scene.monocell_inputs.ball_radius = 0.05
    addon.ops.monocell.add_sighting(picture="ball_2.png")
    new = sightings()[-1]
    # in the digits that were typed, not in Blender's single precision
    assert (new.center_world.tolist(), new.radius) == ([0.62, -0.42, 0.18], 0.05)
    assert len(scene.monocell_cell.sightings) == 6


def test_the_cursor_and_the_active_object_tell_places(addon, scene, sightings):
    inputs = scene.monocell_inputs
    inputs.place_source = "CURSOR"
    scene.cursor.location = (0.1, 0.2, 0.3)
    addon.ops.monocell.add_sighting()
    assert sightings()[-1].center_world.tolist() == [0.1, 0.2, 0.3]
    flange = addon.data.objects.new("flange", None)
    scene.collection.objects.link(flange)
    flange.location, flange.rotation_euler = (0.5, 0, 0.4), (np.pi, 0, 0)
    addon.context.view_layer.objects.active = flange
    inputs.place_source, inputs.offset = "OBJECT", (0, 0.1, 0.1)
    addon.ops.monocell.add_sighting()
    assert sightings()[-1].center_world == pytest.approx([0.5, -0.1, 0.3], abs=1e-6)
    inputs.offset_known = False
    addon.ops.monocell.add_sighting()
    assert sightings()[-1].center_world is None
    assert sightings()[-1].world_from_flange.translation == pytest.approx([0.5, 0, 0.4])


def test_joint_angles_tell_a_place_through_the_urdf(addon, scene, sightings, tmp_path):
    (tmp_path / "r.urdf").write_text(URDF)
    inputs = scene.monocell_inputs
    inputs.place_source, inputs.urdf = "JOINTS", str(tmp_path / "r.urdf")
    inputs.joints, inputs.offset = "90", (0.1, 0, 0)
    addon.ops.monocell.add_sighting()
    assert sightings()[-1].center_world == pytest.approx([0.3, 0.1, 0.2], abs=1e-7)
    inputs.joints = "200"
    with pytest.raises(RuntimeError, match=r"turn: 3\.49066 rad is beyond its limits"):
        addon.ops.monocell.add_sighting()
    inputs.joints = "a"
    with pytest.raises(RuntimeError, match="are not all numbers"):
        addon.ops.monocell.add_sighting()


def test_pasted_millimetres_become_new_places_of_the_listed(addon, scene, sightings):
    scene.monocell_inputs.position_unit = "mm"
    moved = bench_cell.CENTRES + np.array([0.01, 0, 0])
    addon.ops.monocell.paste_sightings(text=rows(moved), becomes="PLACES")
    assert np.allclose([s.center_world for s in sightings()], moved)
    with pytest.raises(RuntimeError, match="4 positions for 5 sightings"):
        addon.ops.monocell.paste_sightings(text=rows(moved[:4]), becomes="PLACES")


def test_pasted_rows_with_pictures_become_sightings(addon, scene, sightings):
    addon.ops.monocell.paste_sightings(text="ball_1.png, 0.5, 0.1, 0.2")
    assert sightings()[-1].picture == "ball_1.png" or sightings()[-1].picture.endswith("ball_1.png")
    with pytest.raises(RuntimeError, match=r"gone\.png: there is no such picture"):
        addon.ops.monocell.paste_sightings(text="gone.png, 0.5, 0.1, 0.2")
    assert len(sightings()) == 6


def test_a_csv_file_names_pictures_from_its_own_folder(addon, scene, sightings, raw_bench):
    path = raw_bench.parent / "positions.csv"
    listed = (f"ball_{i}.png,{x},{y},{z}" for i, (x, y, z) in enumerate(bench_cell.CENTRES))
    path.write_text("picture,x,y,z\n" + "\n".join(listed))
    while len(scene.monocell_cell.sightings):
        addon.ops.monocell.remove_sighting()
    addon.ops.monocell.read_sightings(filepath=str(path))
    assert addon.ops.monocell.calibrate() == {"FINISHED"}
    assert {row.status for row in scene.monocell_cell.sightings} == {"used"}


def test_chosen_pictures_are_paired_with_copied_positions(addon, scene, sightings, raw_bench):
    addon.ops.monocell.add_pictures(
        directory=str(raw_bench.parent),
        files=[{"name": "ball_1.png"}, {"name": "ball_0.png"}],
        positions=rows(bench_cell.CENTRES[:2]),
        unit="mm",
    )
    new = sightings()[-2:]
    assert [s.picture[-10:] for s in new] == ["ball_0.png", "ball_1.png"]
    assert np.allclose([s.center_world for s in new], bench_cell.CENTRES[:2])


def test_a_sighting_switched_off_is_kept_and_left_out(addon, scene, sightings):
    scene.monocell_cell.sightings[1].use = False
    assert [s.use for s in sightings()] == [True, False, True, True, True]
    addon.ops.monocell.calibrate()
    assert [row.status for row in scene.monocell_cell.sightings] == [
        "used",
        "",
        "used",
        "used",
        "used",
    ]
    for row in scene.monocell_cell.sightings[2:]:
        row.use = False
    with pytest.raises(RuntimeError, match="has 1 ball sightings in use"):
        addon.ops.monocell.calibrate()


def test_an_edited_number_keeps_the_digits_of_the_others(addon, scene, sightings):
    before = sightings()[0].center_world
    row = scene.monocell_cell.sightings[0]
    row.center = (row.center[0], row.center[1], 0.125)
    assert sightings()[0].center_world.tolist() == [before[0], before[1], 0.125]
    row.radius = 0.041
    assert sightings()[0].radius == 0.041


def test_editing_after_a_calibration_asks_for_another(addon, module, scene):
    addon.ops.monocell.calibrate()
    step = module("addon.panels.steps").camera_step
    assert step(scene).mark == "done"
    scene.monocell_cell.sightings[0].center = (0.3, 0.3, 0.3)
    assert (step(scene).mark, step(scene).said[:17]) == ("doubt", "Sightings changed")
    statuses = [row.status for row in scene.monocell_cell.sightings]
    assert statuses == ["", "used", "used", "used", "used"]


def test_find_all_draws_without_calibrating(addon, scene, sightings):
    assert addon.ops.monocell.find_all() == {"FINISHED"}
    assert {row.status for row in scene.monocell_cell.sightings} == {"found"}
    addon.ops.monocell.save_cell(filepath=scene.monocell_cell.folder + "/y.cell.json")
    assert read_cell(scene.monocell_cell.folder + "/y.cell.json").camera.camera_from_world is None


def test_a_window_is_kept_and_cleared(addon, scene, sightings):
    scene.monocell_cell.sighting_index = 2
    addon.ops.monocell.drag_window("EXEC_DEFAULT", window=(100, 120, 80, 60))
    assert sightings()[2].window == (100, 120, 80, 60)
    addon.ops.monocell.clear_window()
    assert sightings()[2].window is None


def test_points_calibrate_without_a_ball(addon, scene, sightings):
    while len(scene.monocell_cell.sightings):
        addon.ops.monocell.remove_sighting()
    corners = [*bench_cell.BOX.corners_world(), *bench_cell.CENTRES]
    for corner in corners:
        scene.monocell_inputs.place = corner
        pixel = bench_cell.CAMERA.project(np.array([corner]))[0]
        addon.ops.monocell.add_point("EXEC_DEFAULT", pixel_at=pixel)
    assert all(isinstance(one, PointSighting) for one in sightings())
    addon.ops.monocell.calibrate()
    camera = read_back(addon, scene)
    assert np.linalg.norm(camera.centre_world - bench_cell.CAMERA.centre_world) < 1e-3


def read_back(addon, scene):
    path = scene.monocell_cell.folder + "/z.cell.json"
    addon.ops.monocell.save_cell(filepath=path)
    return read_cell(path).camera


def test_calibrating_tells_millimetres_and_where_to_hold_the_ball_next(addon, module, scene):
    addon.ops.monocell.calibrate()
    report = module("addon.cell.document").stored_report(scene)
    assert report.surface == "floor"
    assert len(report.advice) == 3
    now = report.surface_millimetres
    assert all(0 < place.sigma_millimetres < now + 0.01 for place in report.advice)


def test_a_removed_sighting_leaves_the_others_as_they_were(addon, scene, sightings):
    addon.ops.monocell.calibrate()
    scene.monocell_cell.sighting_index = 1
    addon.ops.monocell.remove_sighting()
    assert [s.picture[-10:] for s in sightings()] == [f"ball_{i}.png" for i in (0, 2, 3, 4)]
    assert {row.status for row in scene.monocell_cell.sightings} == {"used"}


def test_undo_takes_a_sighting_back(addon, scene, sightings):
    addon.ops.ed.undo_push(message="opened")
    addon.ops.monocell.paste_sightings("EXEC_DEFAULT", True, text="ball_1.png 0.5 0.1 0.2")
    assert len(sightings()) == 6
    addon.ops.ed.undo()
    assert len(sightings()) == 5
    assert json.loads(addon.context.scene.monocell_cell.text)["monocell"] == 1


def test_a_point_has_no_window_and_no_radius(addon, scene, sightings):
    addon.ops.monocell.add_point(pixel_at=(320, 240))
    ours = addon.ops.monocell
    for edit in (partial(ours.drag_window, window=(9, 9, 50, 50)), ours.clear_window):
        with pytest.raises(RuntimeError, match=r"^Error: sighting 6 is a clicked point and has no"):
            edit()
    scene.monocell_cell.sightings[5].radius = 0.1
    assert isinstance(sightings()[5], PointSighting)


def test_a_radius_that_is_no_balls_is_held_at_the_largest(addon, scene, sightings, capfd):
    scene.monocell_cell.sightings[0].radius = 1e6
    assert sightings()[0].radius == 1e3
    assert "Traceback" not in "".join(capfd.readouterr())
