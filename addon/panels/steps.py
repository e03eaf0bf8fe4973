# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the four steps of the work stand: a scene in, for each a mark and what comes next out."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

from ..camera.report import Report
from ..cell.document import bare_cell, has_cell, stored_report

Mark = Literal["done", "next", "waiting", "doubt"]
FEWEST_SIGHTINGS = 3


@dataclass(frozen=True)
class Step:
    """How far one step has come, and one sentence for the operator; empty where all is said."""

    mark: Mark
    said: str = ""


def picture_step(scene: Any) -> Step:
    """The first step: a cell, with a picture behind the view."""
    if not has_cell(scene):
        return Step("next", "Open a picture or a cell document, or drop it on the view.")
    shown = scene.monocell_cell.shown_picture
    if not shown:
        return Step("doubt", "The document names no picture: add sightings with theirs.")
    cell = bare_cell(scene)
    for name in (shown, *_active_picture(scene)):
        path = cell.path_of(name)
        if not path.is_file():
            return Step("doubt", f"{path.name} is no longer in {path.parent}. Is it elsewhere?")
    return Step("done")


def camera_step(scene: Any) -> Step:
    """The second step: ball sightings, and the pose they give."""
    if not has_cell(scene):
        return Step("waiting", "Comes after the picture.")
    cell, report = bare_cell(scene), stored_report(scene)
    if report is not None and report.verdict == "failed":
        return Step("doubt", "The sightings fit no pose: see what is wrong with them below.")
    if cell.camera.camera_from_world is None:
        return Step("next", _to_calibrate(len(cell.sightings), len(cell.in_use().sightings)))
    if report is None:
        return Step("done", "The document brought the camera's pose.")
    if report.changed:
        return Step("doubt", "Sightings changed since: calibrate again.")
    if report.searched or not report.verdict:
        return Step("next", "Balls were found again: calibrate to use them.")
    return _judged(report)


def model_step(scene: Any) -> Step:
    """The third step: objects picked on the picture."""
    if not has_cell(scene):
        return Step("waiting", "Comes after the camera.")
    cell = bare_cell(scene)
    if cell.camera.camera_from_world is None:
        return Step("waiting", "Calibrate first: a picture has no scale without it.")
    if scene.monocell_cell.outdated and count_objects(scene):
        return Step("doubt", scene.monocell_cell.outdated)
    if cell.sketches:
        count = len(cell.sketches)
        return Step("next", f"{count} picked in the document: press Solve All.")
    if not count_objects(scene):
        return Step("next", "Add an object, then click on the picture.")
    return Step("done")


def use_step(scene: Any) -> Step:
    """The last step: what robot programs take."""
    if not has_cell(scene):
        return Step("waiting", "Comes after the model.")
    count = count_objects(scene)
    if not count:
        return Step("waiting", "Nothing to export yet.")
    said = "1 object" if count == 1 else f"{count} objects"
    return Step("next", f"{said} to export.")


def is_posed(scene: Any) -> bool:
    """Whether the scene has a cell whose camera has a pose."""
    return has_cell(scene) and bare_cell(scene).camera.camera_from_world is not None


def count_objects(scene: Any) -> int:
    """How many objects the scene's cell holds."""
    from ...scene.objects import is_modelled

    return sum(is_modelled(ob) for ob in scene.objects) if has_cell(scene) else 0


def _active_picture(scene: Any) -> tuple[str, ...]:
    """That of the active sighting: not all are looked up with every redraw."""
    stored = scene.monocell_cell
    rows, index = stored.sightings, stored.sighting_index
    return (rows[index].picture,) if 0 <= index < len(rows) else ()


def _to_calibrate(count: int, used: int) -> str:
    if not count:
        return "Add where the robot held the ball: three sightings or more, not in one line."
    if used < FEWEST_SIGHTINGS:
        return f"{used} of at least {FEWEST_SIGHTINGS} sightings: add more, not all in one line."
    return f"{used} sightings are ready: calibrate."


def _judged(report: Report) -> Step:
    if report.verdict == "good":
        return Step("done")
    return Step("doubt", "Calibrated, but weakly: see why below.")
