# SPDX-License-Identifier: GPL-3.0-or-later
"""URDF, SDF, MJCF and MoveIt scenes hold the shapes of a cell where they stand, and names."""

from __future__ import annotations

import tempfile
from dataclasses import replace

import numpy as np
import pytest
from drawn_cells import cells
from format_cells import CAMERA, CHEST, at, written
from format_readers import read_mjcf, read_obj, read_scene, read_sdf, read_urdf
from hypothesis import HealthCheck, given, settings
from monocell.core import (
    Appearance,
    Box,
    Camera,
    Cell,
    Composite,
    Motion,
    Prism,
    Sphere,
    Tube,
)
from monocell.core.errors import DocumentError, InvalidValue
from monocell.core.formats.identifiers import identifiers
from monocell.core.formats.link_tree import links_of
from monocell.core.formats.text_formats import WRITERS, write_text_format
from monocell.core.shape.mass import volume
from monocell.core.shape.pieces import pieces_of

READERS = {
    ".urdf": lambda path: read_urdf(path)[0],
    ".sdf": lambda path: read_sdf(path)[0],
    ".xml": lambda path: read_mjcf(path)[0],
    ".scene": read_scene,
}
FORMATS = pytest.mark.parametrize("ending", READERS)
ELL = np.array([[-0.1, -0.1], [0.2, -0.1], [-0.1, 0.2]])
# how much larger than the solid its pieces are, as a share of what is inside its outside
TOO_LARGE = {"cone": 0.002, "tube": 0.005, "prism": 1e-9}


def assert_same(thing, shapes):
    """The shapes read back are the object."""
    tolerance = 1e-6 * max(1.0, np.abs(thing.world_from_object.translation).max())
    tolerance = max(tolerance, 1e-9 * thing.half_extent.max())
    if shapes[0].kind != "mesh":
        (shape,) = shapes
        wanted = thing.sizes if thing.kind != "cone" else [thing.radius, thing.height]
        assert shape.kind == thing.kind
        np.testing.assert_allclose(shape.sizes, wanted, rtol=1e-11)
        far = np.abs(shape.world_from_shape.matrix() - thing.world_from_object.matrix()).max()
        assert far < tolerance
        return
    wanted = np.concatenate(pieces_of(thing).corners())
    found = np.concatenate([shape.corners_world() for shape in shapes])
    np.testing.assert_allclose(found, thing.world_from_object.apply(wanted), atol=tolerance)
    # and its pieces, which face outwards, fill it and hardly more
    filled = sum(shape.volume() for shape in shapes)
    whole = np.pi * thing.radius**2 * thing.height if thing.kind == "tube" else volume(thing)
    assert -1e-9 * whole <= filled - volume(thing) < TOO_LARGE[thing.kind] * whole


@FORMATS
@settings(max_examples=12, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(cell=cells())
def test_any_cell_survives_in_its_geometry(ending, cell):
    with tempfile.TemporaryDirectory() as folder:
        path, _ = written(cell, folder, ending)
        found = READERS[ending](path)
    own = names_in(cell, ending)
    assert set(own) <= set(found)
    for name, thing in own.items():
        assert_same(thing, found[name])


def names_in(cell, ending):
    if ending == ".scene":
        names = identifiers([thing.name for thing in cell.objects])
        return dict(zip(names, cell.objects, strict=True))
    return {link.name: link.thing for link in links_of(cell)[0]}


@FORMATS
def test_names_with_spaces_and_of_other_scripts_are_told_in_full(ending, tmp_path):
    things = tuple(
        Box(name, at(0.1 * i, 0, 0), size=[0.1] * 3)
        for i, name in enumerate(
            ["Kiste 1", "Kiste-1", "箱", "箱子", "crate_joint", "crate", "a--b"]
        )
    )
    path, _ = written(Cell(CAMERA, objects=things), tmp_path, ending)
    found = READERS[ending](path)
    for name, thing in names_in(Cell(CAMERA, objects=things), ending).items():
        assert_same(thing, found[name])
    if ending != ".scene":
        text = path.read_text(encoding="utf-8")
        assert "<!-- 箱, a box" in text and "<!-- a- -b, a box" in text


@FORMATS
def test_an_empty_cell_without_a_camera_pose_is_a_file_all_the_same(ending, tmp_path):
    path, told = written(Cell(Camera(CAMERA.intrinsics)), tmp_path, ending)
    assert not any(READERS[ending](path).values()) and told == ()
    assert [file.name for file in tmp_path.iterdir()] == [path.name]


def test_colours_are_encoded_as_programs_show_them(tmp_path):
    cell = Cell(
        CAMERA,
        objects=(
            Sphere("s", at(0, 0, 0), radius=1, appearance=Appearance(np.array([0.0, 0.2159, 1]))),
        ),
    )
    path, _ = written(cell, tmp_path, ".urdf")
    assert 'rgba="0 0.502 1 1"' in path.read_text()


def test_the_error_of_an_object_stands_above_it(tmp_path):
    sigmas = np.array([1e-3] * 3 + [5e-4, 6e-4, 7e-4] + [8e-4] * 3)
    cell = Cell(CAMERA, objects=(replace(CHEST[0], covariance=np.diag(sigmas**2)),))
    for ending in (".urdf", ".sdf", ".xml"):
        text = written(cell, tmp_path, ending)[0].read_text(encoding="utf-8")
        assert "position ± 0.5 0.6 0.7 mm, rotation ± 0.057 0.057 0.057 degrees" in text
        assert "size_x 300.0 ± 0.8 mm" in text


def test_meshes_lie_beside_the_document_and_the_visual_one_lies_on_the_surface(tmp_path):
    things = (
        Tube("pipe", at(0, 0, 0), radius=0.1, inner_radius=0.05, height=0.2),
        Prism("flap", at(1, 0, 0), polygon=ELL, height=0.02),
    )
    written(Cell(CAMERA, objects=things), tmp_path, ".urdf")
    files = {file.name for file in (tmp_path / "my_cell_meshes").iterdir()}
    assert files == {
        "pipe_visual.obj",
        "pipe_piece0.obj",
        "flap_visual.obj",
        "flap_piece0.obj",
    }
    vertices, _ = read_obj(tmp_path / "my_cell_meshes" / "pipe_visual.obj")
    away = np.linalg.norm(vertices[:, :2], axis=1)
    assert set(away.round(9)) == {0.05, 0.1}


def test_masses_that_are_given_twice_leave_what_was_there(tmp_path):
    group = Composite("both", ("chest", "lid"), Motion("movable", mass=3.0))
    cell = Cell(CAMERA, objects=CHEST[:3], composites=(group,))
    path = tmp_path / "my cell.urdf"
    path.write_text("old")
    with pytest.raises(InvalidValue, match="lid has a mass of its own"):
        write_text_format(cell, path)
    with pytest.raises(DocumentError, match=r"the folder .* is not there; make it first"):
        write_text_format(Cell(CAMERA), tmp_path / "no" / "cell.urdf")
    assert [file.name for file in tmp_path.iterdir()] == ["my cell.urdf"]
    assert path.read_text() == "old"


def test_every_ending_has_a_reader_here():
    assert set(WRITERS) - set(READERS) == {".world", ".mjcf"}
