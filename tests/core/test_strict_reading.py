# SPDX-License-Identifier: GPL-3.0-or-later
"""Every single field of a document, when it is spoilt, is refused by its path and nothing else."""

from __future__ import annotations

import copy
import re
from pathlib import Path

import pytest
from drawn_cells import whole_document
from monocell.core.document.cell_file import cell_from_document
from monocell.core.document.entries import object_from_entry
from monocell.core.errors import DocumentError

# a null stands for "not known" in these, and for a corner that is not seen among picks
MAY_BE_NULL = {
    "distortion",
    "camera_from_world",
    "covariance",
    "picture",
    "sightings",
    "references",
    "objects",
    "window",
    "on",
    "known",
    "picks",
    "appearance",
    "size_z",
    "coefficients",
    "radius",
    "relations",
    "own",
    "motion",
    "mass",
    "density",
    "point",
    "limits",
    "composites",
}
# a null stands for "not known" in these places alone
NULL_AMONG = {"radius": "known", "point": "motion"}
SPOILERS = {
    "text": "spoilt",
    "empty text": "",
    "NaN": float("nan"),
    "infinity": float("inf"),
    "true": True,
    "null": None,
    "list": [],
    "object": {},
    "number": -12.5,
    "huge whole number": 10**400,
    "nested lists": [[["x"]]],
}


def steps_of(value, path=()):
    """Every place in a document, as the keys and indices that lead there."""
    yield path
    if isinstance(value, dict | list):
        pairs = value.items() if isinstance(value, dict) else enumerate(value)
        for key, inner in pairs:
            yield from steps_of(inner, (*path, key))


def written(path):
    """A place as messages name it: `objects[2].size[1]`."""
    told = "".join(f"[{s}]" if isinstance(s, int) else f".{s}" for s in path)
    return told.lstrip(".")


def at(document, path):
    for step in path:
        document = document[step]
    return document


def refusal_of(document):
    with pytest.raises(DocumentError) as refusal:
        cell_from_document(document, Path())
    assert "\n" not in str(refusal.value)
    return str(refusal.value)


# the first number of a list stands for all of them
PLACES = [
    path
    for path in steps_of(whole_document())
    if path and not any(isinstance(s, int) and s > 0 for s in path[2:])
]
KEYS = [path for path in PLACES if isinstance(path[-1], str)]
OBJECTS = [
    path for path in steps_of(whole_document()) if isinstance(at(whole_document(), path), dict)
]
LISTS = [path for path in PLACES if isinstance(at(whole_document(), path), list)]
# lists of any length: the documents' own, and picks
FREE_LISTS = (
    "sightings",
    "references",
    "objects",
    "composites",
    "relations",
    "parts",
    "base",
    "rim",
)


def names_the_place(told, path):
    """The path itself, or that of an object around it and then the fields that lead on."""
    if told.startswith(written(path)):
        return True
    for entry in (p for p in OBJECTS if p and p == path[: len(p)]):
        fields = [str(s) for s in path[len(entry) :] if isinstance(s, str)]
        rest = told.removeprefix(written(entry))
        if fields and told.startswith(written(entry)) and all(f in rest for f in fields):
            return True
    return False


def harmless(path, spoiler):
    """Whether a value is still one that may stand in a place."""
    last, value = path[-1], SPOILERS[spoiler]
    among_picks = "picks" in path and isinstance(last, int) and isinstance(path[-2], str)
    if value is None:
        needed = last in NULL_AMONG and NULL_AMONG[last] not in path
        return among_picks or (last in MAY_BE_NULL and not needed)
    if spoiler == "text":
        # any text is a name or a picture
        return last in ("name", "picture")
    if spoiler == "list":
        return last in FREE_LISTS and last != "parts"
    if spoiler == "object":
        return last in ("known", "picks")
    if spoiler == "number":
        if last in ("cx", "cy"):
            return True
        numbers = (
            "point",
            "normal",
            "direction",
            "center",
            "translation",
            "coefficients",
            "window",
            "axis",
            "limits",
        )
        return (isinstance(last, int) and path[-2] in numbers) or (
            "picks" in path and isinstance(last, int) and isinstance(path[-2], int)
        )
    return False


@pytest.mark.parametrize("path", PLACES, ids=written)
def test_a_spoilt_value_is_refused_by_its_path(path):
    for spoiler, value in SPOILERS.items():
        document = whole_document()
        at(document, path[:-1])[path[-1]] = copy.deepcopy(value)
        try:
            cell_from_document(document, Path())
        except DocumentError as error:
            told = str(error)
            assert names_the_place(told, path) or told_elsewhere(told, path), f"{spoiler}: {told}"
        else:
            assert harmless(path, spoiler), spoiler


def told_elsewhere(told, path):
    """Where a spoilt value shows first: a camera may be a file, a name is missed at its use."""
    if path == ("camera",):
        return "spoilt: there is no such camera file" in told
    if path[-1] in ("name", "references", "objects"):
        missed = r"(no reference is called|is the name of no object)"
        return re.match(rf"(objects|composites)\[\d\]\.[\w.\[\]]+: .*{missed}", told) is not None
    if path[-1] in ("kind", "world_from_object"):
        # another kind has other keys
        return told.startswith(written(path[:-1]) + ".")
    return False


@pytest.mark.parametrize("path", KEYS, ids=written)
def test_a_missing_key_is_missed_by_its_path_or_was_never_needed(path):
    document = whole_document()
    del at(document, path[:-1])[path[-1]]
    try:
        cell_from_document(document, Path())
    except DocumentError as error:
        told = str(error)
        missed = told.startswith(f"{written(path)}: is missing")
        counted = path[-1] == "coefficients" and "plumb_bob has 5, got 0" in told
        combined = names_the_place(told, path) and ("needs" in told or "about" in told)
        assert missed or counted or combined or told_elsewhere(told, path), told
    else:
        assert path[-1] in {*MAY_BE_NULL, "base", "rim"}


@pytest.mark.parametrize("path", OBJECTS, ids=lambda p: written(p) or "document")
def test_an_unknown_key_is_refused_by_its_path(path):
    document = whole_document()
    at(document, path)["colour"] = 1
    told = refusal_of(document)
    assert told.startswith(written((*path, "colour"))), told


@pytest.mark.parametrize("path", LISTS, ids=written)
@pytest.mark.parametrize("change", ["shorter", "longer"])
def test_a_list_of_another_length_is_refused_by_its_path(path, change):
    if path[-1] in FREE_LISTS:
        return
    document = whole_document()
    listed = at(document, path)
    if change == "shorter":
        listed.pop()
    else:
        listed.append(copy.deepcopy(listed[-1]))
    told = refusal_of(document)
    # a corner more or less needs another covariance
    counted = path[-1] == "polygon" and told.startswith(written((*path[:-1], "covariance")))
    assert names_the_place(told, path) or counted


def test_twins_and_orphans_are_named_by_their_place_in_the_document():
    document = whole_document()
    document["objects"][2]["name"] = "new"
    assert refusal_of(document).startswith("objects[2].name: 'new' is also objects[1]'s name")
    document = whole_document()
    document["objects"][2]["on"] = "shelf"
    told = refusal_of(document)
    assert told.startswith("objects[2].on: no reference is called 'shelf'; there is edge, floor")


def test_an_object_without_a_place_is_not_solved_yet():
    entry = whole_document()["objects"][1]
    with pytest.raises(DocumentError, match=r"object\.world_from_object: is missing"):
        object_from_entry(entry)


@pytest.mark.parametrize("value", [None, 3, "box", [], [1]])
def test_what_is_no_object_at_all_is_refused(value):
    with pytest.raises(DocumentError, match="object: expected an object"):
        object_from_entry(value)
