# SPDX-License-Identifier: GPL-3.0-or-later
"""The looks of a cell's objects: cell and picture in, each object's colour and faces out."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass

from ..arrays import Mask
from ..cell import Cell
from ..errors import InvalidValue
from ..picture.pictures import Light, Picture, check_size, linear_light
from ..primitives import Primitive
from ..shape.hits import face_names
from .color import ColorSample, sampled_color
from .sure_pixels import Sight
from .textures import FacePicture, NotSeen, face_picture


@dataclass(frozen=True, eq=False)
class Look:
    """What one object looks like: its colour, and where asked for its faces laid flat.

    `unseen` are the faces that have no texture, each with the reason.
    """

    thing: Primitive
    color: ColorSample
    faces: tuple[FacePicture, ...] = ()
    unseen: tuple[NotSeen, ...] = ()
    warnings: tuple[str, ...] = ()


def looks_of(
    cell: Cell,
    picture: Picture,
    *,
    names: Collection[str] | None = None,
    textured: Collection[str] = (),
    hidden: Mask | None = None,
    jpeg: bool = False,
) -> Iterator[Look]:
    """The looks of the objects called `names` (all without), one after the other.

    `picture` (H, W, 3) BGR is the cell's as `read_picture` gives it; objects in `textured` get
    pictures of their faces too. All objects of the cell may stand in front of each other; `hidden`
    (H, W) marks what else does. Raises NoPose, PictureError, and InvalidValue for a name that no
    solved object has.
    """
    camera = cell.standing_camera()
    check_size(picture, camera.intrinsics, cell.picture or "picture")
    known = [thing.name for thing in cell.objects]
    for name in (*(names or ()), *textured):
        if name not in known:
            listed = ", ".join(known) or "none at all"
            raise InvalidValue(f"no solved object is called {name!r}; there is {listed}")
    sight, light = Sight.of(cell.objects, camera, hidden), linear_light(picture)
    for index, thing in enumerate(cell.objects):
        if names is None or thing.name in names or thing.name in textured:
            yield _look(sight, index, light, jpeg=jpeg, textured=thing.name in textured)


def _look(sight: Sight, index: int, light: Light, *, jpeg: bool, textured: bool) -> Look:
    thing = sight.things[index]
    sampled = sampled_color(sight, index, light, jpeg=jpeg)
    if not textured or sampled.color is None:
        return Look(thing, sampled, warnings=(*sampled.warnings, *_advice(thing, sampled)))
    asked = [face_picture(sight, index, face, light, sampled.color) for face in face_names(thing)]
    faces = tuple(face for face in asked if isinstance(face, FacePicture))
    unseen = tuple(face for face in asked if isinstance(face, NotSeen))
    doubts = sampled.warnings
    if not faces:
        doubts += (f"{thing.name}: none of its faces is seen well enough for a texture",)
    return Look(thing, sampled, faces, unseen, doubts)


def _advice(thing: Primitive, sampled: ColorSample) -> tuple[str, ...]:
    if sampled.uniform or sampled.color is None:
        return ()
    share = f"{100 * sampled.share:.0f} %"
    return (f"{thing.name}: one colour describes {share} of its pixels; give it a texture",)
