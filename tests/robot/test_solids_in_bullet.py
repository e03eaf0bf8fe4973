# SPDX-License-Identifier: GPL-3.0-or-later
"""Balls, cones, tubes and prisms as obstacles: distances against geometry written out."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from monocell.core import Cone, Cylinder, Pose, Prism, Sphere, Tube
from monocell.core.errors import InvalidValue
from monocell.core.primitives import polygon_centre
from monocell.core.shape.pieces import pieces_of

TURNED = Pose.from_rotation_vector([0.4, -0.3, 1.1], [0.2, -0.1, 0.3])
CORNERS = np.array([[0, 0], [0.2, 0], [0.2, 0.05], [0.05, 0.05], [0.05, 0.15], [0, 0.15]])
ELL = CORNERS - polygon_centre(CORNERS)
SOLIDS = {
    "ball": Sphere("ball", TURNED, radius=0.08),
    "cone": Cone("cone", TURNED, radius=0.08, height=0.2),
    "frustum": Cone("frustum", TURNED, radius=0.05, top_radius=0.1, height=0.12),
    "tube": Tube("tube", TURNED, radius=0.1, inner_radius=0.07, height=0.15),
    "ell": Prism("ell", TURNED, polygon=ELL, height=0.1),
}
PROBE = 0.02
places = st.lists(st.floats(-0.3, 0.3), min_size=3, max_size=3)


def outline(thing):
    """The profile (radius, height) of a round solid, or a prism's polygon."""
    half = thing.half_extent[2]
    if isinstance(thing, Tube):
        inner, outer = thing.inner_radius, thing.radius
        return np.array([[inner, -half], [outer, -half], [outer, half], [inner, half]])
    top = thing.top_radius
    return np.array([[0, -half], [thing.radius, -half], [top, half], [0, half]])


def beyond_polygon(point, polygon):
    """Signed distance of a point (2,) from a polygon: negative inside."""
    after = np.roll(polygon, -1, axis=0)
    along = after - polygon
    share = ((point - polygon) * along).sum(axis=1) / np.maximum((along**2).sum(axis=1), 1e-30)
    nearest = polygon + np.clip(share, 0, 1)[:, None] * along
    away = np.linalg.norm(point - nearest, axis=1).min()
    crosses = (polygon[:, 1] > point[1]) != (after[:, 1] > point[1])
    with np.errstate(divide="ignore", invalid="ignore"):
        x = polygon[:, 0] + (point[1] - polygon[:, 1]) / along[:, 1] * along[:, 0]
    inside = np.count_nonzero(crosses & (x > point[0])) % 2 == 1
    return -away if inside else away


def true_distance(thing, point):
    if isinstance(thing, Sphere):
        return np.linalg.norm(point) - thing.radius
    if isinstance(thing, Prism):
        across, up = beyond_polygon(point[:2], thing.polygon), abs(point[2]) - thing.height / 2
        return np.hypot(max(across, 0), max(up, 0)) + min(max(across, up), 0)
    return beyond_polygon(np.array([np.hypot(point[0], point[1]), point[2]]), outline(thing))


@pytest.fixture(scope="module")
def probe():
    """A ball of 20 mm that measures its distance from a solid, from a point in its frame."""
    from monocell.headless.robot.bullet import pybullet
    from monocell.headless.robot.shapes import add_obstacle, add_sphere

    p = pybullet()
    client = p.connect(p.DIRECT)
    sphere = add_sphere(client, PROBE)
    bodies = {name: add_obstacle(client, thing) for name, thing in SOLIDS.items()}

    def distance(thing, point):
        at = thing.world_from_object.apply(point).tolist()
        p.resetBasePositionAndOrientation(sphere, at, [0, 0, 0, 1], physicsClientId=client)
        found = p.getClosestPoints(sphere, bodies[thing.name], 5.0, physicsClientId=client)
        return min(x[8] for x in found)

    yield distance
    p.disconnect(client)


# how much too near a solid may seem, as a share of its radius; a prism is exact
TOO_WIDE = {"ball": 0, "cone": 0.00054, "frustum": 0.00054, "tube": 0.00215, "ell": 0}


@pytest.mark.robot
@pytest.mark.parametrize("name", SOLIDS)
@settings(max_examples=120, deadline=None)
@given(point=places)
def test_a_distance_is_never_more_than_there_is_and_hardly_less(probe, name, point):
    thing = SOLIDS[name]
    true = true_distance(thing, np.array(point)) - PROBE
    if true > 1e-4:
        stated = probe(thing, point)
        # Bullet's search for the nearest point ends within a fiftieth of a millimetre
        assert stated <= true + 2e-5
        assert stated >= true - 2e-5 - TOO_WIDE[name] * thing.half_extent.max()


@pytest.mark.robot
def test_a_ball_fits_into_a_tube_and_into_the_notch_of_a_prism(probe):
    tube = SOLIDS["tube"]
    assert probe(tube, [0, 0, 0]) == pytest.approx(0.07 - PROBE, abs=2e-4)
    notch = np.array([0.12, 0.1]) - polygon_centre(CORNERS)
    assert probe(SOLIDS["ell"], [*notch, 0]) == pytest.approx(0.05 - PROBE, abs=1e-6)


@pytest.mark.parametrize("name", ["tube", "ell"])
def test_every_point_of_a_solid_is_in_one_of_its_pieces(name):
    thing = SOLIDS[name]
    outlines = [piece[: len(piece) // 2, :2] for piece in pieces_of(thing).corners()]
    random = np.random.default_rng(3)
    points = random.uniform(-1, 1, (3000, 3)) * thing.half_extent
    inside = np.array([true_distance(thing, point) <= 0 for point in points])
    held = np.array(
        [min(beyond_polygon(point[:2], outline) for outline in outlines) <= 0 for point in points]
    )
    assert inside.sum() > 500
    assert held[inside].all()
    # and hardly anything more
    assert np.count_nonzero(held & ~inside) < 0.02 * inside.sum()


def test_a_box_is_not_made_of_pieces():
    with pytest.raises(InvalidValue, match="a cylinder is not made of pieces"):
        pieces_of(Cylinder("drum", TURNED, radius=0.1, height=0.2))
