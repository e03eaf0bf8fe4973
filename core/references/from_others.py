# SPDX-License-Identifier: GPL-3.0-or-later
"""Planes, lines and points that are in place already in, the plane or line made from them out."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..arrays import Array
from ..errors import DegenerateReference, InvalidValue
from ..rotation import hat
from .doubt import DOUBTFUL_TILT, HOPELESS_TILT, offset_metres, tilt_degrees
from .influences import Influences, of_camera, of_cause
from .placed import Placed, Task, raised
from .sources import AlongDirection, FacingCamera, FeatureOf, Intersection, Parallel

# degrees between two planes below which they have no line, and below which it is doubtful
PARALLEL_DEGREES, DOUBTFUL_DEGREES = 0.1, 5.0
# metres from a line within which the camera sees every plane through it edge on
LEAST_DISTANCE = 1e-3


def feature_of(task: Task, source: FeatureOf) -> Placed:
    """A face, edge or axis of an object as the reference."""
    return _expected(task, source.of, task.kind)


def facing_camera(task: Task, source: FacingCamera) -> Placed:
    """The plane through a line whose normal points at the camera as much as it can.

    Raises DegenerateReference for a camera that stands on the line.
    """
    line, camera = _expected(task, source.axis, "line"), task.camera()
    sight = camera.centre_world - line.point
    share = float(sight @ line.direction)
    across = sight - share * line.direction
    distance = float(np.linalg.norm(across))
    if distance < LEAST_DISTANCE:
        raise DegenerateReference(
            f"{task.name}: the camera is {1e3 * distance:.2g} mm from {source.axis} itself, so no "
            "plane through it faces the camera"
        )
    normal = across / distance
    turned = hat(normal) @ (np.eye(3) - np.outer(normal, normal)) / distance
    # the line's turning (rotation w: dk = w x k) and moving, then the camera's own moving
    by_direction = -(share * np.eye(3) + np.outer(line.direction, sight))
    by_line = np.zeros((6, 6))
    by_line[:3, :3] = turned @ by_direction @ -hat(line.direction)
    by_sight = turned @ (np.eye(3) - np.outer(line.direction, line.direction))
    by_line[:3, 3:], by_line[3:, 3:] = -by_sight, np.eye(3)
    by_twist = np.zeros((6, 6))
    by_twist[:3, 3:] = -by_sight @ camera.pose.rotation.T
    error = line.influences.through(by_line) + of_camera(by_twist, camera)
    return _doubted(task, Placed("plane", line.point, normal, error), f"{distance:.3g} m away")


def parallel(task: Task, source: Parallel) -> Placed:
    """The plane at a distance from another, along that one's normal."""
    plane = raised(_expected(task, source.to, "plane"), source.distance)
    by_distance = np.concatenate([np.zeros(3), plane.direction])[:, None]
    own = of_cause(f"distance of {task.name}", by_distance, np.array([[source.sigma**2]]))
    # a distance that is typed without an error adds none
    error = plane.influences + own if source.sigma > 0 else plane.influences
    return replace(plane, influences=error, warnings=(), residuals=np.zeros(0))


def intersection(task: Task, source: Intersection) -> Placed:
    """The line in which two planes meet, through its point nearest to the middle of theirs.

    Raises DegenerateReference for planes within 0.1 degrees of parallel.
    """
    one, two = (_expected(task, name, "plane") for name in source.planes)
    cross = np.cross(one.direction, two.direction)
    sine = float(np.linalg.norm(cross))
    degrees = float(np.degrees(np.arcsin(min(sine, 1.0))))
    if degrees < PARALLEL_DEGREES:
        raise DegenerateReference(
            f"{task.name}: {source.planes[0]} and {source.planes[1]} are parallel to "
            f"{degrees:.2g} degrees, so they meet in no line"
        )
    direction = cross / sine
    middle = (one.point + two.point) / 2
    rows = np.array([one.direction, two.direction, direction])
    heights = [one.direction @ one.point, two.direction @ two.point, direction @ middle]
    point = np.linalg.solve(rows, np.array(heights))
    back = np.linalg.inv(rows)
    error = Influences(6)
    flat = hat(direction) @ (np.eye(3) - np.outer(direction, direction)) / sine
    turns = (hat(two.direction) @ hat(one.direction), -hat(one.direction) @ hat(two.direction))
    for i, (plane, turn) in enumerate(zip((one, two), turns, strict=True)):
        by_plane = np.zeros((6, 6))
        by_plane[:3, :3] = flat @ turn
        by_plane[3:] = np.outer(back[:, i], rise(plane, point))
        error = error + plane.influences.through(by_plane)
    angle = f"the planes meet at {degrees:.1f} degrees"
    placed = Placed("line", point, direction, error)
    return _doubted(task, placed, angle, certain=degrees >= DOUBTFUL_DEGREES)


def along_direction(task: Task, source: AlongDirection) -> Placed:
    """The line through a point, typed or a feature's, in a direction, typed or another's."""
    own = np.zeros((6, 6))
    error = Influences(6)
    if isinstance(source.through, str):
        start = _expected(task, source.through, "point")
        point, by_point = start.point, np.diag([0.0, 0, 0, 1, 1, 1])
        error = error + start.influences.through(by_point)
    else:
        point = source.through
        own[3:, 3:] = source.sigma**2 * np.eye(3)
    if isinstance(source.along, str):
        way = task.lookup(source.along)
        if way.kind == "point":
            raise InvalidValue(f"{task.name}: {source.along} is a point, which has no direction")
        direction = way.direction
        error = error + way.influences.through(np.diag([1.0, 1, 1, 0, 0, 0]))
    else:
        direction = source.along / np.linalg.norm(source.along)
        own[:3, :3] = source.tilt_sigma**2 * np.eye(3)
    if own.any():
        error = error + of_cause(f"numbers of {task.name}", np.eye(6), own)
    return Placed("line", point, direction, error)


def rise(plane: Placed, point: Array) -> Array:
    """How far a plane moves along its normal at a point of it, by its own motion, (6,).

    `n . (v + w x q)` for a point q from the plane's own.
    """
    return np.concatenate([np.cross(point - plane.point, plane.direction), plane.direction])


def _expected(task: Task, name: str, kind: str) -> Placed:
    placed = task.lookup(name)
    if placed.kind != kind:
        raise InvalidValue(f"{task.name}: {name} is a {placed.kind}, and a {kind} is needed there")
    return replace(placed, warnings=(), residuals=np.zeros(0))


def _doubted(task: Task, placed: Placed, why: str, *, certain: bool = True) -> Placed:
    """With a warning where little is known of the direction; a refusal where nothing is."""
    tilt, offset = tilt_degrees(placed), offset_metres(placed)
    known = f"its direction is known to {tilt:.2g} degrees and its place to {1e3 * offset:.2g} mm"
    if tilt > HOPELESS_TILT:
        raise DegenerateReference(f"{task.name}: {why}, and {known}; make it from something else")
    if certain and tilt <= DOUBTFUL_TILT:
        return placed
    return replace(placed, warnings=(*placed.warnings, f"{task.name}: {why}: {known}"))
