# SPDX-License-Identifier: GPL-3.0-or-later
"""Picked corners of a box standing on a plane in, the box with its covariance out.

The operator picks three or four base corners in order round the base, and the corners above them
(paper section 5: the block of figure 3). All corners are fitted at once, in pixels.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..camera import Camera
from ..errors import PickError
from ..intrinsics import Intrinsics
from ..pose import Pose, point_jacobian
from ..primitives import Box
from ..reference import ReferenceLine, ReferencePlane
from ..rotation import rotation_from_vector
from ..sketch import Sketch
from .pick_fit import (
    Modelled,
    PickEquations,
    covariance_or_refusal,
    fit_picks,
    fit_warnings,
    rms,
)
from .picks import RolePicks, read_picks
from .reverse_mapping import grazing_warnings, points_on_line, points_on_plane

PARAMETERS = ("x", "y", "yaw", "size_x", "size_y", "size_z")
# base corners in order round the base, for picks that go anticlockwise seen from the normal's tip
ROUND = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
# sine of a corner's angle below which three corners count as one line (6 degrees)
COLLINEAR = 0.1


def solve_box(
    camera: Camera, sketch: Sketch, plane: ReferencePlane, pick_sigma_pixels: float = 1.0
) -> Modelled:
    """The box that best fits its picks: x from base[0] to base[1], z along the plane's normal.

    Picks: `base`, three or four corners in order round the base; `top`, the corners above them in
    the same order, null where not seen (with three base corners top[3] is the corner above the
    unseen fourth). At least one top pick, or a known size_z. Three base corners alone would give a
    parallelogram; the fit gives the rectangle nearest to the picks.

    Raises PickError, naming object and pick, for picks that can't be a box.
    """
    picked = read_picks(sketch, camera.intrinsics, ("base", "top"), nullable=("top",))
    base, top = picked["base"], picked["top"]
    _refuse_wrong_counts(sketch, base, top)
    corners = _base_corners(camera, plane, base)
    turn = _turn(sketch.name, corners)
    start = _start(camera, sketch, plane, corners, top)
    free = np.array([name not in sketch.known for name in PARAMETERS])

    picks = _CornerPicks(
        camera.intrinsics,
        camera.pose @ plane.world_from_plane,
        np.concatenate([base.pixels, top.pixels]),
        (ROUND * [1.0, turn])[[*base.places, *top.places]],
        np.repeat([0.0, 1.0], [len(base), len(top)]),
    )
    fit = fit_picks(start, free, picks.equations, pick_sigma_pixels)
    if fit is None:
        raise PickError(f"{sketch.name}: its corners as picked can't all be seen by this lens")
    _refuse_negative(sketch.name, fit.parameters)
    covariance = covariance_or_refusal(fit, camera, sketch.name, PARAMETERS)
    box = _box(sketch, plane, fit.parameters, covariance)
    distances = np.linalg.norm(fit.equations.residuals.reshape(-1, 2), axis=1)
    labels = (*base.labels, *top.labels)
    warnings = grazing_warnings(camera, plane, base.pixels, base.labels) + fit_warnings(
        fit, camera, box, labels, distances
    )
    return Modelled(box, distances, rms(distances), warnings)


@dataclass(frozen=True, eq=False)
class _CornerPicks:
    """Pixels (N, 2) of corners on sides `signs` (N, 2) of x and y, `raised` (N,) 0 or 1."""

    intrinsics: Intrinsics
    camera_from_plane: Pose
    pixels: Array
    signs: Array
    raised: Array

    def equations(self, parameters: Array) -> PickEquations:
        """Offsets of the corners of any box, u and v in turn, with their derivatives."""
        points, by_parameters = _corner_points(parameters, self.signs, self.raised)
        points_camera = self.camera_from_plane.apply(points)
        image, by_point = self.intrinsics.project_with_jacobian(points_camera)
        moved = by_point @ self.camera_from_plane.rotation @ by_parameters
        twisted = by_point @ point_jacobian(points_camera)
        return PickEquations(
            (image - self.pixels).ravel(), moved.reshape(-1, 6), twisted.reshape(-1, 6)
        )


def _corner_points(parameters: Array, signs: Array, raised: Array) -> tuple[Array, Array]:
    """Corners (N, 3) in the plane's frame and their derivatives (N, 3, 6)."""
    x, y, yaw, size_x, size_y, size_z = parameters
    cosine, sine = np.cos(yaw), np.sin(yaw)
    along, across = np.array([cosine, sine]), np.array([-sine, cosine])
    half = signs / 2
    points = np.empty((len(signs), 3))
    points[:, :2] = np.outer(half[:, 0] * size_x, along) + np.outer(half[:, 1] * size_y, across)
    derivatives = np.zeros((len(signs), 3, 6))
    derivatives[:, :2, 2] = points[:, :2] @ [[0.0, 1.0], [-1.0, 0.0]]
    points[:, :2] += [x, y]
    points[:, 2] = raised * size_z
    derivatives[:, 0, 0] = derivatives[:, 1, 1] = 1.0
    derivatives[:, :2, 3] = half[:, :1] * along
    derivatives[:, :2, 4] = half[:, 1:] * across
    derivatives[:, 2, 5] = raised
    return points, derivatives


def _box(sketch: Sketch, plane: ReferencePlane, parameters: Array, covariance: Array) -> Box:
    world_from_plane = plane.world_from_plane
    x, y, yaw = parameters[:3]
    size = parameters[3:]
    plane_from_box = Pose(rotation_from_vector([0.0, 0.0, yaw]), np.array([x, y, size[2] / 2]))
    # the primitive's covariance is on the rotation vector, the centre and the sizes, in the world
    derivative = np.zeros((9, 6))
    derivative[:3, 2] = plane.normal
    derivative[3:6, :2] = world_from_plane.rotation[:, :2]
    derivative[3:6, 5] = plane.normal / 2
    derivative[6:, 3:] = np.eye(3)
    return Box(
        sketch.name,
        world_from_plane @ plane_from_box,
        on=sketch.on,
        picks=sketch.picks,
        known=sketch.known,
        appearance=sketch.appearance,
        covariance=derivative @ covariance @ derivative.T,
        size=size,
    )


def _start(
    camera: Camera, sketch: Sketch, plane: ReferencePlane, corners: Array, top: RolePicks
) -> Array:
    """The rectangle through the mapped base corners, and the median height of the top picks."""
    first, second, third = corners[:3]
    # by its diagonal the unseen fourth corner is also known
    corners = corners if len(corners) == 4 else np.array([*corners, first + third - second])
    turn = _turn(sketch.name, corners)
    one, other = second - first, third - second
    quarter = -turn * np.pi / 2
    yaws = np.arctan2(one[1], one[0]), np.arctan2(other[1], other[0]) + quarter
    yaw = float(np.angle(np.exp(1j * yaws[0]) + np.exp(1j * yaws[1])))
    heights = _heights(camera, plane, corners, top)
    height = float(np.median(heights)) if len(heights) else 0.0
    sizes = [np.linalg.norm(one), np.linalg.norm(other), height]
    known = [sketch.known.get(name, size) for name, size in zip(Box.size_names, sizes, strict=True)]
    return np.array([*corners.mean(axis=0), yaw, *known])


def _heights(camera: Camera, plane: ReferencePlane, corners: Array, top: RolePicks) -> Array:
    """How far each top pick is above its base corner. Raises PickError for one below it."""
    world_from_plane = plane.world_from_plane
    heights = []
    for place, label, pixel in zip(top.places, top.labels, top.pixels, strict=True):
        foot = world_from_plane.apply([*corners[place], 0.0])
        upright = ReferenceLine(f"the edge above base[{place}]", foot, plane.normal)
        point = points_on_line(camera, upright, pixel[None], [label])[0]
        height = float((point - foot) @ plane.normal)
        if height <= 0:
            raise PickError(
                f"{label} at ({pixel[0]:.1f}, {pixel[1]:.1f}) lies {-1e3 * height:.1f} mm below "
                f"{plane.name}; a top pick is above base[{place}], along {plane.name}'s normal"
            )
        heights.append(height)
    return np.array(heights)


def _base_corners(camera: Camera, plane: ReferencePlane, base: RolePicks) -> Array:
    """The mapped base corners (3 or 4, 2) in the plane's frame."""
    points = points_on_plane(camera, plane, base.pixels, base.labels)
    return plane.world_from_plane.inverse().apply(points)[:, :2]


def _turn(name: str, corners: Array) -> float:
    """+1 for anticlockwise corners, -1 for clockwise. Raises PickError unless they go round."""
    count = len(corners)
    triples = [(i, (i + 1) % count, (i + 2) % count) for i in range(count if count == 4 else 1)]
    sines = []
    for i, j, k in triples:
        one, other = corners[j] - corners[i], corners[k] - corners[j]
        lengths = float(np.linalg.norm(one) * np.linalg.norm(other))
        sine = float(one[0] * other[1] - one[1] * other[0]) / max(lengths, 1e-300)
        if lengths < 1e-12 or abs(sine) < COLLINEAR:
            raise PickError(
                f"{name}: base[{i}], base[{j}] and base[{k}] lie on one line "
                f"(a bend of {np.degrees(np.arcsin(sine)):.1f} degrees); pick three corners"
            )
        sines.append(sine)
    if min(sines) < 0 < max(sines):
        raise PickError(f"{name}: the base corners cross; pick them in order round the base")
    return float(np.sign(sines[0]))


def _refuse_wrong_counts(sketch: Sketch, base: RolePicks, top: RolePicks) -> None:
    if len(base) not in (3, 4):
        raise PickError(
            f"{sketch.name}: base holds {len(base)} corners; pick three or four, in order round it"
        )
    if any(place > 3 for place in top.places):
        raise PickError(f"{sketch.name}: top[{top.places[-1]}] is above no corner; a box has four")
    if not len(top) and "size_z" not in sketch.known:
        raise PickError(
            f"{sketch.name}: nothing tells its height; pick a corner of top, or give size_z"
        )


def _refuse_negative(name: str, parameters: Array) -> None:
    for size, value in zip(PARAMETERS[3:], parameters[3:], strict=True):
        if value <= 0:
            raise PickError(
                f"{name}: the picks fit best with a {size} of {1e3 * value:.1f} mm; "
                "check that top is above base, and the side the normal points to"
            )
