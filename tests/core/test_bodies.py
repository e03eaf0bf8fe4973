# SPDX-License-Identifier: GPL-3.0-or-later
"""Who moves with whom, what it weighs, and what can't be."""

from __future__ import annotations

import numpy as np
import pytest
from monocell.core import Box, Camera, Cell, Composite, Intrinsics, Motion, Pose, Relation
from monocell.core.bodies import rigid_bodies
from monocell.core.errors import InvalidValue
from monocell.core.links import (
    references_kept,
    with_new_names,
    without_lost_joints,
    without_lost_relations,
)
from monocell.core.reference import PendingReference, ReferenceLine, ReferencePlane
from monocell.core.references.sources import FeatureOf, Intersection
from monocell.core.shape.masses import masses
from monocell.core.sketch import Sketch

CAMERA = Camera(Intrinsics(640, 480, 500.0, 500.0, 320.0, 240.0))
FREE = Motion("movable")


def thing(name, motion=None, **more):
    return Box(name, Pose.identity(), size=[0.1, 0.1, 0.1], motion=motion or Motion(), **more)


def fixed(to):
    return Motion("attached", to=to, joint="fixed")


def hinge(to):
    return Motion("attached", to=to, joint="hinge", axis=[0, 0, 2])


def told(things, composites=()):
    """Each body as its kind of motion, the names of its parts, and those of what it hangs on."""
    bodies = rigid_bodies(things, composites)
    names = [tuple(things[i].name for i in body.parts) for body in bodies]
    return [
        (
            body.motion.joint or body.motion.kind,
            parts,
            *([names[body.parent]] if body.motion.to else []),
        )
        for body, parts in zip(bodies, names, strict=True)
    ]


def test_everything_is_a_body_of_its_own_unless_told():
    assert told([thing("a"), thing("b", FREE)]) == [("static", ("a",)), ("movable", ("b",))]


def test_fixed_joints_make_one_body_that_stands_if_a_part_does():
    things = [thing("a", fixed("b")), thing("b", fixed("c")), thing("c", FREE)]
    assert told(things) == [("movable", ("a", "b", "c"))]
    things[2] = thing("c")
    assert told(things) == [("static", ("a", "b", "c"))]


def test_a_chain_of_hinges_is_in_order_whatever_the_order_of_the_document():
    things = [thing("hand", hinge("arm")), thing("arm", hinge("post")), thing("post")]
    assert told(things) == [
        ("static", ("post",)),
        ("hinge", ("arm",), ("post",)),
        ("hinge", ("hand",), ("arm",)),
    ]


def test_the_parts_of_a_composite_that_moves_are_one_body_but_for_hanging_ones():
    things = [thing("a"), thing("b"), thing("door", hinge("b")), thing("table")]
    assert told(things, [Composite("cupboard", ("a", "b", "door"), FREE)]) == [
        ("movable", ("a", "b")),
        ("static", ("table",)),
        ("hinge", ("door",), ("a", "b")),
    ]
    # a group that does not move says nothing
    assert len(told(things, [Composite("cupboard", ("a", "b", "door"))])) == 4
    on_table = Composite("cupboard", ("a", "b", "door"), fixed("table"))
    assert told(things, [on_table])[0] == ("static", ("a", "b", "table"))
    on_hinge = Composite("cupboard", ("door", "a", "b"), hinge("table"))
    assert ("hinge", ("a", "b"), ("table",)) in told(things, [on_hinge])


@pytest.mark.parametrize(
    ("things", "composites", "message"),
    [
        ([thing("a", hinge("b"))], (), r"objects\[0\]\.motion\.to: 'b' is the name of no object"),
        ([thing("a", hinge("a"))], (), r"objects\[0\]\.motion\.to: 'a' can't hang on itself"),
        (
            [thing("x"), thing("a", hinge("b")), thing("b", hinge("a"))],
            (),
            r"objects\[1\]\.motion\.to: the joints of a, b hang on each other in a circle",
        ),
        (
            [thing("a", hinge("x")), thing("b", hinge("x")), thing("x"), thing("c")],
            (Composite("g", ("a", "b", "c"), hinge("x")), Composite("h", ("x",), fixed("c"))),
            r"motion\.to: the joints of a, b, c hang on each other in a circle",
        ),
        (
            [thing("a"), thing("b", hinge("x")), thing("x"), thing("c", fixed("b"))],
            (Composite("g", ("a", "c"), hinge("x")),),
            r"objects\[0\]\.motion: 'b' and 'a' are one rigid body, and each has a joint",
        ),
        (
            [thing("a")],
            (Composite("a", ("a",)),),
            r"composites\[0\]\.name: 'a' is also objects\[0\]",
        ),
        (
            [thing("a"), thing("b")],
            (Composite("g", ("a",)), Composite("g", ("b",))),
            r"composites\[1\]\.name: 'g' is also composites\[0\]'s name",
        ),
        (
            [thing("a")],
            (Composite("g", ("b",)),),
            r"composites\[0\]\.parts\[0\]: 'b' is the name of no",
        ),
        (
            [thing("a")],
            (Composite("g", ("a",)), Composite("h", ("a",))),
            r"composites\[1\]\.parts\[0\]: 'a' is a part of composites\[0\]",
        ),
        (
            [thing("a")],
            (Composite("g", ("a",), fixed("a")),),
            r"composites\[0\]\.motion\.to: 'a' can't",
        ),
        (
            [thing("a", hinge("x")), thing("x")],
            (Composite("g", ("a",), FREE),),
            r"composites\[0\]\.motion: each part hangs on a joint of its own",
        ),
    ],
)
def test_what_can_t_be_is_refused_by_its_path(things, composites, message):
    with pytest.raises(InvalidValue, match=message):
        Cell(CAMERA, objects=tuple(things), composites=composites)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Composite("", ("a",)), "a composite needs a name"),
        (lambda: Composite("g", ()), "g: parts: a composite needs one object"),
        (lambda: Composite("g", ("a", "b", "a")), "g: parts: 'a' is named twice"),
    ],
)
def test_a_composite_of_nothing_is_refused(make, message):
    with pytest.raises(InvalidValue, match=message):
        make()


def test_a_mass_is_given_or_follows_from_a_density_or_is_that_of_water():
    things = [
        thing("given", Motion("movable", mass=3)),
        thing("dense", Motion("movable", density=7000)),
        thing("group a"),
        thing("group b"),
        thing("foam"),
        thing("plain"),
    ]
    composites = [
        Composite("g", ("group a", "group b"), Motion("movable", mass=5)),
        Composite("h", ("foam",), Motion("movable", density=30)),
    ]
    found, assumed = masses(things, composites)
    np.testing.assert_allclose(found, [3, 7, 2.5, 2.5, 0.03, 1])
    assert assumed == ("plain",)
    with pytest.raises(InvalidValue, match=r"g: motion\.mass is that of all its parts, and given"):
        masses(things, [Composite("g", ("given", "plain"), Motion("movable", mass=5))])


HELD = thing(
    "held",
    hinge("crate"),
    on="crate.top",
    relations=(
        Relation("parallel", "crate.axis"),
        Relation("touches", "floor"),
        Relation("same_size", "crate"),
        Relation("symmetric", "other", about="crate.x+"),
    ),
)
OTHERS = (thing("crate"), thing("other"))
PICKED = Sketch("picked", "box", "crate.top", {}, relations=(Relation("same_size", "crate"),))
GROUP = Composite("group", ("held", "crate"), hinge("other"))


def test_all_that_names_a_renamed_object_follows_and_makes_a_whole_cell():
    things, composites = with_new_names((HELD, PICKED), (GROUP,), {"crate": "box.001"})
    held, picked = things
    assert (held.on, held.motion.to, picked.on) == ("box.001.top", "box.001", "box.001.top")
    assert [r.to for r in held.relations] == ["box.001.axis", "floor", "box.001", "other"]
    assert held.relations[3].about == "box.001.x+"
    assert composites[0].parts == ("held", "box.001")
    assert Cell(
        CAMERA,
        references=(ReferencePlane("floor", [0, 0, 0], [0, 0, 1]),),
        objects=(held, thing("box.001"), OTHERS[1]),
        sketches=(picked,),
        composites=(Composite("group", composites[0].parts),),
    )


def test_what_is_deleted_is_let_go_of_with_a_word_for_each():
    things, composites, joints = without_lost_joints((HELD,), (GROUP,))
    (held,), lost = without_lost_relations(things, {"floor"})
    assert held.motion.kind == "static" and held.on is None
    assert [r.to for r in held.relations] == ["floor"]
    assert composites[0].parts == ("held",) and composites[0].motion.kind == "static"
    assert joints == (
        "held: it hangs on crate, which is not there; it is taken as static",
        "group: its parts crate are not there",
        "group: it hangs on other, which is not there; it is taken as static",
    )
    assert "held: crate.top held it, which is not there any more" in lost and len(lost) == 4
    whole, groups, none = without_lost_joints((HELD, *OTHERS), (GROUP,))
    assert (whole[0], groups[0].parts, none) == (HELD, GROUP.parts, ())
    assert without_lost_relations((HELD, *OTHERS), {"floor"})[1] == ()


def test_a_reference_made_from_an_object_follows_its_name_and_keeps_its_place_when_it_goes():
    made = ReferencePlane("lid", [0, 0, 1], [0, 0, 1], source=FeatureOf("crate.top"))
    between = ReferenceLine("seam", [0, 0, 1], [1, 0, 0], source=Intersection(("crate.top", "lid")))
    pending = PendingReference("rim", "line", FeatureOf("crate.axis"))
    references = (made, between, pending)
    lid, seam, rim = references_kept(references, {"crate": "box.001"}, {"box.001"})
    assert lid.source.of == "box.001.top" and rim.source.of == "box.001.axis"
    assert seam.source.needs == ("box.001.top", "lid")
    lid, seam, rim = references_kept(references, {}, {"other"})
    assert lid.source is None and seam.source is None and lid.point.tolist() == [0, 0, 1]
    # what never had a place can't keep one
    assert rim.source.of == "crate.axis"
    assert references_kept(references, {}, {"crate"})[0].source.of == "crate.top"


@pytest.mark.parametrize(
    ("held", "message"),
    [
        ({"on": "crate"}, r"objects\[0\]\.on: .*an object of that name: say which .* crate\.top"),
        ({"on": "crat.top"}, r"'crat\.top', and no object 'crat'; there is floor"),
        ({"on": "it.top"}, r"objects\[0\]\.on: 'it\.top' is a feature of its own"),
        ({"on": "crate.lid"}, r"'crate\.lid': a box has no feature 'lid'; it has base, top"),
        (
            {"relations": (Relation("touches", "floor"), Relation("parallel", "drum.axis"))},
            r"objects\[0\]\.relations\[1\]\.to: no reference is called 'drum\.axis'",
        ),
        ({"relations": (Relation("same_size", "floor"),)}, "'floor' is the name of no object"),
        ({"relations": (Relation("same_size", "it"),)}, "'it' is the object itself"),
        (
            {"relations": (Relation("symmetric", "crate", about="wall"),)},
            r"relations\[0\]\.about: no reference is called 'wall'",
        ),
        (
            {"relations": (Relation("leans_on", "floor", own="side0"),)},
            r"relations\[0\]\.own: a box has no feature 'side0'",
        ),
        (
            {"relations": (Relation("same_size", "crate", own="radius"),)},
            r"relations\[0\]\.own: a box has no size 'radius'; it has size_x",
        ),
    ],
)
def test_a_relation_to_nothing_is_refused_by_its_path(held, message):
    floor = ReferencePlane("floor", [0, 0, 0], [0, 0, 1])
    with pytest.raises(InvalidValue, match=message):
        Cell(CAMERA, references=(floor,), objects=(thing("it", **held), thing("crate")))
