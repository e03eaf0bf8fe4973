# SPDX-License-Identifier: GPL-3.0-or-later
"""References that can't be are refused with the numbers; doubtful ones are warned of."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from monocell.core import Box, Camera, Pose, ReferenceLine, ReferencePlane, Relation
from monocell.core.errors import DegenerateReference, InvalidValue, NoPose, PickError
from monocell.core.reference import PendingReference
from monocell.core.references.order import objects_behind
from monocell.core.references.resolve import resolve_references, resolved_reference
from monocell.core.references.sources import (
    AlongDirection,
    FacingCamera,
    FeatureOf,
    Intersection,
    Parallel,
    PickedPoints,
    Stated,
    ThroughPoints,
    Upright,
)
from referenced_cell import CAMERA, CRATE, DRUM, FLOOR, LENS, referenced_cell

# camera 1 m up that looks level along x: the horizon is the row of the principal point
LEVEL = CAMERA.placed(Pose.looking_at([0, 0, 1.0], [1.0, 0, 1.0], [0, 0, 1]))
GOOD = CAMERA.project([[0, 0, 0], [0.3, 0, 0], [0, 0.3, 0], [0.3, 0.3, 0]])


def warnings_of(kind, source, camera=CAMERA, *others):
    cell = referenced_cell(camera, {"it": (kind, source)})
    return resolve_references(replace(cell, references=(*cell.references, *others)))[1]


def plane(source, *others, camera=CAMERA):
    return warnings_of("plane", source, camera, *others)


def line(source, *others, camera=CAMERA):
    return warnings_of("line", source, camera, *others)


def picked(pixels, heights=0.0):
    return PickedPoints(pixels, heights, "floor")


@pytest.mark.parametrize(
    ("make", "error", "told"),
    [
        (
            lambda: plane(ThroughPoints(np.eye(3)[:2])),
            DegenerateReference,
            "it: 2 points make no plane; give 3 or more",
        ),
        (
            lambda: plane(ThroughPoints([[0, 0, 0], [1, 0, 0], [2, 0, 0]])),
            DegenerateReference,
            "it: its points lie within 0 mm of one line 2000 mm long; give one beside it",
        ),
        (
            lambda: plane(ThroughPoints([[0, 0, 0], [1, 0, 0], [2, 1e-3, 0]], 1e-3)),
            DegenerateReference,
            r"it: its points span 2000 mm x 0\.\d+ mm, which leaves its direction open by",
        ),
        (
            lambda: line(ThroughPoints([[0, 0, 0], [0, 0, 0]])),
            DegenerateReference,
            "it: its points lie within 0 mm of each other; give points that are apart",
        ),
        (
            lambda: plane(picked(GOOD[:2])),
            PickError,
            "it: 2 picks make no plane; pick 3 or more",
        ),
        (
            lambda: plane(picked(CAMERA.project([[0, 0, 0], [0.2, 0, 0], [0.4, 0.002, 0]]))),
            PickError,
            r"it: its picks lie within 1 mm of one line 400 mm long; pick one beside it",
        ),
        (
            lambda: plane(picked([[5000.0, 300], *GOOD])),
            PickError,
            r"it: pixels\[0\] at \(5000\.0, 300\.0\) lies more than half a picture outside the "
            "1280 x 960 px picture; pick it again",
        ),
        (
            lambda: plane(picked([*GOOD, GOOD[1] + [0.8, 0]])),
            PickError,
            r"it: pixels\[4\] is 0\.8 px from pixels\[1\]: they are one place; pick them apart",
        ),
        (
            lambda: plane(picked([[650, 700], [200, 700], [650.3, 440.8]]), camera=LEVEL),
            PickError,
            r"it: pixels\[2\] at \(650\.3, 440\.8\) lies 30\.\d px \(1\.7 degrees\) above the hor"
            "izon of floor; pick a point on floor",
        ),
        (
            lambda: plane(picked([[650, 600], [200, 700], [650, 750]], 1.2), camera=LEVEL),
            PickError,
            r"above the horizon of floor raised by 1\.2 m",
        ),
        (
            lambda: plane(Upright(GOOD[:1], "floor")),
            PickError,
            "it: 1 picks make no plane; pick 2 or more",
        ),
        (
            lambda: line(Upright(GOOD[:2], "floor")),
            PickError,
            "it: an upright line stands at one pick, and 2 are given",
        ),
        (
            lambda: line(Intersection(("floor", "crate.top"))),
            DegenerateReference,
            "it: floor and crate.top are parallel to 0 degrees, so they meet in no line",
        ),
        (
            lambda: plane(
                FacingCamera("sight"),
                ReferenceLine("sight", CAMERA.centre_world, [0, 0, 1]),
            ),
            DegenerateReference,
            "it: the camera is 0 mm from sight itself, so no plane through it faces the camera",
        ),
        (
            lambda: plane(Parallel("crate.axis", 0.1)),
            InvalidValue,
            r"it: crate\.axis is a line, and a plane is needed there",
        ),
        (
            lambda: line(AlongDirection("crate.top", [0, 0, 1])),
            InvalidValue,
            r"it: crate\.top is a plane, and a point is needed there",
        ),
        (
            lambda: line(AlongDirection([0, 0, 0], "crate.centre")),
            InvalidValue,
            r"it: crate\.centre is a point, which has no direction",
        ),
        (
            lambda: plane(FeatureOf("crate.lid")),
            InvalidValue,
            "it: crate: a box has no feature 'lid'; it has base, top, x-",
        ),
        (
            lambda: plane(FeatureOf("crate")),
            InvalidValue,
            "it: nothing is called 'crate'; references are floor, it; objects, whose features are "
            r"named like crate\.top, are crate, drum, ball",
        ),
        (
            lambda: plane(Parallel("flor", 0.1)),
            InvalidValue,
            "it: nothing is called 'flor'; references are floor, it",
        ),
        (
            lambda: plane(Parallel("it", 0.1)),
            DegenerateReference,
            r"it: it is made from itself \(it -> it\); break the circle",
        ),
        (
            lambda: plane(Upright(GOOD[:2], "floor"), camera=Camera(LENS)),
            NoPose,
            "the camera has no pose yet",
        ),
    ],
)
def test_what_can_t_be_is_refused_with_the_numbers(make, error, told):
    with pytest.raises(error, match=told) as refusal:
        make()
    assert "\n" not in str(refusal.value)


def test_a_circle_of_several_is_named_whole():
    sources = {
        "a": ("plane", Parallel("b", 0.1)),
        "b": ("plane", Parallel("c", 0.1)),
        "c": ("plane", Parallel("a", 0.1)),
    }
    with pytest.raises(DegenerateReference, match=r"a: .* \(a -> b -> c -> a\)"):
        resolve_references(referenced_cell(sources=sources))


def test_a_circle_through_an_object_is_one_too():
    sources = {"lid": ("plane", FeatureOf("crate.top"))}
    cell = referenced_cell(sources=sources, things=(replace(CRATE, on="lid"),))
    with pytest.raises(DegenerateReference, match=r"\(lid -> crate\.top -> lid\)"):
        resolve_references(cell)


def test_a_circle_through_a_relation_is_one_too_and_objects_may_hold_each_other():
    sources = {"lid": ("plane", FeatureOf("crate.top"))}
    leaning = replace(CRATE, relations=(Relation("leans_on", "lid"),))
    with pytest.raises(DegenerateReference, match=r"\(lid -> crate\.top -> lid\)"):
        resolve_references(referenced_cell(sources=sources, things=(leaning,)))
    one = replace(CRATE, relations=(Relation("parallel", "drum.axis"),))
    other = replace(DRUM, relations=(Relation("parallel", "crate.axis"),))
    cell = referenced_cell(sources=sources, things=(one, other))
    assert resolve_references(cell)[1] == ()


def test_a_chain_of_hundreds_resolves_in_any_order_and_an_endless_one_is_refused():
    names = [f"p{i}" for i in range(350)]
    links = list(zip(names[1:], names, strict=False))[::-1]
    sources = {name: ("plane", Parallel(below, 0.01)) for name, below in links}
    sources["p0"] = ("plane", Parallel("floor", 0.01))
    cell = resolve_references(referenced_cell(sources=sources))[0]
    np.testing.assert_allclose(cell.reference("p349").point, [0, 0, 3.5])
    sources |= {f"p{i}": ("plane", Parallel(f"p{i - 1}", 0.01)) for i in range(450, 349, -1)}
    sources = {"last": ("plane", Parallel("p450", 0.01)), **sources}
    with pytest.raises(DegenerateReference, match="last: it is made from more than 400 others"):
        resolve_references(referenced_cell(sources=sources))


def test_planes_that_are_nearly_parallel_are_told_with_their_angle_and_sigma():
    ramp = ReferencePlane("ramp", [0, 0, 0.0], [0.05, 0, 1.0], source=Stated(1e-3, 1e-3))
    (told,) = line(Intersection(("floor", "ramp")), ramp)
    assert "it: the planes meet at 2.9 degrees: its direction is known to " in told
    steep = ReferencePlane("ramp", [0, 0, 0.0], [1, 0, 1.0], source=Stated(1e-3, 1e-3))
    assert line(Intersection(("floor", "ramp")), steep) == ()


def test_planes_that_meet_at_less_than_their_own_error_are_refused():
    ramp = ReferencePlane("ramp", [0, 0, 0.1], [0.005, 0, 1.0], source=Stated(1e-3, 2e-2))
    with pytest.raises(DegenerateReference, match=r"it: the planes meet at 0\.3 degrees, and its"):
        line(Intersection(("floor", "ramp")), ramp)


def test_picks_at_a_grazing_angle_are_told():
    row = 470.8 + 990.0 * np.tan(np.radians(1.2))
    told = plane(picked([[650.3, row], [200, 700], [1000, 800]]), camera=LEVEL)
    assert any("it: pixels[0] at" in t and "grazes floor at" in t for t in told)


def test_picks_that_miss_their_plane_are_told_with_the_worst():
    pixels = CAMERA.project([[x, y, 0.2] for x in (0, 0.2, 0.4) for y in (0, 0.4)])
    pixels[3] += [0, 30]
    heights = np.array([0.2, 0.2, 0.25, 0.25, 0.3, 0.3])
    (told,) = plane(PickedPoints(pixels, heights, "floor"))
    assert "it: the picks miss the plane by up to 22.6 px (pixels[3])" in told
    assert "times what 1 px of pick noise explain" in told
    foot = CAMERA.project([[-0.3, -0.4, 0], [-0.3, 0, 0], [-0.3, 0.4, 0]])
    foot[1] += [0, 20]
    told, vague = plane(Upright(foot, "floor"))
    assert "(pixels[1])" in told
    assert "so its direction is known to" in vague


def test_points_that_hardly_tell_the_tilt_are_told_with_it():
    (told,) = plane(ThroughPoints([[0, 0, 0], [1, 0, 0], [0.5, 0.02, 0]], 1e-3))
    assert "it: its points span 1000 mm x 20 mm, so its direction is known to " in told


def test_a_kind_that_a_source_can_t_make_is_refused():
    with pytest.raises(InvalidValue, match="it: 'parallel' makes a plane, not a line"):
        PendingReference("it", "line", Parallel("floor", 1.0))


def test_what_a_reference_hangs_on_is_found_through_others():
    sources = {
        "lid": ("plane", FeatureOf("crate.top")),
        "loft": ("plane", Parallel("lid", 0.3)),
        "seam": ("line", Intersection(("loft", "drum.base"))),
    }
    cell = referenced_cell(sources=sources)
    assert objects_behind(cell, "seam") == ("crate", "drum")
    assert objects_behind(cell, "floor") == ()
    assert objects_behind(cell, "drum.axis") == ("drum",)


def test_one_reference_is_worked_out_without_looking_at_others_that_can_t_be():
    sources = {
        "loft": ("plane", Parallel("floor", 0.3)),
        "bad": ("line", Intersection(("floor", "loft"))),
    }
    loft, warnings = resolved_reference(referenced_cell(sources=sources), "loft")
    np.testing.assert_allclose(loft.point, [0, 0, 0.3])
    assert warnings == ()
    top, _ = resolved_reference(referenced_cell(sources=sources), "crate.top")
    assert top.name == "crate.top"


def test_a_reference_s_name_goes_before_an_object_s_feature():
    loft = ReferencePlane("crate.top", [0, 0, 1], [0, 0, 1])
    cell = replace(referenced_cell(sources={}), references=(FLOOR, loft))
    assert cell.reference("crate.top") is loft


def test_a_point_feature_is_no_reference():
    with pytest.raises(InvalidValue, match=r"ball\.centre: is a point"):
        referenced_cell().reference("ball.centre")


def test_names_with_points_in_them_still_have_features():
    box = Box("row.2", Pose.identity(), size=[1, 1, 1])
    assert referenced_cell(things=(box,), sources={}).reference("row.2.top").point[2] == 0.5
