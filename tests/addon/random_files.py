# SPDX-License-Identifier: GPL-3.0-or-later
"""A random user's moves with files: documents, pictures, glTF and .blend opened and saved."""

from __future__ import annotations

import json

import bench_cell


class FileMoves:
    """Open, save, close and open again."""

    def does_open_cell(self):
        self.press("open_cell", filepath=str(self.bench / "bench.cell.json"))

    does_open_cell.often = 2

    def does_open_raw(self):
        """One without a pose."""
        path = self.bench / "raw.cell.json"
        document = json.loads((self.bench / "bench.cell.json").read_text())
        document["camera"].pop("camera_from_world")
        document["camera"].pop("covariance")
        path.write_text(json.dumps(document))
        self.press("open_cell", filepath=str(path))

    does_open_raw.often = 1

    def does_open_wrong(self):
        path = self.folder / "wrong.json"
        path.write_text(self.one_of(["", "{}", '{"monocell": 99}', "[1"]))
        self.press(self.one_of(["open_cell", "open_gltf"]), filepath=str(path))

    does_open_wrong.often = 1

    def does_open_sample(self):
        self.press("open_sample")

    does_open_sample.often = 1

    def does_open_picture(self):
        (self.folder / "camera.yaml").write_text(bench_cell.ros_camera())
        picture = str(self.one_of([self.bench / "bench.png", self.bench / "none.png", ""]))
        camera = self.one_of(["", str(self.folder / "camera.yaml"), str(self.folder / "none.yaml")])
        if self.chance(0.5):
            self.press("open_picture", picture=picture, camera=camera)
        else:
            self.press("drop_picture", filepath=picture)

    does_open_picture.often = 2

    def does_save_and_open_document(self):
        """A document that was saved opens as what it was."""
        before = self.check()
        path = self.bench / "saved.cell.json"
        if self.press("save_cell", filepath=str(path)) != {"FINISHED"}:
            return
        self.press("open_cell", filepath=str(path))
        after = self.check()
        assert _seen(after) == _seen(before), f"saved and opened:\n{before}\n{after}"

    does_save_and_open_document.often = 3

    def does_export_and_open(self):
        if self.chance(0.3):
            ending = self.one_of(["STL", "URDF", "MJCF", "PLY", "nothing"])
            path = self.folder / f"cell.{ending.lower()}"
            self.press("export_gltf", filepath=str(path))
        path = self.folder / "cell.glb"
        if self.press("export_gltf", filepath=str(path), format="GLB") != {"FINISHED"}:
            return
        names = {thing.name for thing in self.cell().objects}
        if self.press("open_gltf", filepath=str(path)) == {"FINISHED"}:
            assert {thing.name for thing in self.cell().objects} == names

    does_export_and_open.often = 3

    def does_save_and_open_blend(self):
        """A .blend that was saved opens as what it was."""
        before = self.check()
        path = str(self.folder / "session.blend")
        self.bpy.ops.wm.save_as_mainfile(filepath=path)
        self.bpy.ops.wm.open_mainfile(filepath=path)
        after = self.check()
        assert after == before, f".blend saved and opened:\n{before}\n{after}"

    does_save_and_open_blend.often = 4

    def does_undo(self):
        for _ in range(int(self.rng.integers(1, 6))):
            if self.bpy.ops.ed.undo.poll():
                self.bpy.ops.ed.undo()

    does_undo.often = 16

    def does_redo(self):
        for _ in range(int(self.rng.integers(1, 4))):
            if self.bpy.ops.ed.redo.poll():
                self.bpy.ops.ed.redo()

    does_redo.often = 10


def _seen(text):
    """A document without the names of its files, whose folder is another."""
    if not text or text.startswith("Error"):
        return text
    document = json.loads(text)
    document.pop("picture", None)
    for sighting in document["sightings"]:
        sighting.pop("picture")
    return document
