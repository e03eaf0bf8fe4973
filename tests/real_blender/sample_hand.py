# SPDX-License-Identifier: GPL-3.0-or-later
"""A hand on the sample to be modelled: its truth in, pixels of the view, off by an error, out.

The pixels are of the undistorted picture, which is what the window shows.
"""

from pathlib import Path

import numpy as np
from monocell.core.document.cell_file import read_cell

SAMPLE = Path(__file__).resolve().parents[2] / "samples" / "03_stack"
# the corners of a box in order round its foot
ROUND = (0, 1, 3, 2)
# where a rim is picked: left, front and right, radians from the side that faces the camera
LEFT_FRONT_RIGHT = (-1.2, 0.0, 1.2)
TOP_FRONT_BACK = (0.0, np.pi)
# how far the carton's free top lies from its middle, metres along its sides
FREE_TOP = (0.07, 0.03)


class Hand:
    """Clicks on the truth of a cell, each off by `sigma` pixels of the picture in u and in v."""

    def __init__(self, sigma, seed):
        self.truth = read_cell(SAMPLE / "truth.cell.json")
        self.things = {thing.name: thing for thing in self.truth.objects}
        self.sigma, self.rng = sigma, np.random.default_rng(seed)

    def job(self):
        """All clicks of the session, by the thing they are on."""
        size = self.truth.camera.intrinsics.undistorted()
        return {
            "width": size.width,
            "height": size.height,
            "carton": self.box("carton"),
            "carton_top": self.free_top(),
            "can": self.cylinder("can"),
            "block": self.box("block"),
            "cone": self.cone("cone"),
        }

    def box(self, name):
        """Three corners of the foot that are seen, going round, and the one above the middle."""
        thing = self.things[name]
        corners = thing.corners_world()
        at = ROUND.index(int(np.argmax(self._view(corners[:4], 0.0)[:, 1])))
        ring = [ROUND[(at + step) % 4] for step in (-1, 0, 1)]
        picked = self._view(corners[[*ring, ring[1] + 4]], self.sigma).tolist()
        return {"base": picked[:3], "top": picked[3]}

    def cylinder(self, name):
        """Three points of the rim it stands on, and of the top's the nearest and the farthest."""
        thing = self.things[name]
        base = self._ring(thing, LEFT_FRONT_RIGHT, -thing.height / 2)
        top = self._ring(thing, TOP_FRONT_BACK, thing.height / 2)
        return {
            "rim": self._view(base, self.sigma).tolist(),
            "top": self._view(top, self.sigma).tolist(),
        }

    def cone(self, name):
        """Three points of the rim it stands on, and its tip."""
        thing = self.things[name]
        tip = thing.world_from_object.apply(np.array([[0.0, 0.0, thing.height / 2]]))
        base = self._ring(thing, LEFT_FRONT_RIGHT, -thing.height / 2)
        return {
            "rim": self._view(base, self.sigma).tolist(),
            "apex": self._view(tip, self.sigma)[0].tolist(),
        }

    def free_top(self):
        """A place on the carton's top that the can leaves free."""
        carton = self.things["carton"]
        place = np.array([[*FREE_TOP, carton.half_extent[2]]])
        return self._view(carton.world_from_object.apply(place), 0.0)[0].tolist()

    def _ring(self, thing, angles, z):
        eye = thing.world_from_object.inverse().apply(self.truth.camera.centre_world)
        at = np.arctan2(eye[1], eye[0]) + np.array(angles)
        rim = thing.radius * np.stack([np.cos(at), np.sin(at)], axis=1)
        return thing.world_from_object.apply(np.column_stack([rim, np.full(len(at), z)]))

    def _view(self, points, sigma):
        """Where points (N, 3) of the world lie in the view, (N, 2); with the hand's error."""
        camera = self.truth.camera
        pixels = camera.project(points)
        rays = camera.intrinsics.rays(pixels + self.rng.normal(0.0, 1.0, pixels.shape) * sigma)
        return camera.intrinsics.undistorted().project(rays)
