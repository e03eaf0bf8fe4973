# SPDX-License-Identifier: GPL-3.0-or-later
"""Honest pictures with Cycles: a scene and a camera go in, a PNG or linear light comes out.

No denoiser (it moves edges by 0.1 px), a filter of exactly one pixel, no dither, the 'Standard'
view (plain sRGB), a fixed seed. A lens distortion is not modelled by every Blender: the perfect
picture is rendered finer and resampled over the area of each distorted pixel.
"""

from __future__ import annotations

import math
import tempfile
from pathlib import Path
from typing import Any

import bpy
import numpy as np

from ..core.arrays import Array
from ..core.atomic import atomic_path
from ..core.camera import Camera
from ..core.errors import InvalidValue, RenderFailed
from ..core.intrinsics import Intrinsics
from ..core.picture.undistortion import (
    distorted_picture,
    distorted_window,
    pinhole_around,
    window_behind,
)
from .blender_camera import place_camera
from .quiet import quiet_stdout

CAMERA_NAME = "monocell camera"
# how much finer the perfect picture is than the distorted one, along each side
FINER = 2
CUT = 0.01


def set_up_cycles(scene: Any, *, samples: int, bounces: int = 2) -> None:
    """Cycles on the processor, as honest and as quick as it gets.

    Sampling is adaptive: `samples` is the most that a pixel gets.
    """
    render, cycles = scene.render, scene.cycles
    render.engine = "CYCLES"
    cycles.device = "CPU"
    cycles.samples, cycles.seed, cycles.use_animated_seed = samples, 0, False
    # Debian's builds have no denoiser and fail when it is left on
    cycles.use_denoising = False
    cycles.use_adaptive_sampling, cycles.adaptive_threshold = samples > 8, 0.02
    cycles.pixel_filter_type = "BOX"
    cycles.max_bounces, cycles.diffuse_bounces, cycles.glossy_bounces = bounces, bounces, bounces
    cycles.transmission_bounces = cycles.volume_bounces = cycles.transparent_max_bounces = 0
    cycles.caustics_reflective = cycles.caustics_refractive = False
    cycles.use_auto_tile = False
    render.use_motion_blur = render.use_border = render.use_compositing = False
    render.use_sequencer, render.film_transparent = False, False
    render.dither_intensity = 0.0
    # no dates or file names of the user inside the picture: the same scene is the same file
    for name in (p.identifier for p in render.bl_rna.properties):
        if name.startswith("use_stamp"):
            setattr(render, name, False)
    view = scene.view_settings
    view.view_transform, view.look, view.exposure, view.gamma = "Standard", "None", 0.0, 1.0
    scene.display_settings.display_device = "sRGB"


def render_picture(
    scene: Any, camera: Camera, path: str | Path, *, samples: int, bounces: int = 2
) -> None:
    """Render what `camera` sees, distortion included, to an 8-bit sRGB PNG.

    The file is written whole or not at all. Raises NoPose, RenderFailed when Cycles gives no
    picture, and InvalidValue for a field of view that no flat picture can hold.
    """
    set_up_cycles(scene, samples=samples, bounces=bounces)
    if camera.intrinsics.distortion.model == "none":
        _place(scene, camera)
        with atomic_path(path) as temporary:
            _render(scene, temporary, "PNG", "8")
        return
    linear = _distorted(scene, camera, samples=samples)
    with atomic_path(path) as temporary:
        _write_png(linear, temporary)


def render_linear(
    scene: Any,
    camera: Camera,
    *,
    samples: int,
    bounces: int = 2,
    window: tuple[int, int, int, int] | None = None,
) -> Array:
    """Render what `camera` sees as linear light, (H, W, 3) float32, rows from the top.

    `window` (x, y, width, height) in pixels renders only that part; the rest stays black. It is
    ignored for a camera with distortion.
    """
    set_up_cycles(scene, samples=samples, bounces=bounces)
    if camera.intrinsics.distortion.model != "none":
        return _distorted(scene, camera, samples=samples)
    _place(scene, camera)
    if window is not None:
        _set_border(scene.render, window)
    linear = _linear(scene)
    scene.render.use_border = False
    return linear


def render_window(
    scene: Any,
    camera: Camera,
    window: tuple[int, int, int, int],
    *,
    samples: int,
    bounces: int = 2,
) -> Array:
    """What `camera` sees in `window` (x, y, width, height) of its picture as linear light.

    (height, width, 3) float32, rows from the top, distortion included; nothing else is rendered.
    Raises as `render_linear`, and InvalidValue for a window that is not inside the picture.
    """
    set_up_cycles(scene, samples=samples, bounces=bounces)
    intrinsics = camera.intrinsics
    x, y, width, height = window
    if min(x, y) < 0 or min(width, height) < 1 or not _ends_inside(intrinsics, window):
        raise InvalidValue(
            f"window: {list(window)} is not inside the picture of "
            f"{intrinsics.width} x {intrinsics.height} px"
        )
    if intrinsics.distortion.model == "none":
        return _cropped(scene, camera, window)
    pinhole = pinhole_around(intrinsics, FINER)
    behind = window_behind(pinhole, intrinsics, window)
    scene.cycles.samples = math.ceil(samples / FINER**2)
    scene.cycles.use_adaptive_sampling = False
    perfect = _cropped(scene, Camera(pinhole, camera.pose), behind)
    return distorted_window(perfect, behind[:2], pinhole, intrinsics, window)


def _ends_inside(intrinsics: Intrinsics, window: tuple[int, int, int, int]) -> bool:
    x, y, width, height = window
    return x + width <= intrinsics.width and y + height <= intrinsics.height


def _cropped(scene: Any, camera: Camera, window: tuple[int, int, int, int]) -> Array:
    _place(scene, camera)
    _set_border(scene.render, window)
    scene.render.use_crop_to_border = True
    try:
        light = _linear(scene)
    finally:
        scene.render.use_border = scene.render.use_crop_to_border = False
    if light.shape[:2] != (window[3], window[2]):
        raise RenderFailed(f"Cycles gave {light.shape[1]} x {light.shape[0]} px for {list(window)}")
    return light


def _distorted(scene: Any, camera: Camera, *, samples: int) -> Array:
    pinhole = pinhole_around(camera.intrinsics, FINER)
    _place(scene, Camera(pinhole, camera.pose))
    scene.cycles.samples = math.ceil(samples / FINER**2)
    scene.cycles.use_adaptive_sampling = False
    return distorted_picture(_linear(scene), pinhole, camera.intrinsics)


def _place(scene: Any, camera: Camera) -> None:
    if scene.camera is None:
        ob = bpy.data.objects.new(CAMERA_NAME, bpy.data.cameras.new(CAMERA_NAME))
        scene.collection.objects.link(ob)
        scene.camera = ob
    place_camera(scene.camera, scene.render, camera.intrinsics, camera.pose)
    scene.camera.data.dof.use_dof = False
    scene.camera.data.clip_start, scene.camera.data.clip_end = 0.01, 1000.0


def _set_border(render: Any, window: tuple[int, int, int, int]) -> None:
    x, y, width, height = window
    w, h = render.resolution_x, render.resolution_y
    # Blender cuts to whole pixels after rounding to single precision: a little more is safe
    low, high = x + CUT, x + width + CUT
    render.border_min_x, render.border_max_x = low / w, high / w
    # and it counts rows from below
    low, high = h - y - height + CUT, h - y + CUT
    render.border_min_y, render.border_max_y = low / h, high / h
    render.use_border, render.use_crop_to_border = True, False


def _linear(scene: Any) -> Array:
    """Render to a temporary 32-bit EXR, the one way to the float values in every Blender."""
    with tempfile.TemporaryDirectory(prefix="monocell-") as folder:
        path = Path(folder) / "linear.exr"
        _render(scene, path, "OPEN_EXR", "32")
        image = bpy.data.images.load(str(path))
        try:
            width, height = image.size
            values = np.empty(width * height * image.channels, np.float32)
            image.pixels.foreach_get(values)
            return values.reshape(height, width, -1)[::-1, :, :3].copy()
        finally:
            bpy.data.images.remove(image)


def _render(scene: Any, path: Path, file_format: str, depth: str) -> None:
    render = scene.render
    settings = render.image_settings
    if hasattr(settings, "media_type"):
        settings.media_type = "IMAGE"
    settings.file_format, settings.color_mode, settings.color_depth = file_format, "RGB", depth
    # a temporary file is read at once: packing it would only take time
    settings.exr_codec, settings.compression = "NONE", 15
    render.use_file_extension, render.use_overwrite = False, True
    render.filepath = str(path)
    # so that an old file is not taken for the new picture
    path.unlink(missing_ok=True)
    with quiet_stdout():
        bpy.ops.render.render(write_still=True, scene=scene.name)
    if not path.exists():
        raise RenderFailed(f"{path.name}: Cycles gave no picture; is the disk full?")


def _write_png(linear: Array, path: Path) -> None:
    height, width = linear.shape[:2]
    image = bpy.data.images.new("monocell picture", width, height, alpha=False)
    try:
        rows = np.ones((height, width, 4), np.float32)
        rows[:, :, :3] = encoded_srgb(linear)[::-1]
        image.pixels.foreach_set(rows.ravel())
        image.file_format, image.filepath_raw = "PNG", str(path)
        image.save()
    finally:
        bpy.data.images.remove(image)


def encoded_srgb(linear: Array) -> Array:
    """Linear light to sRGB values from 0 to 1 (IEC 61966-2-1), what 'Standard' shows."""
    light = np.clip(linear, 0.0, 1.0)
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
