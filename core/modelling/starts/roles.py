# SPDX-License-Identifier: GPL-3.0-or-later
"""The roles that each kind is picked by in, what every pick means out."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ...camera import Camera
from ...errors import PickError
from ...shape.anchors import anchors
from ...sketch import Sketch
from ..pick_plan import PickPlan
from ..picks import RolePicks, read_picks
from .seen import Seen

ROLES = {
    "box": ("base", "top"),
    "prism": ("base", "top"),
    "cylinder": ("rim", "top", "sides"),
    "cone": ("rim", "top", "sides", "apex"),
    "tube": ("rim", "top", "sides", "hole"),
    "sphere": ("outline",),
}
# corners that are not seen are null, so that the others keep their places
NULLABLE = {"box": ("base", "top"), "prism": ("base", "top")}
CURVES = {
    "rim": ("base rim",),
    "top": ("top rim",),
    "sides": ("side-", "side+"),
    "outline": ("outline",),
}
HOLES = {1.0: ("top hole",), -1.0: ("base hole",)}
# base corners in order round the base, for picks that go anticlockwise seen from the top
ROUND = ((-1, -1), (1, -1), (1, 1), (-1, 1))

Picked = Mapping[str, RolePicks]


def picked_roles(sketch: Sketch, camera: Camera) -> dict[str, RolePicks]:
    """The picks of every role of the sketch's kind. Raises PickError for what can't be picks."""
    picked = read_picks(
        sketch, camera.intrinsics, ROLES[sketch.kind], NULLABLE.get(sketch.kind, ())
    )
    if sketch.kind == "cone" and len(picked["apex"]):
        if len(picked["apex"]) > 1 or len(picked["top"]):
            raise PickError(
                f"{sketch.name}: a cone ends in one apex, or in a top circle; "
                f"{len(picked['apex'])} apex and {len(picked['top'])} top picks say both"
            )
        if sketch.known.get("top_radius", 0.0) > 0:
            raise PickError(
                f"{sketch.name}: apex[0] is where a cone ends in a point, and its top_radius is "
                f"known as {1e3 * sketch.known['top_radius']:.1f} mm; take one away"
            )
    return picked


def corner_names(kind: str, picked: Picked, turn: float) -> tuple[str, ...]:
    """The anchors of base and top picks of a box or prism picked anticlockwise (+1) or clockwise.

    A box has x from base[0] to base[1]; a prism keeps its corners' order, or reverses it.
    """
    names = []
    count = polygon_count(picked)
    for role in ("base", "top"):
        for place in picked[role].places:
            if kind == "box":
                x, y = ROUND[place]
                names.append(f"x{'-+'[x > 0]}y{'-+'[y * turn > 0]}{role}")
            else:
                names.append(f"{role}{place if turn > 0 else count - 1 - place}")
    return tuple(names)


def polygon_count(picked: Picked) -> int:
    """How many corners the base has, counting those above which a corner was picked."""
    return 1 + max((place for role in ("base", "top") for place in picked[role].places), default=-1)


def corner_plan(kind: str, picked: Picked, turn: float, sigma_pixels: float) -> PickPlan:
    """What the picks of a box or prism mean."""
    base, top = picked["base"], picked["top"]
    return PickPlan(
        np.concatenate([base.pixels, top.pixels]),
        corner_names(kind, picked, turn),
        labels=(*base.labels, *top.labels),
        sigma_pixels=sigma_pixels,
    )


def round_plan(picked: Picked, facing: float, sigma_pixels: float) -> PickPlan:
    """What the picks of a round solid mean, whose end `facing` (+1 top, -1 base) is seen."""
    curves = {**CURVES, "hole": HOLES[facing]}
    roles = [role for role in picked if role != "apex"]
    apex = picked.get("apex")
    points = np.zeros((0, 2)) if apex is None else apex.pixels
    return PickPlan(
        points,
        ("apex",) * len(points),
        np.concatenate([picked[role].pixels for role in roles]),
        tuple(curves[role] for role in roles for _ in picked[role].places),
        (
            *(() if apex is None else apex.labels),
            *(n for role in roles for n in picked[role].labels),
        ),
        sigma_pixels,
    )


def corners_seen(camera: Camera, plan: PickPlan, kind: str, parameters: int) -> Seen:
    """The rays of a box's or prism's corners."""
    origin, rays = camera.rays_world(plan.points)
    by = anchors(kind, np.zeros(parameters), plan.anchors)[1]
    return Seen(kind, origin, focal_of(camera), rays, by)


def round_seen(camera: Camera, picked: Picked, kind: str, parameters: int) -> Seen:
    """The rays of a round solid's rims, sides and outline."""
    # all at once: undistorting one pixel costs as much as undistorting twenty
    origin, together = camera.rays_world(np.concatenate([p.pixels for p in picked.values()]))
    ends = np.cumsum([len(p) for p in picked.values()])
    rays = dict(zip(picked, np.split(together, ends[:-1]), strict=True))
    apex = rays.pop("apex", np.zeros((0, 3)))
    names = ["top centre"] * len(apex)
    by = anchors(kind, np.zeros(parameters), names)[1] if names else np.zeros((0, 3, parameters))
    return Seen(kind, origin, focal_of(camera), apex, by, **rays)


def focal_of(camera: Camera) -> float:
    """Pixels per radian, about."""
    return float(np.sqrt(camera.intrinsics.fx * camera.intrinsics.fy))
