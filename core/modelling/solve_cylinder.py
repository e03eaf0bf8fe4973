# SPDX-License-Identifier: GPL-3.0-or-later
"""Picked outlines of a cylinder standing on a plane in, the cylinder with its covariance out.

Picks lie anywhere on the base circle, the top circle and the two silhouette lines (paper section 5:
the base and the trunk of figure 3). All are fitted at once, by their distances in pixels.
"""

from __future__ import annotations

from collections.abc import Iterable
from itertools import islice

import numpy as np

from ..arrays import Array, Mask
from ..camera import Camera
from ..errors import PickError
from ..pose import Pose
from ..primitives import Cylinder
from ..reference import ReferencePlane
from ..sketch import Sketch
from .cylinder_equations import CylinderPicks
from .cylinder_starts import CylinderRays, cylinder_starts
from .pick_fit import (
    Modelled,
    PickFit,
    covariance_or_refusal,
    fit_picks,
    fit_warnings,
    rms,
)
from .picks import RolePicks, read_picks
from .reverse_mapping import grazing_warnings, points_on_plane

PARAMETERS = ("x", "y", "radius", "height")
# of all starts, those with the smallest residuals are descended from
DESCENTS = 12
# steps after which a descent shows which valley it is in
ROUGH_STEPS = 8
LAST_DESCENTS = 4
# two fits whose chi squared differs by less than this are within the noise of each other
WITHIN_NOISE = 4.0
# fits that agree to this share of their sizes are one and the same
SAME_SHARE = 1e-3


def solve_cylinder(
    camera: Camera, sketch: Sketch, plane: ReferencePlane, pick_sigma_pixels: float = 1.0
) -> Modelled:
    """The cylinder that best fits its picks, its axis along the plane's normal.

    Picks, any number of each: `rim` on the base circle, `top` on the top circle, `sides` on the two
    silhouette lines. x, y, radius and height (those not known) need an equation each: every rim and
    top pick gives one, and each of the two sides.

    Raises PickError, naming object and pick, for picks that can't be a cylinder or leave it open.
    """
    picked = read_picks(sketch, camera.intrinsics, ("rim", "top", "sides"))
    _refuse_too_few(sketch, picked)
    rim, top, sides = picked["rim"], picked["top"], picked["sides"]
    free = np.array([name not in sketch.known for name in PARAMETERS])
    picks = CylinderPicks(
        camera.intrinsics,
        camera.pose @ plane.world_from_plane,
        rim.pixels,
        top.pixels,
        sides.pixels,
    )
    starts = cylinder_starts(_rays(camera, plane, rim, picks), sketch.known)
    fits = _all_fits(starts, free, picks, pick_sigma_pixels)
    fit, rivals = _choose(sketch.name, fits, picks)
    covariance = covariance_or_refusal(fit, camera, sketch.name, PARAMETERS)
    cylinder = _cylinder(sketch, plane, fit.parameters, covariance)
    distances = fit.equations.residuals
    labels = (*rim.labels, *top.labels, *sides.labels)
    warnings = (
        *grazing_warnings(camera, plane, rim.pixels, rim.labels),
        *_ambiguities(sketch.name, fit, rivals),
        *fit_warnings(fit, camera, cylinder, labels, distances),
    )
    return Modelled(cylinder, distances, rms(distances), warnings)


def _refuse_too_few(sketch: Sketch, picked: dict[str, RolePicks]) -> None:
    open_ones = [name for name in PARAMETERS if name not in sketch.known]
    rim, top, sides = (len(picked[role]) for role in ("rim", "top", "sides"))
    if "height" in open_ones and not top:
        raise PickError(
            f"{sketch.name}: nothing tells its height; pick a point of top, or give height"
        )
    equations = rim + top + min(sides, 2)
    if equations < len(open_ones):
        raise PickError(
            f"{sketch.name}: {rim} rim, {top} top and {sides} side picks give {equations} "
            f"equations for {', '.join(open_ones)}; pick {len(open_ones) - equations} more"
        )


def _rays(
    camera: Camera, plane: ReferencePlane, rim: RolePicks, picks: CylinderPicks
) -> CylinderRays:
    plane_from_world = plane.world_from_plane.inverse()
    on_plane = plane_from_world.apply(points_on_plane(camera, plane, rim.pixels, rim.labels))
    plane_from_camera = picks.camera_from_plane.inverse()
    return CylinderRays(
        plane_from_camera.translation,
        on_plane[:, :2],
        plane_from_camera.rotate(camera.intrinsics.rays(picks.top)),
        plane_from_camera.rotate(camera.intrinsics.rays(picks.sides)),
    )


def _all_fits(
    starts: Iterable[Array], free: Mask, picks: CylinderPicks, sigma: float
) -> list[PickFit]:
    """The different fits from the starts that promise most, best first."""
    costs = [(float(np.sum(picks.equations(start).residuals ** 2)), start) for start in starts]
    seen = sorted((c for c in costs if np.isfinite(c[0])), key=lambda c: c[0])
    descended = (
        fit_picks(start, free, picks.equations, sigma, steps=ROUGH_STEPS)
        for _, start in seen[:DESCENTS]
    )
    rough = _different([fit for fit in descended if fit is not None])
    # a circle of negative radius is the same circle: the last descent starts from its mirror image
    upright = (fit.parameters * [1, 1, np.sign(fit.parameters[2]), 1] for fit in rough)
    ends = (
        fit_picks(start, free, picks.equations, sigma) for start in islice(upright, LAST_DESCENTS)
    )
    return _different([fit for fit in ends if fit is not None])


def _different(fits: list[PickFit]) -> list[PickFit]:
    """The fits, best first, without those that end where a better one does."""
    kept: list[PickFit] = []
    for fit in sorted(fits, key=lambda f: f.chi_squared):
        if not any(_same(fit, other) for other in kept):
            kept.append(fit)
    return kept


def _choose(name: str, fits: list[PickFit], picks: CylinderPicks) -> tuple[PickFit, list[PickFit]]:
    """The fit that hides the fewest of its own picks among the best, and others as good."""
    if not fits:
        raise PickError(f"{name}: no cylinder in front of the camera comes near these picks")
    noise = WITHIN_NOISE * fits[0].noise_scale ** 2
    good = [f for f in fits if f.chi_squared <= fits[0].chi_squared + noise]
    real = [f for f in good if f.parameters[2] > 0 and f.parameters[3] > 0]
    if not real:
        radius, height = 1e3 * fits[0].parameters[2:]
        raise PickError(
            f"{name}: the picks fit best with a radius of {radius:.1f} and a height of "
            f"{height:.1f} mm; check that top is above rim, and the side the normal points to"
        )
    hidden = [picks.hidden(f.parameters) for f in real]
    seen = [f for f, count in zip(real, hidden, strict=True) if count == min(hidden)]
    # between perfect fits the taller is taken: its top picks are on the side facing the camera
    seen.sort(key=lambda f: (round(f.chi_squared, 6), -f.parameters[3]))
    return seen[0], [f for f in seen[1:] if not _same(f, seen[0])]


def _same(one: PickFit, other: PickFit) -> bool:
    apart = np.abs(one.parameters - other.parameters).max()
    return bool(apart <= SAME_SHARE * np.abs(one.parameters[2:]).max())


def _ambiguities(name: str, fit: PickFit, rivals: list[PickFit]) -> tuple[str, ...]:
    if not rivals:
        return ()
    (_, _, radius, height), (_, _, other_radius, other_height) = (
        1e3 * f.parameters for f in (fit, rivals[0])
    )
    return (
        f"{name}: the picks fit two cylinders: radius {radius:.1f}, height {height:.1f} mm (taken) "
        f"and radius {other_radius:.1f}, height {other_height:.1f} mm; add a pick to tell them "
        "apart",
    )


def _cylinder(
    sketch: Sketch, plane: ReferencePlane, parameters: Array, covariance: Array
) -> Cylinder:
    world_from_plane = plane.world_from_plane
    x, y, radius, height = (float(p) for p in parameters)
    # the primitive's covariance is on the rotation vector, the centre and the sizes, in the world
    derivative = np.zeros((8, 4))
    derivative[3:6, :2] = world_from_plane.rotation[:, :2]
    derivative[3:6, 3] = plane.normal / 2
    derivative[6, 2] = derivative[7, 3] = 1.0
    return Cylinder(
        sketch.name,
        world_from_plane @ Pose(np.eye(3), np.array([x, y, height / 2])),
        on=sketch.on,
        picks=sketch.picks,
        known=sketch.known,
        appearance=sketch.appearance,
        covariance=derivative @ covariance @ derivative.T,
        radius=radius,
        height=height,
    )
