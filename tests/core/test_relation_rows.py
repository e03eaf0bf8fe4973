# SPDX-License-Identifier: GPL-3.0-or-later
"""Relations as equations: zero where they hold, with the derivatives that they really have."""

from __future__ import annotations

import numpy as np
import pytest
from monocell.core import Box, Cone, Cylinder, Pose, Prism, Relation, Sphere, Tube
from monocell.core.errors import InvalidValue
from monocell.core.modelling.relation_rows import reference_feature, relation_rows
from monocell.core.modelling.solid import Solid
from monocell.core.reference import ReferenceLine, ReferencePlane
from monocell.core.rotation import rotation_from_vector
from monocell.core.shape.features import feature

TILTED = Pose.from_rotation_vector([0.3, -0.2, 0.5], [0.1, 0.2, 0.4])
OWN = {
    "box": Box("own", TILTED, size=[0.2, 0.12, 0.15]),
    "cylinder": Cylinder("own", TILTED, radius=0.05, height=0.2),
    "sphere": Sphere("own", TILTED, radius=0.06),
    "cone": Cone("own", TILTED, radius=0.08, top_radius=0.03, height=0.2),
    "tube": Tube("own", TILTED, radius=0.06, inner_radius=0.04, height=0.1),
    "prism": Prism(
        "own",
        TILTED,
        polygon=[[-0.1, -0.05], [0.1, -0.05], [0.1, 0.05], [-0.1, 0.05]],
        height=0.1,
    ),
}
PLANE = ReferencePlane("ramp", [0.1, -0.1, 0.05], [0.2, -0.3, 1.0])
LINE = ReferenceLine("pole", [0.3, 0.1, 0.0], [0.1, 0.9, 0.2])
OTHER = Box(
    "other", Pose.from_rotation_vector([0.2, 0.4, -0.3], [-0.2, 0.1, 0.3]), size=[0.3, 0.2, 0.1]
)
TWIN = Box("twin", Pose.from_rotation_vector([-0.2, 0.3, 0.1], [-0.3, 0.2, 0.3]), size=[0.1] * 3)
CASES = [
    *[(kind, Relation("touches", "ramp"), PLANE) for kind in OWN],
    *[(kind, Relation("stands_on", "ramp"), PLANE) for kind in OWN],
    *[(kind, Relation("lies_on", "ramp"), PLANE) for kind in ("cylinder", "cone", "tube")],
    *[(kind, Relation("touches", "pole"), LINE) for kind in ("sphere", "cylinder", "tube")],
    *[(kind, Relation("centred_on", "pole"), LINE) for kind in OWN],
    ("box", Relation("leans_on", "ramp", own="x+"), PLANE),
    ("box", Relation("touches", "ramp", own="x+y-"), PLANE),
    ("box", Relation("touches", "ramp", own="centre"), PLANE),
    ("cylinder", Relation("parallel", "pole"), LINE),
    ("cylinder", Relation("parallel", "ramp"), PLANE),
    ("cone", Relation("perpendicular", "pole"), LINE),
    ("box", Relation("perpendicular", "pole", own="axis_x"), LINE),
    ("box", Relation("leans_on", "other.y+", own="base"), OTHER),
    ("cylinder", Relation("perpendicular", "other.axis"), OTHER),
    ("sphere", Relation("touches", "other.x+top"), OTHER),
    ("sphere", Relation("centred_on", "other.centre"), OTHER),
]


def tangent_size(thing):
    return 6 if isinstance(thing, ReferencePlane | ReferenceLine) else 6 + len(thing.parameters)


def moved(thing, step):
    if isinstance(thing, ReferencePlane):
        turn = rotation_from_vector(step[:3])
        return ReferencePlane(thing.name, thing.point + step[3:], turn @ thing.normal)
    if isinstance(thing, ReferenceLine):
        turn = rotation_from_vector(step[:3])
        return ReferenceLine(thing.name, thing.point + step[3:], turn @ thing.direction)
    return Solid.of(thing).moved(step).applied(thing)


def target(relation, thing):
    if isinstance(thing, ReferencePlane | ReferenceLine):
        return reference_feature(thing)
    return feature(thing, relation.to.partition(".")[2])


def slopes(values, size, step=1e-6):
    columns = []
    for i in range(size):
        ahead = np.zeros(size)
        ahead[i] = step
        columns.append((values(ahead) - values(-ahead)) / (2 * step))
    return np.stack(columns, axis=1)


def differentiable(kind, size):
    """A prism's single corners move its origin too, which its raw derivatives leave out."""
    return slice(0, 7) if kind == "prism" else slice(0, size)


@pytest.mark.parametrize(("kind", "relation", "to"), CASES, ids=lambda v: str(v)[:24])
def test_rows_have_the_derivatives_they_state(kind, relation, to):
    own = OWN[kind]
    rows = relation_rows(relation, own, target(relation, to))
    size = tangent_size(own)
    part = differentiable(kind, size)
    by_own = slopes(
        lambda s: relation_rows(relation, moved(own, s), target(relation, to)).values, size
    )
    by_to = slopes(
        lambda s: relation_rows(relation, own, target(relation, moved(to, s))).values,
        tangent_size(to),
    )
    # rows that hold directions to each other are exact where they hold, and to first order beside
    near = 1e-7 if not loose(relation) else np.inf
    np.testing.assert_allclose(rows.by_own[:, part], by_own[:, part], atol=near)
    np.testing.assert_allclose(rows.by_to, by_to, atol=near)


def loose(relation):
    flush = relation.kind in ("stands_on", "leans_on", "parallel", "centred_on")
    return flush or relation.own in ("x+", "x+y-")


def held(relation, own, to, steps=30):
    """The object moved until the relation holds, by Gauss-Newton on its rows."""
    for _ in range(steps):
        rows = relation_rows(relation, own, target(relation, to))
        rigid = -np.linalg.pinv(rows.by_own[:, :6]) @ rows.values
        own = moved(own, np.concatenate([rigid, np.zeros(tangent_size(own) - 6)]))
    return own


@pytest.mark.parametrize(("kind", "relation", "to"), CASES, ids=lambda v: str(v)[:24])
def test_a_relation_can_be_restored_and_its_derivatives_are_exact_there(kind, relation, to):
    own = held(relation, OWN[kind], to)
    rows = relation_rows(relation, own, target(relation, to))
    assert np.abs(rows.values).max() < 1e-10
    size = tangent_size(own)
    part = differentiable(kind, size)
    by_own = slopes(
        lambda s: relation_rows(relation, moved(own, s), target(relation, to)).values, size
    )
    by_to = slopes(
        lambda s: relation_rows(relation, own, target(relation, moved(to, s))).values,
        tangent_size(to),
    )
    # the two directions across may be chosen anew for a moved plane: lengths of rows are compared
    if not loose(relation):
        np.testing.assert_allclose(rows.by_own[:, part], by_own[:, part], atol=1e-7)
        np.testing.assert_allclose(rows.by_to, by_to, atol=1e-7)
    else:
        np.testing.assert_allclose(
            np.linalg.norm(rows.by_own[:, part], axis=0),
            np.linalg.norm(by_own[:, part], axis=0),
            atol=1e-6,
        )
        np.testing.assert_allclose(
            np.linalg.norm(rows.by_to, axis=0), np.linalg.norm(by_to, axis=0), atol=1e-6
        )


def test_a_lying_cylinder_touches_along_a_line():
    lying = held(Relation("lies_on", "ramp"), OWN["cylinder"], PLANE)
    assert abs(lying.world_from_object.rotation[:, 2] @ PLANE.normal) < 1e-9
    away = (lying.world_from_object.translation - PLANE.point) @ PLANE.normal
    assert away == pytest.approx(lying.radius, abs=1e-9)


def test_a_lying_cone_touches_with_its_side():
    lying = held(Relation("lies_on", "ramp"), OWN["cone"], PLANE)
    slope = np.arctan2(lying.radius - lying.top_radius, lying.height)
    sine = lying.world_from_object.rotation[:, 2] @ PLANE.normal
    assert abs(sine) == pytest.approx(np.sin(slope), abs=1e-9)


@pytest.mark.parametrize("about", [PLANE])
def test_mirror_images_have_the_derivatives_they_state(about):
    relation, mirror = Relation("symmetric", "twin", about="ramp"), reference_feature(about)
    rows = relation_rows(relation, OWN["box"], TWIN, mirror)
    own, twin = OWN["box"], TWIN
    for _ in range(40):
        rows = relation_rows(relation, own, twin, mirror)
        own = moved(own, -np.linalg.pinv(rows.by_own) @ rows.values)
    assert np.abs(relation_rows(relation, own, twin, mirror).values).max() < 1e-10
    reflect = np.eye(3) - 2 * np.outer(about.normal, about.normal)
    middle = about.point + reflect @ (twin.world_from_object.translation - about.point)
    np.testing.assert_allclose(own.world_from_object.translation, middle, atol=1e-9)
    np.testing.assert_allclose(own.sizes, twin.sizes, atol=1e-9)
    rows = relation_rows(relation, own, twin, mirror)
    by_about = slopes(
        lambda s: relation_rows(relation, own, twin, reference_feature(moved(about, s))).values, 6
    )
    assert rows.by_about is not None
    # the middle's three rows are the same whatever directions across are chosen
    np.testing.assert_allclose(rows.by_about[3:6], by_about[3:6], atol=1e-7)


@pytest.mark.parametrize(
    ("kind", "relation", "to", "told"),
    [
        ("box", Relation("lies_on", "ramp"), PLANE, "own: a box does not lie on its side"),
        ("box", Relation("touches", "pole"), LINE, "a box touches a plane, and pole is a line"),
        ("sphere", Relation("parallel", "pole"), LINE, "a sphere has no axis to be parallel"),
        ("box", Relation("stands_on", "pole"), LINE, "stands_on needs a plane, and pole is a line"),
        ("cylinder", Relation("lies_on", "pole"), LINE, "needs a plane, and pole is a line"),
        ("box", Relation("stands_on", "ramp", own="front"), PLANE, "has no feature 'front'"),
    ],
)
def test_a_relation_that_means_nothing_is_refused_by_name(kind, relation, to, told):
    with pytest.raises(InvalidValue, match=told):
        relation_rows(relation, OWN[kind], target(relation, to))


def test_sizes_of_other_kinds_are_shared_by_name_only():
    with pytest.raises(InvalidValue, match="a cylinder can't be of the same size as other, a box"):
        relation_rows(Relation("same_size", "other"), OWN["cylinder"], OTHER)
    with pytest.raises(InvalidValue, match="other: a box has no size 'radius'"):
        relation_rows(Relation("same_size", "other", own="radius"), OWN["cylinder"], OTHER)
    rows = relation_rows(Relation("same_size", "own", own="radius"), OWN["cone"], OWN["cylinder"])
    np.testing.assert_allclose(rows.values, [0.08 - 0.05])
