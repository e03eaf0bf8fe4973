# SPDX-License-Identifier: GPL-3.0-or-later
"""A virtual environment from glTF: exact objects from the nodes' extras, meshes from the rest.

glTF is y up, our world z up: a node's `T` there is `C T C^-1` here, with `C` the quarter turn about
x. The entries in `extras.monocell` are z up already.
"""

from __future__ import annotations

import copy
import io
import json
import struct
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ...core.arrays import Array
from ...core.bodies import rigid_bodies
from ...core.composite import Composite
from ...core.document.entries import composite_from_entry, object_from_entry
from ...core.errors import DocumentError, InvalidValue, MissingPackage
from ...core.links import without_lost_joints
from ...core.primitives import Primitive
from ...core.rotation import rotation_from_vector
from .environment import Environment, WorldMesh

KEY = "monocell"
JSON_CHUNK, BINARY_CHUNK = 0x4E4F534A, 0x004E4942
Z_UP_FROM_Y_UP = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])
# a node that is farther than this from its own extras was moved by another program
MOVED_METRES, MOVED_RADIANS = 1e-4, 1e-3


def read_environment(path: str | Path) -> Environment:
    """The objects and meshes of a `.glb` or `.gltf`, in z-up world coordinates, metres.

    A node with `extras.monocell` becomes its solid or composite; its mesh is not looked at. A node
    with a mesh and no such extras becomes a WorldMesh. A node that stands elsewhere than its extras
    say is taken where the extras say, and warned of, as is a joint to a node that is gone.

    Raises DocumentError with the path of the file and what is wrong.
    """
    file = Path(path)
    document, binary = _document(file)
    objects, composites, warnings = [], [], []
    for i, node, matrix in _placed_nodes(document, file):
        entry, where = _extras(node).get(KEY), f"{file}: nodes[{i}].extras.{KEY}"
        if _is(entry, "composite"):
            composites.append(composite_from_entry(_without_kind(entry), where))
        elif entry is not None and not _is(entry, "camera"):
            thing = object_from_entry(entry, where)
            objects.append(thing)
            warnings += _moved(thing, matrix)
    kept, groups, lost = without_lost_joints(objects, composites)
    _check_bodies(kept, groups, file)
    return Environment(
        kept,
        tuple(_meshes(document, binary, file)),
        _scene_extras(document, file),
        (*warnings, *lost),
        groups,
    )


def _is(entry: Any, kind: str) -> bool:
    """Nodes of cameras and composites are marked as ours, too."""
    return isinstance(entry, dict) and entry.get("kind") == kind


def _without_kind(entry: dict[str, Any]) -> dict[str, Any]:
    return {key: value for key, value in entry.items() if key != "kind"}


def _check_bodies(
    objects: Sequence[Primitive], composites: Sequence[Composite], file: Path
) -> None:
    try:
        rigid_bodies(objects, composites)
    except InvalidValue as error:
        raise DocumentError(f"{file}: {error}") from None


def _document(file: Path) -> tuple[dict[str, Any], bytes]:
    try:
        data = file.read_bytes()
    except OSError as error:
        raise DocumentError(f"{file}: can't be read ({error.strerror})") from None
    text, binary = _chunks(data, file) if data[:4] == b"glTF" else (data, b"")
    try:
        document = json.loads(text)
    except ValueError as error:
        raise DocumentError(f"{file}: is neither GLB nor glTF JSON ({error})") from None
    if not isinstance(document, dict) or "asset" not in document:
        raise DocumentError(f"{file}: has no `asset`, so it is not a glTF document")
    return document, binary


def _chunks(data: bytes, file: Path) -> tuple[bytes, bytes]:
    if len(data) < 20:
        raise DocumentError(f"{file}: is cut short ({len(data)} bytes, a GLB has at least 20)")
    _, version, length = struct.unpack_from("<4sII", data)
    if version != 2:
        raise DocumentError(f"{file}: is GLB version {version}; only version 2 is read")
    if length > len(data):
        raise DocumentError(f"{file}: is cut short ({len(data)} of {length} bytes)")
    found: dict[int, bytes] = {}
    offset = 12
    while offset + 8 <= length:
        size, kind = struct.unpack_from("<II", data, offset)
        if offset + 8 + size > length:
            raise DocumentError(f"{file}: the chunk at byte {offset} runs past the file's end")
        found.setdefault(kind, data[offset + 8 : offset + 8 + size])
        offset += 8 + size
    if JSON_CHUNK not in found:
        raise DocumentError(f"{file}: has no JSON chunk")
    return found[JSON_CHUNK], found.get(BINARY_CHUNK, b"")


def _placed_nodes(
    document: dict[str, Any], file: Path
) -> Iterator[tuple[int, dict[str, Any], Array]]:
    """Every node of the scene with its index and its y-up world matrix (4, 4)."""
    nodes = _listed(document, "nodes", file)
    roots = _scene(document, file).get("nodes")
    if roots is None:
        children = {c for i in range(len(nodes)) for c in _children(nodes, i, file)}
        roots = [i for i in range(len(nodes)) if i not in children]
    waiting, seen = [(i, np.eye(4)) for i in reversed(roots)], set()
    while waiting:
        i, parent = waiting.pop()
        if not isinstance(i, int) or not 0 <= i < len(nodes):
            raise DocumentError(f"{file}: node {i!r} is asked for, there are {len(nodes)}")
        if i in seen:
            raise DocumentError(f"{file}: nodes[{i}] hangs in the tree twice")
        seen.add(i)
        matrix = parent @ _matrix(nodes[i], f"{file}: nodes[{i}]")
        yield i, nodes[i], matrix
        waiting += [(child, matrix) for child in reversed(_children(nodes, i, file))]


def _children(nodes: list[dict[str, Any]], i: int, file: Path) -> list[int]:
    children = nodes[i].get("children", [])
    if not isinstance(children, list) or not all(isinstance(c, int) for c in children):
        raise DocumentError(f"{file}: nodes[{i}].children: expected a list of node numbers")
    return children


def _matrix(node: dict[str, Any], where: str) -> Array:
    def numbers(key: str, default: list[float]) -> Array:
        try:
            values = np.array(node.get(key, default), dtype=float)
        except (TypeError, ValueError):
            raise DocumentError(f"{where}.{key}: expected {len(default)} numbers") from None
        if values.shape != (len(default),) or not np.isfinite(values).all():
            raise DocumentError(f"{where}.{key}: expected {len(default)} numbers")
        return values

    if "matrix" in node:
        return numbers("matrix", [0.0] * 16).reshape(4, 4).T
    quaternion = numbers("rotation", [0.0, 0.0, 0.0, 1.0])
    sine = float(np.linalg.norm(quaternion[:3]))
    axis = quaternion[:3] / sine if sine > 1e-12 else np.zeros(3)
    turn = rotation_from_vector(axis * 2 * np.arctan2(sine, quaternion[3]))
    matrix = np.eye(4)
    matrix[:3, :3] = turn * numbers("scale", [1.0, 1.0, 1.0])
    matrix[:3, 3] = numbers("translation", [0.0, 0.0, 0.0])
    return matrix


def _moved(thing: Primitive, matrix: Array) -> list[str]:
    scale = np.linalg.norm(matrix[:3, :3], axis=0)
    if (scale < 1e-12).any() or np.linalg.det(matrix[:3, :3]) <= 0:
        return [f"{thing.name}: its node is flattened or mirrored; its extras are used"]
    turn = Z_UP_FROM_Y_UP @ (matrix[:3, :3] / scale) @ Z_UP_FROM_Y_UP.T
    place = Z_UP_FROM_Y_UP @ matrix[:3, 3]
    away = float(np.linalg.norm(place - thing.world_from_object.translation))
    # the chord between the axes; a shear shows here as well
    turned = float(np.linalg.norm(turn - thing.world_from_object.rotation, axis=0).max())
    if away <= MOVED_METRES and turned <= MOVED_RADIANS:
        return []
    return [
        f"{thing.name}: its node stands {away * 1e3:.1f} mm and {np.degrees(turned):.1f} degrees "
        "from where its extras say; was it moved in another program? The extras are used"
    ]


def _meshes(document: dict[str, Any], binary: bytes, file: Path) -> Iterator[WorldMesh]:
    """The meshes of nodes without exact shape; trimesh is asked only when there are any."""
    rest = copy.deepcopy(document)
    for node in _listed(rest, "nodes", file):
        if KEY in _extras(node):
            node.pop("mesh", None)
    if not any("mesh" in node for node in rest.get("nodes", [])):
        return
    scene = _loaded(rest, binary, file)
    for name in scene.graph.nodes_geometry:
        matrix, geometry = scene.graph[name]
        mesh = scene.geometry[geometry]
        if len(getattr(mesh, "faces", ())) == 0:
            continue
        y_up = mesh.vertices @ matrix[:3, :3].T + matrix[:3, 3]
        yield WorldMesh(str(name), y_up @ Z_UP_FROM_Y_UP.T, np.asarray(mesh.faces))


def _loaded(document: dict[str, Any], binary: bytes, file: Path) -> Any:
    try:
        import trimesh
    except ImportError:
        raise MissingPackage(
            f"{file}: has meshes, and trimesh is not installed to read them; "
            "install it with: pip install 'monocell[robot]'"
        ) from None
    text = json.dumps(document).encode()
    packed, kind = (text, "gltf") if not binary else (_packed(text, binary), "glb")
    try:
        return trimesh.load_scene(
            io.BytesIO(packed),
            file_type=kind,
            resolver=trimesh.resolvers.FilePathResolver(str(file)),
        )
    # trimesh raises whatever its parsing ran into
    except Exception as error:
        raise DocumentError(f"{file}: its meshes can't be read ({error})") from None


def _packed(text: bytes, binary: bytes) -> bytes:
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    return b"".join(
        [
            struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(binary)),
            struct.pack("<II", len(text), JSON_CHUNK),
            text,
            struct.pack("<II", len(binary), BINARY_CHUNK),
            binary,
        ]
    )


def _listed(document: dict[str, Any], key: str, file: Path) -> list[dict[str, Any]]:
    values = document.get(key, [])
    if not isinstance(values, list) or not all(isinstance(v, dict) for v in values):
        raise DocumentError(f"{file}: {key}: expected a list of objects")
    return values


def _scene(document: dict[str, Any], file: Path) -> dict[str, Any]:
    scenes, index = _listed(document, "scenes", file), document.get("scene", 0)
    if not scenes:
        return {}
    if not isinstance(index, int) or not 0 <= index < len(scenes):
        raise DocumentError(f"{file}: scene {index!r} is asked for, there are {len(scenes)}")
    return scenes[index]


def _scene_extras(document: dict[str, Any], file: Path) -> dict[str, Any]:
    extras = _extras(_scene(document, file)).get(KEY, {})
    if not isinstance(extras, dict):
        raise DocumentError(f"{file}: scene.extras.{KEY}: expected an object")
    return extras


def _extras(holder: dict[str, Any]) -> dict[str, Any]:
    """A node's or scene's extras; glTF allows any JSON there, and only an object can be ours."""
    extras = holder.get("extras", {})
    return extras if isinstance(extras, dict) else {}
