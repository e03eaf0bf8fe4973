# SPDX-License-Identifier: GPL-3.0-or-later
"""Every way of making a reference is written and read again, and spoilt entries are refused."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from monocell.core import ReferencePlane
from monocell.core.document.cell_file import cell_from_document, document_from_cell
from monocell.core.document.reference_entries import reference_entry, reference_from_entry
from monocell.core.errors import DocumentError
from monocell.core.reference import PendingReference
from monocell.core.references.resolve import resolve_references
from monocell.core.references.sources import Stated, ThroughPoints
from referenced_cell import CRATE, DRUM, FLOOR, SOURCES, referenced_cell, way_of

STATED = ReferencePlane("ramp", [0, 0, 1], [0, 1, 1], source=Stated(1e-3, 2e-3))
ENTRIES = {
    name: reference_entry(PendingReference(name, kind, source))
    for name, (kind, source) in SOURCES.items()
} | {"ramp": reference_entry(STATED)}


@pytest.mark.parametrize("name", ENTRIES)
def test_a_source_comes_back_as_it_was_written(name):
    entry = json.loads(json.dumps(ENTRIES[name]))
    again = reference_from_entry(entry, "references[0]")
    assert type(again.source) is type(SOURCES.get(name, ("", STATED.source))[1])
    assert reference_entry(again) == ENTRIES[name]


def test_a_resolved_cell_comes_back_with_places_and_errors():
    sources = {name: source for name, source in SOURCES.items() if name != "string"}
    cell = resolve_references(referenced_cell(sources=sources, things=(CRATE, DRUM)))[0]
    document = json.loads(json.dumps(document_from_cell(cell, Path())))
    again = cell_from_document(document, Path())
    for one, other in zip(cell.references, again.references, strict=True):
        np.testing.assert_array_equal(one.point, other.point)
        np.testing.assert_array_equal(way_of(one), way_of(other))
        np.testing.assert_array_equal(one.covariance, other.covariance)
        if one.source is not None:
            np.testing.assert_array_equal(one.by_camera, other.by_camera)


def test_a_floor_with_a_stated_covariance_keeps_it():
    entry = reference_entry(FLOOR)
    assert set(entry) == {"name", "kind", "point", "normal", "covariance"}
    again = reference_from_entry(entry, "references[0]")
    np.testing.assert_array_equal(again.covariance, FLOOR.covariance)


def test_one_sigma_or_height_stands_for_all():
    points = {"way": "points", "points": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "sigma": 0.002}
    read = reference_from_entry({"name": "t", "kind": "plane", "from": points}, "r")
    assert isinstance(read.source, ThroughPoints)
    np.testing.assert_array_equal(read.source.sigma, [0.002] * 3)
    picks = {"way": "picks", "pixels": [[1, 2], [3, 4], [5, 6]], "heights": 0.7, "above": "floor"}
    read = reference_from_entry({"name": "t", "kind": "plane", "from": picks}, "r")
    np.testing.assert_array_equal(read.source.heights, [0.7] * 3)


def spoilt(name, **changes):
    entry = json.loads(json.dumps(ENTRIES[name]))
    entry["from"] |= changes
    entry["from"] = {k: v for k, v in entry["from"].items() if v is not ...}
    return entry


@pytest.mark.parametrize(
    ("entry", "told"),
    [
        (spoilt("wall", way="magic"), "references[1].from.way: 'magic' is none of stated, points"),
        (spoilt("wall", way=...), "references[1].from.way: is missing"),
        (spoilt("wall", on=...), "references[1].from.on: is missing"),
        (spoilt("wall", colour=1), "references[1].from.colour: unknown key"),
        (spoilt("wall", pixels=[[1, 2], [3]]), "references[1].from.pixels[1]: expected 2 numbers"),
        (spoilt("wall", pixels=5), "references[1].from.pixels: expected a list, got 5"),
        (spoilt("shelf", points=[[1, 2, "x"]]), "references[1].from.points[0][2]: expected a num"),
        (spoilt("shelf", sigma=[1e-3]), "references[1].from: sigma: 1 numbers for 3 points"),
        (spoilt("shelf", sigma=-1.0), "references[1].from: sigma: must not be below zero, got -1"),
        (spoilt("shelf", sigma=[0, 1, 1]), "references[1].from: sigma: zero for some points"),
        (
            spoilt("shelf", sigma=1e-300),
            "references[1].from: sigma: 1e-300 is no error; give 0, or",
        ),
        (spoilt("nail", sigma=1e9), "references[1].from: sigma: 1e+09 is no error; give 0, or 1e-"),
        (spoilt("loft", distance=1e9), "references[1].from: distance: 1e+09 m is farther than any"),
        (spoilt("board", heights=1e9), "references[1].from: heights: 1e+09 m is farther than any"),
        (spoilt("board", heights=[0.1]), "references[1].from: heights: 1 numbers for 4 pixels"),
        (spoilt("board", heights="low"), "references[1].from.heights: expected a number, got"),
        (spoilt("loft", distance=None), "references[1].from.distance: expected a number, got null"),
        (spoilt("loft", sigma=-2), "references[1].from: sigma: must not be below zero, got -2"),
        (spoilt("crease", planes=["a"]), "references[1].from.planes: expected two names"),
        (spoilt("crease", planes=["a", "a"]), "references[1].from: planes: expected two that dif"),
        (spoilt("crease", planes=["a", 3]), "references[1].from.planes[1]: expected a text, got 3"),
        (spoilt("nail", through=[1, 2]), "references[1].from.through: expected 3 numbers, got 2"),
        (spoilt("string", along=[0, 0, 0]), "references[1].from: along: its length: must be above"),
        (spoilt("string", sigma=1e-3), "sigma: is of numbers that are typed, and through names"),
        (ENTRIES["wall"] | {"from": 3}, "references[1].from: expected an object {...}, got 3"),
        (ENTRIES["rail"] | {"kind": "plain"}, "references[1].kind: 'plain' is neither plane nor"),
        (ENTRIES["crease"] | {"kind": "plane"}, "crease: 'intersection' makes a line, not a plane"),
        (ENTRIES["wall"] | {"normal": [0, 0, 1]}, "references[1].point: is missing"),
        (ENTRIES["wall"] | {"covariance": 1}, "references[1].covariance: unknown key"),
        (ENTRIES["ramp"] | {"covariance": [[1]]}, "covariance: expected 6 rows, got 1"),
        (ENTRIES["ramp"] | {"direction": [1, 0, 0]}, "references[1].direction: unknown key"),
        (
            {"name": "r", "kind": "plane", "from": {"way": "stated"}},
            "references[1].point: is missing",
        ),
    ],
)
def test_a_spoilt_entry_is_refused_by_its_path(entry, told):
    with pytest.raises(DocumentError) as refusal:
        reference_from_entry(entry, "references[1]")
    assert told in str(refusal.value)
    assert str(refusal.value).startswith("references[1]")
