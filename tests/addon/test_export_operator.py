# SPDX-License-Identifier: GPL-3.0-or-later
"""One operator exports every format: from its menu, and from a script by the file's ending."""

from __future__ import annotations

import json

import bench_cell
import pytest
from monocell.core.formats.endings import FORMATS

pytestmark = pytest.mark.blender


def opened(bpy, path):
    bpy.ops.monocell.open_cell(filepath=str(path))
    picks = json.dumps(bench_cell.box_picks())
    bpy.ops.monocell.add_box("EXEC_DEFAULT", True, picks=picks, name="Kiste ä")
    return bpy.context.scene


def test_the_ending_of_the_file_tells_the_format(addon, bench, tmp_path):
    scene = opened(addon, bench)
    for ending in FORMATS:
        path = tmp_path / f"bench{ending}"
        assert addon.ops.monocell.export_gltf(filepath=str(path)) == {"FINISHED"}
        assert path.stat().st_size > 100
        assert addon.context.scene == scene
    assert scene.objects["Kiste ä"]
    assert '<link name="Kiste_a">' in (tmp_path / "bench.urdf").read_text()


def test_formats_are_written_while_the_user_edits_a_mesh_and_he_goes_on_editing(
    addon, bench, tmp_path
):
    scene = opened(addon, bench)
    addon.context.view_layer.objects.active = scene.objects["Kiste ä"]
    addon.ops.object.mode_set(mode="EDIT")
    for ending in (".obj", ".stl", ".ply", ".usda", ".gltf"):
        path = tmp_path / f"bench{ending}"
        assert addon.ops.monocell.export_gltf(filepath=str(path)) == {"FINISHED"}
        assert path.stat().st_size > 500
    assert addon.context.mode == "EDIT_MESH" and addon.context.scene == scene


def test_an_unknown_ending_is_refused_with_the_list(addon, bench, tmp_path):
    opened(addon, bench)
    with pytest.raises(RuntimeError, match=r"no format ends in \.dae; name it one of \.glb"):
        addon.ops.monocell.export_gltf(filepath=str(tmp_path / "bench.dae"))
    assert list(tmp_path.iterdir()) == []


def test_choosing_the_format_changes_the_ending_that_is_offered(addon, module, bench):
    opened(addon, bench)
    cls = module("addon.operators.export_gltf").ExportCell

    class Chosen:
        """What Blender's file browser shows of the operator."""

        check_extension = True
        filename_ext = cls.filename_ext
        check = cls.check
        filepath, format = "/here/bench.glb", "URDF"

    chosen = Chosen()
    assert chosen.check(addon.context)
    assert chosen.filepath == "/here/bench.urdf"


def test_every_entry_of_the_menu_is_a_format_with_a_tooltip(addon, module, bench):
    menus = module("addon.menus")
    offered = {**menus.ROBOT_FORMATS, **menus.FORMATS_3D}
    assert set(offered) == set(FORMATS) - {".world", ".mjcf", ".usdc"}
    cls = module("addon.operators.export_gltf").ExportCell

    class Properties:
        format = "STL"

    assert cls.description(addon.context, Properties) == (
        f"Export objects and camera: {FORMATS['.stl']}"
    )


def test_a_wait_that_is_felt_is_told_with_its_length(addon, module):
    lasting = module("addon.operators.export_gltf").lasting
    assert [lasting(0.2), lasting(0.6), lasting(12.34)] == ["", " in 0.6 s", " in 12.3 s"]
