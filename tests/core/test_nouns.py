# SPDX-License-Identifier: GPL-3.0-or-later
"""The nouns refuse what can't be, by name and number, and keep what they were given."""

from __future__ import annotations

import numpy as np
import pytest
from drawn import numbers, poses, vectors
from hypothesis import given, settings
from monocell.core import (
    Appearance,
    Box,
    Camera,
    Cell,
    Cylinder,
    Intrinsics,
    Pose,
    ReferenceLine,
    ReferencePlane,
    Sketch,
    SphereSighting,
)
from monocell.core.errors import InvalidValue

LAWS = settings(max_examples=30, deadline=None)
HERE = Pose.identity()
CAMERA = Camera(Intrinsics(640, 480, 500.0, 500.0, 320.0, 240.0))
FLOOR = ReferencePlane("floor", [0, 0, 0], [0, 0, 1])


@LAWS
@given(poses(), numbers(0.01, 2), numbers(0.01, 2), numbers(0.01, 2))
def test_the_corners_of_a_box_are_its_size_apart(pose, x, y, z):
    corners = Box("b", pose, size=[x, y, z]).corners_world()
    for bit, size in ((1, x), (2, y), (4, z)):
        for i in range(8):
            if not i & bit:
                edge = corners[i | bit] - corners[i]
                axis = pose.rotation[:, bit.bit_length() - 1]
                np.testing.assert_allclose(edge, size * axis, atol=1e-12)
    np.testing.assert_allclose(corners.mean(axis=0), pose.translation, atol=1e-12)


def test_sizes_and_their_sigmas_stand_in_the_order_of_their_names():
    variances = np.arange(1.0, 9.0) ** 2
    drum = Cylinder("d", HERE, radius=0.1, height=0.4, covariance=np.diag(variances))
    assert dict(zip(drum.size_names, drum.sizes, strict=True)) == {"radius": 0.1, "height": 0.4}
    np.testing.assert_allclose(drum.position_sigma(), [4, 5, 6])
    np.testing.assert_allclose(drum.size_sigma(), [7, 8])
    np.testing.assert_allclose(drum.half_extent, [0.1, 0.1, 0.2])
    box = Box("b", HERE, size=[1, 2, 3])
    np.testing.assert_allclose(box.half_extent, [0.5, 1, 1.5])
    assert box.position_sigma() is None
    assert box.size_sigma() is None


@pytest.mark.parametrize(
    ("make", "told"),
    [
        (lambda: Box("", HERE, size=[1, 1, 1]), "needs a name"),
        (lambda: Box("b", HERE, size=[1, 0, 1]), "b: size must be above zero"),
        (lambda: Box("b", HERE, size=[1, 1]), "b: size: expected shape"),
        (lambda: Box("b", HERE, size=[1, 1, 1], covariance=np.eye(8)), "b: covariance"),
        (lambda: Cylinder("d", HERE, radius=-1, height=1), "d: radius: must be above zero"),
        (lambda: Cylinder("d", HERE, radius=1, height=np.nan), "d: height"),
        (lambda: Appearance([0, 0.5, 1.2]), r"from 0 to 1, got \[0.0, 0.5, 1.2\]"),
        (lambda: Appearance([0, 0.5]), r"appearance\.color"),
        (lambda: ReferencePlane("floor", [0, 0, 0], [0, 0, 0]), "floor: normal: has no length"),
        (lambda: ReferenceLine("edge", [0, 0, np.inf], [1, 0, 0]), "edge: point"),
        (lambda: SphereSighting("a.png", [0, 0], 0.1), "center: expected shape"),
        (lambda: SphereSighting("a.png", [0, 0, 0], 0), "radius: must be above zero"),
        (lambda: SphereSighting("a.png", [0, 0, 0], 0.1, (0, 0, 5, 90)), "5 x 90 px is too small"),
        (lambda: SphereSighting("a.png", [0, 0, 0], 0.1, (0, 0, 5)), "window"),
        (lambda: Sketch("s", "blob", "floor", {}), "'blob' is none of box, cylinder"),
        (lambda: Sketch("s", "box", "floor", {}, {"radius": 1}), "no size 'radius'"),
        (lambda: Sketch("s", "box", "floor", {}, {"size_x": 0}), "known size_x: must be above"),
    ],
)
def test_what_can_t_be_is_refused_by_name(make, told):
    with pytest.raises(InvalidValue, match=told):
        make()


@LAWS
@given(vectors(3.0), vectors(3.0).filter(lambda v: np.linalg.norm(v) > 1e-3))
def test_a_plane_s_frame_stands_on_it_with_x_level(point, normal):
    frame = ReferencePlane("p", point, normal).world_from_plane
    unit = normal / np.linalg.norm(normal)
    np.testing.assert_allclose(frame.rotation[:, 2], unit, atol=1e-9)
    np.testing.assert_allclose(frame.translation, point)
    if np.hypot(unit[0], unit[1]) > 0.03:
        assert abs(frame.rotation[2, 0]) < 1e-12


@LAWS
@given(vectors(3.0).filter(lambda v: np.linalg.norm(v) > 1e-3))
def test_a_direction_once_normalised_stays_exactly_as_it_is(normal):
    once = ReferencePlane("p", [0, 0, 0], normal)
    again = ReferencePlane("p", [0, 0, 0], once.normal)
    np.testing.assert_array_equal(again.normal, once.normal)


def test_a_sketch_comes_from_an_object_with_picks_and_from_no_other():
    picks = {"base": [[1, 2], [3, 4], [5, 6]]}
    red = Appearance([1, 0, 0])
    block = Box(
        "b", HERE, size=[1, 1, 1], on="floor", picks=picks, known={"size_z": 1.0}, appearance=red
    )
    sketch = Sketch.of(block)
    assert (sketch.kind, sketch.on, sketch.picks, sketch.known) == (
        "box",
        "floor",
        picks,
        {"size_z": 1.0},
    )
    assert sketch.appearance is red
    for bare in (Box("b", HERE, size=[1, 1, 1]), Box("b", HERE, size=[1, 1, 1], on="floor")):
        with pytest.raises(InvalidValue, match="has no picks"):
            Sketch.of(bare)


def test_a_cell_refuses_twins_and_objects_on_nothing():
    block = Box("block", HERE, size=[1, 1, 1])
    with pytest.raises(InvalidValue, match=r"objects\[1\]\.name: 'block' is also objects\[0\]"):
        Cell(CAMERA, objects=(block, block))
    with pytest.raises(InvalidValue, match=r"objects\[1\]\.name"):
        Cell(
            CAMERA,
            references=(FLOOR,),
            objects=(block,),
            sketches=(Sketch("block", "box", "floor", {}),),
        )
    with pytest.raises(InvalidValue, match=r"references\[1\]\.name"):
        Cell(CAMERA, references=(FLOOR, FLOOR))
    hanging = Box("block", HERE, size=[1, 1, 1], on="shelf")
    with pytest.raises(InvalidValue, match=r"objects\[0\]\.on: .*'shelf'; there is floor"):
        Cell(CAMERA, references=(FLOOR,), objects=(hanging,))


def test_a_cell_gives_its_references_by_name():
    cell = Cell(CAMERA, references=(FLOOR,))
    assert cell.reference("floor") is FLOOR
    with pytest.raises(InvalidValue, match="no reference is called 'wall'"):
        cell.reference("wall")
