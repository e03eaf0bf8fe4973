# SPDX-License-Identifier: GPL-3.0-or-later
"""A cell to MJCF for MuJoCo: a body for each object, joints, exact masses, and the camera.

Boxes, cylinders and balls are exact; the other solids are convex meshes written into the file. See
https://mujoco.readthedocs.io/en/stable/XMLreference.html.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Sequence

import numpy as np

from ..camera import Camera
from ..cell import Cell
from ..pose import Pose
from ..primitives import Box, Cylinder, Primitive, Sphere
from ..shape.pieces import pieces_of
from ..shape.tessellation import Tessellation
from .link_tree import CAMERA, FREE, STILL, Link, links_of, parent_from_link
from .markup import child, comment, document, position, quaternion
from .number_text import errors_of, numbers, rgba
from .written import Written

JOINTS = {"hinge": "hinge", "slider": "slide"}
# MuJoCo's camera looks along -z with y up
CAMERA_FROM_OPENGL = Pose(np.diag([1.0, -1.0, -1.0]), np.zeros(3))


def mjcf(cell: Cell, name: str, folder: str) -> Written:
    """The MuJoCo model called `name`; one file, nothing goes into `folder`.

    Raises InvalidValue for masses that are given twice.
    """
    links, told = links_of(cell)
    root = ET.Element("mujoco", model=name)
    comment(root, "made by monocell: metres, radians, z up; the origin is the robot's base")
    child(root, "compiler", angle="radian")
    asset, world = child(root, "asset"), child(root, "worldbody")
    bodies: list[ET.Element] = []
    for link in links:
        parent = world if link.parent is None else bodies[link.parent]
        comment(parent, errors_of(link.thing))
        bodies.append(_add_body(parent, asset, links, link))
    if not len(asset):
        root.remove(asset)
    if cell.camera.camera_from_world is not None:
        told += _add_camera(world, cell.camera)
    return Written(document(root), {}, told)


def _add_body(
    parent: ET.Element, asset: ET.Element, links: Sequence[Link], link: Link
) -> ET.Element:
    pose = parent_from_link(links, link)
    body = child(parent, "body", name=link.name, pos=position(pose), quat=quaternion(pose))
    if link.joint == FREE:
        child(body, "freejoint", name=f"{link.name}_joint")
    elif link.joint in JOINTS:
        limits = {} if link.limits is None else {"range": numbers(link.limits)}
        child(
            body,
            "joint",
            name=f"{link.name}_joint",
            type=JOINTS[link.joint],
            axis=numbers(link.axis),
            limited="false" if link.limits is None else "true",
            **limits,
        )
    if link.joint != STILL:
        _add_inertial(body, link)
    _add_geoms(body, asset, link)
    return body


def _add_inertial(body: ET.Element, link: Link) -> None:
    i = link.inertia
    full = [i[0, 0], i[1, 1], i[2, 2], i[0, 1], i[0, 2], i[1, 2]]
    centre, mass = numbers(link.centre_of_mass), numbers([link.mass])
    child(body, "inertial", pos=centre, mass=mass, fullinertia=numbers(full))


def _add_geoms(body: ET.Element, asset: ET.Element, link: Link) -> None:
    color = rgba(link.thing.appearance)
    kind = _kind_and_size(link.thing)
    if kind is not None:
        place = link.link_from_object
        where = {"pos": position(place), "quat": quaternion(place)}
        child(body, "geom", name=link.name, type=kind[0], size=kind[1], rgba=color, **where)
        return
    made = pieces_of(link.thing)
    for number, shape in enumerate(made.shapes):
        _add_mesh(asset, f"{link.name}_piece{number}", shape)
    for number, object_from_piece in made.placed:
        place = link.link_from_object @ object_from_piece
        where = {"pos": position(place), "quat": quaternion(place)}
        mesh = f"{link.name}_piece{number}"
        child(body, "geom", type="mesh", mesh=mesh, rgba=color, **where)


def _kind_and_size(thing: Primitive) -> tuple[str, str] | None:
    """MuJoCo counts sizes from the middle."""
    if isinstance(thing, Box):
        return "box", numbers(thing.size / 2)
    if isinstance(thing, Cylinder):
        return "cylinder", numbers([thing.radius, thing.height / 2])
    if isinstance(thing, Sphere):
        return "sphere", numbers([thing.radius])
    return None


def _add_mesh(asset: ET.Element, name: str, shape: Tessellation) -> None:
    corners, faces = numbers(shape.vertices.ravel()), shape.triangles.ravel()
    # the body's own inertia is exact; that of its outside keeps MuJoCo content with thin solids
    child(
        asset,
        "mesh",
        name=name,
        inertia="shell",
        vertex=corners,
        face=" ".join(map(str, faces)),
    )


def _add_camera(world: ET.Element, camera: Camera) -> tuple[str, ...]:
    i = camera.intrinsics
    pose = camera.pose.inverse() @ CAMERA_FROM_OPENGL
    # from the middle of the picture, and towards its top left: rendered and measured
    middle = [(i.width - 1) / 2 - i.cx, (i.height - 1) / 2 - i.cy]
    child(
        world,
        "camera",
        name=CAMERA,
        pos=position(pose),
        quat=quaternion(pose),
        resolution=f"{i.width} {i.height}",
        sensorsize=numbers([1.0, i.height / i.width]),
        focalpixel=numbers([i.fx, i.fy]),
        principalpixel=numbers(middle),
    )
    if i.distortion.model == "none":
        return ()
    return (f"the lens distortion {i.distortion.model} is left out: MuJoCo's camera has none",)
