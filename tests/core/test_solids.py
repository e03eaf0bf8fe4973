# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes, volumes and inertia of the solids agree; polygons are cut and refused as they should."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from monocell.core import Box, Cone, Cylinder, Pose, Prism, Sphere, Tube
from monocell.core.errors import InvalidValue
from monocell.core.primitives import polygon_centre
from monocell.core.shape.mass import centre_of_mass, inertia, volume
from monocell.core.shape.polygons import (
    convex_pieces,
    crossing_sides,
    is_convex,
    polygon_area,
    triangulated,
)
from monocell.core.shape.tessellation import tessellated

HERE = Pose.identity()
CORNERS = np.array([[0, 0], [4, 0], [4, 1], [1, 1], [1, 3], [0, 3.0]])
COMB = np.array(
    [
        [0, 0],
        [7, 0],
        [7, 3],
        [6, 3],
        [6, 1],
        [4, 1],
        [4, 3],
        [3, 3],
        [3, 1],
        [1, 1],
        [1, 3],
        [0, 3.0],
    ]
)
SOLIDS = {
    "box": Box("it", HERE, size=[1, 2, 3]),
    "cylinder": Cylinder("it", HERE, radius=0.1, height=0.3),
    "sphere": Sphere("it", HERE, radius=0.1),
    "cone": Cone("it", HERE, radius=0.1, height=0.3),
    "frustum": Cone("it", HERE, radius=0.1, top_radius=0.2, height=0.3),
    "tube": Tube("it", HERE, radius=0.1, inner_radius=0.07, height=0.2),
    "prism": Prism("it", HERE, polygon=CORNERS - polygon_centre(CORNERS), height=0.3),
    "comb": Prism("it", HERE, polygon=COMB - polygon_centre(COMB), height=0.3),
}
EVERY = pytest.mark.parametrize("thing", SOLIDS.values(), ids=SOLIDS)


def tetrahedra(thing):
    """The corners (M, 3) of a mesh's triangles, and the volume (M,) between each and the origin."""
    mesh = tessellated(thing)
    a, b, c = (mesh.vertices[mesh.triangles[:, i]] for i in range(3))
    return (a, b, c), np.einsum("ij,ij->i", a, np.cross(b, c)) / 6


@EVERY
def test_a_mesh_is_closed_and_every_edge_goes_both_ways(thing):
    triangles = tessellated(thing).triangles
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    there = set(map(tuple, edges.tolist()))
    assert len(there) == len(edges)
    assert all((b, a) in there for a, b in there)


@EVERY
def test_volume_centre_and_inertia_are_those_of_the_mesh(thing):
    (a, b, c), volumes = tetrahedra(thing)
    whole = volumes.sum()
    # what is round is inscribed: a tenth of a percent is missing
    assert -2e-3 < whole / volume(thing) - 1 < 1e-12
    middle = ((a + b + c) / 4 * volumes[:, None]).sum(axis=0) / whole
    reach = thing.half_extent.max()
    np.testing.assert_allclose(middle, centre_of_mass(thing), atol=1e-12 * reach)
    second = sum(np.einsum("i,ij,ik->jk", volumes, p, p) for p in (a, b, c, a + b + c))
    second = second / 20 / whole - np.outer(middle, middle)
    expected = np.trace(second) * np.eye(3) - second
    np.testing.assert_allclose(inertia(thing), expected, rtol=2e-3, atol=1e-9 * reach**2)


@EVERY
def test_every_vertex_reaches_the_bounding_box_and_none_beyond(thing):
    reach = np.abs(tessellated(thing).vertices).max(axis=0)
    np.testing.assert_allclose(reach, thing.half_extent, rtol=1e-9)


def test_faces_are_smooth_where_the_solid_is_round():
    for name, smooth_area in (("cylinder", 0.1 * 0.3), ("tube", 0.17 * 0.2)):
        mesh = tessellated(SOLIDS[name])
        starts = [*mesh.starts, len(mesh.corners)]
        area = 0.0
        for i in np.flatnonzero(mesh.smooth):
            at = mesh.vertices[mesh.corners[starts[i] : starts[i + 1]]]
            area += np.linalg.norm(np.cross(at[1] - at[0], at[-1] - at[0]))
        assert area == pytest.approx(2 * np.pi * smooth_area, rel=1e-3)
    assert not tessellated(SOLIDS["prism"]).smooth.any()


@st.composite
def stars(draw):
    """Simple polygons of any shape: corners at growing angles about a point, near and far."""
    count = draw(st.integers(3, 12))
    random = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    turns = np.sort(random.uniform(0, 2 * np.pi, count))
    assume(np.diff([*turns, turns[0] + 2 * np.pi]).max() < np.pi - 0.1)
    assume(np.diff(turns).min() > 1e-3)
    away = random.uniform(0.1, 1, count)
    return np.stack([np.cos(turns), np.sin(turns)], axis=1) * away[:, None]


@settings(max_examples=150, deadline=None)
@given(stars())
def test_triangles_and_pieces_fill_a_polygon_exactly_once(polygon):
    assert crossing_sides(polygon) is None
    triangles = triangulated(polygon)
    areas = [polygon_area(polygon[t]) for t in triangles]
    assert len(triangles) == len(polygon) - 2 and min(areas) > -1e-15
    assert sum(areas) == pytest.approx(polygon_area(polygon))
    pieces = convex_pieces(polygon)
    assert all(is_convex(polygon[piece]) for piece in pieces)
    assert sum(polygon_area(polygon[piece]) for piece in pieces) == pytest.approx(
        polygon_area(polygon)
    )
    reflex = 0 if is_convex(polygon) else 1
    assert 1 + reflex <= len(pieces) <= max(1, len(polygon) - 2)


def test_a_comb_is_cut_into_few_pieces_and_a_corner_on_a_side_does_no_harm():
    assert len(convex_pieces(COMB)) <= 6
    on_side = np.array([[0, 0], [1, 0], [2, 0], [2, 2], [1, 1], [0, 2.0]])
    assert sum(polygon_area(on_side[t]) for t in triangulated(on_side)) == pytest.approx(3)
    mesh = tessellated(Prism("p", HERE, polygon=on_side - polygon_centre(on_side), height=1))
    assert len(mesh.triangles) == 2 * 4 + 2 * 6


@pytest.mark.parametrize(
    ("corners", "told"),
    [
        ([[0, 0], [2, 2], [2, 0], [0.5, 3]], "side from corner 0 meets the side from corner 2"),
        (
            [[0, 0], [2, 0], [2, 2], [0.9, 0], [0, 2]],
            "side from corner 0 meets the side from corner",
        ),
        (
            [[0, 0], [2, 0], [2, 2], [2, 2], [0, 2]],
            "side from corner 1 meets the side from corner 2",
        ),
        (
            [[0, 0], [2, 0], [2, 3], [2, 2], [0, 2]],
            "side from corner 1 meets the side from corner 2",
        ),
        ([[0, 0], [0, 2], [2, 2], [2, 0]], "go clockwise"),
        ([[0, 0], [1, 1], [2, 2]], "lie on a line"),
    ],
)
def test_a_polygon_that_crosses_or_touches_itself_is_refused(corners, told):
    polygon = np.array(corners, float)
    centre = polygon_centre(polygon) if abs(polygon_area(polygon)) > 0 else 0
    with pytest.raises(InvalidValue, match=f"p: polygon: .*{told}"):
        Prism("p", HERE, polygon=polygon - centre, height=1)


def test_a_shape_of_no_known_kind_is_a_programmer_s_mistake():
    for ask in (tessellated, volume, inertia):
        with pytest.raises(TypeError, match=r"is not known|no mesh is known"):
            ask(type("Odd", (), {"kind": "odd"})())
