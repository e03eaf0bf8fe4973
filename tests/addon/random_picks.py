# SPDX-License-Identifier: GPL-3.0-or-later
"""What a random user clicks: a kind of solid in, picks that may be one out."""

from __future__ import annotations

import json

import bench_cell
import numpy as np

KINDS = ("box", "cylinder", "cone", "tube", "sphere", "prism")
JUNK = ("", "[]", "{", '{"base": 3}', '{"base": [[1, 2]]}', '{"rim": [["a", 1]]}', '{"x": []}')
MOST_CLICKS = 12


class PickMoves:
    """Moves that add solids, each of them by the add-on's own plan of clicks."""

    def does_add_solid(self):
        kind = self.one_of(KINDS)
        way = self.one_of(name for name, *_ in self.module("addon.picking.pick_plans").WAYS[kind])
        picks = self._clicked(kind, way)
        if picks is None:
            return
        known = {"height": 0.1} if kind != "sphere" and self.chance(0.2) else {}
        known = {"radius": 0.05} if way == "FLOATING" else known
        self.press(
            f"add_{kind}", picks=json.dumps(picks), known=json.dumps(known), way=way, on=self._on()
        )

    does_add_solid.often = 24

    def does_add_nonsense(self):
        verb = f"add_{self.one_of(KINDS)}"
        self.press(verb, picks=self.one_of(JUNK), on=self.one_of(["", "nothing", "a.b.c"]))

    def does_add_true_box(self):
        noise = self.rng.uniform(0, 2)
        self.press("add_box", picks=json.dumps(bench_cell.box_picks(noise)))

    def does_move_pick(self):
        cell = self.cell()
        thing = self.one_of(cell.objects) if cell else None
        places = [
            (role, i, pixel)
            for role, pixels in (thing.picks if thing is not None else {}).items()
            for i, pixel in enumerate(pixels)
            if pixel is not None
        ]
        if places:
            role, index, pixel = self.one_of(places)
            to = np.array(pixel) + self.rng.normal(0, 15, 2)
            self.press("move_pick", name=thing.name, role=role, index=index, pixel_at=to)
        else:
            self.press("move_pick", role="base", pixel_at=(100, 100))

    does_move_pick.often = 6

    def does_upright(self):
        feet = bench_cell.CAMERA.project(self.rng.uniform([0, -0.3, 0], [0.7, 0.3, 1e-9], (2, 3)))
        verb = self.one_of(["add_upright_plane", "add_upright_line"])
        picks = self.one_of([feet.tolist(), feet[:1].tolist(), [], [feet[0].tolist()] * 2])
        self.press(verb, picks=json.dumps(picks), on=self.one_of(["", "", "floor", self.path()]))

    def path(self):
        """Something that may be named: a reference, an object, a feature of one, or nothing."""
        cell = self.cell()
        if cell is None:
            return "nothing.top"
        features = self.module("core.shape.features").feature_names
        paths = [reference.name for reference in cell.references]
        paths += [f"{thing.name}.{name}" for thing in cell.objects for name in features(thing)]
        paths += [thing.name for thing in cell.objects] + ["nothing.top"]
        return self.one_of(paths)

    def _on(self):
        return "" if self.chance(0.7) else self.path()

    def _clicked(self, kind, way):
        """Picks by the add-on's plan, at a solid that may stand on the floor; None without a cell.

        The hand shakes by up to two pixels.
        """
        cell = self.cell()
        if cell is None or cell.camera.camera_from_world is None:
            return None
        plan = self.module("addon.picking.pick_plans").plan_of(kind, way)
        session = self.module("addon.picking.pick_session").PickSession(
            plan, cell.standing_camera(), cell.reference("floor") if _has_floor(cell) else None
        )
        pixels = list(self._outline(kind) + self.rng.uniform(-1, 1, 2) * self.rng.uniform(0, 2))
        corners = int(self.rng.integers(3, 6))
        for k in range(MOST_CLICKS):
            if session.complete:
                break
            if k == corners and session.closes(None, 0.0):
                session = session.with_closed()
            pixel = pixels.pop(0) if pixels else self.rng.uniform([100, 100], [700, 500])
            session = session.picked(np.array(pixel))
        return session.picks()

    def _outline(self, kind):
        """Pixels (N, 2) of a solid's foot, in order, and of its top."""
        centre = np.array([*self.rng.uniform([0.15, -0.25], [0.6, 0.25]), 0.0])
        radius, height = self.rng.uniform(0.03, 0.12, 2)
        at = self.rng.uniform(0, 7) + np.array([0.0, 1.6, 3.1, 4.7])
        ring = np.stack([np.cos(at), np.sin(at), np.zeros(4)], axis=1) * radius
        up = np.array([0.0, 0.0, height])
        if kind == "sphere":
            middle = bench_cell.CAMERA.project(centre[None] + up)
            return middle + 25 * ring[:3, :2] / radius
        foot, top = centre + ring, centre + 0.7 * ring + up
        if kind in ("box", "prism"):
            return bench_cell.CAMERA.project(np.array([*foot[:3], foot[1] + up]))
        return bench_cell.CAMERA.project(np.array([*foot[:3], *top]))


def _has_floor(cell):
    return any(reference.name == "floor" for reference in cell.placed_references)
