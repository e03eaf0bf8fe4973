# SPDX-License-Identifier: GPL-3.0-or-later
"""Which part of a 3D viewport shows the picture: an area and a place in it in, its region out.

A quad view has four regions, each with a view, a zoom and an offset of its own; the usual viewport
has one.
"""

from __future__ import annotations

from typing import Any

from ...core.errors import InvalidValue


def looks_through(scene: Any, space: Any, view: Any) -> bool:
    """Whether the `view` of a region of a viewport goes through the cell's own camera."""
    camera = space.camera if space.use_local_camera else scene.camera
    return (
        view.view_perspective == "CAMERA"
        and camera is not None
        and camera == scene.monocell_cell.camera
    )


def view_of(space: Any, region: Any) -> Any:
    """The view of a region; only a quad view's regions know their own in every Blender."""
    return region.data if space.region_quadviews else space.region_3d


def camera_region(scene: Any, area: Any, place: tuple[int, int] | None = None) -> Any | None:
    """The region of a 3D viewport that looks through the cell's camera, None without one.

    Of several the one with the `place` (x, y) in window pixels, else the first.
    """
    space = area.spaces.active
    regions = window_regions(area)
    looking = [r for r in regions if looks_through(scene, space, view_of(space, r))]
    under = (r for r in looking if place is not None and _contains(r, *place))
    return next(under, looking[0] if looking else None)


def picking_region(context: Any, place: tuple[int, int]) -> Any:
    """The region to pick in, where an operator starts. Raises InvalidValue without a picture."""
    scene, space = context.scene, context.space_data
    region = None
    if space is not None and space.type == "VIEW_3D":
        region = camera_region(scene, context.area, place)
    if region is None:
        raise InvalidValue("Look through the cell's camera first: picks are made there")
    if not scene.monocell_cell.camera.visible_get(viewport=space):
        raise InvalidValue(
            "The cell's camera is hidden here, and its picture with it: press Look Through"
        )
    return region


def region_under(area: Any, place: tuple[int, int]) -> Any:
    """The region of a 3D viewport at a `place` in window pixels, or else its last."""
    regions = window_regions(area)
    return next((region for region in regions if _contains(region, *place)), regions[-1])


def window_regions(area: Any) -> list[Any]:
    """The regions of a 3D viewport that show the scene; the last is the one that turns freely."""
    return [region for region in area.regions if region.type == "WINDOW"]


def hidden_names(scene: Any, space: Any) -> frozenset[str]:
    """What the document calls the objects that a viewport does not show, local view included."""
    from ...scene.objects import document_name, is_modelled

    modelled = (ob for ob in scene.objects if is_modelled(ob))
    return frozenset(document_name(ob) for ob in modelled if not ob.visible_get(viewport=space))


def _contains(region: Any, x: int, y: int) -> bool:
    return 0 <= x - region.x < region.width and 0 <= y - region.y < region.height
