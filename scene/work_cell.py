# SPDX-License-Identifier: GPL-3.0-or-later
"""The plain description of a synthetic robot cell: what stands where, and who looks at it."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ..core.arrays import Array, frozen, positive
from ..core.camera import Camera
from ..core.mesh_part import MeshPart
from ..core.pose import Pose
from ..core.primitives import Primitive


@dataclass(frozen=True, eq=False)
class Ball:
    """The calibration ball: `center_world` (3,), `radius` in metres, `color` (3,) in linear light.

    `roughness` is 0 for a mirror's lacquer and 1 for chalk. With `world_from_flange` a gripper
    reaches from the flange to the ball: its palm behind, one finger on each side, which hide a part
    of the ball as they do in life.
    """

    center_world: Array
    radius: float
    color: Array
    world_from_flange: Pose | None = None
    roughness: float = 0.55

    def __post_init__(self) -> None:
        object.__setattr__(self, "center_world", frozen(self.center_world, (3,), "center_world"))
        object.__setattr__(self, "radius", positive(self.radius, "radius"))
        object.__setattr__(self, "color", frozen(self.color, (3,), "color"))


@dataclass(frozen=True, eq=False)
class Panel:
    """A printed plate, such as a calibration board, in the gripper.

    `world_from_panel`: origin in the middle of the print, x right, y down, z into the plate.
    `size` (2,) in metres; `albedo` (H, W) from 0 to 1 is the print, rows from the top. The gripper
    reaches from the flange to a stub behind the plate.
    """

    world_from_panel: Pose
    size: Array
    albedo: Array
    world_from_flange: Pose | None = None
    thickness: float = 0.005

    def __post_init__(self) -> None:
        object.__setattr__(self, "size", frozen(self.size, (2,), "panel.size"))
        object.__setattr__(self, "albedo", frozen(self.albedo, (None, None), "panel.albedo"))
        object.__setattr__(self, "thickness", positive(self.thickness, "panel.thickness"))


@dataclass(frozen=True, eq=False)
class Table:
    """The table whose top is the plane z = 0: its `centre` (2,) and `size` (2,) in metres.

    Its top is `height` above the floor of the room.
    """

    centre: Array = field(default_factory=lambda: np.array([0.35, 0.0]))
    size: Array = field(default_factory=lambda: np.array([1.6, 1.5]))
    height: float = 0.8

    def __post_init__(self) -> None:
        object.__setattr__(self, "centre", frozen(self.centre, (2,), "table.centre"))
        object.__setattr__(self, "size", frozen(self.size, (2,), "table.size"))
        object.__setattr__(self, "height", positive(self.height, "table.height"))


@dataclass(frozen=True, eq=False)
class Lab:
    """What the room is painted with, colours (3,) in linear light, and how it is lit.

    The table wanders between `table_dark` and `table_light`, `grain` (3,) times a metre along x, y
    and z. `to_lamp` (3,) points from the table to the lamp, a disc of `lamp_size` metres that gives
    `lamp_watts`; None puts it over the camera's shoulder. `ambient` is the light of the room.
    """

    table_dark: Array = field(default_factory=lambda: np.array([0.40, 0.255, 0.135]))
    table_light: Array = field(default_factory=lambda: np.array([0.56, 0.39, 0.225]))
    grain: Array = field(default_factory=lambda: np.array([1.2, 38.0, 1.0]))
    wall: Array = field(default_factory=lambda: np.array([0.58, 0.60, 0.61]))
    dado: Array = field(default_factory=lambda: np.array([0.075, 0.135, 0.18]))
    floor: Array = field(default_factory=lambda: np.array([0.215, 0.22, 0.23]))
    to_lamp: Array | None = None
    lamp_size: float = 0.9
    lamp_watts: float = 95.0
    ambient: float = 0.55

    def __post_init__(self) -> None:
        for name in ("table_dark", "table_light", "grain", "wall", "dado", "floor"):
            object.__setattr__(self, name, frozen(getattr(self, name), (3,), f"lab.{name}"))
        if self.to_lamp is not None:
            object.__setattr__(self, "to_lamp", frozen(self.to_lamp, (3,), "lab.to_lamp"))
        object.__setattr__(self, "lamp_size", positive(self.lamp_size, "lab.lamp_size"))


@dataclass(frozen=True, eq=False)
class WorkCell:
    """A robot on a table in a lab. World: metres, z up, the robot's base at the origin.

    `parts` are the meshes of the arm in their poses. `light` scales the brightness of the room.
    Textures of the objects are named from `folder`.
    """

    camera: Camera
    objects: tuple[Primitive, ...] = ()
    ball: Ball | None = None
    parts: tuple[MeshPart, ...] = ()
    table: Table = field(default_factory=Table)
    light: float = 1.0
    lab: Lab = field(default_factory=Lab)
    folder: Path = Path()
