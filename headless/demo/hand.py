# SPDX-License-Identifier: GPL-3.0-or-later
"""An operator's hand: true objects in, the pixels a person would pick on them out, with error."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...core.arrays import Array
from ...core.camera import Camera
from ...core.primitives import Box, Cylinder, Primitive
from ...core.sketch import Sketch

# a base rim is seen on the camera's side, a top rim all round
RIM_DEGREES, TOP_DEGREES = (-65.0, 0.0, 65.0), (-120.0, 0.0, 120.0)


def pick_objects(
    camera: Camera, objects: tuple[Primitive, ...], sigma_pixels: float, seed: int
) -> tuple[Sketch, ...]:
    """What a hand picks on the true objects as `camera` truly sees them, off by `sigma_pixels`.

    Only corners and rim points on the camera's side are picked, as only they are seen.
    """
    rng = np.random.default_rng(seed)
    return tuple(_sketch(camera, thing, sigma_pixels, rng) for thing in objects)


def _sketch(
    camera: Camera, thing: Primitive, sigma_pixels: float, rng: np.random.Generator
) -> Sketch:
    def picked(points_world: Array) -> list[Any]:
        pixels = camera.project(points_world)
        return (pixels + rng.normal(0, sigma_pixels, pixels.shape)).tolist()

    places = _box_places(camera, thing) if isinstance(thing, Box) else _rims(camera, thing)
    picks = {role: picked(points) for role, points in places.items()}
    assert thing.on is not None
    return Sketch(thing.name, thing.kind, thing.on, picks, appearance=thing.appearance)


def _box_places(camera: Camera, box: Box) -> dict[str, Array]:
    """The three base corners nearest to the camera in order round, and the tops above them."""
    round_base = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * box.half_extent[:2]
    base = np.column_stack([round_base, np.full(4, -box.half_extent[2])])
    eye = box.world_from_object.inverse().apply(camera.centre_world)
    farthest = int(np.argmax(np.linalg.norm(base - eye, axis=1)))
    seen = base[[(farthest + i) % 4 for i in (1, 2, 3)]]
    top = seen * [1, 1, -1]
    return {role: box.world_from_object.apply(p) for role, p in (("base", seen), ("top", top))}


def _rims(camera: Camera, thing: Primitive) -> dict[str, Array]:
    assert isinstance(thing, Cylinder)
    eye = thing.world_from_object.inverse().apply(camera.centre_world)
    towards = float(np.degrees(np.arctan2(eye[1], eye[0])))

    def rim(degrees: tuple[float, ...], z: float) -> Array:
        phi = np.radians(towards + np.array(degrees))
        ring = thing.radius * np.stack([np.cos(phi), np.sin(phi)], axis=1)
        return thing.world_from_object.apply(np.column_stack([ring, np.full(len(phi), z)]))

    half = thing.height / 2
    return {"rim": rim(RIM_DEGREES, -half), "top": rim(TOP_DEGREES, half)}
