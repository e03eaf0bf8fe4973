# SPDX-License-Identifier: GPL-3.0-or-later
"""A job's folder: its files as they stand, and a document of it with something spoilt."""

from __future__ import annotations

import json


def state_of(folder):
    return {p.name: (p.read_bytes(), p.stat().st_mtime_ns) for p in folder.iterdir() if p.is_file()}


def edited(job, change, name="cell.cell.json"):
    document = json.loads((job / name).read_text())
    change(document)
    (job / "edited.json").write_text(json.dumps(document))
    return "edited.json"
