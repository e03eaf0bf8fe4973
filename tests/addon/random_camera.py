# SPDX-License-Identifier: GPL-3.0-or-later
"""A random user's moves with the camera: lens estimates, other cameras, points with balls."""

from __future__ import annotations

import json
from pathlib import Path

import bench_cell
import numpy as np

BOARDS = Path(__file__).resolve().parents[2] / "samples" / "02_cameras" / "board"
STATED = (
    {"camera_source": "ANGLE", "field_degrees": 60.0, "lens_model": "none"},
    {"camera_source": "ANGLE", "field_degrees": 55.0, "lens_model": "plumb_bob"},
    {"camera_source": "PIXELS", "focal_x": 760.0, "focal_y": 757.0, "lens_model": "none"},
    {"camera_source": "BOARD"},
)


class CameraMoves:
    """What a camera is known from, and what it is known by."""

    def does_change_camera(self):
        stated = self.one_of([*STATED, None, None])
        inputs = self.scene.monocell_inputs
        if stated is None:
            inputs.camera_source, inputs.camera = "FILE", self.camera_file()
        else:
            inputs.coefficients = ""
            for name, value in stated.items():
                setattr(inputs, name, value)
        self.by_hand(f"stated {stated}")
        self.press("change_camera")

    def does_estimate_lens(self):
        """As many pictures of a board as are enough, or too few, or none."""
        lens = self.scene.monocell_lens
        lens.model = self.one_of(["none", "plumb_bob"])
        lens.corners_x = self.one_of([9, 9, 9, 8])
        numbers = self.one_of([(0, 3, 5), (0, 3, 5, 8), (0, 3), ()])
        files = [{"name": f"board_{number:02d}.jpg"} for number in numbers]
        folder = BOARDS if files else self.folder
        self.press("estimate_lens", directory=str(folder), files=files)

    does_estimate_lens.often = 2

    def does_open_board(self):
        """The picture that a lens estimate is for."""
        self.scene.monocell_inputs.camera_source = self.one_of(["BOARD", "BOARD", "ANGLE"])
        self.press("open_picture", picture=str(BOARDS / "board_00.jpg"))

    does_open_board.often = 1

    def does_calibrate_with_points(self):
        """Corners of the box whose place is known, clicked, with the balls or instead of them."""
        if self.stored.text == "":
            return
        places = bench_cell.BOX.corners_world()[: int(self.rng.integers(2, 7))]
        pixels = bench_cell.CAMERA.project(places) + self.rng.normal(0, 0.5, (len(places), 2))
        inputs = self.scene.monocell_inputs
        inputs.place_source, inputs.position_unit = "TYPED", "m"
        for place, pixel in zip(places, pixels, strict=True):
            inputs.place = place
            self.press("add_point", pixel_at=np.round(pixel, 2).tolist())
        if self.chance(0.5):
            for row in self.stored.sightings:
                row.use = row.radius == 0
            self.by_hand("balls switched off")
        self.press("calibrate")

    does_calibrate_with_points.often = 2

    def does_usual_work(self):
        """What is usually done to two objects, in a file with nothing else."""
        self.press("open_cell", filepath=str(self.bench / "bench.cell.json"))
        self.press("add_box", picks=json.dumps(bench_cell.box_picks(self.rng.uniform(0, 2))))
        self.press("add_cylinder", picks=json.dumps(bench_cell.drum_picks()), name="drum")
        work = [
            ("add_relation", {"name": "drum", "kind": "parallel", "to": "box.axis", "own": "axis"}),
            ("remove_relation", {"name": "drum", "index": 0}),
            ("set_motion", {"name": "drum", "kind": "movable", "mass": 1.0}),
            ("take_colors", {"everything": True}),
            ("take_textures", {"everything": True}),
            ("align", {"name": "drum"}),
            ("solve_again", {}),
            ("propose", {"on": "floor", "doubtful": True}),
        ]
        for i in self.rng.permutation(len(work))[: int(self.rng.integers(2, 9))]:
            verb, properties = work[i]
            self.press(verb, **properties)

    def camera_file(self):
        """The bench's own camera, or one of a longer lens and no distortion."""
        path, text = self.folder / "camera.yaml", bench_cell.ros_camera()
        if self.chance(0.5):
            text = text.replace(str(bench_cell.INTRINSICS.fx), "900.0")
        path.write_text(text)
        return str(path)
