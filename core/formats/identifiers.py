# SPDX-License-Identifier: GPL-3.0-or-later
"""Names of a document to names that every robot format takes: plain ASCII, each unlike the rest."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Collection, Sequence

NAMELESS = "object"


def identifiers(names: Sequence[str], reserved: Collection[str] = ()) -> tuple[str, ...]:
    """For each name one of letters, digits and underscores that begins with no digit.

    No two are alike, or like one of `reserved`, in a file system that can't tell A from a either.

    >>> identifiers(["Kiste 1", "kiste_1", "2nd", "\\u7bb1"])
    ('Kiste_1', 'kiste_1_2', 'object_2nd', 'object')
    """
    taken = {name.lower() for name in reserved}
    # a name that needs no change keeps itself, whoever comes before it
    whole = {name for name in names if _plain(name) == name and name.lower() not in taken}
    found = []
    for name in names:
        plain, count = _plain(name), 1
        fits = plain
        while fits.lower() in taken or (fits in whole and fits != name):
            count += 1
            fits = f"{plain}_{count}"
        taken.add(fits.lower())
        found.append(fits)
    return tuple(found)


def _plain(name: str) -> str:
    letters = unicodedata.normalize("NFKD", name)
    bare = "".join(letter for letter in letters if not unicodedata.combining(letter))
    plain = re.sub(r"[^A-Za-z0-9_]+", "_", bare).strip("_") or NAMELESS
    return plain if not plain[0].isdigit() else f"{NAMELESS}_{plain}"
