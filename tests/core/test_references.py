# SPDX-License-Identifier: GPL-3.0-or-later
"""References made in every way lie where the truth is, and follow what they are made from."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from drawn import differences
from monocell.core import ReferencePlane
from monocell.core.reference import PendingReference
from monocell.core.references.resolve import resolve_references, resolved
from monocell.core.references.sources import FacingCamera, PickedPoints, ThroughPoints, Upright
from monocell.core.rotation import rotation_from_vector
from monocell.core.shape.features import feature
from referenced_cell import (
    BALL,
    BOARD,
    CAMERA,
    CRATE,
    DRUM,
    FLOOR,
    FLOOR_COVARIANCE,
    POSE,
    SHELF,
    SHELF_SIGMA,
    SOURCES,
    TWIST_COVARIANCE,
    referenced_cell,
    tangent,
    way_of,
)

CELL, WARNINGS = resolve_references(referenced_cell())
every_reference = pytest.mark.parametrize("name", SOURCES)


def place(cell, name):
    return resolve_references(cell)[0].reference(name)


def test_nothing_here_is_doubtful():
    assert WARNINGS == ()


@every_reference
def test_a_reference_is_in_place_and_knows_where_it_comes_from(name):
    reference = CELL.reference(name)
    assert reference.source is SOURCES[name][1]
    assert isinstance(reference, ReferencePlane) == (SOURCES[name][0] == "plane")
    assert np.linalg.norm(way_of(reference)) == pytest.approx(1.0)


def test_planes_lie_where_their_points_are():
    for name, points in (("shelf", SHELF[:3]), ("board", BOARD)):
        plane = CELL.reference(name)
        np.testing.assert_allclose((points - plane.point) @ plane.normal, 0, atol=1e-9)
        assert plane.normal[2] > 0, "seen from above"
    wall = CELL.reference("wall")
    np.testing.assert_allclose(wall.normal, [1, 0, 0], atol=1e-9)
    assert wall.point[0] == pytest.approx(-0.3)
    loft, board = CELL.reference("loft"), CELL.reference("board")
    np.testing.assert_allclose(loft.point, board.point + 0.25 * board.normal)
    np.testing.assert_allclose(CELL.reference("lid").point, [0.2, -0.1, 0.2])


def test_a_plane_that_faces_the_camera_holds_its_line_and_leans_as_little_as_it_can():
    sheet, axis = CELL.reference("sheet"), CELL.reference("drum.axis")
    assert sheet.normal @ axis.direction == pytest.approx(0, abs=1e-12)
    sight = CAMERA.centre_world - axis.point
    best = np.linalg.norm(np.cross(sight, axis.direction)) / np.linalg.norm(sight)
    assert sheet.normal @ sight / np.linalg.norm(sight) == pytest.approx(best)


def test_lines_lie_where_they_should():
    post = CELL.reference("post")
    np.testing.assert_allclose(post.point, [0.3, 0.35, 0.0], atol=1e-9)
    np.testing.assert_allclose(post.direction, [0, 0, 1])
    for name, planes in (("crease", ("wall", "board")), ("seam", ("lid", "crate.x+"))):
        line = CELL.reference(name)
        for plane in map(CELL.reference, planes):
            assert (line.point - plane.point) @ plane.normal == pytest.approx(0, abs=1e-12)
            assert line.direction @ plane.normal == pytest.approx(0, abs=1e-12)
    seam, rim = CELL.reference("seam"), CELL.reference("rim")
    assert np.linalg.norm(np.cross(seam.point - rim.point, rim.direction)) < 1e-12
    np.testing.assert_allclose(CELL.reference("nail").direction, CELL.reference("wall").normal)
    np.testing.assert_allclose(CELL.reference("string").point, BALL.world_from_object.translation)


def stepped(change, size, step=1e-5):
    """How all references follow a change of the cell, (6, size) by name."""

    def offs(at):
        cell = resolve_references(change(at))[0]
        return np.array([tangent(cell.reference(n), CELL.reference(n)) for n in SOURCES])

    return dict(zip(SOURCES, differences(offs, np.zeros(size), step), strict=True))


def with_camera_moved(twist):
    """The camera moved, and objects with it as their own `by_camera` says."""
    moved = [turned(t, t.by_camera @ twist) for t in (CRATE, DRUM)]
    cell = referenced_cell(CAMERA.placed(POSE.perturbed(twist), TWIST_COVARIANCE))
    return replace(cell, objects=(*moved, BALL))


@cache
def by_every_cause():
    """How all references follow each cause, and the cause's covariance."""
    return [(stepped(change, len(c)), c) for change, c in causes()]


def test_references_follow_the_camera_as_they_say():
    shown = stepped(with_camera_moved, 6)
    for name in SOURCES:
        stated = CELL.reference(name).by_camera
        if name == "string":
            # nobody says how the ball hangs on the camera
            assert stated is None
        else:
            np.testing.assert_allclose(
                stated, shown[name], atol=1e-6 * max(1, abs(shown[name]).max()), err_msg=name
            )


@pytest.mark.parametrize("name", [n for n in SOURCES if n != "string"])
def test_the_covariance_is_that_of_all_causes_together(name):
    """Every input is moved by itself, and what its own error makes of the reference is added up."""
    summed = np.zeros((6, 6))
    for by, covariance in by_every_cause():
        summed += by[name] @ covariance @ by[name].T
    scale = np.sqrt(np.diag(summed))
    stated = CELL.reference(name).covariance
    np.testing.assert_allclose(stated, summed, atol=1e-5 * np.outer(scale, scale).max() + 1e-14)


def causes():
    """What errs: how a cell is changed by a step, and the step's covariance."""
    picks = [name for name, (_, s) in SOURCES.items() if isinstance(s, PickedPoints | Upright)]
    for name in picks:
        kind, source = SOURCES[name]

        def picked(step, name=name, kind=kind, source=source):
            # steps are of kilopixels, to be as small as those of metres
            pixels = source.pixels + 1e3 * step.reshape(-1, 2)
            return referenced_cell(sources=SOURCES | {name: (kind, replace(source, pixels=pixels))})

        yield picked, 1e-6 * np.eye(source.pixels.size)
    for name, count in (("shelf", 3), ("rail", 2)):
        kind, source = SOURCES[name]

        def pointed(step, name=name, kind=kind, source=source):
            moved = ThroughPoints(source.points + step.reshape(-1, 3), source.sigma)
            return referenced_cell(sources=SOURCES | {name: (kind, moved)})

        yield pointed, np.diag(np.repeat(SHELF_SIGMA[:count] ** 2, 3))

    def floored(step):
        normal = rotation_from_vector(step[:3]) @ FLOOR.normal
        return referenced_cell(floor=replace(FLOOR, point=FLOOR.point + step[3:], normal=normal))

    yield floored, FLOOR_COVARIANCE

    def distant(step):
        source = replace(SOURCES["loft"][1], distance=0.25 + step[0])
        return referenced_cell(sources=SOURCES | {"loft": ("plane", source)})

    yield distant, np.array([[4e-6]])

    def nailed(step):
        source = replace(SOURCES["nail"][1], through=np.array([0.1, 0.2, 0.3]) + step)
        return referenced_cell(sources=SOURCES | {"nail": ("line", source)})

    yield nailed, 1e-6 * np.eye(3)

    yield with_camera_moved, TWIST_COVARIANCE
    for i, thing in enumerate((CRATE, DRUM)):

        def own(step, i=i, thing=thing):
            things = [CRATE, DRUM, BALL]
            things[i] = turned(thing, step)
            return referenced_cell(things=tuple(things))

        yield own, left_over(thing)


def left_over(thing):
    """The object's covariance without the share of the camera, which has been counted."""
    rest = thing.covariance - thing.by_camera @ TWIST_COVARIANCE @ thing.by_camera.T
    assert np.linalg.eigvalsh(rest).min() > 0
    return rest


def turned(thing, step):
    pose = type(thing.world_from_object)(
        rotation_from_vector(step[:3]) @ thing.world_from_object.rotation,
        thing.world_from_object.translation + step[3:6],
    )
    return replace(thing.with_parameters(thing.parameters + step[6:]), world_from_object=pose)


def test_a_moved_source_moves_its_reference():
    moved = turned(CRATE, np.array([0, 0, 0, 0, 0, 0.05, 0, 0, 0]))
    cell = resolve_references(replace(CELL, objects=(moved, DRUM, BALL)))[0]
    np.testing.assert_allclose(cell.reference("lid").point, [0.2, -0.1, 0.25])
    np.testing.assert_allclose(cell.reference("floor").point, CELL.reference("floor").point)


def test_resolving_again_changes_nothing():
    again = resolve_references(CELL)[0]
    for one, other in zip(CELL.references, again.references, strict=True):
        np.testing.assert_array_equal(way_of(one), way_of(other))
        np.testing.assert_array_equal(one.covariance, other.covariance)


def test_the_side_that_a_document_states_is_kept():
    flipped = [
        replace(r, normal=-r.normal) if r.name in ("shelf", "board", "wall") else r
        for r in CELL.references
    ]
    again = resolve_references(replace(CELL, references=tuple(flipped)))[0]
    for name in ("shelf", "board", "wall"):
        np.testing.assert_allclose(again.reference(name).normal, -CELL.reference(name).normal)


def test_more_points_than_needed_are_least_squares_with_residuals():
    points = np.array([[x, y, 0.5] for x in (0, 1.0) for y in (0, 1.0)])
    points[3, 2] += 0.004
    cell = referenced_cell(sources={"top": ("plane", ThroughPoints(points, 2e-3))})
    resolution = resolved(cell)
    np.testing.assert_allclose(np.abs(resolution.residuals["top"]), 0.001, rtol=1e-4)
    assert resolution.warnings == ()


def test_points_that_miss_their_plane_are_warned_of_and_counted():
    points = np.array([[x, y, 0.5] for x in (0, 1.0) for y in (0, 1.0)])
    points[3, 2] += 0.04
    calm = place(
        referenced_cell(sources={"t": ("plane", ThroughPoints(points * [1, 1, 0], 1e-3))}), "t"
    )
    cell = referenced_cell(sources={"t": ("plane", ThroughPoints(points, 1e-3))})
    resolution = resolved(cell)
    (told,) = resolution.warnings
    assert "t: the points miss the plane by up to 10 mm (points[" in told
    louder = np.sqrt(
        np.trace(resolution.cell.reference("t").covariance) / np.trace(calm.covariance)
    )
    assert louder == pytest.approx(20.0, rel=0.01)


def test_without_a_stated_sigma_the_scatter_tells_it_or_nothing_does():
    three = ThroughPoints(SHELF[:3])
    assert place(referenced_cell(sources={"t": ("plane", three)}), "t").covariance is None
    points = np.array([[x, y, 0.5] for x in (0, 1.0) for y in (0, 1.0)])
    points[3, 2] += 0.004
    four = place(referenced_cell(sources={"t": ("plane", ThroughPoints(points))}), "t")
    # four residuals of 1 mm and one spare equation: a point's sigma is 2 mm, their mean's 1 mm
    assert np.sqrt(four.covariance[5, 5]) == pytest.approx(1e-3, rel=1e-3)


def test_an_object_that_is_only_picked_yet_leaves_its_references_pending():
    from monocell.core import Sketch
    from monocell.core.errors import InvalidValue

    sketch = Sketch("crate", "box", "floor", {"base": [[1.0, 2.0]]})
    cell = replace(referenced_cell(things=(DRUM, BALL)), sketches=(sketch,))
    resolution = resolved(cell)
    assert set(resolution.pending) == {"lid", "rim", "seam"}
    assert isinstance(resolution.cell.references[3], PendingReference)
    with pytest.raises(InvalidValue, match="lid: has no place yet"):
        resolution.cell.reference("lid")
    with pytest.raises(InvalidValue, match="crate is picked and not solved yet; model it first"):
        resolution.cell.reference("crate.top")


def test_a_path_to_a_face_or_an_edge_is_a_reference_with_the_object_s_error():
    top = CELL.reference("crate.top")
    assert top.name == "crate.top"
    np.testing.assert_allclose(top.point, feature(CRATE, "top").point)
    np.testing.assert_allclose(top.covariance, CELL.reference("lid").covariance)
    axis = CELL.reference("drum.axis")
    np.testing.assert_allclose(axis.by_camera, CELL.reference("spine").by_camera)


def test_a_reference_through_an_object_of_unknown_share_is_bounded_from_above():
    # the distance to a shelf of known share of the camera, from a ball of unknown
    sheet = SOURCES | {"sheet": ("plane", FacingCamera("string"))}
    cell = resolve_references(referenced_cell(sources=sheet))[0]
    assert cell.reference("string").by_camera is None
    bound = cell.reference("sheet").covariance
    alone = resolve_references(referenced_cell(CAMERA.placed(POSE), sheet))[0]
    still = replace(BALL, covariance=np.zeros((7, 7)))
    unmoved = resolve_references(referenced_cell(sources=sheet, things=(CRATE, DRUM, still)))[0]
    parts = [c.reference("sheet").covariance for c in (alone, unmoved)]
    assert np.linalg.eigvalsh(2 * sum(parts) - bound).min() > -1e-15
    assert np.trace(bound) > np.trace(parts[0])
