# SPDX-License-Identifier: GPL-3.0-or-later
"""A random user's moves with the add-on's own operators and with the fields of its panels."""

from __future__ import annotations

import bench_cell
from monocell.core.relation import RELATIONS

TEXTS = ("", "a b", "1 2", "{}", "[[1]]", "0.3 0.1 0.2", "x,y,z\n0.3,0.1,0.2\n0.1,0.1,0.2")
FIELDS = {
    "camera_source": ("FILE", "PIXELS", "ANGLE", "BOARD"),
    "focal_x": (0.0, 700.0, 1e9),
    "field_degrees": (1.0, 60.0, 170.0),
    "centred": (True, False),
    "lens_model": ("none", "plumb_bob", "equidistant"),
    "coefficients": ("", "0.1", "-0.2 0.1 0 0 0", "a"),
    "pick_sigma_pixels": (0.05, 1.0, 50.0),
    "show_grid": (True, False),
    "ball_radius": (1e-5, 0.04, 0.5),
    "position_unit": ("m", "mm", "cm", "in"),
    "place_source": ("TYPED", "CURSOR", "OBJECT", "JOINTS"),
    "place": ((0.3, 0.1, 0.2), (0, 0, 0), (1e9, 0, 0)),
    "offset_known": (True, False),
    "offset": ((0, 0, 0), (0, 0, 0.1)),
    "joints": ("", "1 2", "a"),
    "urdf": ("", "no.urdf"),
}
LOOKS = {
    "line_width": (0.5, 3.0),
    "snap": (True, False),
    "loupe": (True, False),
    "unit": ("mm", "cm", "m", "in"),
    "object_color": ((1, 0, 0, 1), (0, 0.5, 1, 0.2)),
}


class VerbMoves:
    """Sightings, calibration, references, relations, sizes, looks."""

    def does_sighting_field(self):
        rows = self.stored.sightings
        if not len(rows):
            return
        row, field = self.one_of(rows), self.one_of(["use", "center", "radius", "active"])
        if field == "use":
            row.use = not row.use
        elif field == "center":
            row.center[int(self.rng.integers(3))] = float(self.rng.normal(0.3, 0.2))
        elif field == "radius":
            row.radius = float(self.one_of([self.rng.uniform(0.001, 0.1), 1e6, 0.0]))
        else:
            self.stored.sighting_index = row.index
        self.by_hand(f"sighting's {field}")

    does_sighting_field.often = 8

    def does_remove_sighting(self):
        self.press("remove_sighting")

    def does_paste(self):
        i = int(self.rng.integers(5))
        place = " ".join(str(v) for v in bench_cell.CENTRES[i])
        text = self.one_of([f"ball_{i}.png {place}", *TEXTS[1:]])
        self.press("paste_sightings", text=text, becomes=self.one_of(["NEW", "PLACES"]))

    def does_read_sightings(self):
        path = self.bench / "given.csv"
        path.write_text(self.one_of(["picture,x,y,z\nball_1.png,0.55,-0.15,0.12\n", "", "a,b\n1"]))
        self.press("read_sightings", filepath=str(self.one_of([path, self.bench / "none.csv"])))

    def does_add_pictures(self):
        count = int(self.rng.integers(0, 5))
        files = [{"name": f"ball_{i}.png"} for i in range(count)]
        places = bench_cell.CENTRES[: self.one_of([count, count, 1])]
        positions = "\n".join(" ".join(str(v) for v in place) for place in places)
        self.press("add_pictures", directory=str(self.bench), files=files, positions=positions)

    def does_add_sighting(self):
        self.press("add_sighting", picture=self.one_of(["", "ball_2.png", "none.png"]))

    def does_add_point(self):
        self.press("add_point", pixel_at=self.rng.uniform([-50, -50], [850, 650]))

    def does_window(self):
        self.press("drag_window", window=self.rng.uniform([-50, -50, -9, 0], [700, 500, 300, 300]))

    def does_clear_window(self):
        self.press("clear_window")

    def does_find_all(self):
        self.press("find_all")

    does_find_all.often = 2

    def does_calibrate(self):
        self.press("calibrate")

    does_calibrate.often = 3

    def does_cancel_work(self):
        self.press("cancel_work")

    does_cancel_work.often = 1

    def does_show_picture(self):
        self.press("show_picture", picture=self.one_of(["bench.png", "ball_0.png", "none.png"]))

    def does_look_through(self):
        self.press("look_through")

    def does_find_pictures(self):
        self.press("find_pictures", directory=str(self.bench))

    does_find_pictures.often = 1

    def does_opacity(self):
        camera = self.stored.camera
        if camera is not None and len(camera.data.background_images):
            camera.data.background_images[0].alpha = float(self.rng.random())
            self.by_hand("opacity")

    does_opacity.often = 1

    def does_type_input(self):
        name = self.one_of(FIELDS)
        setattr(self.scene.monocell_inputs, name, self.one_of(FIELDS[name]))
        self.by_hand(f"input {name}")

    does_type_input.often = 8

    def does_set_preference(self):
        name = self.one_of(LOOKS)
        preferences = self.bpy.context.preferences.addons[
            "bl_ext.user_default.monocell"
        ].preferences
        setattr(preferences, name, self.one_of(LOOKS[name]))

    does_set_preference.often = 1

    def does_choose_reference(self):
        if len(self.stored.references):
            self.stored.reference_index = int(self.rng.integers(len(self.stored.references)))
            self.by_hand("reference chosen")

    does_choose_reference.often = 6

    def does_choose_object(self):
        # one too many at times, as a script may
        self.stored.object_index = int(self.rng.integers(len(self.scene.objects) + 1))
        self.by_hand("object chosen")

    does_choose_object.often = 8

    def does_pick_reference(self):
        self.press("pick_reference", of=self.path())

    does_pick_reference.often = 6

    def does_parallel(self):
        distance = float(self.one_of([0.0, 0.1, self.rng.normal(0, 0.1), 1e6]))
        self.press("add_parallel_plane", to=self.one_of(["", self.path()]), distance=distance)

    does_parallel.often = 2

    def does_remove_reference(self):
        self.press("remove_reference", name=self.one_of(["", "", "floor", "nothing"]))

    def does_size(self):
        cell = self.cell()
        thing = self.one_of(cell.objects) if cell else None
        if thing is not None:
            metres = float(self.one_of([self.rng.normal(0.1, 0.06), 0.0, 1e6]))
            size, known = self.one_of(thing.size_names), self.chance(0.7)
            self.press("set_size", name=thing.name, size=size, metres=metres, known=known)
        self.press("set_size", size="height", metres=0.1)

    def does_type_size(self):
        fields, i = self.scene.monocell_object, int(self.rng.integers(3))
        if self.chance(0.6):
            setattr(fields, f"size_{i}", float(self.rng.normal(0.1, 0.06)))
        else:
            held = getattr(fields, f"known_{i}")
            setattr(fields, f"known_{i}", not held)
        self.by_hand("size typed")

    does_type_size.often = 8

    def does_relate(self):
        about = self.one_of(["", "floor", self.path()])
        own = self.one_of(["", "", "top", "axis", "side", "nothing"])
        kind, to = self.one_of(RELATIONS), self.path()
        self.press("add_relation", name=self._name(), kind=kind, to=to, own=own, about=about)

    does_relate.often = 10

    def does_let_go(self):
        self.press("remove_relation", name=self._name(), index=int(self.rng.integers(-1, 2)))

    def does_stand_on(self):
        self.press("stand_on", name=self._name(), on=self.one_of(["", self.path()]))

    does_stand_on.often = 6

    def does_motion(self):
        self.press(
            "set_motion",
            name=self._name(),
            kind=self.one_of(["static", "movable", "attached"]),
            mass=self.one_of([0.0, 1.0]),
            density=self.one_of([0.0, 0.0, 1000.0]),
            to=self._name(),
            joint=self.one_of(["fixed", "hinge", "slider"]),
            axis=self.one_of([(0, 0, 1), (0, 0, 0), (1, 1, 0)]),
            limited=self.chance(0.3),
            upper=self.one_of([0.0, 1.0]),
        )

    def does_solve_again(self):
        self.press("solve_again", joint=self.chance(0.3))

    does_solve_again.often = 2

    def does_align(self):
        self.press("align", name=self._name(), everything=self.chance(0.3))

    does_align.often = 1

    def does_propose(self):
        on = self.one_of(["", "floor", "floor", "nothing"])
        self.press("propose", on=on, doubtful=self.chance(0.5))

    does_propose.often = 1

    def does_colour(self):
        self.press("take_colors", everything=self.chance(0.5))

    does_colour.often = 2

    def does_texture(self):
        self.press("take_textures", everything=self.chance(0.5))

    does_texture.often = 1

    def _name(self):
        """An object's name in the document, or none for the active one."""
        cell = self.cell()
        names = [thing.name for thing in cell.objects] if cell else []
        return self.one_of(["", "nothing", *names, *names])
