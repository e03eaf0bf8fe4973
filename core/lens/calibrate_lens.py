# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of a board in, the lens with its errors, a status a picture and a verdict out."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

from numpy.typing import NDArray

from ..errors import BoardNotFound, InvalidValue, NotConverged, PictureError, TooFewPictures
from ..intrinsics import Intrinsics
from .board import Board, CharucoBoard
from .bundle import LensFit, fit_lens, subset
from .detection import find_board, seen_pattern
from .hints import seen_instead
from .model_choice import MODELS, ModelScore, best_model, score
from .outvoting import outvoted
from .quality import LensQuality
from .starts import first_fit, without_k3
from .verdict import Verdict, verdict_of
from .view import BoardView, moved_pixels

Status = Literal["used", "rejected"]
FEWEST_PICTURES = 3
# pictures without a board that are searched for another one
HINTED = 3
# a board whose corners moved less than so many pixels did not move
STILL = 1.0
Read = Callable[[str], NDArray[Any]]


@dataclass(frozen=True, eq=False)
class PictureReport:
    """One picture: used or rejected and why, its corners, and how far they are off (pixels)."""

    picture: str
    status: Status
    reason: str = ""
    corners: int = 0
    rms_pixels: float | None = None
    blur_pixels: float | None = None


@dataclass(frozen=True, eq=False)
class LensCalibration:
    """A lens with its fit, verdict and warnings, each picture's report, and the models compared.

    `board` is the board as it was seen: of a ChArUco board the pattern may be the old one.
    """

    fit: LensFit
    quality: LensQuality
    verdict: Verdict
    warnings: tuple[str, ...]
    pictures: tuple[PictureReport, ...]
    models: tuple[ModelScore, ...]
    board: Board

    @property
    def lens(self) -> Intrinsics:
        """The intrinsics found."""
        return self.fit.lens


def calibrate_lens(
    names: Sequence[str],
    read: Read,
    board: Board,
    model: str = "auto",
    *,
    watch: Callable[[str], None] = lambda _: None,
) -> LensCalibration:
    """Calibrate a lens from pictures of a board; `read` gives the pixels of a named picture.

    `model` is a distortion model, or `auto`: the smallest that foretells unseen corners as well as
    the best. Pictures without a usable board, of another size than most, or that contradict the
    others are rejected and named. `watch` is told each picture and model before it is worked on.

    Raises TooFewPictures for fewer than three usable ones, BoardNotFound where no picture shows the
    board (with the board that was seen instead), InvalidValue for an unknown model.
    """
    if model != "auto" and model not in MODELS:
        raise InvalidValue(f"--model {model}: is none of auto, {', '.join(MODELS)}")
    views, reports, board, size = _seen(names, read, board, watch)
    _refuse_few(views, reports, names, read, board)
    fits = _fits(views, size, MODELS if model == "auto" else (model,), watch)
    scores: tuple[ModelScore, ...] = ()
    if model == "auto":
        fit, scores = _chosen(fits)
    else:
        fit = fits[0]
    fit, off = outvoted(fit)
    for i, rms in off.items():
        reports[views[i].picture] = _outvoted_report(views[i], rms, fit)
    for view, rms in zip(fit.views, fit.rms_of_views, strict=True):
        reports[view.picture] = replace(_report(view), rms_pixels=float(rms))
    quality = LensQuality.of(fit)
    verdict, warnings = verdict_of(fit, quality, [views[i].picture for i in off])
    told = _rejections([r for r in reports.values() if r.status == "rejected"], len(names))
    pictures = tuple(reports[name] for name in dict.fromkeys(names))
    return LensCalibration(fit, quality, verdict, (*told, *warnings), pictures, scores, board)


def _seen(
    names: Sequence[str], read: Read, board: Board, watch: Callable[[str], None]
) -> tuple[list[BoardView], dict[str, PictureReport], Board, tuple[int, int]]:
    """What every picture shows, those of the most frequent size being views."""
    found: dict[str, BoardView] = {}
    sizes: dict[str, tuple[int, int]] = {}
    reports: dict[str, PictureReport] = {}
    decided = False
    for name in dict.fromkeys(names):
        watch(name)
        try:
            picture = read(name)
            if not decided:
                board = seen_pattern(picture, board)
            found[name] = find_board(picture, board, name)
            sizes[name], decided = (picture.shape[1], picture.shape[0]), True
        except (PictureError, BoardNotFound) as error:
            reports[name] = PictureReport(name, "rejected", _bare(str(error), name))
    if not found:
        return [], reports, board, (0, 0)
    size = Counter(sizes.values()).most_common(1)[0][0]
    for name in [name for name in found if sizes[name] != size]:
        other, told = sizes[name], f"{size[0]} x {size[1]}"
        reason = f"other size: {other[0]} x {other[1]} px, most are {told}"
        reports[name] = replace(_report(found.pop(name)), status="rejected", reason=reason)
    return _moved(list(found.values()), reports), reports, board, size


def _moved(views: Sequence[BoardView], reports: dict[str, PictureReport]) -> list[BoardView]:
    """Views without those of a board that stands where it stood in an earlier picture.

    They repeat each other's errors: counted as new, they would make the stated sigmas too small.
    """
    kept: list[BoardView] = []
    for view in views:
        same = next((other for other in kept if moved_pixels(view, other) < STILL), None)
        if same is None:
            kept.append(view)
            continue
        reason = f"the same view as {same.picture}: move the board or the camera between pictures"
        reports[view.picture] = replace(_report(view), status="rejected", reason=reason)
    return kept


def _refuse_few(
    views: Sequence[BoardView],
    reports: dict[str, PictureReport],
    names: Sequence[str],
    read: Read,
    board: Board,
) -> None:
    if len(views) >= FEWEST_PICTURES:
        return
    rejected = [report for report in reports.values() if report.status == "rejected"]
    first = f"{rejected[0].picture}: {rejected[0].reason}" if rejected else "give more pictures"
    count = len(dict.fromkeys(names))
    if views:
        raise TooFewPictures(
            f"{len(views)} of {count} pictures show the {board} well enough, at least "
            f"{FEWEST_PICTURES} are needed ({first})"
        )
    hint = _hint([r.picture for r in rejected], read, board)
    raise BoardNotFound(f"no picture of {count} shows a usable {board}; {hint or first}")


def _hint(names: Sequence[str], read: Read, board: Board) -> str | None:
    for name in names[:HINTED]:
        try:
            instead = seen_instead(read(name), board)
        except PictureError:
            continue
        if instead is not None:
            return f"in {name} {instead}"
    return None


def _fits(
    views: Sequence[BoardView],
    size: tuple[int, int],
    models: Sequence[str],
    watch: Callable[[str], None],
) -> list[LensFit]:
    fits, refusals = [], []
    for model in models:
        watch(model)
        try:
            fits.append(first_fit(views, size, model))
            if model == "plumb_bob" and len(models) > 1:
                fits.append(without_k3(fits[-1]))
        except (NotConverged, InvalidValue) as error:
            refusals.append(error)
    if not fits:
        raise refusals[0]
    return fits


def _chosen(fits: Sequence[LensFit]) -> tuple[LensFit, tuple[ModelScore, ...]]:
    """The fit of the model that the pictures ask for, contradicting pictures set aside before."""
    # the median is not impressed by a picture that contradicts the others
    roughly = min(fits, key=lambda fit: float(sorted(fit.rms_of_views)[len(fit.views) // 2]))
    _, off = outvoted(roughly)
    kept = [i for i in range(len(roughly.views)) if i not in off]
    scores = tuple(score(_refitted(fit, kept)) for fit in fits)
    return fits[scores.index(best_model(scores))], scores


def _refitted(fit: LensFit, kept: Sequence[int]) -> LensFit:
    return fit if len(kept) == len(fit.views) else fit_lens(subset(fit, kept))


def _report(view: BoardView) -> PictureReport:
    return PictureReport(view.picture, "used", "", len(view.numbers), None, view.blur_pixels)


def _outvoted_report(view: BoardView, rms: float, fit: LensFit) -> PictureReport:
    usual = float(sorted(fit.rms_of_views)[len(fit.views) // 2])
    return replace(
        _report(view),
        status="rejected",
        reason=f"outvoted: {rms:.2f} px off under the lens of the others, which are {usual:.2f}",
        rms_pixels=rms,
    )


def _rejections(rejected: Sequence[PictureReport], count: int) -> tuple[str, ...]:
    if not rejected:
        return ()
    first = rejected[0]
    return (f"{len(rejected)} of {count} pictures rejected: {first.picture}: {first.reason}",)


def _bare(message: str, name: str) -> str:
    """A reason without the name of its picture, which the report has beside it."""
    return message.removeprefix(f"{name}: ")


def pattern_told(board: Board, asked: Board) -> str | None:
    """What to tell of a ChArUco board whose pattern is not the one that was asked for."""
    if not isinstance(board, CharucoBoard) or board == asked:
        return None
    age = "of before OpenCV 4.6" if board.legacy else "of OpenCV 4.6 and later"
    return f"the board has the pattern {age}: that one was used"
