# SPDX-License-Identifier: GPL-3.0-or-later
"""How each solid is picked: the plans of all kinds, each kind with its ways by name."""

from __future__ import annotations

from collections.abc import Mapping

from .pick_plan import PickPlan, Stage

# as high as a sheet of paper stands for no height yet
THIN = 1e-3
RIM = Stage(
    "rim",
    ("base rim, point 1 of 3", "base rim, point 2 of 3", "base rim, point 3 of 3, far from both"),
    "another point of the base rim",
    ("radius",),
)
# a circle on the reference says it all before the height is set
DISC = ("cylinder", {"height": THIN})

BOX = PickPlan(
    "box",
    (
        Stage(
            "base",
            (
                "base corner 1 of 3",
                "base corner 2 of 3, next to the first",
                "base corner 3 of 3, going on round",
            ),
            "the fourth base corner",
            ("size_x", "size_y"),
            most=4,
        ),
        Stage(
            "top",
            ("top corner, above any base corner",),
            "another corner of the top",
            ("size_z",),
            most=4,
        ),
    ),
    flat=("box", {"size_z": THIN}),
)
PRISM = PickPlan(
    "prism",
    (
        Stage(
            "base",
            ("base corner 1", "base corner 2, going round", "base corner 3, going on round"),
            "the next base corner, or Enter when you are round",
            closing=True,
        ),
        Stage(
            "top",
            ("top corner, above any base corner",),
            "another corner of the top",
            ("height",),
        ),
    ),
    flat=("prism", {"height": THIN}),
)
CYLINDER = PickPlan(
    "cylinder",
    (
        RIM,
        Stage(
            "top",
            ("top rim, on the side that faces the camera",),
            "another point of the top rim, on its far side, which settles the height",
            ("height",),
        ),
    ),
    flat=DISC,
)
LYING_ENDS = (
    Stage(
        "rim",
        (
            "rim of the end you see best, point 1 of 4",
            "the same rim, point 2 of 4",
            "the same rim, point 3 of 4",
            "the same rim, point 4 of 4, all round",
        ),
        "another point of that rim",
        ("radius",),
    ),
    Stage(
        "top",
        (
            "rim of the other end, point 1 of 3",
            "rim of the other end, point 2 of 3",
            "rim of the other end, point 3 of 3",
        ),
        "another point of that rim",
    ),
)
LYING_CYLINDER = PickPlan("cylinder", LYING_ENDS, held="lies")
CONE = PickPlan(
    "cone",
    (RIM, Stage("apex", ("the tip",), "the tip", ("height",), most=1)),
    known={"top_radius": 0.0},
    flat=DISC,
)
FRUSTUM = PickPlan(
    "cone",
    (
        RIM,
        Stage(
            "top",
            ("top rim, point 1 of 3", "top rim, point 2 of 3", "top rim, point 3 of 3"),
            "another point of the top rim",
            ("top_radius", "height"),
        ),
    ),
    flat=DISC,
)
TUBE = PickPlan(
    "tube",
    (
        RIM,
        Stage(
            "top",
            ("outer rim of the top, on the side that faces the camera",),
            "another point of the outer top rim, on its far side, which settles the height",
            ("height",),
        ),
        Stage("hole", ("rim of the hole",), "another point of the hole", ("inner_radius",)),
    ),
    flat=DISC,
)
LYING_TUBE = PickPlan(
    "tube",
    (*LYING_ENDS, Stage("hole", ("rim of the hole",), "another point of it", ("inner_radius",))),
    held="lies",
)
OUTLINE = Stage(
    "outline",
    ("outline, point 1 of 3", "outline, point 2 of 3", "outline, point 3 of 3, far from both"),
    "another point of the outline",
    # not `sets`: where a ball of known radius is, its outline has still to say
)
SPHERE = PickPlan("sphere", (OUTLINE,))
FLOATING_SPHERE = PickPlan("sphere", (OUTLINE,), held="floats")

# kind to its ways: an identifier, what it is called, what it means, the plan
WAYS: Mapping[str, tuple[tuple[str, str, str, PickPlan], ...]] = {
    "box": (("STANDING", "Standing", "Its base lies on the reference", BOX),),
    "prism": (("STANDING", "Standing", "Its base lies on the reference", PRISM),),
    "cylinder": (
        ("STANDING", "Standing", "Its base lies on the reference", CYLINDER),
        ("LYING", "Lying", "It lies on its side", LYING_CYLINDER),
    ),
    "cone": (
        ("POINTED", "Pointed", "It ends in a tip", CONE),
        ("FRUSTUM", "Frustum", "It ends in a smaller or larger circle", FRUSTUM),
    ),
    "tube": (
        ("STANDING", "Standing", "Its base lies on the reference", TUBE),
        ("LYING", "Lying", "It lies on its side", LYING_TUBE),
    ),
    "sphere": (
        ("RESTING", "Resting", "It touches the reference, which tells its radius", SPHERE),
        ("FLOATING", "Floating", "It touches nothing: type its radius", FLOATING_SPHERE),
    ),
}


def plan_of(kind: str, way: str) -> PickPlan:
    """The plan of a way of a kind."""
    return next(plan for name, _, _, plan in WAYS[kind] if name == way)


def next_way(kind: str, way: str) -> str:
    """The way that comes after one, going round."""
    names = [name for name, _, _, _ in WAYS[kind]]
    return names[(names.index(way) + 1) % len(names)]
