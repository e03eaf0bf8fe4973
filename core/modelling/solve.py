# SPDX-License-Identifier: GPL-3.0-or-later
"""A camera and what the operator picked in its picture in, metric objects out."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from ..arrays import positive
from ..camera import Camera
from ..cell import Cell
from ..errors import InvalidValue, PickError
from ..primitives import Primitive
from ..reference import Reference, ReferencePlane
from ..sketch import Sketch
from .pick_fit import Modelled
from .solve_box import solve_box
from .solve_cylinder import solve_cylinder

Solver = Callable[[Camera, Sketch, ReferencePlane, float], Modelled]
SOLVERS: dict[str, Solver] = {"box": solve_box, "cylinder": solve_cylinder}


# wide enough for any hand and any noiseless test; beyond, squares overflow
LEAST_SIGMA, MOST_SIGMA = 1e-9, 1e4


def solve_sketch(
    camera: Camera, sketch: Sketch, reference: Reference, pick_sigma_pixels: float = 1.0
) -> Modelled:
    """The object of a sketch that stands on `reference`, fitted to its picks in pixels.

    `pick_sigma_pixels` is 1 sigma of a pick in u and in v. The object's covariance joins pick noise
    and `camera.covariance`.

    Raises PickError for picks that can't mean the object, naming object and pick, or a reference
    that is not a plane; InvalidValue for an impossible pick noise; NoPose without a camera pose.
    """
    sigma = positive(pick_sigma_pixels, "pick_sigma_pixels")
    if not LEAST_SIGMA <= sigma <= MOST_SIGMA:
        raise InvalidValue(
            f"pick_sigma_pixels: {sigma:g} px is no error of a hand; "
            f"give {LEAST_SIGMA:g} to {MOST_SIGMA:g}"
        )
    if not isinstance(reference, ReferencePlane):
        raise PickError(
            f"{sketch.name}: a {sketch.kind} stands on a plane, and {reference.name} is a line; "
            "name a plane in `on`"
        )
    return SOLVERS[sketch.kind](camera, sketch, reference, sigma)


def model_cell(cell: Cell, pick_sigma_pixels: float = 1.0) -> tuple[Cell, tuple[Modelled, ...]]:
    """Solve every sketch of a cell, and again every object that has picks.

    Returns the cell with the objects first, in their order, then the solved sketches, and the
    results of all that was solved in the same order. Objects without picks stay untouched.

    Raises what `solve_sketch` raises; the cell is then as it was.
    """
    objects: list[Primitive] = []
    results: list[Modelled] = []
    things: tuple[Primitive | Sketch, ...] = (*cell.objects, *cell.sketches)
    for thing in things:
        if not isinstance(thing, Sketch) and not thing.picks:
            objects.append(thing)
            continue
        sketch = thing if isinstance(thing, Sketch) else Sketch.of(thing)
        reference = cell.reference(sketch.on or "")
        modelled = solve_sketch(cell.standing_camera(), sketch, reference, pick_sigma_pixels)
        objects.append(modelled.object)
        results.append(modelled)
    return replace(cell, objects=tuple(objects), sketches=()), tuple(results)


__all__ = ["Modelled", "model_cell", "solve_sketch"]
