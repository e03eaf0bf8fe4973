# SPDX-License-Identifier: GPL-3.0-or-later
"""A lens calibration in, its report as lines, as JSON values or as overlay pictures out."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ..core.camera import Camera
from ..core.document.entries import camera_entry
from ..core.lens.calibrate_lens import LensCalibration, PictureReport
from ..core.lens.model_choice import ModelScore
from ..core.lens.parameters import parameter_names, parameters_of
from .told import pairs, table

# where the error of the lens is told as a length
TOLD_AT = 2.0


def document(calibration: LensCalibration) -> dict[str, Any]:
    """The whole report as JSON values; angles in degrees and pixels by name."""
    quality, fit = calibration.quality, calibration.fit
    return {
        "verdict": calibration.verdict,
        "warnings": calibration.warnings,
        "camera": camera_entry(Camera(calibration.lens)),
        "sigma": quality.sigmas(),
        "parameters": parameter_names(calibration.lens.distortion.model),
        "covariance": fit.covariance,
        "rms_pixels": fit.rms_pixels,
        "noise_pixels": fit.noise_pixels,
        "disagreement": fit.disagreement,
        "corner_error_at_2_m": quality.corner_error(TOLD_AT),
        "covered": quality.covered,
        "tilts_degrees": np.degrees(quality.tilts),
        "distances": quality.distances,
        "radial_residuals_pixels": [
            {"inner": r.inner, "outer": r.outer, "outward": r.outward, "sigma": r.sigma}
            for r in quality.rings
        ],
        "board": str(calibration.board),
        "models": [_model_entry(one) for one in calibration.models],
        "pictures": [vars(report) for report in calibration.pictures],
    }


def tell(calibration: LensCalibration) -> None:
    """The report for a person."""
    lens, quality, fit = calibration.lens, calibration.quality, calibration.fit
    model = lens.distortion.model
    corners = sum(len(view.pixels) for view in fit.views)
    tilts, distances = np.degrees(quality.tilts), quality.distances
    rows = [
        ("verdict", calibration.verdict),
        ("lens", f"{lens.width} x {lens.height} px, distortion {model}"),
        *_parameters(calibration),
        ("rms", f"{fit.rms_pixels:.3f} px over {corners} corners of {len(fit.views)} pictures"),
        ("agreement", f"pictures pull {fit.disagreement:.1f} times as far as their noise explains"),
        ("at the rim", _rim(calibration)),
        (f"at {TOLD_AT:g} m", _error_at(quality.corner_error(TOLD_AT))),
        (
            "boards",
            f"tilted {tilts.min():.0f} to {tilts.max():.0f} deg, {distances.min():.2f} to "
            f"{distances.max():.2f} m away, covering {100 * quality.covered:.0f} % of the picture",
        ),
    ]
    print(pairs(rows))
    if calibration.models:
        print(f"\n{_models(calibration)}")
    header = ("picture", "corners", "rms px", "blur px", "status")
    print(f"\n{table(header, _pictures(calibration))}")
    reasons = [(Path(r.picture).name, r.reason) for r in calibration.pictures if r.reason]
    if reasons:
        print(f"\n{pairs(reasons)}")


def draw(calibration: LensCalibration, folder: Path) -> None:
    """Each used picture with its corners and residuals, and all corners in one, as PNG files."""
    from ..core.atomic import made_folder
    from ..core.lens.lens_overlay import draw_coverage, draw_view, residual_gain
    from ..core.picture.pictures import read_picture
    from .pictures import write_picture

    made_folder(folder)
    fit = calibration.fit
    gain = residual_gain(fit)
    taken: set[str] = {"coverage"}
    for i, view in enumerate(fit.views):
        name = _free(Path(view.picture).stem, taken)
        picture = read_picture(view.picture, fit.lens)
        write_picture(folder / f"{name}.png", draw_view(picture, fit, i, gain))
    write_picture(folder / "coverage.png", draw_coverage(fit, gain))


def _model_entry(one: ModelScore) -> dict[str, Any]:
    return {
        "model": one.model,
        "coefficients": one.coefficients,
        "rms_pixels": one.rms_pixels,
        "unseen_rms_pixels": one.unseen_rms_pixels,
        "images_the_corners": one.whole,
    }


def _free(stem: str, taken: set[str]) -> str:
    """A name that no other picture of the folder has."""
    name, count = stem, 2
    while name in taken:
        name, count = f"{stem}_{count}", count + 1
    taken.add(name)
    return name


def _parameters(calibration: LensCalibration) -> list[tuple[str, str]]:
    sigmas = calibration.quality.sigmas()
    names = parameter_names(calibration.lens.distortion.model)
    rows = []
    for name, value in zip(names, parameters_of(calibration.lens), strict=True):
        pixels = name in ("fx", "fy", "cx", "cy")
        digits, unit = (2, " px") if pixels else (5, "")
        told = f"{value:.{digits}f}"
        if sigmas is not None:
            told += f" ± {sigmas[name]:.{digits}f}"
        if sigmas is not None and sigmas[name] == 0:
            told = f"{value:g}, given"
        rows.append((name, told + unit))
    return rows


def _rim(calibration: LensCalibration) -> str:
    rings = calibration.quality.rings
    if not rings:
        return "too few corners to look for a pattern"
    last = rings[-1]
    return (
        f"corners {last.inner:.0f} to {last.outer:.0f} px from the middle lie "
        f"{last.outward:+.3f} ± {last.sigma:.3f} px farther out than expected"
    )


def _error_at(error: float | None) -> str:
    if error is None:
        return "unknown: the lens images nothing in the picture's corners"
    return f"a point in the picture's corner is off by {1e3 * error:.2f} mm (1 sigma)"


def _models(calibration: LensCalibration) -> str:
    def unseen(one: ModelScore) -> str:
        error = one.unseen_rms_pixels
        return f"{error:.3f}" if np.isfinite(error) else "folds"

    chosen = calibration.lens.distortion.model
    held = calibration.fit.held
    rows = [
        (
            one.name + (" (taken)" if one.model == chosen and one.fit.held == held else ""),
            str(one.coefficients),
            f"{one.rms_pixels:.3f}",
            unseen(one),
        )
        for one in calibration.models
    ]
    return table(("model", "coefficients", "rms px", "unseen px"), rows)


def _pictures(calibration: LensCalibration) -> list[tuple[str, ...]]:
    def row(report: PictureReport) -> tuple[str, ...]:
        rms = "" if report.rms_pixels is None else f"{report.rms_pixels:.3f}"
        blur = "" if report.blur_pixels is None else f"{report.blur_pixels:.1f}"
        return (Path(report.picture).name, str(report.corners or ""), rms, blur, report.status)

    return [row(report) for report in calibration.pictures]
