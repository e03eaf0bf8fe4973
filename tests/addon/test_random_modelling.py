# SPDX-License-Identifier: GPL-3.0-or-later
"""Random modelling: whatever is done in whatever order, the document stays valid, and no traceback.

A refusal is an answer; a traceback, a document that can't be read, or a scene that undo and redo
leave otherwise than it was is not.
"""

import json

import bench_cell
import numpy as np
import pytest
from monocell.core.document.cell_file import read_cell
from monocell.core.relation import RELATIONS
from monocell.core.shape.features import feature_names

pytestmark = [pytest.mark.blender, pytest.mark.slow]

STEPS, SEEDS = 60, range(4)


class Hand:
    """One user's random session."""

    def __init__(self, bpy, path, folder, seed):
        self.bpy, self.ops, self.folder = bpy, bpy.ops.monocell, folder
        self.rng = np.random.default_rng(seed)
        self.ops.open_cell(filepath=str(path))
        bpy.ops.ed.undo_push(message="opened")
        self.steps = [getattr(self, n) for n in dir(type(self)) if n.startswith("does_")]

    def step(self):
        """Do something; a refusal has to be one line."""
        chosen = self.steps[self.rng.integers(len(self.steps))]
        try:
            chosen()
        except RuntimeError as refusal:
            told = str(refusal)
            assert told.startswith("Error: "), (chosen.__name__, told)
            assert "Traceback" not in told, (chosen.__name__, told)

    def saved(self):
        path = self.folder / "now.cell.json"
        assert self.ops.save_cell(filepath=str(path)) == {"FINISHED"}
        return path.read_text(), read_cell(path)

    def thing(self):
        _, cell = self.saved()
        return cell.objects[self.rng.integers(len(cell.objects))] if cell.objects else None

    def path(self):
        _, cell = self.saved()
        paths = [r.name for r in cell.references]
        paths += [f"{t.name}.{name}" for t in cell.objects for name in feature_names(t)]
        paths += [t.name for t in cell.objects] + ["nothing.top"]
        return paths[self.rng.integers(len(paths))]

    def does_add_box(self):
        picks = bench_cell.box_picks(noise=2.0)
        self.ops.add_box("EXEC_DEFAULT", True, picks=json.dumps(picks))

    def does_add_drum(self):
        way = ("STANDING", "LYING")[self.rng.integers(2)]
        picks = bench_cell.drum_picks(tops=2)
        self.ops.add_cylinder("EXEC_DEFAULT", True, picks=json.dumps(picks), way=way)

    def does_add_ball(self):
        around = np.array([[0, 30], [28, -10], [-28, -10]])
        middle = bench_cell.CAMERA.project(np.array([[0.45, 0.0, 0.05]]))
        self.ops.add_sphere(
            "EXEC_DEFAULT", True, picks=json.dumps({"outline": (middle + around).tolist()})
        )

    def does_size(self):
        thing = self.thing()
        if thing is not None:
            names = thing.size_names
            self.ops.set_size(
                "EXEC_DEFAULT",
                True,
                name=thing.name,
                size=names[self.rng.integers(len(names))],
                metres=float(self.rng.normal(0.1, 0.06)),
                known=bool(self.rng.integers(2)),
            )

    def does_relate(self):
        thing = self.thing()
        if thing is not None:
            kinds = list(RELATIONS)
            kind = kinds[self.rng.integers(len(kinds))]
            own = ("", "", "top", "axis")[self.rng.integers(4)]
            about = "floor" if kind == "symmetric" else ""
            self.ops.add_relation(
                "EXEC_DEFAULT",
                True,
                name=thing.name,
                kind=kind,
                to=self.path(),
                own=own,
                about=about,
            )

    def does_let_go(self):
        thing = self.thing()
        if thing is not None:
            index = int(self.rng.integers(-1, 2))
            self.ops.remove_relation("EXEC_DEFAULT", True, name=thing.name, index=index)

    def does_stand(self):
        thing = self.thing()
        if thing is not None:
            self.ops.stand_on("EXEC_DEFAULT", True, name=thing.name, on=self.path())

    def does_choose(self):
        self.ops.pick_reference("EXEC_DEFAULT", True, of=self.path())

    def does_parallel(self):
        distance = float(self.rng.normal(0, 0.1))
        self.ops.add_parallel_plane("EXEC_DEFAULT", True, to=self.path(), distance=distance)

    def does_wall(self):
        feet = bench_cell.CAMERA.project(self.rng.uniform([0, -0.3, 0], [0.7, 0.3, 1e-9], (2, 3)))
        self.ops.add_upright_plane("EXEC_DEFAULT", True, picks=json.dumps(feet.tolist()))

    def does_forget_reference(self):
        self.ops.remove_reference("EXEC_DEFAULT", True)

    def does_move_pick(self):
        thing = self.thing()
        places = [
            (role, i, pixel)
            for role, pixels in (thing.picks if thing is not None else {}).items()
            for i, pixel in enumerate(pixels)
            if pixel is not None
        ]
        if places:
            role, index, pixel = places[self.rng.integers(len(places))]
            to = np.array(pixel) + self.rng.normal(0, 15, 2)
            self.ops.move_pick(
                "EXEC_DEFAULT", True, name=thing.name, role=role, index=index, pixel_at=to
            )

    def does_motion(self):
        thing, to = self.thing(), self.thing()
        if thing is not None:
            kind = ("static", "movable", "attached")[self.rng.integers(3)]
            self.ops.set_motion(
                "EXEC_DEFAULT",
                True,
                name=thing.name,
                kind=kind,
                mass=1.0 * (kind != "static"),
                to=to.name,
                joint="hinge",
            )

    def ob(self):
        held = self.bpy.context.scene.monocell_cell.collection
        obs = list(held.objects) if held is not None else []
        return obs[self.rng.integers(len(obs))] if obs else None

    def does_rename(self):
        ob = self.ob()
        if ob is not None:
            ob.name = f"thing {self.rng.integers(99)}"
            self.bpy.ops.ed.undo_push(message="renamed")

    def does_delete(self):
        ob = self.ob()
        if ob is not None:
            self.bpy.data.objects.remove(ob)
            self.bpy.ops.ed.undo_push(message="deleted")

    def does_copy(self):
        ob = self.ob()
        if ob is not None:
            self.bpy.context.scene.monocell_cell.collection.objects.link(ob.copy())
            self.bpy.ops.ed.undo_push(message="copied")

    def does_shift(self):
        ob = self.ob()
        if ob is not None:
            ob.location.x += 0.02
            self.bpy.ops.ed.undo_push(message="moved")

    def does_edit_mode(self):
        ob = self.ob()
        if ob is not None and self.bpy.context.mode == "OBJECT":
            self.bpy.context.view_layer.objects.active = ob
            self.bpy.ops.object.mode_set(mode="EDIT")
        elif self.bpy.context.mode != "OBJECT":
            self.bpy.ops.object.mode_set(mode="OBJECT")

    def does_solve_again(self):
        self.ops.solve_again("EXEC_DEFAULT", True)

    def does_colour(self):
        self.ops.take_colors("EXEC_DEFAULT", True, everything=True)


@pytest.mark.parametrize("seed", SEEDS)
def test_whatever_is_done_the_document_stays_valid(addon, bench, tmp_path, seed):
    hand = Hand(addon, bench, tmp_path, seed)
    for _ in range(STEPS):
        hand.step()
        before, _ = hand.saved()
        if hand.rng.random() < 0.15 and addon.context.mode == "OBJECT":
            addon.ops.ed.undo_push(message="now")
            before, _ = hand.saved()
            addon.ops.ed.undo()
            hand.saved()
            addon.ops.ed.redo()
            assert hand.saved()[0] == before
