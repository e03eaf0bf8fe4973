# SPDX-License-Identifier: GPL-3.0-or-later
"""Node names in glTF: those of the document go in for those that Blender made unique.

Blender calls an object `block.001` when the user's scene has a `block` already.
"""

from __future__ import annotations

import json
import struct
from typing import Any

# glTF 2.0, section 4: a header of 12 bytes, then chunks of length, type and padded data
HEADER = struct.Struct("<4sII")
CHUNK = struct.Struct("<II")
JSON_CHUNK = 0x4E4F534A


def glb_named_by_entries(glb: bytes) -> bytes:
    """The same file with each node named after `extras.monocell.name`, where it has one."""
    magic, version, _ = HEADER.unpack_from(glb)
    length, kind = CHUNK.unpack_from(glb, HEADER.size)
    start = HEADER.size + CHUNK.size
    if magic != b"glTF" or kind != JSON_CHUNK:
        raise ValueError("not a binary glTF with a JSON chunk first")
    document = _renamed(json.loads(glb[start : start + length]))
    text = json.dumps(document, separators=(",", ":"), ensure_ascii=False).encode()
    text += b" " * (-len(text) % 4)
    rest = glb[start + length :]
    total = HEADER.size + CHUNK.size + len(text) + len(rest)
    return HEADER.pack(magic, version, total) + CHUNK.pack(len(text), JSON_CHUNK) + text + rest


def gltf_named_by_entries(text: str) -> str:
    """The same for the text of a `.gltf`."""
    return json.dumps(_renamed(json.loads(text)), indent=1, ensure_ascii=False) + "\n"


def _renamed(document: dict[str, Any]) -> dict[str, Any]:
    for node in document.get("nodes", []):
        entry = node.get("extras", {}).get("monocell", {})
        if "name" in entry:
            node["name"] = entry["name"]
    return document
