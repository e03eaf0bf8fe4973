# SPDX-License-Identifier: GPL-3.0-or-later
"""What an object looks like: a uniform colour in linear light, and textures of its faces."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace

from .arrays import Array, finite, frozen
from .errors import InvalidValue


@dataclass(frozen=True)
class Texture:
    """A picture of one face, laid flat as its chart says (`core.shape.charts`).

    `picture` names a PNG in sRGB; its alpha is 255 where the texel was seen, and 0 where it was
    made up. `seen` is the share of the face that was seen, from 0 to 1.
    """

    picture: str
    seen: float = 1.0

    def __post_init__(self) -> None:
        if not self.picture:
            raise InvalidValue("texture: its picture needs a name that is not empty")
        seen = finite(self.seen, f"{self.picture}: seen")
        if not 0 <= seen <= 1:
            raise InvalidValue(f"{self.picture}: seen is a share from 0 to 1, got {seen:g}")
        object.__setattr__(self, "seen", seen)


@dataclass(frozen=True, eq=False)
class Appearance:
    """`color` (3,): red, green, blue from 0 to 1, linear (not sRGB-encoded), as in glTF.

    `textures` maps names of faces (`top`, `x+`, `side`, ...) to what is to be seen on them; the
    other faces are of the uniform colour.
    """

    color: Array
    textures: Mapping[str, Texture] = field(default_factory=dict)

    def __post_init__(self) -> None:
        color = frozen(self.color, (3,), "appearance.color")
        if (color < 0).any() or (color > 1).any():
            raise InvalidValue(
                f"appearance.color: each part must be from 0 to 1, got {color.round(4).tolist()}"
            )
        object.__setattr__(self, "color", color)
        object.__setattr__(self, "textures", dict(self.textures))

    def with_pictures(self, renamed: Callable[[str], str]) -> Appearance:
        """The same with each texture's picture by the name that `renamed` gives it."""
        textures = {
            face: replace(texture, picture=renamed(texture.picture))
            for face, texture in self.textures.items()
        }
        return replace(self, textures=textures)
