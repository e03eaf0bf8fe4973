# SPDX-License-Identifier: GPL-3.0-or-later
import json

import bench_cell
import numpy as np
import pytest
from monocell.core.document.cell_file import read_cell
from monocell.core.document.entries import camera_entry

pytestmark = pytest.mark.blender


def opened(bpy, path):
    assert bpy.ops.monocell.open_cell(filepath=str(path)) == {"FINISHED"}
    return bpy.context.scene


def saved(bpy, path):
    assert bpy.ops.monocell.save_cell(filepath=str(path)) == {"FINISHED"}
    return read_cell(path)


def add(bpy, kind, picks, **options):
    operator = getattr(bpy.ops.monocell, f"add_{kind}")
    return operator("EXEC_DEFAULT", True, picks=json.dumps(picks), **options)


def test_a_document_opens_in_a_scene_of_its_own(addon, bench):
    before = addon.context.scene
    scene = opened(addon, bench)
    assert scene != before
    assert scene.name.startswith("bench")
    assert len(before.objects) == 0
    assert scene.camera.data.background_images[0].image.size[:] == (800, 600)


def test_a_document_that_is_opened_and_saved_is_the_same(addon, bench, tmp_path):
    opened(addon, bench)
    back = saved(addon, tmp_path / "copy.cell.json")
    truth = read_cell(bench)
    assert camera_entry(back.camera) == camera_entry(truth.camera)
    assert [s.center_world.tolist() for s in back.sightings] == bench_cell.CENTRES.tolist()
    assert back.path_of(back.picture).resolve() == truth.path_of(truth.picture).resolve()


def test_a_missing_picture_is_refused_in_one_line_and_changes_nothing(addon, bench, tmp_path):
    lonely = tmp_path / "lonely.cell.json"
    lonely.write_text(bench.read_text())
    scenes = len(addon.data.scenes)
    with pytest.raises(RuntimeError, match=r"bench\.png: there is no such picture"):
        addon.ops.monocell.open_cell(filepath=str(lonely))
    assert len(addon.data.scenes) == scenes


def test_a_lens_that_blender_lacks_is_refused_and_leaves_no_scene(addon, bench, tmp_path):
    document = json.loads(bench.read_text())
    document["camera"] |= {"fx": 15.0, "fy": 15.0, "distortion": {"model": "none"}}
    wide = bench.parent / "wide.cell.json"
    wide.write_text(json.dumps(document))
    counts = [len(d) for d in (addon.data.scenes, addon.data.objects, addon.data.cameras)]
    with pytest.raises(RuntimeError, match="shortest lens"):
        addon.ops.monocell.open_cell(filepath=str(wide))
    after = [len(d) for d in (addon.data.scenes, addon.data.objects, addon.data.cameras)]
    assert after == counts


def test_a_picture_opens_with_its_ros_camera_file(addon, bench, tmp_path):
    camera = tmp_path / "camera.yaml"
    camera.write_text(bench_cell.ros_camera())
    picture = str(bench.parent / "bench.png")
    addon.ops.monocell.open_picture(picture=picture, camera=str(camera))
    back = saved(addon, tmp_path / "new.cell.json")
    assert back.camera.camera_from_world is None
    assert back.camera.intrinsics.matrix().tolist() == bench_cell.INTRINSICS.matrix().tolist()
    assert [r.name for r in back.references] == ["floor"]


def test_exact_picks_give_the_true_box(addon, bench, tmp_path):
    opened(addon, bench)
    assert add(addon, "box", bench_cell.box_picks()) == {"FINISHED"}
    (box,) = saved(addon, tmp_path / "x.cell.json").objects
    truth = bench_cell.BOX
    assert np.allclose(sorted(box.size), sorted(truth.size), atol=1e-8)
    assert np.allclose(
        box.world_from_object.translation, truth.world_from_object.translation, atol=1e-8
    )
    assert box.covariance is not None
    assert box.picks["base"] == bench_cell.box_picks()["base"]


def test_exact_picks_give_the_true_cylinder(addon, bench, tmp_path):
    opened(addon, bench)
    assert add(addon, "cylinder", bench_cell.drum_picks(), name="drum") == {"FINISHED"}
    (drum,) = saved(addon, tmp_path / "x.cell.json").objects
    assert (drum.radius, drum.height) == pytest.approx((0.06, 0.18), abs=1e-6)
    assert drum.name == "drum"


def test_new_objects_get_names_of_their_own(addon, bench, tmp_path):
    opened(addon, bench)
    for _ in range(2):
        add(addon, "box", bench_cell.box_picks())
    assert [o.name for o in saved(addon, tmp_path / "x.cell.json").objects] == ["box", "box 2"]
    with pytest.raises(RuntimeError, match="box"):
        add(addon, "box", bench_cell.box_picks(), name="box 2")


def test_picks_that_are_no_box_are_refused_and_build_nothing(addon, bench):
    scene = opened(addon, bench)
    picks = bench_cell.box_picks()
    picks["base"][2] = picks["base"][0]
    with pytest.raises(RuntimeError, match="line"):
        add(addon, "box", picks)
    assert [ob.type for ob in scene.objects] == ["CAMERA"]


def test_nothing_is_modelled_before_the_camera_is_calibrated(addon, raw_bench):
    opened(addon, raw_bench)
    assert not addon.ops.monocell.add_box.poll()
    with pytest.raises(RuntimeError, match="calibrate it first"):
        add(addon, "box", bench_cell.box_picks())


def test_calibration_finds_the_true_camera_and_colours_the_sightings(addon, raw_bench, tmp_path):
    scene = opened(addon, raw_bench)
    assert addon.ops.monocell.calibrate() == {"FINISHED"}
    camera = saved(addon, tmp_path / "x.cell.json").camera
    assert np.linalg.norm(camera.centre_world - bench_cell.CAMERA.centre_world) < 1e-3
    assert camera.covariance is not None
    assert {row.status for row in scene.monocell_cell.sightings} == {"used"}
    assert all(float(row.residual) < 0.5 for row in scene.monocell_cell.sightings)


def test_calibration_without_pictures_is_refused_and_keeps_the_document(addon, bench, tmp_path):
    document = json.loads(bench.read_text())
    document["sightings"][2]["picture"] = "gone.png"
    path = bench.parent / "gone.cell.json"
    path.write_text(json.dumps(document))
    scene = opened(addon, path)
    text = scene.monocell_cell.text
    with pytest.raises(RuntimeError, match=r"gone\.png"):
        addon.ops.monocell.calibrate()
    assert scene.monocell_cell.text == text


def test_a_calibration_that_failed_is_told_and_moves_no_camera(addon, raw_bench, tmp_path):
    document = json.loads(raw_bench.read_text())
    for sighting in document["sightings"]:
        # the mistake of a robot whose y axis points the other way
        sighting["center"][1] *= -1
    path = raw_bench.parent / "mirrored.cell.json"
    path.write_text(json.dumps(document))
    opened(addon, path)
    with pytest.raises(RuntimeError, match="Calibration failed"):
        addon.ops.monocell.calibrate()
    assert saved(addon, tmp_path / "x.cell.json").camera.camera_from_world is None
    assert not addon.ops.monocell.add_box.poll()


def test_undo_takes_back_object_and_calibration_at_once(addon, raw_bench, tmp_path):
    opened(addon, raw_bench)
    addon.ops.ed.undo_push(message="opened")
    addon.ops.monocell.calibrate("EXEC_DEFAULT", True)
    add(addon, "box", bench_cell.box_picks())
    assert len(saved(addon, tmp_path / "1.cell.json").objects) == 1
    addon.ops.ed.undo()
    without = saved(addon, tmp_path / "2.cell.json")
    assert without.objects == ()
    assert without.camera.camera_from_world is not None
    addon.ops.ed.undo()
    assert saved(addon, tmp_path / "3.cell.json").camera.camera_from_world is None
    assert addon.context.scene.monocell_cell.report == ""
    addon.ops.ed.redo()
    addon.ops.ed.redo()
    assert len(saved(addon, tmp_path / "4.cell.json").objects) == 1


def test_a_saved_and_loaded_file_still_is_the_document(addon, raw_bench, tmp_path):
    opened(addon, raw_bench)
    addon.ops.monocell.calibrate()
    add(addon, "box", bench_cell.box_picks())
    saved(addon, tmp_path / "before.cell.json")
    addon.ops.wm.save_as_mainfile(filepath=str(tmp_path / "x.blend"))
    addon.ops.wm.open_mainfile(filepath=str(tmp_path / "x.blend"))
    saved(addon, tmp_path / "after.cell.json")
    before, after = (tmp_path / f"{n}.cell.json" for n in ("before", "after"))
    assert after.read_text() == before.read_text()


def test_an_object_moved_in_blender_is_moved_in_the_document(addon, bench, tmp_path):
    scene = opened(addon, bench)
    add(addon, "box", bench_cell.box_picks())
    scene.objects["box"].location.x += 0.1
    (box,) = saved(addon, tmp_path / "x.cell.json").objects
    assert box.world_from_object.translation[0] == pytest.approx(0.46, abs=1e-6)
    addon.ops.monocell.solve_again()
    (box,) = saved(addon, tmp_path / "y.cell.json").objects
    assert box.world_from_object.translation[0] == pytest.approx(0.36, abs=1e-6)


def test_what_a_document_only_has_picks_of_is_kept_until_it_is_solved(addon, bench, tmp_path):
    document = json.loads(bench.read_text())
    sketch = {"name": "crate", "kind": "box", "on": "floor", "picks": bench_cell.box_picks()}
    document["objects"] = [sketch]
    path = bench.parent / "sketch.cell.json"
    path.write_text(json.dumps(document))
    opened(addon, path)
    kept = saved(addon, tmp_path / "x.cell.json")
    assert (kept.objects, [s.name for s in kept.sketches]) == ((), ["crate"])
    addon.ops.monocell.solve_again()
    solved = saved(addon, tmp_path / "y.cell.json")
    assert ([o.name for o in solved.objects], solved.sketches) == (["crate"], ())


def test_a_moved_camera_is_noticed_and_put_back(addon, module, bench):
    scene = opened(addon, bench)
    stands = module("addon.cell.cell_scene").camera_stands
    assert stands(scene)
    scene.camera.location.x += 0.01
    assert not stands(scene)
    addon.ops.monocell.look_through()
    assert stands(scene)
    scene.render.resolution_x = 640
    assert not stands(scene)


def test_the_gltf_carries_the_objects_and_the_users_scene_stays(addon, bench, tmp_path):
    scene = opened(addon, bench)
    add(addon, "box", bench_cell.box_picks())
    assert addon.ops.monocell.export_gltf(filepath=str(tmp_path / "x.glb")) == {"FINISHED"}
    data = (tmp_path / "x.glb").read_bytes()
    document = json.loads(data[20 : 20 + int.from_bytes(data[12:16], "little")])
    assert {node["name"] for node in document["nodes"]} == {"box", "camera"}
    assert addon.context.scene == scene


def test_every_picture_can_be_shown_behind_the_view(addon, bench):
    scene = opened(addon, bench)
    addon.ops.monocell.show_picture(picture="ball_1.png")
    assert scene.monocell_cell.shown_picture == "ball_1.png"
    assert len(scene.camera.data.background_images) == 1


def test_what_the_user_deleted_is_made_again(addon, module, bench, tmp_path):
    scene = opened(addon, bench)
    addon.data.objects.remove(scene.camera)
    addon.data.collections.remove(scene.monocell_cell.collection)
    assert not module("addon.cell.cell_scene").camera_stands(scene)
    addon.ops.monocell.look_through()
    add(addon, "box", bench_cell.box_picks())
    assert module("addon.cell.cell_scene").camera_stands(scene)
    assert [thing.name for thing in saved(addon, tmp_path / "x.cell.json").objects] == ["box"]


def test_a_duplicate_in_blender_is_a_second_object(addon, bench, tmp_path):
    scene = opened(addon, bench)
    add(addon, "box", bench_cell.box_picks())
    copy = scene.objects["box"].copy()
    copy.location.x += 0.3
    scene.monocell_cell.collection.objects.link(copy)
    names = [thing.name for thing in saved(addon, tmp_path / "x.cell.json").objects]
    assert names == ["box", "box.001"]


def test_a_box_is_added_while_another_is_edited(addon, bench, tmp_path):
    opened(addon, bench)
    add(addon, "box", bench_cell.box_picks(), name="first")
    addon.ops.object.mode_set(mode="EDIT")
    assert add(addon, "box", bench_cell.box_picks(), name="second") == {"FINISHED"}
    names = {thing.name for thing in saved(addon, tmp_path / "x.cell.json").objects}
    assert {"first", "second"} <= names


def test_a_script_that_names_the_export_s_format_prints_no_traceback(addon, bench, tmp_path, capfd):
    opened(addon, bench)
    path = tmp_path / "cell.stl"
    add(addon, "box", bench_cell.box_picks())
    assert addon.ops.monocell.export_gltf(filepath=str(path), format="STL") == {"FINISHED"}
    assert path.stat().st_size > 80
    assert "Traceback" not in "".join(capfd.readouterr())
