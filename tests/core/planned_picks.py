# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects and the plans of picks on them, as a hand with noise makes them."""

from __future__ import annotations

import numpy as np
from monocell.core.modelling.pick_plan import PickPlan
from monocell.core.shape.anchors import anchors
from monocell.core.shape.curves import curves_seen

BOX_CORNERS = tuple(f"x{x}y{y}{z}" for z in ("base", "top") for y in "-+" for x in "-+")


def corner_plan(thing, cam, names, rng=None, sigma=1.0):
    """Picks of named corners, with noise of `sigma` pixels where `rng` is given."""
    points, _ = anchors(thing.kind, thing.parameters, names)
    pixels = cam.project(thing.world_from_object.apply(points))
    if rng is not None:
        pixels = pixels + rng.normal(0, sigma, pixels.shape)
    labels = tuple(f"{thing.name}: {name}" for name in names)
    return PickPlan(pixels, tuple(names), labels=labels, sigma_pixels=sigma)


def curve_plan(thing, cam, names, count=5, rng=None, sigma=1.0):
    """`count` picks on each of the named curves where it is visible."""
    found = curves_seen(thing, cam)
    pixels, on = [], []
    for name in names:
        i = next(i for i, n in enumerate(found.names) if n == name and found.visible[i])
        t = np.linspace(*found.ends[i], count + 2)[1:-1]
        every = t[:, None] * np.ones(len(found))
        pixels.append(cam.project(thing.world_from_object.apply(found.points(every)[:, i])))
        on += [(name,)] * count
    flat = np.concatenate(pixels)
    if rng is not None:
        flat = flat + rng.normal(0, sigma, flat.shape)
    labels = tuple(f"{thing.name}: {names[0]}" for names in on)
    return PickPlan(on_curves=flat, curves=tuple(on), labels=labels, sigma_pixels=sigma)
