# SPDX-License-Identifier: GPL-3.0-or-later
"""Random steps of an operator's work, seeded: whatever is done, the document stays valid."""

import json

import bench_cell
import numpy as np
import pytest
from monocell.core.document.cell_file import read_cell

pytestmark = [pytest.mark.blender, pytest.mark.slow]

STEPS = 120


class Hand:
    """Someone who presses what can be pressed."""

    def __init__(self, bpy, folder, seed):
        self.bpy, self.ops, self.folder = bpy, bpy.ops.monocell, folder
        self.rng = np.random.default_rng(seed)
        self.refusals = []

    @property
    def scene(self):
        return self.bpy.context.scene

    def any_of(self, names):
        return names[self.rng.integers(len(names))]

    def press(self, operator, **properties):
        """An operator as the interface calls it: refused in one line, or done and undoable."""
        try:
            operator("EXEC_DEFAULT", True, **properties)
        except RuntimeError as refusal:
            assert "Traceback" not in str(refusal), refusal
            self.refusals.append(str(refusal))

    def step(self):
        getattr(self, self.any_of([name for name in dir(self) if name.startswith("do_")]))()

    def do_add_box(self):
        self.press(self.ops.add_box, picks=json.dumps(bench_cell.box_picks(noise=2.0)))

    def do_add_cylinder(self):
        self.press(self.ops.add_cylinder, picks=json.dumps(bench_cell.drum_picks()))

    def do_bad_picks(self):
        picks = {"base": self.rng.uniform(-100, 900, (3, 2)).tolist()}
        self.press(self.ops.add_box, picks=json.dumps(picks))

    def do_undo(self):
        if self.bpy.ops.ed.undo.poll():
            self.bpy.ops.ed.undo()

    def do_redo(self):
        if self.bpy.ops.ed.redo.poll():
            self.bpy.ops.ed.redo()

    def do_delete(self):
        things = [ob for ob in self.scene.objects if ob.type == "MESH"]
        if things:
            self.bpy.data.objects.remove(self.any_of(things))

    def do_rename(self):
        things = [ob for ob in self.scene.objects if ob.type == "MESH"]
        if things:
            self.any_of(things).name = self.any_of(["box", "x", "a b", "Cell camera"])

    def do_duplicate(self):
        things = [ob for ob in self.scene.objects if ob.type == "MESH"]
        if things:
            copy = self.any_of(things).copy()
            copy.data = copy.data.copy()
            self.scene.monocell_cell.collection.objects.link(copy)

    def do_move(self):
        things = [ob for ob in self.scene.objects if ob.type == "MESH"]
        if things:
            self.any_of(things).location.x += float(self.rng.uniform(-0.1, 0.1))

    def do_switch(self):
        rows = self.scene.monocell_cell.sightings
        if len(rows):
            row = self.any_of(list(rows))
            row.use = not row.use

    def do_edit_place(self):
        rows = self.scene.monocell_cell.sightings
        if len(rows):
            self.any_of(list(rows)).center[2] += 1e-4

    def do_remove_sighting(self):
        self.scene.monocell_cell.sighting_index = int(self.rng.integers(8))
        self.press(self.ops.remove_sighting)

    def do_paste(self):
        i = int(self.rng.integers(5))
        place = " ".join(str(v) for v in bench_cell.CENTRES[i])
        self.press(self.ops.paste_sightings, text=f"ball_{i}.png {place}")

    def do_nonsense(self):
        self.press(self.ops.paste_sightings, text=self.any_of(["", "a b", "1 2", "{}", "[[1]]"]))

    def do_calibrate(self):
        self.press(self.ops.calibrate)

    def do_find(self):
        self.press(self.ops.find_all)

    def do_window(self):
        self.press(self.ops.drag_window, window=self.rng.uniform(0, 400, 4))

    def do_solve_again(self):
        self.press(self.ops.solve_again)

    def do_move_camera(self):
        self.scene.camera.location.x += 0.01
        self.press(self.ops.look_through)

    def do_save_and_load(self):
        path = str(self.folder / "x.blend")
        self.bpy.ops.wm.save_as_mainfile(filepath=path)
        self.bpy.ops.wm.open_mainfile(filepath=path)


@pytest.mark.parametrize("seed", [1, 2])
def test_the_document_stays_valid_whatever_is_done(addon, raw_bench, tmp_path, seed):
    addon.ops.monocell.open_cell("EXEC_DEFAULT", True, filepath=str(raw_bench))
    hand, path = Hand(addon, tmp_path, seed), tmp_path / "now.cell.json"
    for _ in range(STEPS):
        hand.step()
        if not hand.scene.monocell_cell.text:
            # undone to before the cell was opened
            addon.ops.monocell.open_cell("EXEC_DEFAULT", True, filepath=str(raw_bench))
        rows = hand.scene.monocell_cell.sightings
        addon.ops.monocell.save_cell(filepath=str(path))
        cell = read_cell(path)
        assert len(cell.sightings) == len(rows)
        assert [one.use for one in cell.sightings] == [row.use for row in rows]
        meshes = [ob.name for ob in hand.scene.objects if ob.type == "MESH"]
        assert sorted(thing.name for thing in cell.objects) == sorted(meshes)
    assert hand.refusals
