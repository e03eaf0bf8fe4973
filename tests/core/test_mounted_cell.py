# SPDX-License-Identifier: GPL-3.0-or-later
"""Cells of cameras on the flange, offsets and clicks as documents: read, written, and refused."""

from __future__ import annotations

import copy
from pathlib import Path

import numpy as np
import pytest
from drawn_cells import whole_document
from monocell.core import Camera, Pose
from monocell.core.document.cell_file import cell_from_document, document_from_cell
from monocell.core.errors import DocumentError, NoPose
from monocell.core.modelling.solve import model_cell
from monocell.core.mount import Mount
from monocell.core.sighting import PointSighting

FLANGE = {"rotation": [[0, -1, 0], [1, 0, 0], [0, 0, 1]], "translation": [0.4, 0.2, 0.5]}
SEAT = {"rotation": [[1, 0, 0], [0, 1, 0], [0, 0, 1]], "translation": [0.0, 0.05, -0.02]}


def mounted_document():
    document = whole_document()
    document["camera"].pop("camera_from_world")
    spread = document["camera"].pop("covariance")
    document["mount"] = {
        "on": "flange",
        "camera_from_flange": SEAT,
        "covariance": spread,
        "world_from_flange": FLANGE,
    }
    document["sightings"] = [
        {"picture": "a.png", "world_from_flange": FLANGE, "radius": 0.04},
        {"picture": "b.png", "center": [0, 1, 2], "world_from_flange": FLANGE, "radius": 0.04},
        {
            "picture": "c.png",
            "world_from_flange": FLANGE,
            "target": "corner",
            "pixel": [10.5, 20.0],
            "sigma_pixels": 0.3,
        },
    ]
    return document


def refusal_of(document):
    with pytest.raises(DocumentError) as refusal:
        cell_from_document(document, Path())
    return str(refusal.value)


def test_every_field_comes_back():
    document = mounted_document()
    again = document_from_cell(cell_from_document(document, Path()), Path())
    for key in ("mount", "sightings", "camera"):
        assert again[key] == document[key]


def test_the_camera_stands_where_the_flange_stood_for_the_picture():
    cell = cell_from_document(mounted_document(), Path())
    flange = Pose(FLANGE["rotation"], FLANGE["translation"])
    seat = Pose(SEAT["rotation"], SEAT["translation"])
    expected = seat @ flange.inverse()
    np.testing.assert_allclose(cell.camera.pose.matrix(), expected.matrix())
    np.testing.assert_array_equal(cell.camera.covariance, cell.mount.covariance)


def test_a_left_twist_of_the_seat_is_the_same_twist_of_the_camera_in_the_world():
    cell = cell_from_document(mounted_document(), Path())
    twist = np.array([0.01, -0.02, 0.03, 0.001, 0.002, -0.003])
    moved = Mount(
        cell.mount.camera_from_flange.perturbed(twist), None, cell.mount.world_from_flange
    )
    there = moved.placed(Camera(cell.camera.intrinsics)).pose
    np.testing.assert_allclose(there.matrix(), cell.camera.pose.perturbed(twist).matrix())


def test_a_point_has_the_sigma_of_a_careful_click():
    document = whole_document()
    document["sightings"] = [{"picture": "a.png", "center": [0, 0, 1], "pixel": [3, 4]}]
    (point,) = cell_from_document(document, Path()).sightings
    assert isinstance(point, PointSighting)
    assert point.sigma_pixels == 0.5


@pytest.mark.parametrize(
    ("path", "value", "told"),
    [
        (("mount", "on"), "wrist", "mount.on: 'wrist' is not known; a camera rides on the flange"),
        (("mount", "on"), None, "mount.on: expected a text"),
        (("mount", "camera_from_flange"), {}, "mount.camera_from_flange.rotation: is missing"),
        (("mount", "covariance"), [[1]], "mount.covariance: expected 6 rows"),
        (("mount", "seat"), 1, "mount.seat: unknown key"),
        (("sightings", 0, "world_from_flange"), None, "sightings[0].center: is missing; give"),
        (("sightings", 1, "world_from_flange"), None, "sightings[1].world_from_flange: is missing"),
        (("sightings", 1, "pixel"), [1, 2], "sightings[1].radius: unknown key"),
        (("sightings", 2, "pixel"), [1, 2, 3], "sightings[2].pixel: expected 2 numbers"),
        (("sightings", 2, "sigma_pixels"), 0, "sightings[2]: sigma_pixels: must be above zero"),
        (("sightings", 2, "sigma_pixels"), 1e4, "a click is known to between 0.001 and 100 px"),
        (("sightings", 2, "target"), 7, "sightings[2].target: expected a text"),
    ],
)
def test_what_can_not_be_is_refused_by_its_path(path, value, told):
    document = copy.deepcopy(mounted_document())
    place = document
    for step in path[:-1]:
        place = place[step]
    place[path[-1]] = value
    assert told in refusal_of(document)


def test_a_mounted_camera_has_no_pose_of_its_own():
    document = mounted_document()
    document["camera"]["camera_from_world"] = SEAT
    assert "stands elsewhere in every picture; give mount.camera_from_flange" in refusal_of(
        document
    )


def test_a_place_told_twice_before_a_fixed_camera_is_refused():
    document = whole_document()
    document["sightings"][0]["world_from_flange"] = FLANGE
    assert "the camera is fixed, and center tells the place already" in refusal_of(document)


@pytest.mark.parametrize("missing", ["camera_from_flange", "world_from_flange"])
def test_modelling_says_what_is_missing_for_the_picture(missing):
    document = mounted_document()
    del document["mount"][missing]
    cell = cell_from_document(document, Path())
    with pytest.raises(NoPose, match=rf"rides on the flange, and mount\.{missing} is missing"):
        model_cell(cell)
