# SPDX-License-Identifier: GPL-3.0-or-later
"""The arm among its obstacles: joint angles in, the nearest distance and what it is between out.

Distances are Bullet's, between exact obstacles and the convex hulls of the arm's links, which
Bullet makes 1 mm larger: what is stated is never more than there is (but for 0.02 mm at the rim of
a cylinder). The pieces that cones, tubes and prisms are made of are a trace too large, too.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ...core.arrays import Array
from ...core.closing import Closing
from ...core.composite import Composite
from ...core.errors import InvalidValue
from ...core.pose import Pose
from ...core.primitives import Box, Primitive
from .arm import Arm
from .bullet import pybullet
from .environment import WorldMesh
from .held import HeldBodies
from .multibodies import BASE, add_objects, world_from_object
from .shapes import add_obstacle

# farther than any arm reaches: "no limit" for a distance query
EVERYWHERE = 10.0
# links whose hulls touch at nearly every angle are built that way
BUILT_TOUCHING, POSES_TRIED = 0.95, 100


@dataclass(frozen=True, eq=False)
class Gap:
    """The distance between a part of the arm and a thing, negative where they overlap.

    `link` is the arm's link or "ball"; `thing` is the object, "table", or another link of the arm.
    `at_world` (3,) is the nearest point of the thing.
    """

    distance: float
    link: str
    thing: str
    at_world: Array

    def __str__(self) -> str:
        if self.distance < 0:
            return f"{self.link} is {-self.distance * 1e3:.1f} mm inside {self.thing}"
        return f"{self.link} is {self.distance * 1e3:.1f} mm from {self.thing}"


@dataclass(frozen=True)
class Part:
    """A piece of the arm that can touch something: a Bullet body and link, and its name."""

    body: int
    link: int
    name: str


class RobotScene(Closing):
    """The arm among its obstacles; a context manager that takes the obstacles out again.

    `objects` become exact shapes, `meshes` their convex hulls. Objects that move have their mass
    and joints (`multibodies.py`), and stay where they are unless someone steps the world; what had
    to be assumed of them is in `warnings`. Links of the arm that no joint moves are held against
    nothing: no path can bring them into a collision. All distances are metres.

    Raises InvalidValue when two things share a name, and for joints or masses that can't be.
    """

    def __init__(
        self,
        arm: Arm,
        objects: Sequence[Primitive] = (),
        *,
        meshes: Sequence[WorldMesh] = (),
        table: Box | None = None,
        composites: Sequence[Composite] = (),
    ) -> None:
        self.arm, self.objects, self.meshes, self.table = arm, tuple(objects), tuple(meshes), table
        things: list[Primitive | WorldMesh] = [
            *objects,
            *meshes,
            *([table] if table is not None else []),
        ]
        self.names = tuple(thing.name for thing in things)
        if len(set(self.names)) < len(self.names):
            twin = next(name for name in self.names if self.names.count(name) > 1)
            raise InvalidValue(f"two things of the scene are called {twin!r}; rename one")
        self._p: Any = pybullet()
        self._placed, self.warnings = add_objects(arm.client, self.objects, composites)
        standing = [add_obstacle(arm.client, thing) for thing in things[len(self.objects) :]]
        self._at = [(at.body, at.link) for at in self._placed]
        self._at += [(body, BASE) for body in standing]
        self._on_body: dict[int, dict[int, int]] = {}
        for thing, (body, link) in enumerate(self._at):
            self._on_body.setdefault(body, {})[link] = thing
        self._held = HeldBodies(arm)
        self.parts = tuple(self._all_parts())
        self._pairs = self._pairs_that_can_part()

    def __enter__(self) -> RobotScene:
        return self

    def close(self) -> None:
        """Take the obstacles and the ball out of the arm's world."""
        for body in (*self._on_body, *self._held.bodies):
            self._p.removeBody(body, physicsClientId=self.arm.client)
        self._at, self._on_body = [], {}

    @property
    def object_names(self) -> tuple[str, ...]:
        """The names of the exact objects: without meshes and table."""
        return tuple(thing.name for thing in self.objects)

    def world_from_object(self, name: str) -> Pose:
        """Where an object stands now. Raises InvalidValue for a name that is none of theirs."""
        if name not in self.object_names:
            raise InvalidValue(
                f"no object of the scene is called {name!r}; "
                f"there is {', '.join(self.object_names) or 'none'}"
            )
        placed = self._placed[self.object_names.index(name)]
        return world_from_object(self.arm.client, placed)

    def clearance(self, joints: ArrayLike) -> Gap:
        """The nearest gap between the arm at `joints` (n,) and any thing of the scene.

        Raises InvalidValue for joints outside their limits, and when the scene is empty.
        """
        self.place(self.arm.checked(joints))
        gaps = [self.gap(i, EVERYWHERE) for i in range(len(self.names))]
        found = [gap for gap in gaps if gap is not None]
        if not found:
            raise InvalidValue("clearance: the scene holds nothing that the arm could be near to")
        return min(found, key=lambda gap: gap.distance)

    def own_clearance(self, joints: ArrayLike) -> Gap | None:
        """The nearest gap between two links of the arm that are not neighbours; None without."""
        self.place(self.arm.checked(joints))
        return self.own_gap(EVERYWHERE)

    def in_collision(self, joints: ArrayLike, margin: float = 0.0) -> bool:
        """Whether anything is nearer than `margin` metres, or the arm touches itself."""
        q = self.arm.checked(joints)
        return self.blocked(q, [margin] * len(self.names), 0.0)

    def blocked(self, joints: Array, needs: Sequence[float], own_need: float) -> bool:
        """Whether thing i is nearer than `needs[i]`, or two own links than `own_need`; fast."""
        self.place(joints)
        return any(self._nearer(body, needs) for body in self._on_body) or any(
            self._pair_nearer(a, b, own_need) for a, b in self._pairs
        )

    def place(self, joints: Array) -> None:
        """Put the arm and what it holds at `joints`."""
        self.arm.move(joints)
        self._held.follow()

    def gap(self, thing: int, reach: float) -> Gap | None:
        """The nearest gap to a thing (its index in `names`) where the arm stands; None beyond."""
        points = [
            (point[8], part.name, point[6])
            for part in self.parts
            for point in self._points(part, *self._at[thing], reach)
        ]
        if not points:
            return None
        distance, link, at = min(points)
        return Gap(distance, link, self.names[thing], np.array(at))

    def own_gap(self, reach: float) -> Gap | None:
        """The nearest gap between two links of the arm where it stands; None beyond `reach`."""
        points = [
            (point[8], a.name, b.name, point[6])
            for a, b in self._pairs
            for point in self._points(a, b.body, b.link, reach)
        ]
        if not points:
            return None
        distance, link, other, at = min(points)
        return Gap(distance, link, other, np.array(at))

    def _points(self, part: Part, body: int, link: int, reach: float) -> Any:
        return self._p.getClosestPoints(
            part.body, body, reach, part.link, link, physicsClientId=self.arm.client
        )

    def _nearer(self, body: int, needs: Sequence[float]) -> bool:
        """One query for the whole arm: a quarter of the time of one for each link."""
        client, fixed, things = self.arm.client, self.arm.fixed_links, self._on_body[body]
        reach = max(needs[thing] for thing in things.values())
        for own in (self.arm.body, *self._held.bodies):
            for point in self._p.getClosestPoints(own, body, reach, physicsClientId=client):
                near = point[8] < needs[things[point[4]]]
                if near and not (own == self.arm.body and point[3] in fixed):
                    return True
        return False

    def _pair_nearer(self, a: Part, b: Part, need: float) -> bool:
        return any(point[8] < need for point in self._points(a, b.body, b.link, need))

    def _all_parts(self) -> Iterator[Part]:
        for link in self.arm.links:
            if link not in self.arm.fixed_links:
                yield Part(self.arm.body, link, self.arm.link_name(link))
        for body in self._held.bodies:
            yield Part(body, -1, "ball")

    def _pairs_that_can_part(self) -> tuple[tuple[Part, Part], ...]:
        """Pairs of own parts, less neighbours and those that touch at nearly every angle."""
        fixed = [Part(self.arm.body, i, self.arm.link_name(i)) for i in self.arm.fixed_links]
        every = [*fixed, *self.parts]
        pairs = [
            (a, b)
            for i, a in enumerate(every)
            for b in every[i + 1 :]
            if not (a in fixed and b in fixed) and not self._neighbours(a, b)
        ]
        touches = np.zeros(len(pairs))
        random = np.random.default_rng(0)
        for _ in range(POSES_TRIED):
            self.place(random.uniform(self.arm.lower, self.arm.upper))
            touches += [self._pair_nearer(a, b, 0.0) for a, b in pairs]
        built_so = touches >= BUILT_TOUCHING * POSES_TRIED
        return tuple(pair for pair, touching in zip(pairs, built_so, strict=True) if not touching)

    def _neighbours(self, a: Part, b: Part) -> bool:
        if b.body != self.arm.body:
            return a.body != self.arm.body or self._held.touches(b.body, a.link)
        return self.arm.neighbours(a.link, b.link)
