# SPDX-License-Identifier: GPL-3.0-or-later
"""A cell to URDF: a link for each object and one for the camera, hung on the link `world`.

What is static is fixed to the world; hinges and sliders are joints. Boxes, cylinders and balls are
exact, the other solids convex meshes beside the file. See http://wiki.ros.org/urdf/XML.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Sequence

from ..cell import Cell
from ..pose import Pose
from ..primitives import Box, Cylinder, Primitive, Sphere
from .link_tree import FREE, OPTICAL, WORLD, Link, links_of, parent_from_link
from .markup import child, comment, document, moments, position, turn
from .number_text import errors_of, numbers, rgba
from .wavefront import SolidFiles, solid_files
from .written import Written

JOINTS = {"still": "fixed", "fixed": "fixed", "free": "fixed"}
# URDF asks for them of every joint, and a picture does not tell them
EFFORT, VELOCITY = 100.0, 1.0
# of a slider without limits, metres either way
FAR = 1000.0


def urdf(cell: Cell, name: str, folder: str) -> Written:
    """The URDF of a robot called `name`; mesh files are named into `folder` beside it.

    Raises InvalidValue for masses that are given twice.
    """
    links, told = links_of(cell)
    root = ET.Element("robot", name=name)
    comment(root, "made by monocell: metres, radians, z up; the link world is the robot's base")
    # MuJoCo would look for meshes without their folder; others pass over this element
    child(child(root, "mujoco"), "compiler", strippath="false")
    child(root, "link", name=WORLD)
    files: dict[str, str] = {}
    for link in links:
        made = None
        if not isinstance(link.thing, Box | Cylinder | Sphere):
            made = solid_files(link.thing, link.name, folder)
            files |= made.files
        comment(root, errors_of(link.thing))
        _add_link(root, link, made)
        _add_joint(root, links, link)
    if cell.camera.camera_from_world is not None:
        _add_camera(root, cell)
    free = [link.thing.name for link in links if link.joint == FREE]
    if free:
        told = (*told, f"{', '.join(free)}: stands fixed in URDF, which holds nothing that is free")
    return Written(document(root), files, told)


def _add_link(root: ET.Element, link: Link, made: SolidFiles | None) -> None:
    element = child(root, "link", name=link.name)
    inertial = child(element, "inertial")
    child(inertial, "origin", xyz=numbers(link.centre_of_mass), rpy="0 0 0")
    child(inertial, "mass", value=numbers([link.mass]))
    child(inertial, "inertia", **moments(link.inertia))
    visual = child(element, "visual")
    _add_origin(visual, link.link_from_object)
    _add_shape(visual, link.thing, None if made is None else made.visual)
    material = child(visual, "material", name=f"{link.name}_color")
    child(material, "color", rgba=rgba(link.thing.appearance))
    pieces: Sequence[tuple[str | None, Pose]]
    pieces = ((None, Pose.identity()),) if made is None else made.pieces
    for file, object_from_piece in pieces:
        collision = child(element, "collision")
        _add_origin(collision, link.link_from_object @ object_from_piece)
        _add_shape(collision, link.thing, file)


def _add_shape(parent: ET.Element, thing: Primitive, file: str | None) -> None:
    geometry = child(parent, "geometry")
    if file is not None:
        child(geometry, "mesh", filename=file)
    elif isinstance(thing, Box):
        child(geometry, "box", size=numbers(thing.size))
    elif isinstance(thing, Cylinder):
        child(geometry, "cylinder", radius=numbers([thing.radius]), length=numbers([thing.height]))
    elif isinstance(thing, Sphere):
        child(geometry, "sphere", radius=numbers([thing.radius]))


def _add_joint(root: ET.Element, links: Sequence[Link], link: Link) -> None:
    kind = JOINTS.get(link.joint) or _moving_kind(link)
    joint = child(root, "joint", name=f"{link.name}_joint", type=kind)
    _add_origin(joint, parent_from_link(links, link))
    child(joint, "parent", link=WORLD if link.parent is None else links[link.parent].name)
    child(joint, "child", link=link.name)
    if kind == "fixed":
        return
    child(joint, "axis", xyz=numbers(link.axis))
    effort = {"effort": numbers([EFFORT]), "velocity": numbers([VELOCITY])}
    comment(joint, "effort (N or N m) and velocity (m/s or rad/s) are not known: put yours in")
    if kind == "continuous":
        child(joint, "limit", **effort)
        return
    lower, upper = link.limits or (-FAR, FAR)
    child(joint, "limit", lower=numbers([lower]), upper=numbers([upper]), **effort)


def _moving_kind(link: Link) -> str:
    if link.joint == "slider":
        return "prismatic"
    return "revolute" if link.limits is not None else "continuous"


def _add_camera(root: ET.Element, cell: Cell) -> None:
    i = cell.camera.intrinsics
    comment(
        root,
        f"the camera: x right, y down, z forward; {i.width} x {i.height} px, "
        f"fx {numbers([i.fx])} fy {numbers([i.fy])} cx {numbers([i.cx])} cy {numbers([i.cy])}, "
        f"distortion {i.distortion.model} {numbers(i.distortion.coefficients)}",
    )
    child(root, "link", name=OPTICAL)
    joint = child(root, "joint", name=f"{OPTICAL}_joint", type="fixed")
    _add_origin(joint, cell.camera.pose.inverse())
    child(joint, "parent", link=WORLD)
    child(joint, "child", link=OPTICAL)


def _add_origin(parent: ET.Element, pose: Pose) -> None:
    child(parent, "origin", xyz=position(pose), rpy=turn(pose))
