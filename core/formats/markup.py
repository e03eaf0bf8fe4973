# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers, comments and whole documents of XML, as URDF, SDF and MJCF have them."""

from __future__ import annotations

import xml.etree.ElementTree as ET

from ..arrays import Array
from ..pose import Pose
from ..rotation import quaternion_from_rotation, roll_pitch_yaw
from .number_text import numbers, plain


def child(parent: ET.Element, tag: str, text: str | None = None, **attributes: str) -> ET.Element:
    """A new element at the end of `parent`."""
    element = ET.SubElement(parent, tag, attributes)
    element.text = text
    return element


def comment(parent: ET.Element, text: str) -> None:
    """A comment at the end of `parent`; what XML can't hold in one is replaced."""
    parent.append(ET.Comment(f" {plain(text).replace('--', '- -')} "))


def position(pose: Pose) -> str:
    """`x y z` in metres."""
    return numbers(pose.translation)


def turn(pose: Pose) -> str:
    """`roll pitch yaw` in radians, about fixed axes x, y, z."""
    return numbers(roll_pitch_yaw(pose.rotation))


def quaternion(pose: Pose) -> str:
    """`w x y z`."""
    return numbers(quaternion_from_rotation(pose.rotation))


def moments(inertia: Array) -> dict[str, str]:
    """The six numbers of an inertia (3, 3) as URDF and SDF name them."""
    return {
        f"i{'xyz'[row]}{'xyz'[column]}": numbers([inertia[row, column]])
        for row in range(3)
        for column in range(row, 3)
    }


def document(root: ET.Element) -> str:
    """The whole file, indented."""
    ET.indent(root)
    return f'<?xml version="1.0"?>\n{ET.tostring(root, encoding="unicode")}\n'
