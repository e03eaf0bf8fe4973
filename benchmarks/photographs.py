# SPDX-License-Identifier: GPL-3.0-or-later
"""What a camera makes of rendered light: blur, noise, sRGB, 8 bits and JPEG; files and a cell out.

    cell = photograph_rig(rig, Development(noise_grey_levels=4, jpeg_quality=80), folder)

The cell is what a user would hand in: pictures, intrinsics, radius and positions, and no pose.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import cv2
import numpy as np
from monocell.core.camera import Camera
from monocell.core.cell import Cell
from monocell.core.intrinsics import Intrinsics
from monocell.core.sighting import SphereSighting
from monocell.headless.pictures import write_picture
from rendered_rigs import RenderedRig
from rig_plans import RADIUS, RigPlan

# linear light of an encoded value of one half, and what one unit of light is there in code
MIDDLE, CODE_BY_LIGHT = 0.214, 1.08
READ_SHARE = 0.1
# of what stands in the ball's surroundings this share stays below this part of white
SPARED, WHITE = 0.99, 0.95


@dataclass(frozen=True)
class Development:
    """From light on the lens to a file.

    `blur_pixels` is the sigma of the lens' blur and `motion_pixels` the length of a straight shake;
    `noise_grey_levels` the sigma of the noise at middle grey, alike everywhere in the encoded
    picture, or with `photons` as light itself has it: more in bright places, less in dark ones.
    `halved` bins 2 x 2 pixels. `jpeg_quality` None is a PNG. `burnt` exposes for the room, whatever
    becomes of the ball: where light ends at white, a bright ball's outline moves out by a tenth of
    a pixel. Otherwise the exposure spares the ball, as a photographer's does.
    """

    blur_pixels: float = 0.5
    motion_pixels: float = 0.0
    noise_grey_levels: float = 1.0
    photons: bool = False
    jpeg_quality: int | None = None
    halved: bool = False
    burnt: bool = False

    def told(self) -> str:
        """In a few words."""
        parts = [f"blur {self.blur_pixels:.1f}", f"noise {self.noise_grey_levels:.1f}"]
        parts[1] += "p" if self.photons else ""
        parts += [f"motion {self.motion_pixels:.1f}"] if self.motion_pixels else []
        parts += ["png" if self.jpeg_quality is None else f"jpeg {self.jpeg_quality}"]
        parts += [name for name in ("halved", "burnt") if getattr(self, name)]
        return " ".join(parts)


def random_development(seed: int) -> Development:
    """Any camera that a user may come with."""
    rng = np.random.default_rng([11, seed])
    return Development(
        blur_pixels=float(rng.uniform(0.3, 1.2)),
        motion_pixels=float(rng.uniform(1, 3)) if rng.random() < 0.2 else 0.0,
        noise_grey_levels=float(rng.uniform(0, 8)),
        photons=bool(rng.random() < 0.5),
        jpeg_quality=[None, 95, 90, 80, 70][rng.integers(5)],
        halved=bool(rng.random() < 0.15),
        burnt=bool(rng.random() < 0.2),
    )


def photograph_rig(rig: RenderedRig, how: Development, folder: Path) -> Cell:
    """Write each sighting's picture into `folder` and return the cell that a user would send."""
    ending = "png" if how.jpeg_quality is None else "jpg"
    sightings = []
    for i, place in enumerate(rig.plan.positions):
        name = f"pose_{i:02d}.{ending}"
        picture = developed(rig.light(i), exposure_gain(rig, how), how, (rig.plan.seed, i))
        if how.jpeg_quality is None:
            write_picture(folder / name, picture)
        else:
            (folder / name).write_bytes(_jpeg(picture, how.jpeg_quality))
        sightings.append(SphereSighting(name, place, RADIUS))
    camera = Camera(given_intrinsics(rig.plan, how))
    return Cell(camera, sightings=tuple(sightings), folder=folder)


def given_intrinsics(plan: RigPlan, how: Development) -> Intrinsics:
    """Those of the picture as it is written."""
    lens = plan.camera.intrinsics
    if not how.halved:
        return lens
    return replace(
        lens,
        width=lens.width // 2,
        height=lens.height // 2,
        fx=lens.fx / 2,
        fy=lens.fy / 2,
        # the centre of the first pixel of two lies between them
        cx=(lens.cx + 0.5) / 2 - 0.5,
        cy=(lens.cy + 0.5) / 2 - 0.5,
    )


def exposure_gain(rig: RenderedRig, how: Development) -> float:
    """What brings the middle brightness of the empty picture to the plan's exposure, or less."""
    middle = float(np.median(rig.background.astype(np.float32).mean(axis=2)))
    gain = rig.plan.exposure / middle
    if how.burnt:
        return gain
    around = [patches[-1].light.reshape(-1, 3).max(axis=1) for patches in rig.patches]
    brightest = float(np.quantile(np.concatenate(around).astype(np.float32), SPARED))
    return min(gain, WHITE / brightest)


def developed(
    light: np.ndarray, gain: float, how: Development, seed: tuple[int, int]
) -> np.ndarray:
    """Linear light (H, W, 3) red, green, blue to 8-bit sRGB (H, W, 3) blue, green, red."""
    rng = np.random.default_rng([7, *seed])
    seen = light[:, :, ::-1] * np.float32(gain)
    if how.halved:
        h, w = (n // 2 * 2 for n in seen.shape[:2])
        seen = seen[:h, :w].reshape(h // 2, 2, w // 2, 2, 3).mean(axis=(1, 3))
    if how.blur_pixels > 0:
        seen = cv2.GaussianBlur(seen, (0, 0), how.blur_pixels)
    if how.motion_pixels > 0:
        shake = _shake(how.motion_pixels, rng.uniform(0, np.pi))
        seen = cv2.filter2D(seen, -1, shake, borderType=cv2.BORDER_REPLICATE)
    noise = rng.normal(0, how.noise_grey_levels / 255, seen.shape).astype(np.float32)
    if how.photons:
        share = READ_SHARE + (1 - READ_SHARE) * seen / MIDDLE
        seen = seen + noise / CODE_BY_LIGHT * np.sqrt(np.maximum(share, 0))
        noise = np.zeros(1, np.float32)
    return np.clip(np.rint(255 * (_encoded(seen) + noise)), 0, 255).astype(np.uint8)


def as_file_gives(picture: np.ndarray, how: Development) -> np.ndarray:
    """The picture as it is read back from its file."""
    if how.jpeg_quality is None:
        return picture
    data = np.frombuffer(_jpeg(picture, how.jpeg_quality), np.uint8)
    return cv2.imdecode(data, cv2.IMREAD_COLOR)


def _jpeg(picture: np.ndarray, quality: int) -> bytes:
    _, data = cv2.imencode(".jpg", picture, [cv2.IMWRITE_JPEG_QUALITY, quality])
    return data.tobytes()


def _encoded(light: np.ndarray) -> np.ndarray:
    seen = np.clip(light, 0.0, 1.0)
    return np.where(seen <= 0.0031308, 12.92 * seen, 1.055 * seen ** (1 / 2.4) - 0.055)


def _shake(length: float, angle: float) -> np.ndarray:
    """A straight line through the middle, its points shared among the pixels around them."""
    half = int(np.ceil(length / 2)) + 1
    kernel = np.zeros((2 * half + 1, 2 * half + 1))
    along = (np.arange(201) / 200 - 0.5) * length
    for u, v in zip(half + along * np.cos(angle), half + along * np.sin(angle), strict=True):
        x, y = int(u), int(v)
        a, b = u - x, v - y
        kernel[y : y + 2, x : x + 2] += np.outer([1 - b, b], [1 - a, a])
    return kernel / kernel.sum()
