# SPDX-License-Identifier: GPL-3.0-or-later
"""A cell's objects as a tree of rigid links with joints: what URDF, SDF and MJCF are made of."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..bodies import rigid_bodies
from ..cell import Cell
from ..links import without_lost_joints
from ..pose import Pose
from ..primitives import Primitive
from ..shape.mass import centre_of_mass, inertia
from ..shape.masses import DEFAULT_DENSITY, masses
from .identifiers import identifiers

WORLD, CAMERA, OPTICAL = "world", "camera", "camera_optical_frame"
RESERVED = (WORLD, CAMERA, OPTICAL, "sun")
STILL, FREE = "still", "free"


@dataclass(frozen=True, eq=False)
class Link:
    """An object as a rigid link; its frame is turned as the object, and stands at its joint.

    `parent` is the number of the link that it hangs on, None for the world. `joint` is `still`
    (fixed, and nothing below it moves), `fixed` to what moves, `free`, `hinge` or `slider` about or
    along `axis` (3,) with its `limits`. `mass` in kg.
    """

    thing: Primitive
    name: str
    mass: float
    link_from_object: Pose
    parent: int | None
    joint: str
    axis: Array
    limits: tuple[float, float] | None

    @property
    def world_from_link(self) -> Pose:
        return self.thing.world_from_object @ self.link_from_object.inverse()

    @property
    def centre_of_mass(self) -> Array:
        """(3,) in the link's frame."""
        return self.link_from_object.apply(centre_of_mass(self.thing))

    @property
    def inertia(self) -> Array:
        """(3, 3) about the centre of mass, in the link's axes, kg m^2."""
        return self.mass * inertia(self.thing)


def links_of(cell: Cell) -> tuple[tuple[Link, ...], tuple[str, ...]]:
    """The links of all solved objects, each after the one it hangs on; and what was assumed.

    Raises InvalidValue for masses that are given twice.
    """
    objects, composites, lost = without_lost_joints(cell.objects, cell.composites)
    weights, assumed = masses(objects, composites)
    names = _link_names([thing.name for thing in objects])
    index = {thing.name: i for i, thing in enumerate(objects)}
    number: dict[int, int] = {}
    links: list[Link] = []
    for body in rigid_bodies(objects, composites):
        for part in body.parts:
            motion = body.motion
            if motion.kind == "static":
                parent, joint = None, STILL
            elif part != body.owner:
                parent, joint = number[body.owner], "fixed"
            elif motion.to is None:
                parent, joint = None, FREE
            else:
                parent, joint = number[index[motion.to]], str(motion.joint)
            jointed = joint in ("hinge", "slider")
            axis = motion.axis if jointed and motion.axis is not None else np.array([0, 0, 1.0])
            point = motion.point if jointed and motion.point is not None else np.zeros(3)
            number[part] = len(links)
            links.append(
                Link(
                    objects[part],
                    names[part],
                    float(weights[part]),
                    Pose(np.eye(3), -point),
                    parent,
                    joint,
                    axis,
                    motion.limits if jointed else None,
                )
            )
    return tuple(links), (*lost, *_weights_told(links, assumed))


def parent_from_link(links: Sequence[Link], link: Link) -> Pose:
    """Where a link stands in the frame of the one it hangs on, or in the world."""
    if link.parent is None:
        return link.world_from_link
    return links[link.parent].world_from_link.inverse() @ link.world_from_link


def moving(links: Sequence[Link]) -> list[Link]:
    """The links that may move."""
    return [link for link in links if link.joint != STILL]


def _link_names(names: Sequence[str]) -> tuple[str, ...]:
    """None of them is the name of a joint: SDF keeps links and joints in one list."""
    joints = [f"{name}_joint" for name in identifiers(names)]
    return identifiers(names, (*RESERVED, *joints))


def _weights_told(links: Sequence[Link], assumed: Sequence[str]) -> tuple[str, ...]:
    unsure = [link.thing.name for link in moving(links) if link.thing.name in assumed]
    if not unsure:
        return ()
    return (
        f"no mass or density is given of {', '.join(unsure)}: taken as {DEFAULT_DENSITY:g} "
        "kg/m^3, the density of water",
    )
