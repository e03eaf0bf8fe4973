# SPDX-License-Identifier: GPL-3.0-or-later
"""Hard pictures of a ball with known truth: a seed in, picture, lens, ball and window out."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import cv2
import numpy as np
from monocell.core.ball.sphere import outline_pixels, sphere_at
from monocell.core.distortion import Distortion
from monocell.core.errors import InvalidValue
from monocell.core.intrinsics import Intrinsics
from monocell.core.picture.pictures import Picture
from monocell.core.picture.synthetic import Ball, Bar, Photographer, photograph

RADIUS = 0.04
NORMAL = Intrinsics(
    960, 720, 900.0, 898.0, 489.0, 353.0, Distortion("plumb_bob", [-0.12, 0.04, 5e-4, -3e-4, 0.0])
)
LARGE = Intrinsics(1280, 960, 1200.0, 1197.0, 652.0, 471.0)
# towards its corners a sphere shows as an ellipse of axis ratio 1.15 and more
WIDE = Intrinsics(960, 720, 520.0, 519.0, 489.0, 353.0)
FISHEYE = Intrinsics(
    960, 720, 330.0, 329.0, 489.0, 353.0, Distortion("equidistant", [-0.02, 0.004, -0.001, 2e-4])
)
Color = tuple[float, float, float]


@dataclass(frozen=True, eq=False)
class Shot:
    """One picture, what took it, and the truth that only the judge may use."""

    picture: Picture
    intrinsics: Intrinsics
    ball: Ball

    @property
    def window(self) -> tuple[float, float, float, float]:
        """A window around the ball's middle, as a rough prediction would give it."""
        outline = outline_pixels(self.intrinsics, self.ball.centre_camera, self.ball.radius)
        low, high = np.nanmin(outline, axis=0), np.nanmax(outline, axis=0)
        reach = max(60.0, 0.9 * float((high - low).max()))
        u, v = (low + high) / 2
        return (u - reach, v - reach, 2 * reach, 2 * reach)


def conditions_of(names: Sequence[str]) -> list[str]:
    """Those of the names that have a ball. Raises InvalidValue for an unknown one."""
    for name in names:
        if name not in CONDITIONS and name not in NO_BALL:
            raise InvalidValue(f"{name!r} is no condition; there is {', '.join(CONDITIONS)}")
    return [name for name in names if name in CONDITIONS]


def _rng(seed: int) -> np.random.Generator:
    return np.random.default_rng([seed, 31])


def _placed(
    rng: np.random.Generator,
    lens: Intrinsics = NORMAL,
    size: tuple[float, float] = (12.0, 40.0),
    at: tuple[float, float] | None = None,
) -> tuple[Ball, float, float, float]:
    """A ball of any colour wholly in the picture; its place and radius in pixels."""
    r = float(np.exp(rng.uniform(*np.log(size))))
    far = 1.1 * r + 6
    u, v = at or (rng.uniform(far, lens.width - far), rng.uniform(far, lens.height - far))
    centre = sphere_at(lens, (u, v), r, RADIUS)
    color = tuple(float(c) for c in rng.uniform(0.05, 0.8, 3))
    shine = float(rng.uniform(0, 0.4))
    return Ball(tuple(centre.tolist()), RADIUS, color, shine), u, v, r


def _ordinary(rng: np.random.Generator) -> Photographer:
    """Light from above, a wall that is neither black nor white, little noise."""
    return Photographer(
        light=tuple((rng.normal(size=3) * [1.0, 0.4, 0.3] + [0, -1, -0.6]).tolist()),
        background=tuple(rng.uniform(0.03, 0.4, 2).tolist()),
        texture=0.12,
        noise_grey_levels=1.5,
        supersampling=4,
        seed=int(rng.integers(1 << 30)),
    )


def _plain(seed: int, **changes: object) -> Shot:
    rng = _rng(seed)
    ball, *_ = _placed(rng)
    return Shot(photograph(NORMAL, (ball,), replace(_ordinary(rng), **changes)), NORMAL, ball)


def _fingers(seed: int, *, own_color: bool = False) -> Shot:
    """Two or three slanted fingers over up to 40 % of the outline."""
    rng = _rng(seed)
    ball, u, v, r = _placed(rng, size=(14.0, 40.0))
    grip = rng.uniform(0, 2 * np.pi)
    bars = []
    for i in range(rng.integers(2, 4)):
        side = grip + i * 2.2 + rng.normal(0, 0.15)
        touch = np.array([u, v]) + 0.75 * r * np.array([np.cos(side), np.sin(side)])
        way = grip + rng.normal(0, 0.3)
        end = touch + 4 * r * np.array([np.cos(way), np.sin(way)])
        color = ball.color if own_color else tuple(rng.uniform(0.02, 0.7, 3).tolist())
        bars.append(Bar(tuple(touch), tuple(end), float(rng.uniform(0.25, 0.5) * r), color))
    how = replace(_ordinary(rng), bars=tuple(bars))
    return Shot(photograph(NORMAL, (ball,), how), NORMAL, ball)


def _shadow(seed: int) -> Shot:
    """A straight shadow's edge somewhere across the ball."""
    rng = _rng(seed)
    ball, *_ = _placed(rng)
    normal = rng.normal(size=3)
    normal /= np.linalg.norm(normal)
    d = normal @ np.array(ball.centre_camera) + RADIUS * rng.uniform(-0.5, 0.5)
    how = replace(_ordinary(rng), shadow=(*normal.tolist(), float(d)), ambient=0.15)
    return Shot(photograph(NORMAL, (ball,), how), NORMAL, ball)


def _motion(seed: int) -> Shot:
    rng = _rng(seed)
    way, length = rng.uniform(0, np.pi), rng.uniform(2, 4)
    return _plain(seed, motion_pixels=(length * np.cos(way), length * np.sin(way)))


def _own_color_behind(seed: int) -> Shot:
    """A panel of the ball's colour covers what is behind one side of it."""
    rng = _rng(seed)
    ball, u, v, _ = _placed(rng)
    side = [(u, 0, 960, 720), (0, 0, u, 720), (0, v, 960, 720), (0, 0, 960, v)][rng.integers(4)]
    how = _ordinary(rng)
    shade = float(rng.uniform(0.5, 0.9))
    color = tuple(shade * c for c in ball.color)
    how = replace(how, panels=((tuple(float(x) for x in side), color),))
    return Shot(photograph(NORMAL, (ball,), how), NORMAL, ball)


def _cut(seed: int, share: tuple[float, float]) -> Shot:
    """A ball of whose outline the share given lies outside the picture."""
    rng = _rng(seed)
    out = rng.uniform(*share)
    r = float(np.exp(rng.uniform(*np.log((14, 40)))))
    u = r * np.cos(np.pi * out) - 0.5
    v = float(rng.uniform(2 * r, 720 - 2 * r))
    at = [(u, v), (959 - u, v), (v * 960 / 720, u), (v * 960 / 720, 719 - u)][rng.integers(4)]
    ball, *_ = _placed(rng, size=(r, r), at=at)
    return Shot(photograph(NORMAL, (ball,), _ordinary(rng)), NORMAL, ball)


def _sized(seed: int, size: tuple[float, float], **changes: object) -> Shot:
    rng = _rng(seed)
    ball, *_ = _placed(rng, LARGE, size)
    fine = 3 if size[1] < 100 else 2
    how = replace(_ordinary(rng), supersampling=fine, **changes)
    return Shot(photograph(LARGE, (ball,), how), LARGE, ball)


def _aslant(seed: int, lens: Intrinsics) -> Shot:
    """Towards a corner of a wide lens."""
    rng = _rng(seed)
    at = (rng.choice([120.0, 840.0]) + rng.uniform(-40, 40), rng.choice([100, 620.0]))
    ball, *_ = _placed(rng, lens, (14.0, 45.0), at)
    return Shot(photograph(lens, (ball,), _ordinary(rng)), lens, ball)


def _cluttered(seed: int) -> Shot:
    """Boxes, bars and smaller discs all over the picture."""
    rng = _rng(seed)
    ball, *_ = _placed(rng, size=(16.0, 40.0))
    how = replace(_ordinary(rng), panels=_boxes(rng, 40))
    return Shot(photograph(NORMAL, (ball,), how), NORMAL, ball)


def _boxes(rng: np.random.Generator, count: int) -> tuple[tuple[tuple[float, ...], Color], ...]:
    low, high = np.zeros(4), np.array([960.0, 720.0, 140.0, 140.0])
    return tuple(
        (tuple(rng.uniform(low, high).tolist()), tuple(rng.uniform(0.02, 0.7, 3).tolist()))
        for _ in range(count)
    )


CONDITIONS: dict[str, Callable[[int], Shot]] = {
    "ordinary": _plain,
    "fingers": _fingers,
    "fingers of its colour": lambda seed: _fingers(seed, own_color=True),
    "shadow edge": _shadow,
    "darker than the wall": lambda s: _plain(s, background=(0.6, 0.9), ambient=0.15),
    "lighter than the wall": lambda s: _plain(s, background=(0.005, 0.02), ambient=0.5),
    "its colour behind": _own_color_behind,
    "checkerboard behind": lambda s: _plain(s, checker_pixels=23.0),
    "texture behind": lambda s: _plain(s, texture=0.3),
    "clutter behind": _cluttered,
    "motion 2-4 px": _motion,
    "noise 8": lambda s: _plain(s, noise_grey_levels=8.0),
    "JPEG 70": lambda s: _plain(s, jpeg_quality=70),
    "noise 4, blur 1, JPEG 80": lambda s: _plain(
        s, noise_grey_levels=4.0, blur_pixels=1.0, jpeg_quality=80
    ),
    "radius 8-10 px": lambda s: _sized(s, (8.0, 10.0)),
    "radius 100-200 px": lambda s: _sized(s, (100.0, 200.0)),
    "radius 200-400 px": lambda s: _sized(s, (200.0, 400.0)),
    "cut 5-20 %": lambda s: _cut(s, (0.05, 0.2)),
    "cut 20-30 %": lambda s: _cut(s, (0.2, 0.3)),
    "wide angle": lambda s: _aslant(s, WIDE),
    "fisheye": lambda s: _aslant(s, FISHEYE),
}


def _discs(seed: int) -> Shot:
    """Ends of cylinders and coins that lie aslant: ellipses of axis ratio 0.3 to 0.9."""
    rng = _rng(seed)
    return _drawn(rng, lambda image: [_ellipse(image, rng, rng.uniform(0.3, 0.9)) for _ in "12345"])


def _rings(seed: int) -> Shot:
    """Washers and tyres seen aslant: two ellipses, one in the other."""
    rng = _rng(seed)
    return _drawn(
        rng,
        lambda image: [_ellipse(image, rng, rng.uniform(0.3, 0.9), ring=True) for _ in "1234"],
    )


def _rounded(seed: int) -> Shot:
    """Boxes with rounded corners, as tools and phones have them."""
    rng = _rng(seed)

    def draw(image: Picture) -> None:
        for _ in range(6):
            x, y, w, h = (int(n) for n in rng.uniform([20, 20, 60, 60], [820, 600, 200, 160]))
            radius = int(rng.uniform(10, 0.4 * min(w, h)))
            color = [float(c) for c in rng.uniform(10, 230, 3)]
            for a, b in ((radius, 0), (0, radius)):
                cv2.rectangle(image, (x + a, y + b), (x + w - a, y + h - b), color, -1)
            for a in (x + radius, x + w - radius):
                for b in (y + radius, y + h - radius):
                    cv2.circle(image, (a, b), radius, color, -1, cv2.LINE_AA)

    return _drawn(rng, draw)


def _empty(seed: int, **changes: object) -> Shot:
    rng = _rng(seed)
    how = replace(_ordinary(rng), panels=_boxes(rng, int(rng.integers(0, 60))), **changes)
    return Shot(photograph(NORMAL, (), how), NORMAL, _placed(rng)[0])


def _drawn(rng: np.random.Generator, draw: Callable[[Picture], object]) -> Shot:
    image = photograph(NORMAL, (), _ordinary(rng))
    draw(image)
    image = cv2.GaussianBlur(image, (0, 0), 0.6)
    noisy = np.clip(image + rng.normal(0, 1.5, image.shape), 0, 255).astype(np.uint8)
    return Shot(noisy, NORMAL, _placed(rng)[0])


def _ellipse(image: Picture, rng: np.random.Generator, ratio: float, *, ring: bool = False) -> None:
    at = tuple(int(n) for n in rng.uniform([90, 90], [870, 630]) * 16)
    size, turn = rng.uniform(15, 80), rng.uniform(0, 180)
    for share in (1.0, 0.65) if ring else (1.0,):
        axes = (int(16 * share * size), int(16 * share * size * ratio))
        color = [float(c) for c in rng.uniform(10, 230, 3)]
        cv2.ellipse(image, at, axes, turn, 0, 360, color, -1, cv2.LINE_AA, 4)


NO_BALL: dict[str, Callable[[int], Shot]] = {
    "no ball: discs aslant": _discs,
    "no ball: rings aslant": _rings,
    "no ball: rounded boxes": _rounded,
    "no ball: boxes": _empty,
    "no ball: texture": lambda s: _empty(s, texture=0.5),
    "no ball: checkerboard": lambda s: _empty(s, checker_pixels=31.0),
    "no ball: noise": lambda s: _empty(s, noise_grey_levels=30.0),
}
