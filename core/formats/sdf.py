# SPDX-License-Identifier: GPL-3.0-or-later
"""A cell to an SDF world for Gazebo: a model for each thing that stands or moves, and the camera.

Boxes, cylinders and balls are exact, the other solids convex meshes beside the file. See
http://sdformat.org/spec.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Sequence

import numpy as np

from ..camera import Camera
from ..cell import Cell
from ..pose import Pose
from ..primitives import Box, Cylinder, Primitive, Sphere
from .link_tree import CAMERA, STILL, WORLD, Link, links_of
from .markup import child, comment, document, moments, position, turn
from .number_text import errors_of, numbers, rgba
from .wavefront import solid_files
from .written import Written

VERSION = "1.7"
JOINTS = {"fixed": "fixed", "hinge": "revolute", "slider": "prismatic"}
# SDF's own word for no limit
UNLIMITED = 1e16
# an SDF camera looks along x with z up; ours along z with y down
CAMERA_FROM_SENSOR = Pose(np.array([[0, -1.0, 0], [0, 0, -1.0], [1.0, 0, 0]]), np.zeros(3))
# metres before and behind which a simulated camera sees nothing
NEAR, FAR = 0.01, 100.0


def sdf(cell: Cell, name: str, folder: str) -> Written:
    """The SDF world called `name`; mesh files are named into `folder` beside it.

    Raises InvalidValue for masses that are given twice.
    """
    links, told = links_of(cell)
    root = ET.Element("sdf", version=VERSION)
    world = child(root, "world", name=name)
    comment(world, "made by monocell: metres, radians, z up; the origin is the robot's base")
    _add_sun(world)
    files: dict[str, str] = {}
    for group in _models(links):
        model = child(world, "model", name=group[0].name)
        # a model stands where its first link does: PyBullet takes no other place from a file
        world_from_model = group[0].world_from_link
        _add_pose(model, world_from_model)
        if group[0].joint == STILL:
            child(model, "static", "true")
        for link in group:
            comment(model, errors_of(link.thing))
            files |= _add_link(model, link, world_from_model, folder)
        for link in group:
            _add_joint(model, links, link)
    if cell.camera.camera_from_world is not None:
        told += _add_camera(world, cell.camera)
    return Written(document(root), files, told)


def _models(links: Sequence[Link]) -> list[list[Link]]:
    """What stands still, each by itself; what moves with all that hangs on it."""
    groups: dict[int, list[Link]] = {}
    root_of: dict[int, int] = {}
    for i, link in enumerate(links):
        hung = link.parent is not None and links[link.parent].joint != STILL
        root_of[i] = root_of[link.parent] if hung and link.parent is not None else i
        groups.setdefault(root_of[i], []).append(link)
    return list(groups.values())


def _add_link(model: ET.Element, link: Link, world_from_model: Pose, folder: str) -> dict[str, str]:
    element = child(model, "link", name=link.name)
    _add_pose(element, world_from_model.inverse() @ link.world_from_link)
    if link.joint != STILL:
        inertial = child(element, "inertial")
        _add_pose(inertial, Pose(np.eye(3), link.centre_of_mass))
        child(inertial, "mass", numbers([link.mass]))
        inertia = child(inertial, "inertia")
        for name, value in moments(link.inertia).items():
            child(inertia, name, value)
    visual = child(element, "visual", name="visual")
    _add_pose(visual, link.link_from_object)
    pieces: Sequence[tuple[str | None, Pose]] = ((None, Pose.identity()),)
    files: dict[str, str] = {}
    seen = None
    if not isinstance(link.thing, Box | Cylinder | Sphere):
        made = solid_files(link.thing, link.name, folder)
        seen, pieces, files = made.visual, made.pieces, dict(made.files)
    _add_shape(visual, link.thing, seen)
    material = child(visual, "material")
    for light in ("ambient", "diffuse"):
        child(material, light, rgba(link.thing.appearance))
    for number, (file, object_from_piece) in enumerate(pieces):
        collision = child(element, "collision", name=f"collision{number}")
        _add_pose(collision, link.link_from_object @ object_from_piece)
        _add_shape(collision, link.thing, file)
    return files


def _add_shape(parent: ET.Element, thing: Primitive, file: str | None) -> None:
    geometry = child(parent, "geometry")
    if file is not None:
        child(child(geometry, "mesh"), "uri", file)
    elif isinstance(thing, Box):
        child(child(geometry, "box"), "size", numbers(thing.size))
    elif isinstance(thing, Cylinder):
        cylinder = child(geometry, "cylinder")
        child(cylinder, "radius", numbers([thing.radius]))
        child(cylinder, "length", numbers([thing.height]))
    elif isinstance(thing, Sphere):
        child(child(geometry, "sphere"), "radius", numbers([thing.radius]))


def _add_joint(model: ET.Element, links: Sequence[Link], link: Link) -> None:
    if link.joint not in JOINTS or link.parent is None:
        return
    joint = child(model, "joint", name=f"{link.name}_joint", type=JOINTS[link.joint])
    parent = links[link.parent]
    # what stands still is a model of its own, and no part of this one
    child(joint, "parent", WORLD if parent.joint == STILL else parent.name)
    child(joint, "child", link.name)
    if link.joint == "fixed":
        return
    axis = child(joint, "axis")
    child(axis, "xyz", numbers(link.axis))
    limit = child(axis, "limit")
    lower, upper = link.limits or (-UNLIMITED, UNLIMITED)
    child(limit, "lower", numbers([lower]))
    child(limit, "upper", numbers([upper]))


def _add_camera(world: ET.Element, camera: Camera) -> tuple[str, ...]:
    i, lens = camera.intrinsics, camera.intrinsics.distortion
    model = child(world, "model", name=CAMERA)
    child(model, "static", "true")
    _add_pose(model, camera.pose.inverse() @ CAMERA_FROM_SENSOR)
    sensor = child(child(model, "link", name="link"), "sensor", name=CAMERA, type="camera")
    child(sensor, "update_rate", "10")
    element = child(sensor, "camera")
    child(element, "horizontal_fov", numbers([2 * np.arctan2(i.width / 2, i.fx)]))
    image = child(element, "image")
    child(image, "width", str(i.width))
    child(image, "height", str(i.height))
    clip = child(element, "clip")
    child(clip, "near", numbers([NEAR]))
    child(clip, "far", numbers([FAR]))
    if lens.model == "plumb_bob":
        distortion = child(element, "distortion")
        for name, value in zip(("k1", "k2", "p1", "p2", "k3"), lens.coefficients, strict=True):
            child(distortion, name, numbers([value]))
        child(distortion, "center", "0.5 0.5")
    intrinsics = child(child(element, "lens"), "intrinsics")
    comment(intrinsics, "counted from the corner of the picture, half a pixel more than in ROS")
    for name, value in (("fx", i.fx), ("fy", i.fy), ("cx", i.cx + 0.5), ("cy", i.cy + 0.5)):
        child(intrinsics, name, numbers([value]))
    child(intrinsics, "s", "0")
    if lens.model in ("none", "plumb_bob"):
        return ()
    return (f"the lens distortion {lens.model} is left out: SDF has plumb_bob alone",)


def _add_sun(world: ET.Element) -> None:
    sun = child(world, "light", name="sun", type="directional")
    child(sun, "pose", "0 0 10 0 0 0")
    child(sun, "diffuse", "0.8 0.8 0.8 1")
    child(sun, "direction", "-0.4 0.3 -0.9")


def _add_pose(parent: ET.Element, pose: Pose) -> None:
    child(parent, "pose", f"{position(pose)} {turn(pose)}")
