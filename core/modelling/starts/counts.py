# SPDX-License-Identifier: GPL-3.0-or-later
"""How many equations picks give, and how many numbers they have to tell: too few are refused."""

from __future__ import annotations

from collections.abc import Mapping

from ...errors import PickError
from ...sketch import Sketch
from .found import sketch_sizes
from .held import ROUND, Held
from .roles import Picked

# what a role's picks can tell at most: two lines, a cone of sight
MOST = {"sides": 2, "outline": 3}
WORDS = {"sides": "side"}


def refuse_too_few(sketch: Sketch, picked: Picked, held: Held, known: Mapping[int, float]) -> None:
    """Raises PickError with the count of equations and what is open, where they can't suffice.

    It counts only: picks that are enough by number may still say the same thing twice, which the
    fit finds out.
    """
    sizes = [name for i, name in enumerate(sketch_sizes(sketch)) if i not in known]
    corners = (held.parameters - 1) // 2 if held.kind == "prism" else 0
    freedom = _freedom(held)
    places = [] if corners else _places(held, freedom)
    open_ones = [*places, *sizes, *([f"{corners} corners"] if corners else [])]
    # a prism's corners hold its place and turn already
    unknown = len(sizes) + (2 * corners + max(freedom - 3, 0) if corners else freedom)
    equations = sum(
        2 * len(roles) if role in _points(sketch) else min(len(roles), MOST.get(role, 99))
        for role, roles in picked.items()
    )
    if equations >= unknown:
        return
    told = [f"{len(p)} {WORDS.get(role, role)}" for role, p in picked.items()]
    missing = unknown - equations
    what = f"{-(-missing // 2)} more" if sketch.kind in ("box", "prism") else f"{missing} more"
    raise PickError(
        f"{sketch.name}: {_listed(told)} picks give {equations} equations for the {unknown} "
        f"numbers of its {', '.join(open_ones)}; pick {what}, or give a size"
    )


def _points(sketch: Sketch) -> tuple[str, ...]:
    return ("base", "top") if sketch.kind in ("box", "prism") else ("apex",)


def _freedom(held: Held) -> int:
    """How many numbers of the pose are open, a turn that changes nothing not counted."""
    turns = {"sphere": 0}.get(held.kind, 2 if held.kind in ROUND else 3)
    moves = 3
    for grip in held.grips:
        if grip.flush is not None:
            turns, moves = turns - 2, moves - 1
        elif grip.kind == "lies_on":
            turns, moves = turns - 1, moves - 1
        elif grip.kind in ("leans_on", "touches"):
            moves -= 1
        elif grip.kind == "parallel":
            turns -= 2
        elif grip.kind == "perpendicular":
            turns -= 1
        elif grip.kind == "centred_on":
            moves -= 3 if grip.to.kind == "point" else 2
    if any(relation.kind == "symmetric" for relation, _, _ in held.others):
        return 0
    return max(turns, 0) + max(moves, 0)


def _places(held: Held, freedom: int) -> list[str]:
    if freedom == 0:
        return []
    return ["place"] if freedom <= 2 or held.kind == "sphere" else ["place and turn"]


def _listed(words: list[str]) -> str:
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}"
