# SPDX-License-Identifier: GPL-3.0-or-later
"""Where a ball or point is: what was typed, cursor, object or joint angles in, its place out."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ...core.arrays import Array
from ...core.errors import InvalidValue
from ...core.pose import Pose


@dataclass(frozen=True, eq=False)
class Place:
    """A place in the world (3,), or the flange's pose where the offset in it is not known."""

    center: Array | None
    world_from_flange: Pose | None = None


def stated_place(context: Any) -> Place:
    """The place that the scene's inputs state.

    Raises InvalidValue for what is missing or impossible, DocumentError for a URDF that is none.
    """
    inputs = context.scene.monocell_inputs
    if inputs.place_source == "TYPED":
        return Place(decimals(inputs.place))
    if inputs.place_source == "CURSOR":
        return Place(decimals(context.scene.cursor.location))
    flange = _flange_of_object(context) if inputs.place_source == "OBJECT" else _by_joints(inputs)
    if inputs.offset_known:
        return Place(flange.apply(decimals(inputs.offset)))
    return Place(None, flange)


def decimals(vector: Any) -> Array:
    """Blender's single precision as the decimal number that was meant: 0.62, not 0.61999999."""
    return np.array([float(str(np.float32(value))) for value in vector])


def _flange_of_object(context: Any) -> Pose:
    from ...scene.transforms import pose_and_scale, world_matrix

    ob = context.view_layer.objects.active
    if ob is None:
        raise InvalidValue("no object is active: select the flange, or what stands for it")
    if np.linalg.det(world_matrix(ob)[:3, :3]) < 0:
        raise InvalidValue(f"{ob.name}: is mirrored, and a flange is not; make its scale positive")
    pose, _ = pose_and_scale(ob)
    bone = context.active_pose_bone
    if bone is None:
        return pose
    # the flange of a robot that is rigged as an armature
    axes = np.array(bone.matrix.to_3x3().normalized())
    return pose @ Pose(axes, np.array(bone.matrix.translation))


def _by_joints(inputs: Any) -> Pose:
    import bpy

    from ...core.urdf_chain import read_urdf_chain

    if not inputs.urdf:
        raise InvalidValue("no URDF chosen: joint angles need the robot they are of")
    chain = read_urdf_chain(bpy.path.abspath(inputs.urdf), inputs.flange or None)
    words = inputs.joints.replace(",", " ").replace(";", " ").split()
    try:
        values = [float(word) for word in words]
    except ValueError:
        raise InvalidValue(f"joints: {inputs.joints!r:.60} are not all numbers") from None
    if inputs.joint_unit == "DEGREES" and len(values) == len(chain.moving):
        turned = [joint.kind != "prismatic" for joint in chain.moving]
        values = [
            float(np.radians(v)) if turns else v for v, turns in zip(values, turned, strict=True)
        ]
    return chain.base_from_flange(values)
