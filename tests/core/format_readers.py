# SPDX-License-Identifier: GPL-3.0-or-later
"""Strict little readers of the robot formats: a file in, shapes by object where they stand out."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from dataclasses import dataclass

import numpy as np
from monocell.core import Pose

# pose, kind, and sizes as the document has them; or the vertices and triangles of a mesh


@dataclass
class Shape:
    world_from_shape: Pose
    kind: str
    sizes: np.ndarray
    vertices: np.ndarray | None = None
    triangles: np.ndarray | None = None

    def corners_world(self):
        return self.world_from_shape.apply(self.vertices)

    def volume(self):
        a, b, c = (self.vertices[self.triangles[:, i]] for i in range(3))
        return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6)


def read_urdf(path):
    """Collision shapes by link, and joints by child: (type, parent, world_from_child, element)."""
    root = ET.parse(path).getroot()
    assert root.tag == "robot"
    links = {link.get("name"): link for link in root.findall("link")}
    joints = {joint.find("child").get("link"): joint for joint in root.findall("joint")}
    assert len(links) == len(root.findall("link")) and len(joints) == len(root.findall("joint"))
    assert set(links) - set(joints) == {"world"}

    def world_from(name):
        if name == "world":
            return Pose.identity()
        joint = joints[name]
        return world_from(joint.find("parent").get("link")) @ urdf_pose(joint)

    shapes = {
        name: [
            urdf_shape(path, world_from(name), collision) for collision in link.findall("collision")
        ]
        for name, link in links.items()
    }
    told = {
        name: (joint.get("type"), joint.find("parent").get("link"), world_from(name), joint)
        for name, joint in joints.items()
    }
    return shapes, told


def urdf_pose(element):
    origin = element.find("origin")
    return posed(floats(origin.get("xyz")), floats(origin.get("rpy")))


def urdf_shape(path, world_from_link, collision):
    pose = world_from_link @ urdf_pose(collision)
    (shape,) = collision.find("geometry")
    if shape.tag == "mesh":
        return Shape(pose, "mesh", np.zeros(0), *read_obj(path.parent / shape.get("filename")))
    names = {"box": ("size",), "cylinder": ("radius", "length"), "sphere": ("radius",)}[shape.tag]
    return Shape(pose, shape.tag, np.concatenate([floats(shape.get(name)) for name in names]))


def read_sdf(path):
    """Collision shapes by link; models by name; the element of the world."""
    root = ET.parse(path).getroot()
    world = root.find("world")
    models = world.findall("model")
    names = [element.get("name") for element in (*models, *world.findall("light"))]
    assert len(set(names)) == len(names)
    shapes = {}
    for model in models:
        parts = [e.get("name") for e in model if e.tag in ("link", "joint")]
        assert len(set(parts)) == len(parts)
        base = sdf_pose(model)
        for link in model.findall("link"):
            at = base @ sdf_pose(link)
            shapes[link.get("name")] = [
                sdf_shape(path, at, collision) for collision in link.findall("collision")
            ]
    return shapes, {model.get("name"): model for model in models}, world


def sdf_pose(element):
    pose = element.find("pose")
    if pose is None:
        return Pose.identity()
    values = floats(pose.text)
    return posed(values[:3], values[3:])


def sdf_shape(path, world_from_link, collision):
    pose = world_from_link @ sdf_pose(collision)
    (shape,) = collision.find("geometry")
    if shape.tag == "mesh":
        return Shape(pose, "mesh", np.zeros(0), *read_obj(path.parent / shape.find("uri").text))
    return Shape(pose, shape.tag, np.concatenate([floats(size.text) for size in shape]))


def read_mjcf(path):
    """Shapes by body; body elements by name; the worldbody."""
    root = ET.parse(path).getroot()
    assert root.find("compiler").get("angle") == "radian"
    meshes = {mesh.get("name"): mesh for mesh in root.findall("asset/mesh")}
    assert len(meshes) == len(root.findall("asset/mesh"))
    shapes, bodies = {}, {}

    def walk(element, world_from_parent):
        for body in element.findall("body"):
            here = world_from_parent @ mjcf_pose(body)
            assert body.get("name") not in bodies
            bodies[body.get("name")] = body
            shapes[body.get("name")] = [
                mjcf_shape(meshes, here, geom) for geom in body.findall("geom")
            ]
            walk(body, here)

    walk(root.find("worldbody"), Pose.identity())
    return shapes, bodies, root.find("worldbody")


def mjcf_pose(element):
    return turned(floats(element.get("pos")), floats(element.get("quat")))


def mjcf_shape(meshes, world_from_body, geom):
    pose, kind = world_from_body @ mjcf_pose(geom), geom.get("type")
    if kind == "mesh":
        mesh = meshes[geom.get("mesh")]
        vertices = floats(mesh.get("vertex")).reshape(-1, 3)
        triangles = floats(mesh.get("face")).astype(int).reshape(-1, 3)
        return Shape(pose, "mesh", np.zeros(0), vertices, triangles)
    half = {"box": (2, 2, 2), "cylinder": (1, 2), "sphere": (1,)}[kind]
    return Shape(pose, kind, floats(geom.get("size")) * half)


def read_scene(path):
    """Shapes by object, token by token as MoveIt reads them."""
    name, _, rest = path.read_text(encoding="utf-8").partition("\n")
    assert name
    tokens = iter(rest.split())

    def some(count):
        return np.array([float(next(tokens)) for _ in range(count)])

    def pose():
        at, (x, y, z, w) = some(3), some(4)
        return turned(at, (w, x, y, z))

    shapes = {}
    while (marker := next(tokens)) == "*":
        own = next(tokens)
        assert own not in shapes
        at, shapes[own] = pose(), []
        for _ in range(int(next(tokens))):
            kind, mesh, sizes = next(tokens), (), np.zeros(0)
            if kind == "mesh":
                vertices, triangles = (int(v) for v in some(2))
                mesh = (some(3 * vertices).reshape(-1, 3), some(3 * triangles).reshape(-1, 3))
                mesh = (mesh[0], mesh[1].astype(int))
            else:
                sizes = some({"box": 3, "cylinder": 2, "cone": 2, "sphere": 1}[kind])
            shapes[own].append(Shape(at @ pose(), kind, sizes, *mesh))
            color = some(4)
            assert (color >= 0).all() and (color <= 1).all() and color[3] == 1
        assert int(next(tokens)) == 0
    assert marker == "." and next(tokens, None) is None
    return shapes


def read_obj(path):
    lines = [line.split() for line in path.read_text(encoding="ascii").splitlines()]
    vertices = np.array([line[1:] for line in lines if line[0] == "v"], dtype=float)
    triangles = np.array([line[1:] for line in lines if line[0] == "f"], dtype=int) - 1
    return vertices, triangles


def posed(translation, roll_pitch_yaw):
    """`Rz(yaw) Ry(pitch) Rx(roll)`, as URDF and SDF define it."""
    turns = [
        Pose.from_rotation_vector(np.eye(3)[axis] * roll_pitch_yaw[axis], np.zeros(3))
        for axis in (2, 1, 0)
    ]
    return Pose((turns[0] @ turns[1] @ turns[2]).rotation, translation)


def turned(translation, quaternion):
    """From a quaternion w x y z."""
    w, x, y, z = np.asarray(quaternion) / np.linalg.norm(quaternion)
    vector = np.array([x, y, z])
    cross = np.cross(np.eye(3), vector)
    return Pose(
        (w * w - vector @ vector) * np.eye(3) + 2 * np.outer(vector, vector) + 2 * w * cross,
        translation,
    )


def floats(text):
    return np.array(text.split(), dtype=float)
