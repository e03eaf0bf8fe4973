# SPDX-License-Identifier: GPL-3.0-or-later
"""A .glb read by its specification alone: extras, pictures and vertices out."""

import json
import struct

import cv2
import numpy as np

FLOATS = 5126
# glTF is y up, the world z up
WORLD_FROM_GLTF = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])


def document_of(path):
    """The JSON and the bytes behind it."""
    data = path.read_bytes()
    length = struct.unpack_from("<I", data, 12)[0]
    return json.loads(data[20 : 20 + length]), data[20 + length + 8 :]


def entries_of(path):
    """What each node's extras say of its object, by the node's name."""
    document, _ = document_of(path)
    return {node["name"]: node["extras"]["monocell"] for node in document["nodes"]}


def images_of(read):
    """The embedded pictures (H, W, 3 or 4), by name."""
    document, binary = read
    return {
        image["name"]: cv2.imdecode(
            np.frombuffer(_view(document, binary, image["bufferView"]), np.uint8),
            cv2.IMREAD_UNCHANGED,
        )
        for image in document["images"]
    }


def vertices_world(path, name):
    """The vertices (N, 3) of a node's mesh in the world, z up, metres."""
    document, binary = document_of(path)
    node = next(node for node in document["nodes"] if node["name"] == name)
    points = np.concatenate(
        [
            _floats(document, binary, part["attributes"]["POSITION"])
            for part in document["meshes"][node["mesh"]]["primitives"]
        ]
    )
    turned = points @ _rotation(node.get("rotation", (0, 0, 0, 1))).T
    return (turned + node.get("translation", (0, 0, 0))) @ WORLD_FROM_GLTF.T


def _floats(document, binary, index):
    accessor = document["accessors"][index]
    assert accessor["componentType"] == FLOATS
    data = _view(document, binary, accessor["bufferView"])[accessor.get("byteOffset", 0) :]
    return np.frombuffer(data, "<f4", 3 * accessor["count"]).reshape(-1, 3).astype(float)


def _view(document, binary, index):
    view = document["bufferViews"][index]
    start = view.get("byteOffset", 0)
    return binary[start : start + view["byteLength"]]


def _rotation(quaternion):
    x, y, z, w = quaternion
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )
