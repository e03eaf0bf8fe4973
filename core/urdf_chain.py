# SPDX-License-Identifier: GPL-3.0-or-later
"""A robot's joints from base to flange: a URDF file and joint angles in, the flange's pose out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
from numpy.typing import ArrayLike

from .arrays import Array, frozen
from .errors import DocumentError, InvalidValue
from .pose import Pose
from .rotation import rotation_from_vector

TURNING, SLIDING, RIGID = ("revolute", "continuous"), ("prismatic",), ("fixed",)
# a joint of a real robot stops within a hair of its limit
BEYOND = 1e-3
# no revolute joint turns so often: such a number is one of degrees
MOST_TURN = 8 * np.pi


@dataclass(frozen=True, eq=False)
class Joint:
    """One joint: `parent_from_joint` at rest, and the `axis` (3,) it turns about or slides along.

    `limits` in radians or metres, None for a continuous or a rigid joint.
    """

    name: str
    kind: str
    parent: str
    child: str
    parent_from_joint: Pose
    axis: Array
    limits: tuple[float, float] | None

    @property
    def moves(self) -> bool:
        return self.kind not in RIGID

    def parent_from_child(self, value: float) -> Pose:
        """The child's frame with the joint at `value`, radians or metres."""
        if self.kind in TURNING:
            turned = Pose(rotation_from_vector(self.axis * value), np.zeros(3))
            return self.parent_from_joint @ turned
        return self.parent_from_joint @ Pose(np.eye(3), self.axis * value)


@dataclass(frozen=True, eq=False)
class UrdfChain:
    """The joints from the base link to the `flange` link, in order."""

    base: str
    flange: str
    joints: tuple[Joint, ...]

    @property
    def moving(self) -> tuple[Joint, ...]:
        """The joints that are set, in order from the base."""
        return tuple(joint for joint in self.joints if joint.moves)

    def base_from_flange(self, values: ArrayLike) -> Pose:
        """`base_from_flange . p_flange = p_base` with the moving joints at `values` (n,).

        Radians, metres for sliding joints. Raises InvalidValue for another number of them, and for
        one beyond its joint's limits.
        """
        set_to = frozen(values, (None,), "joints")
        if len(set_to) != len(self.moving):
            names = ", ".join(joint.name for joint in self.moving)
            raise InvalidValue(
                f"joints: {len(set_to)} given, and {len(self.moving)} move between {self.base} and "
                f"{self.flange}: {names or 'none'}"
            )
        rest = iter(set_to.tolist())
        pose = Pose.identity()
        for joint in self.joints:
            value = next(rest) if joint.moves else 0.0
            _check_limits(joint, value)
            pose = pose @ joint.parent_from_child(value)
        return pose


def read_urdf_chain(path: str | Path, flange: str | None = None) -> UrdfChain:
    """The chain to the link called `flange`, or to the only last link without a name.

    Only joints are read: meshes need not be there. Raises DocumentError for a file that is no URDF,
    a link that is not in it, several last links, and joints that depend on others.
    """
    file = Path(path)
    robot = _robot(file)
    joints = {_child(file, one): one for one in robot.findall("joint")}
    parents = {_parent(file, one) for one in joints.values()}
    links = [str(one.get("name")) for one in robot.findall("link")]
    end = flange or _only_end(file, [link for link in links if link not in parents])
    if end not in links:
        raise DocumentError(f"{file}: no link is called {end!r}; there are {', '.join(links)}")
    chain: list[Joint] = []
    link = end
    while link in joints:
        if len(chain) > len(links):
            raise DocumentError(f"{file}: the links go round in a circle at {link}")
        chain.append(_joint(file, joints[link]))
        link = chain[-1].parent
    return UrdfChain(link, end, tuple(chain[::-1]))


def _robot(file: Path) -> ElementTree.Element:
    try:
        robot = ElementTree.parse(file).getroot()
    except FileNotFoundError:
        raise DocumentError(f"{file}: there is no such file") from None
    except OSError as error:
        raise DocumentError(f"{file}: can't be read ({error.strerror})") from None
    except (ElementTree.ParseError, UnicodeDecodeError, ValueError) as error:
        raise DocumentError(f"{file}: is no XML ({error})") from None
    if robot.tag != "robot":
        raise DocumentError(f"{file}: is no URDF; its first element is <{robot.tag}>, not <robot>")
    if any("xacro" in str(one.tag) for one in robot.iter()):
        raise DocumentError(f"{file}: is a xacro file; expand it first: xacro {file.name} > x.urdf")
    return robot


def _joint(file: Path, element: ElementTree.Element) -> Joint:
    name, kind = str(element.get("name")), str(element.get("type"))
    where = f"{file}: joint {name}"
    if kind not in (*TURNING, *SLIDING, *RIGID):
        raise DocumentError(f"{where}: is {kind}, which no arm between base and flange is")
    if element.find("mimic") is not None:
        raise DocumentError(f"{where}: follows another joint; choose a flange before it")
    origin, axis = element.find("origin"), element.find("axis")
    along = _numbers(axis, "xyz", "1 0 0", where)
    if kind not in RIGID and not 1e-9 < np.linalg.norm(along) < np.inf:
        raise DocumentError(f"{where}: its axis has no length")
    rotation = _from_roll_pitch_yaw(_numbers(origin, "rpy", "0 0 0", where))
    return Joint(
        name,
        kind,
        _parent(file, element),
        _child(file, element),
        Pose(rotation, _numbers(origin, "xyz", "0 0 0", where)),
        along / (float(np.linalg.norm(along)) or 1.0),
        _limits(element, where) if kind in ("revolute", "prismatic") else None,
    )


def _limits(element: ElementTree.Element, where: str) -> tuple[float, float] | None:
    limit = element.find("limit")
    if limit is None:
        return None
    lower, upper = (float(_numbers(limit, end, "0", where, 1)[0]) for end in ("lower", "upper"))
    # both left out means without limits, in practice
    return (lower, upper) if upper > lower else None


def _from_roll_pitch_yaw(angles: Array) -> Array:
    """The URDF's fixed-axis angles: `R = Rz(yaw) Ry(pitch) Rx(roll)`, (3, 3)."""
    x, y, z = (rotation_from_vector(turn) for turn in np.diag(angles))
    rotation: Array = z @ y @ x
    return rotation


def _numbers(
    element: ElementTree.Element | None, key: str, default: str, where: str, count: int = 3
) -> Array:
    text = default if element is None else element.get(key, default)
    try:
        return frozen([float(word) for word in text.split()], (count,), f"{where}: {key}")
    except (ValueError, InvalidValue):
        raise DocumentError(f"{where}: {key} should be {count} numbers, not {text!r:.40}") from None


def _parent(file: Path, joint: ElementTree.Element) -> str:
    return _link_of(file, joint, "parent")


def _child(file: Path, joint: ElementTree.Element) -> str:
    return _link_of(file, joint, "child")


def _link_of(file: Path, joint: ElementTree.Element, end: str) -> str:
    found = joint.find(end)
    if found is None or not found.get("link"):
        raise DocumentError(f"{file}: joint {joint.get('name')}: has no {end} link")
    return str(found.get("link"))


def _only_end(file: Path, ends: Sequence[str]) -> str:
    if len(ends) != 1:
        raise DocumentError(
            f"{file}: has {len(ends)} last links ({', '.join(ends) or 'none'}); name the flange"
        )
    return ends[0]


def _check_limits(joint: Joint, value: float) -> None:
    unit = "m" if joint.kind in SLIDING else "rad"
    low, high = joint.limits or ((-MOST_TURN, MOST_TURN) if unit == "rad" else (-np.inf, np.inf))
    if not low - BEYOND <= value <= high + BEYOND:
        raise InvalidValue(
            f"{joint.name}: {value:g} {unit} is beyond its limits, {low:.4g} to {high:.4g} {unit}"
            + ("; are these degrees?" if unit == "rad" and abs(value) > 2 * np.pi else "")
        )
