# SPDX-License-Identifier: GPL-3.0-or-later
"""Geometry and the nouns: pure functions on frozen values, with numpy and OpenCV alone.

Importing this loads the nouns only; the modules that measure pictures (`find`, `pictures`) import
OpenCV and are imported where they are used.
"""

from .appearance import Appearance
from .camera import Camera
from .cell import Cell
from .composite import Composite
from .distortion import Distortion
from .errors import MonocellError
from .intrinsics import Intrinsics
from .motion import Motion
from .pose import Pose
from .primitives import Box, Cone, Cylinder, Primitive, Prism, Sphere, Tube
from .reference import ReferenceLine, ReferencePlane
from .relation import Relation
from .sighting import SphereSighting
from .sketch import Sketch

__all__ = [
    "Appearance",
    "Box",
    "Camera",
    "Cell",
    "Composite",
    "Cone",
    "Cylinder",
    "Distortion",
    "Intrinsics",
    "MonocellError",
    "Motion",
    "Pose",
    "Primitive",
    "Prism",
    "ReferenceLine",
    "ReferencePlane",
    "Relation",
    "Sketch",
    "Sphere",
    "SphereSighting",
    "Tube",
]
