# SPDX-License-Identifier: GPL-3.0-or-later
"""What hypothesis draws for the laws of the geometry: poses, lenses, and balls in front of them."""

from __future__ import annotations

import numpy as np
from hypothesis import strategies as st
from monocell.core import Distortion, Intrinsics, Pose

MODELS = ("none", "plumb_bob", "rational_polynomial", "equidistant")
# from mild to strong, as calibrations of real lenses have them
RANGES = {
    "none": (),
    "plumb_bob": ((-0.4, 0.3), (-0.1, 0.2), (-1e-3, 1e-3), (-1e-3, 1e-3), (-0.05, 0.05)),
    "rational_polynomial": (
        *((-0.4, 0.4), (-0.3, 0.3), (-1e-3, 1e-3), (-1e-3, 1e-3), (-0.05, 0.05)),
        # a denominator without poles: none lies in the field of a real lens
        *((0.0, 0.6), (0.0, 0.2), (0.0, 0.03)),
    ),
    "equidistant": ((-0.05, 0.05), (-0.01, 0.01), (-0.003, 0.003), (-5e-4, 5e-4)),
}


def numbers(low, high):
    return st.floats(low, high, allow_nan=False, allow_subnormal=False)


def vectors(reach):
    return st.tuples(*[numbers(-reach, reach)] * 3).map(np.array)


@st.composite
def rotation_vectors(draw, longest=np.pi):
    """Of any length up to half a turn, with the ends drawn often: they are where formulas break."""
    axis = draw(vectors(1.0).filter(lambda v: np.linalg.norm(v) > 1e-2))
    ends = [0.0, 1e-300, 1e-160, 1e-15, 1e-8, 1e-4, longest - 1e-6, longest - 1e-9, longest]
    angle = draw(numbers(0.0, longest) | st.sampled_from(ends))
    return axis / np.linalg.norm(axis) * angle


@st.composite
def poses(draw, reach=5.0):
    return Pose.from_rotation_vector(draw(rotation_vectors()), draw(vectors(reach)))


@st.composite
def distortions(draw, models=MODELS):
    model = draw(st.sampled_from(models))
    return Distortion(model, np.array([draw(numbers(*ends)) for ends in RANGES[model]]))


@st.composite
def lenses(draw, models=MODELS):
    """Intrinsics of pictures from 200 to 4000 pixels wide, narrow and wide angled."""
    width, height = draw(st.integers(200, 4000)), draw(st.integers(200, 3000))
    fx = width * draw(numbers(0.5, 2.5))
    return Intrinsics(
        width,
        height,
        fx,
        fx * draw(numbers(0.97, 1.03)),
        width * draw(numbers(0.4, 0.6)),
        height * draw(numbers(0.4, 0.6)),
        draw(distortions(models)),
    )


def imaged_rays(intrinsics, rng, count=40, share=0.95):
    """Unit rays (N, 3) within `share` of what the lens images, but 80 degrees off axis at most."""
    limit = intrinsics.distortion._profile.limit
    fisheye = intrinsics.distortion.model == "equidistant"
    angle = limit if fisheye else np.arctan(limit)
    off_axis = rng.uniform(0, min(share * angle, np.radians(80)), count)
    phi = rng.uniform(0, 2 * np.pi, count)
    across = np.stack([np.cos(phi), np.sin(phi)], axis=1) * np.sin(off_axis)[:, None]
    return np.column_stack([across, np.cos(off_axis)])


@st.composite
def balls(draw):
    """A lens, a ball wholly imaged by it: (intrinsics, centre in the camera frame, radius)."""
    intrinsics = draw(lenses())
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    direction = imaged_rays(intrinsics, rng, 1, 0.6)[0]
    radius = draw(numbers(0.005, 0.5))
    return intrinsics, direction * radius * draw(numbers(6.0, 80.0)), radius


def differences(function, at, step):
    """Central differences of a function of a vector (P,), stacked on the last axis."""
    columns = []
    for i in range(len(at)):
        move = np.zeros(len(at))
        move[i] = step
        columns.append((function(at + move) - function(at - move)) / (2 * step))
    return np.stack(columns, axis=-1)
