# SPDX-License-Identifier: GPL-3.0-or-later
"""The first sample's picture and truth in, one picture of every way to make a reference out.

`python docs/make_reference_pictures.py` picks on the sample as a person would, resolves the
references, and draws what came out.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path

import cv2
import numpy as np
from monocell.core import Camera, Cell
from monocell.core.arrays import Array
from monocell.core.document.cell_file import read_cell
from monocell.core.picture.overlay import HALO, PALETTE, blend_lines
from monocell.core.picture.overlay_label import Label
from monocell.core.picture.wireframe import Polyline
from monocell.core.reference import PendingReference, Reference, ReferencePlane
from monocell.core.references.resolve import resolve_references, resolved_reference
from monocell.core.references.sources import (
    AlongDirection,
    FacingCamera,
    FeatureOf,
    Intersection,
    Parallel,
    PickedPoints,
    Source,
    Stated,
    ThroughPoints,
    Upright,
)

HERE = Path(__file__).parent / "pictures"
SAMPLE = Path(__file__).parents[1] / "samples" / "01_table" / "truth.cell.json"
# left, top, width and height of the part of the picture that is shown
WINDOW = (380, 430, 640, 400)
QUALITY = 86
PLANE, LINE, MARK = PALETTE[0], PALETTE[1], PALETTE[5]
FINER = 2


@dataclass(frozen=True, eq=False)
class Shown:
    """One picture: the reference, how far to draw it (metres), and what it was made from.

    A plane is drawn from `low` to `high` along its own x and y, a line along itself.
    """

    file: str
    says: str
    kind: str
    source: Source | None
    low: tuple[float, float]
    high: tuple[float, float]
    picks: Array | None = None
    points: Array | None = None


def main() -> None:
    """Write all pictures, with what the reference's 1 sigma is."""
    cell = read_cell(SAMPLE)
    cell = _with_errors(cell)
    cell = replace(cell, references=(*cell.references, *_helpers(cell)))
    picture = cv2.imread(str(SAMPLE.parent / str(cell.picture)))
    for shown in ways(cell):
        _write(_drawn(picture.copy(), cell, shown), shown.file)


def ways(cell: Cell) -> tuple[Shown, ...]:
    """Every way, on this table."""
    things = {thing.name: thing for thing in cell.objects}
    crate, drum, tower = (things[name] for name in ("crate", "drum", "tower"))
    top = crate.corners_world()[[4, 5, 7]]
    foot = np.array([[0.56, -0.42, 0.0], [0.62, -0.17, 0.0], [0.68, 0.08, 0.0]])
    high = np.array([_top(crate), _top(drum), _top(tower)])
    spot = np.array([[0.60, 0.10, 0.0]])
    half = 0.14
    return (
        Shown("plane_stated", "given in the world", "plane", None, (0.4, -0.5), (0.9, 0.5)),
        Shown(
            *("plane_points", "through three world points", "plane"),
            *(ThroughPoints(high, 1e-3), (-0.2, -0.35), (0.2, 0.35)),
            points=high,
        ),
        Shown(
            *("plane_picks", "through picks 110 mm above the table", "plane"),
            *(PickedPoints(cell.camera.project(top), 0.11, "table"), (-0.16, -0.16), (0.16, 0.16)),
            picks=top,
        ),
        Shown(
            *("plane_feature", "a face: crate.x+", "plane"),
            *(FeatureOf("crate.x+"), (-0.06, -0.055), (0.06, 0.055)),
        ),
        Shown(
            *("plane_facing_camera", "through drum.axis, facing the camera", "plane"),
            *(FacingCamera("drum.axis"), (-0.09, -0.11), (0.09, 0.11)),
        ),
        Shown(
            *("plane_upright", "upright on a line picked on the table", "plane"),
            *(Upright(cell.camera.project(foot), "table"), (-0.27, 0.0), (0.27, 0.16)),
            picks=foot,
        ),
        Shown(
            *("plane_parallel", "parallel to the table, 150 mm above", "plane"),
            *(Parallel("table", 0.15, 5e-4), (0.48, -0.30), (0.78, 0.20)),
        ),
        Shown(
            *("line_points", "through two world points", "line"),
            *(ThroughPoints(high[[0, 2]], 1e-3), (-0.4, 0.0), (0.4, 0.0)),
            points=high[[0, 2]],
        ),
        Shown(
            *("line_upright", "upright at a pick on the table", "line"),
            *(Upright(cell.camera.project(spot), "table"), (0.0, 0.0), (0.25, 0.0)),
            picks=spot,
        ),
        Shown(
            *("line_feature", "an edge: tower.x+y-", "line"),
            *(FeatureOf("tower.x+y-"), (-0.115, 0.0), (0.115, 0.0)),
        ),
        Shown(
            *("line_axis", "an axis: drum.axis", "line"),
            *(FeatureOf("drum.axis"), (-half, 0.0), (half, 0.0)),
        ),
        Shown(
            *("line_intersection", "where two planes meet", "line"),
            *(Intersection(("wall", "level")), (-0.35, 0.0), (0.35, 0.0)),
        ),
        Shown(
            *("line_direction", "through can.centre, along table's normal", "line"),
            *(AlongDirection("can.centre", "table"), (-0.0525, 0.0), (0.22, 0.0)),
        ),
    )


def _with_errors(cell: Cell) -> Cell:
    """The truth with errors as a calibration by a ball and a model from picks state them."""
    table = replace(cell.reference("table"), source=Stated(5e-4, 1e-3))
    things = [
        replace(
            thing,
            covariance=np.diag([4e-6] * 3 + [1e-6] * (3 + len(thing.parameters))),
            by_camera=np.zeros((6 + len(thing.parameters), 6)),
        )
        for thing in cell.objects
    ]
    camera = cell.camera.placed(cell.camera.pose, np.diag([1e-8] * 3 + [2.5e-7] * 3))
    cell = replace(cell, camera=camera, objects=tuple(things), references=(table,))
    return resolve_references(cell)[0]


def _helpers(cell: Cell) -> tuple[PendingReference, ...]:
    foot = cell.camera.project([[0.56, -0.42, 0.0], [0.62, -0.17, 0.0], [0.68, 0.08, 0.0]])
    return (
        PendingReference("wall", "plane", Upright(foot, "table")),
        PendingReference("level", "plane", Parallel("table", 0.15, 5e-4)),
    )


def _top(thing: object) -> Array:
    return thing.world_from_object.apply([0.0, 0.0, thing.half_extent[2]])


def _drawn(picture: Array, cell: Cell, shown: Shown) -> Array:
    reference = _resolved(cell, shown)
    picture = cv2.resize(picture, None, fx=FINER, fy=FINER, interpolation=cv2.INTER_CUBIC)
    camera = _finer(cell.camera)
    if isinstance(shown.source, Intersection):
        for name, low, high in (
            ("wall", (-0.27, 0.0), (0.27, 0.16)),
            ("level", (0.48, -0.30), (0.78, 0.20)),
        ):
            _lay(picture, camera, resolved_reference(cell, name)[0], low, high, faint=True)
    if isinstance(reference, ReferencePlane):
        _lay(picture, camera, reference, shown.low, shown.high)
    else:
        ends = [shown.low[0], shown.high[0]]
        _stroke(picture, camera, reference.point + np.outer(ends, reference.direction), LINE, 5)
    _mark(picture, camera, shown)
    left, top, width, height = (FINER * side for side in WINDOW)
    part = picture[top : top + height, left : left + width]
    _say(part, shown, reference)
    return part


def _resolved(cell: Cell, shown: Shown) -> Reference:
    if shown.source is None:
        return cell.reference("table")
    pending = PendingReference("it", shown.kind, shown.source)
    return resolved_reference(replace(cell, references=(*cell.references, pending)), "it")[0]


def _finer(camera: Camera) -> Camera:
    """The same camera on a picture of twice the pixels, whose corner pixel's centre moves."""
    inner, shift = camera.intrinsics, (FINER - 1) / 2
    finer = replace(
        inner,
        **{key: FINER * getattr(inner, key) for key in ("width", "height", "fx", "fy")},
        **{key: FINER * getattr(inner, key) + shift for key in ("cx", "cy")},
    )
    return replace(camera, intrinsics=finer)


def _lay(
    picture: Array,
    camera: Camera,
    plane: ReferencePlane,
    low: tuple[float, float],
    high: tuple[float, float],
    *,
    faint: bool = False,
) -> None:
    """A translucent sheet with a grid of 50 mm, and the normal from its middle."""
    frame = plane.world_from_plane
    (x0, y0), (x1, y1) = low, high
    rim = np.array([[x0, y0, 0], [x1, y0, 0], [x1, y1, 0], [x0, y1, 0], [x0, y0, 0]])
    outline = camera.project(frame.apply(_fine(rim)))
    sheet = picture.copy()
    cv2.fillPoly(sheet, [np.round(outline).astype(np.int32)], PLANE, cv2.LINE_AA)
    share = 0.16 if faint else 0.36
    picture[...] = np.round(picture + share * (sheet.astype(float) - picture)).astype(np.uint8)
    for x in np.arange(np.ceil(x0 / 0.05) * 0.05, x1, 0.05):
        _stroke(picture, camera, frame.apply([[x, y0, 0], [x, y1, 0]]), PLANE, 1, 0.55)
    for y in np.arange(np.ceil(y0 / 0.05) * 0.05, y1, 0.05):
        _stroke(picture, camera, frame.apply([[x0, y, 0], [x1, y, 0]]), PLANE, 1, 0.55)
    _stroke(picture, camera, frame.apply(rim), PLANE, 2 if faint else 3)
    if not faint:
        middle = frame.apply([(x0 + x1) / 2, (y0 + y1) / 2, 0.0])
        _arrow(picture, camera, middle, middle + 0.07 * plane.normal)


def _fine(corners: Array) -> Array:
    """Straight sides cut fine, as a lens bends them."""
    share = np.linspace(0, 1, 40)[:, None]
    return np.concatenate([a + share * (b - a) for a, b in pairwise(corners)])


def _stroke(
    picture: Array, camera: Camera, corners: Array, color: tuple, width: int, share: float = 1.0
) -> None:
    line = Polyline(camera.project(_fine(corners)), True)
    if width > 1:
        blend_lines(picture, [(line, HALO)], width + 4, 0.5)
    blend_lines(picture, [(line, color)], width, share)


def _arrow(picture: Array, camera: Camera, start: Array, end: Array) -> None:
    _stroke(picture, camera, np.array([start, end]), MARK, 4)
    a, b = camera.project([start, end])
    along = (b - a) / np.linalg.norm(b - a)
    across = np.array([-along[1], along[0]])
    head = np.array([b + 12 * along, b - 6 * along + 9 * across, b - 6 * along - 9 * across])
    cv2.fillPoly(picture, [np.round(head).astype(np.int32)], MARK, cv2.LINE_AA)


def _mark(picture: Array, camera: Camera, shown: Shown) -> None:
    """Picks as rings with a cross, world points as dots."""
    for p in camera.project(shown.picks) if shown.picks is not None else ():
        at = tuple(round(float(v)) for v in p)
        for color, width in ((HALO, 7), ((255, 255, 255), 3)):
            cv2.circle(picture, at, 13, color, width, cv2.LINE_AA)
            cv2.drawMarker(picture, at, color, cv2.MARKER_CROSS, 12, max(1, width - 2))
    for p in camera.project(shown.points) if shown.points is not None else ():
        at = tuple(round(float(v)) for v in p)
        cv2.circle(picture, at, 12, HALO, -1, cv2.LINE_AA)
        cv2.circle(picture, at, 9, (255, 255, 255), -1, cv2.LINE_AA)


def _say(part: Array, shown: Shown, reference: Reference) -> None:
    lines = [shown.says]
    if reference.covariance is not None:
        tilt, place = (
            float(np.sqrt(np.linalg.eigvalsh(reference.covariance[rows, rows])[-1]))
            for rows in (slice(0, 3), slice(3, 6))
        )
        lines.append(f"± {1e3 * place:.1f} mm, ± {np.degrees(tilt):.2f} degrees")
    Label(tuple(lines), PLANE if shown.kind == "plane" else LINE, 20).draw(part, 20, 20)


def _write(part: Array, name: str) -> None:
    size = (part.shape[1] // FINER, part.shape[0] // FINER)
    small = cv2.resize(part, size, interpolation=cv2.INTER_AREA)
    cv2.imwrite(str(HERE / f"{name}.jpg"), small, [cv2.IMWRITE_JPEG_QUALITY, QUALITY])


if __name__ == "__main__":
    main()
