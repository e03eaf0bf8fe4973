# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects with mass and joints in PyBullet: they swing, slide and stand as mechanics say."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from monocell.core import Box, Composite, Cone, Cylinder, Motion, Pose, Prism, Sphere, Tube
from monocell.core.errors import InvalidValue
from monocell.core.primitives import polygon_centre
from monocell.core.shape.mass import volume

pytestmark = pytest.mark.robot

G = 9.81
MOVABLE = Motion("movable", density=500)
CORNERS = np.array([[0, 0], [0.2, 0], [0.2, 0.05], [0.05, 0.05], [0.05, 0.15], [0, 0.15]])
ELL = CORNERS - polygon_centre(CORNERS)


def at(x, y, z, *turn):
    return Pose.from_rotation_vector(turn or [0, 0, 0], [x, y, z])


POST = Box("post", at(0, 0, 1), size=[0.05, 0.05, 0.05])


@pytest.fixture
def world():
    """A PyBullet world of its own with gravity, and what puts objects into it."""
    from monocell.headless.robot.bullet import pybullet
    from monocell.headless.robot.multibodies import add_objects, world_from_object

    p = pybullet()
    client = p.connect(p.DIRECT)
    p.setGravity(0, 0, -G, physicsClientId=client)
    p.setTimeStep(1e-3, physicsClientId=client)

    class World:
        def add(self, *objects, composites=()):
            self.placed, self.warnings = add_objects(client, objects, composites)
            for placed in self.placed:
                for link in range(-1, p.getNumJoints(placed.body, physicsClientId=client)):
                    # Bullet's own damping would slow a pendulum
                    p.changeDynamics(
                        placed.body,
                        link,
                        linearDamping=0,
                        angularDamping=0,
                        jointDamping=0,
                        physicsClientId=client,
                    )
                    p.setCollisionFilterGroupMask(placed.body, link, 0, 0, physicsClientId=client)

        def step(self, seconds):
            for _ in range(round(seconds * 1000)):
                p.stepSimulation(physicsClientId=client)

        def pose(self, i):
            return world_from_object(client, self.placed[i])

        def dynamics(self, i):
            placed = self.placed[i]
            return p.getDynamicsInfo(placed.body, placed.link, physicsClientId=client)

    yield World()
    p.disconnect(client)


SOLIDS = (
    Box("it", at(0.3, 0.1, 0.2, 0.3, 0.2, 1), size=[0.1, 0.2, 0.3]),
    Cylinder("it", at(0.3, 0.1, 0.2, 0.3, 0.2, 1), radius=0.05, height=0.3),
    Sphere("it", at(0.3, 0.1, 0.2, 0.3, 0.2, 1), radius=0.05),
    Cone("it", at(0.3, 0.1, 0.2, 0.3, 0.2, 1), radius=0.05, height=0.3),
    Tube("it", at(0.3, 0.1, 0.2, 0.3, 0.2, 1), radius=0.05, inner_radius=0.03, height=0.3),
    Prism("it", at(0.3, 0.1, 0.2, 0.3, 0.2, 1), polygon=ELL, height=0.1),
)


@pytest.mark.parametrize("thing", SOLIDS, ids=lambda thing: thing.kind)
def test_a_movable_solid_weighs_its_density_and_falls_freely(world, thing):
    world.add(replace(thing, motion=MOVABLE))
    assert world.dynamics(0)[0] == pytest.approx(500 * volume(thing))
    before = world.pose(0)
    np.testing.assert_allclose(before.matrix(), thing.world_from_object.matrix(), atol=1e-9)
    world.step(0.2)
    after = world.pose(0)
    assert after.translation[2] - before.translation[2] == pytest.approx(-G * 0.02, rel=0.01)
    np.testing.assert_allclose(after.rotation, before.rotation, atol=1e-6)


def test_a_static_solid_stays_and_a_mass_is_taken_as_given(world):
    world.add(
        replace(SOLIDS[0], name="a"),
        replace(SOLIDS[3], name="b", motion=Motion("movable", mass=2.5)),
    )
    world.step(0.1)
    assert world.dynamics(1)[0] == 2.5
    np.testing.assert_array_equal(
        world.pose(0).translation, SOLIDS[0].world_from_object.translation
    )
    assert world.pose(1).translation[2] < 0.2
    assert world.warnings == ()


def test_what_moves_without_a_mass_is_as_dense_as_water_and_that_is_said(world):
    world.add(replace(SOLIDS[0], motion=Motion("movable")), replace(POST, name="still"))
    assert world.dynamics(0)[0] == pytest.approx(6.0)
    assert world.warnings == (
        "no mass or density is given of it: taken as 1000 kg/m^3, the density of water",
    )


# a frame that is turned, and a joint that is off the middle: axis and point are the object's own
HANGING = (
    # the tip of a cone, hanging down from it: centre of mass 3/4 of the height below
    (Cone("it", at(0, 0, 0.85), radius=0.05, height=0.3), [0, 1, 0], [0, 0, 0.15], 0.225),
    (Box("it", at(0, 0, 0.85, 0, np.pi, 0), size=[0.1, 0.2, 0.3]), [1, 0, 0], [0, 0, -0.15], 0.15),
    (
        Prism("it", at(0, 0, 0.85, np.pi / 2, 0, 0), polygon=ELL, height=0.1),
        [0, 0, 1],
        [0, 0.15, 0],
        0.15,
    ),
)


@pytest.mark.parametrize(("thing", "axis", "point", "arm"), HANGING, ids=lambda v: str(v)[:5])
def test_a_pendulum_swings_with_the_period_of_its_mass_and_inertia(world, thing, axis, point, arm):
    from monocell.core.shape.mass import inertia

    hinge = Motion("attached", to="post", joint="hinge", axis=axis, point=point, density=300)
    tilted = Pose.from_rotation_vector(
        0.05 * thing.world_from_object.rotate(np.array(axis)), [0, 0, 0]
    )
    pivot = thing.world_from_object.apply(point)
    about = Pose(np.eye(3), pivot) @ tilted @ Pose(np.eye(3), -pivot)
    world.add(POST, replace(thing, world_from_object=about @ thing.world_from_object, motion=hinge))
    own = np.array(axis) @ inertia(thing) @ np.array(axis)
    period = 2 * np.pi * np.sqrt((own + arm**2) / (G * arm))
    start = world.pose(1)
    np.testing.assert_allclose(start.apply(point), pivot, atol=1e-6)
    world.step(period / 2)
    other_side = world.pose(1)
    np.testing.assert_allclose(other_side.apply(point), pivot, atol=1e-6)
    expected = thing.world_from_object.rotation
    mirrored = tilted.rotation.T @ expected
    # at half a period it is as far on the other side as it began on this one
    np.testing.assert_allclose(other_side.rotation, mirrored, atol=0.002)
    world.step(period / 2)
    np.testing.assert_allclose(world.pose(1).rotation, start.rotation, atol=0.003)


def test_a_hinge_and_a_slider_stop_at_their_limits(world):
    hinge = Motion(
        "attached", to="post", joint="hinge", axis=[0, 1, 0], point=[-0.2, 0, 0], limits=(-1, 0.3)
    )
    slider = Motion("attached", to="post", joint="slider", axis=[0, 0, -1], limits=(0, 0.04))
    flap = Box("flap", at(0.2, 0, 1), size=[0.4, 0.1, 0.02], motion=hinge)
    drawer = Box("drawer", at(0, 0.3, 1), size=[0.1, 0.1, 0.1], motion=slider)
    world.add(POST, flap, drawer)
    world.step(3)
    # damping is off, so that it bounces between its stops
    turned = [world.pose(1).rotation_vector()[1] for _ in range(300) if world.step(0.01) is None]
    assert 0.28 < max(turned) < 0.33 and min(turned) > -1.05
    fallen = [1 - world.pose(2).translation[2] for _ in range(100) if world.step(0.01) is None]
    assert 0.035 < max(fallen) < 0.05


def test_what_is_fixed_together_moves_as_one_and_what_is_fixed_to_the_world_stays(world):
    lid = Box("lid", at(0.5, 0, 0.6), size=[0.2, 0.2, 0.02])
    glued = Motion("attached", to="crate", joint="fixed", mass=0.5)
    crate = Box("crate", at(0.5, 0, 0.5), size=[0.2, 0.2, 0.18], motion=Motion("movable", mass=2))
    sign = Sphere("sign", at(0, 0, 1.2), radius=0.05)
    stuck = Motion("attached", to="post", joint="fixed", mass=0.1)
    world.add(crate, replace(lid, motion=glued), POST, replace(sign, motion=stuck))
    apart = world.pose(0).inverse() @ world.pose(1)
    world.step(0.2)
    np.testing.assert_allclose(
        (world.pose(0).inverse() @ world.pose(1)).matrix(), apart.matrix(), atol=1e-6
    )
    assert world.pose(0).translation[2] < 0.35
    assert world.pose(3).translation[2] == 1.2
    assert world.placed[0].body == world.placed[1].body
    assert world.placed[2].body != world.placed[3].body


def test_a_composite_moves_as_one_body_and_shares_its_mass_by_volume(world):
    big = Box("big", at(0, 0, 1), size=[0.2, 0.1, 0.1])
    small = Box("small", at(0, 0.1, 1), size=[0.1, 0.1, 0.1])
    world.add(
        big, small, composites=(Composite("both", ("big", "small"), Motion("movable", mass=3)),)
    )
    assert [world.dynamics(i)[0] for i in (0, 1)] == pytest.approx([2, 1])
    world.step(0.2)
    falls = [world.pose(i).translation[2] for i in (0, 1)]
    assert falls[0] == pytest.approx(falls[1], abs=1e-6) and falls[0] < 0.85


def test_an_arm_of_links_hangs_link_on_link(world):
    def link(name, z, to, axis):
        motion = Motion(
            "attached", to=to, joint="hinge", axis=axis, point=[0, 0, 0.1], density=1000
        )
        return Cylinder(name, at(0, 0, z), radius=0.02, height=0.2, motion=motion)

    upper, lower = link("upper", 0.9, "post", [0, 1, 0]), link("lower", 0.7, "upper", [1, 0, 0])
    arm = Composite("arm", ("post", "upper", "lower"))
    world.add(lower, upper, POST, composites=(arm,))
    assert len({placed.body for placed in world.placed}) == 1
    # in balance it hangs still
    world.step(0.3)
    assert world.pose(0).translation == pytest.approx([0, 0, 0.7], abs=1e-4)
    elbow = world.pose(1).apply([0, 0, -0.1])
    np.testing.assert_allclose(world.pose(0).apply([0, 0, 0.1]), elbow, atol=1e-6)


def test_a_composite_with_a_mass_refuses_parts_with_masses_of_their_own(world):
    big = replace(SOLIDS[0], name="big", motion=Motion("movable", mass=1))
    with pytest.raises(InvalidValue, match=r"both: motion\.mass .* big has a mass of its own"):
        world.add(big, composites=(Composite("both", ("big",), Motion("movable", mass=3)),))


def test_distances_to_the_things_of_one_body_are_told_apart(arm):
    from monocell.headless.robot.scene import RobotScene

    crate = Box("crate", at(0.5, 0.0, 0.1), size=[0.2, 0.2, 0.2])
    lid = Box("lid", at(0.5, 0, 0.21), size=[0.2, 0.2, 0.02])
    hinge = Motion("attached", to="crate", joint="hinge", axis=[0, 1, 0], point=[-0.1, 0, 0])
    apart = {}
    with RobotScene(arm, [crate, lid]) as still:
        still.place(arm.rest)
        apart = {name: still.gap(i, 10.0).distance for i, name in enumerate(still.names)}
    with RobotScene(arm, [crate, replace(lid, motion=hinge)]) as jointed:
        jointed.place(arm.rest)
        for i, name in enumerate(jointed.names):
            assert jointed.gap(i, 10.0).distance == pytest.approx(apart[name], abs=1e-6)
        near = apart["lid"]
        assert near < apart["crate"]
        assert jointed.blocked(arm.rest, [0.0, near + 0.001], 0.0)
        assert not jointed.blocked(arm.rest, [near + 0.001, near - 0.001], 0.0)
        assert jointed.warnings[0].startswith("no mass or density is given of lid")
        np.testing.assert_allclose(
            jointed.world_from_object("lid").translation, [0.5, 0, 0.21], atol=1e-9
        )
        with pytest.raises(InvalidValue, match="no object of the scene is called 'lit'"):
            jointed.world_from_object("lit")
