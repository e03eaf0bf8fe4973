# SPDX-License-Identifier: GPL-3.0-or-later
"""Every solid, relation, motion and composite through the command line: compared and refused."""

from __future__ import annotations

import json
from copy import deepcopy

import pytest
from edited_job import edited

FLAT = {"rotation": [[1, 0, 0], [0, 1, 0], [0, 0, 1]], "translation": [0.4, 0.1, 0.1]}
SQUARE = [[-0.1, -0.1], [0.1, -0.1], [0.1, 0.1], [-0.1, 0.1]]
HINGE = {"kind": "attached", "to": "block", "joint": "hinge", "axis": [0, 0, 1]}
KINDS = {
    "ball": {"kind": "sphere", "radius": 0.05},
    "cup": {"kind": "cone", "radius": 0.05, "top_radius": 0.08, "height": 0.2},
    "pipe": {"kind": "tube", "radius": 0.05, "inner_radius": 0.03, "height": 0.2},
    "tile": {"kind": "prism", "polygon": SQUARE, "height": 0.02},
}


def more(document):
    """The job's objects and one of each other kind, on a hinge, held, and in a group."""
    for name, shape in deepcopy(KINDS).items():
        document["objects"].append({"name": name, "world_from_object": FLAT} | shape)
    entry = {e["name"]: e for e in document["objects"]}
    entry["tile"] |= {"on": "block.top", "relations": [{"kind": "parallel", "to": "drum.axis"}]}
    entry["cup"]["motion"] = dict(HINGE)
    entry["ball"]["motion"] = {"kind": "movable", "density": 700}
    document["composites"] = [{"name": "group", "parts": ["ball", "pipe"]}]
    return entry


def test_compare_tells_every_kind_by_its_sizes(run, job):
    def changed(document):
        entry = more(document)
        entry["ball"]["radius"] = 0.051
        entry["pipe"]["inner_radius"] = 0.028
        entry["tile"]["polygon"] = [[1.01 * x, 1.01 * y] for x, y in SQUARE[1:] + SQUARE[:1]]
        # upside down, the radii exchanged: the same cup
        entry["cup"] |= {"radius": 0.08, "top_radius": 0.05}
        entry["cup"]["world_from_object"] = {
            "rotation": [[1, 0, 0], [0, -1, 0], [0, 0, -1]],
            "translation": FLAT["translation"],
        }

    (job / "all.json").write_text((job / edited(job, more, "truth.cell.json")).read_text())
    code, out, err = run("compare", "all.json", edited(job, changed, "truth.cell.json"))
    assert (code, err) == (0, "")
    lines = [line.split() for line in out.splitlines()]
    for row in (
        ["radius", "of", "50.0", "+1.00", "-"],
        ["inner", "radius", "of", "30.0", "-2.00", "-"],
        ["top", "radius", "of", "80.0", "+0.00", "-"],
        ["worst", "corner", "1.41", "-"],
        ["tilt", "0.0000", "deg", "-"],
        ["rotation", "0.0000", "deg", "-"],
    ):
        assert row in lines, out
    code, out, _ = run("compare", "all.json", "edited.json", "--json")
    told = {error["name"]: error for error in json.loads(out)["objects"]}
    assert told["cup"]["size_names"] == ["radius", "top_radius", "height"]
    assert told["cup"]["tilt"] == 0.0 and told["tile"]["corners"][0] == pytest.approx(2**0.5 / 1e3)


def test_compare_warns_of_a_prism_with_other_corners(run, job):
    def fewer(document):
        more(document)["tile"]["polygon"] = [[-0.1, -0.1], [0.2, -0.1], [-0.1, 0.2]]

    (job / "all.json").write_text((job / edited(job, more, "truth.cell.json")).read_text())
    code, _, err = run("compare", "all.json", edited(job, fewer, "truth.cell.json"))
    assert code == 0
    assert err == "warning: tile: has 3 corners, the true one 4: not matched\n"


def spoilt(path, value):
    """A change of one field, named as in a message: `tile.polygon`, `composites.0.parts`."""

    def change(document):
        entries = more(document) | {"composites": document["composites"]}
        *steps, last = path.split(".")
        at = entries
        for step in steps:
            at = at[int(step)] if step.isdecimal() else at[step]
        at[int(last) if last.isdecimal() else last] = value

    return change


CROSSED = [[-0.1, -0.1], [0.1, 0.1], [0.1, -0.1], [-0.1, 0.2]]


@pytest.mark.parametrize(
    ("path", "value", "told"),
    [
        ("ball.radius", -1, "objects[2]: ball: radius: must be above zero, got -1"),
        ("ball.size", [1, 1, 1], "objects[2].size: unknown key; known here are name, kind"),
        ("ball.kind", "blob", "objects[2].kind: 'blob' is none of box, cylinder, sphere, cone"),
        ("cup.top_radius", -0.1, "objects[3]: cup: top_radius must not be below zero, got -0.1"),
        ("pipe.inner_radius", 0.05, "inner_radius 0.05 leaves no wall inside a radius of 0.05"),
        ("tile.polygon", SQUARE[:2], "objects[5].polygon: expected 3 corners or more, got 2"),
        ("tile.polygon", SQUARE[::-1], "go clockwise (area -4e+04 mm^2)"),
        ("tile.polygon", CROSSED, "objects[5]: tile: polygon: "),
        ("tile.polygon", [[0, 0], [1, 0], [0, 1]], "its centre of area lies 471 mm from"),
        ("tile.polygon.2", [0.1], "objects[5].polygon[2]: expected 2 numbers, got 1"),
        ("tile.covariance", [[1]], "objects[5].covariance: expected 15 rows, got 1"),
        ("tile.on", "shelf", "objects[5].on: no reference is called 'shelf'; there is floor"),
        ("tile.on", "block", "objects[5].on: no reference is called 'block'; there is an object"),
        ("tile.on", "block.lid", "objects[5].on: 'block.lid': a box has no feature 'lid'"),
        ("tile.on", "crate.top", "'crate.top', and no object 'crate'"),
        ("tile.on", "tile.top", "'tile.top' is a feature of its own"),
        ("tile.relations.0.kind", "near", "objects[5].relations[0].kind: 'near' is none of stands"),
        ("tile.relations.0.to", "drum.side", "relations[0].to: 'drum.side': a cylinder has no"),
        ("tile.relations.0.about", "floor", "relations[0]: relation parallel: `about` names the"),
        ("tile.relations.0.own", "side7", "relations[0].own: a prism has no feature 'side7'"),
        ("tile.relations.0.angle", 3, "objects[5].relations[0].angle: unknown key"),
        ("tile.relations", {}, "objects[5].relations: expected a list, got {}"),
        ("cup.motion.kind", "loose", "objects[3].motion.kind: 'loose' is none of static, movable"),
        ("cup.motion.joint", "screw", "objects[3].motion.joint: 'screw' is none of fixed, hinge"),
        ("cup.motion.to", "crate", "objects[3].motion.to: 'crate' is the name of no object"),
        ("cup.motion.to", "cup", "objects[3].motion.to: 'cup' can't hang on itself"),
        ("cup.motion.axis", [0, 0, 0], "objects[3].motion.axis: has no length"),
        ("cup.motion.limits", [0.1, 1], "objects[3].motion.limits: from 0.1 to 1 leaves out 0"),
        ("cup.motion.mass", 0, "objects[3].motion.mass: must be above zero, got 0"),
        ("ball.motion.mass", 1, "objects[2].motion: mass and density are both given"),
        ("ball.motion.joint", "hinge", "objects[2].motion: movable: only `attached` has a joint"),
        (
            "ball.motion",
            {"kind": "static", "mass": 1},
            "objects[2].motion: static: what never moves",
        ),
        ("ball.motion", {"kind": "attached"}, "objects[2].motion: attached: needs `to`"),
        ("block.motion", HINGE | {"to": "cup"}, "hang on each other in a circle"),
        ("composites.0.parts", [], "composites[0]: group: parts: a composite needs one object"),
        ("composites.0.parts", ["ball", "ball"], "composites[0]: group: parts: 'ball' is named tw"),
        ("composites.0.parts.1", "crate", "composites[0].parts[1]: 'crate' is the name of no obj"),
        ("composites.0.parts.1", 3, "composites[0].parts[1]: expected a text, got 3"),
        ("composites.0.name", "ball", "composites[0].name: 'ball' is also objects[2]'s name"),
        ("composites.0.color", 1, "composites[0].color: unknown key; known here are name, parts"),
        (
            "composites.0.motion",
            HINGE | {"to": "pipe"},
            "composites[0].motion.to: 'pipe' can't hang",
        ),
    ],
)
def test_what_can_t_be_is_refused_in_one_line_with_its_path(refused, job, path, value, told):
    document = edited(job, spoilt(path, value), "truth.cell.json")
    assert told in refused("compare", "truth.cell.json", document)
