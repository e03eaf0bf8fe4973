# SPDX-License-Identifier: GPL-3.0-or-later
"""A random user of the add-on: a seed in, steps out that are checked, and can be done again.

A step is a move's name and a seed of its own: what it does depends on these and on the scene alone,
so that steps can be left out of a log and the rest done again.
"""

from __future__ import annotations

import os
import re
import traceback
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from random_blender import BlenderMoves
from random_camera import CameraMoves
from random_files import FileMoves
from random_picks import PickMoves
from random_verbs import VerbMoves
from scene_check import check_scene

# one line that says what is wrong, from the operator or from its poll
REFUSAL = re.compile(r"Error: [^\n]+|Operator bpy\.ops\.monocell\.\w+\.poll\(\) (?!failed)[^\n]+")
UNDO_SHARE = 0.12
REACHED = "steps.txt"
MOST_REPLAYS = int(os.environ.get("MONOCELL_REPLAYS", "150"))


@dataclass(frozen=True)
class Step:
    """One move of the hand."""

    move: str
    seed: int

    def __str__(self):
        return f"{self.move} {self.seed}"

    @staticmethod
    def drawn(seed, i):
        """Step number i of a session, whatever the others are."""
        rng = np.random.default_rng([seed, i])
        moves = Hand.moves()
        return Step(moves[rng.integers(len(moves))], int(rng.integers(2**31)))


def read_steps(path):
    """The steps of a log; what follows a # tells what was called."""
    lines = (line.partition("#")[0].split() for line in Path(path).read_text().splitlines())
    return [Step(words[0], int(words[1])) for words in lines if words]


def walked(new_hand, steps):
    """Make the steps with a new hand; the hand, and what went wrong at the last one, or None."""
    hand = new_hand()
    for step in steps:
        try:
            hand.do(step)
        except Exception:
            return hand, traceback.format_exc()
    return hand, None


def shortest(new_hand, steps, failure):
    """As few of the steps as still go wrong in the same place; ever smaller parts are left out."""
    wanted, size, replays = _place(failure), max(1, len(steps) // 2), 0
    while size >= 1:
        start = 0
        while start < len(steps) and replays < MOST_REPLAYS:
            fewer = steps[:start] + steps[start + size :]
            replays += 1
            told = walked(new_hand, fewer)[1]
            if told is not None and _place(told) == wanted:
                steps = fewer
            else:
                start += size
        size //= 2
    return steps


def _place(failure):
    """The line of code that a traceback ends at."""
    lines = [line for line in failure.splitlines() if line.startswith("  File")]
    return lines[-1]


class Hand(PickMoves, VerbMoves, CameraMoves, FileMoves, BlenderMoves):
    """One session, from a fresh file on.

    `bench` is a folder with a cell document and its pictures, `told` returns what was printed
    since it was asked last, `module` imports a module of the extension.
    """

    def __init__(self, bpy, module, bench, folder, told):
        self.bpy, self.module, self.bench, self.folder = bpy, module, bench, folder
        self.folder.mkdir(parents=True, exist_ok=True)
        self.ops, self.told = bpy.ops.monocell, told
        self.refusals, self.made, self.checked, self.finished = [], 0, 0, set()
        self.log = (folder / REACHED).open("w")
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        self.module("addon.preferences").settings(bpy.context)
        self.rng = np.random.default_rng(0)
        self.does_open_cell()
        self.told()

    @classmethod
    def moves(cls):
        """The names of all moves, as often as they are made."""
        names = sorted(name for name in dir(cls) if name.startswith("does_"))
        return [name[5:] for name in names for _ in range(getattr(getattr(cls, name), "often", 4))]

    def do(self, step):
        """Make a step and check all that has to hold after it."""
        self._note(f"{step}\n")
        self.made += 1
        self.rng = np.random.default_rng(step.seed)
        getattr(self, f"does_{step.move}")()
        before = self.check()
        if self.scene.monocell_cell.text == "" and self.chance(0.5):
            # undone to before the cell was opened, or in another scene
            self.does_open_cell()
        elif self.chance(UNDO_SHARE) and self.bpy.context.mode == "OBJECT":
            self._there_and_back(before)

    def check(self):
        """The document that stands in the scene now; AssertionError where something is amiss."""
        document = check_scene(self.bpy, self.module, self.folder)
        self.checked += bool(document) and not document.startswith("Error")
        printed = self.told()
        assert "Traceback" not in printed, printed
        assert "Error" not in printed.replace("Error: ", ""), printed
        return document

    def press(self, verb, **properties):
        """One of our operators as the interface calls it: refused in one line, or done."""
        self._note(f"    # {verb} {properties}\n")
        try:
            done = getattr(self.ops, verb)("EXEC_DEFAULT", True, **properties)
            if done == {"FINISHED"}:
                self.finished.add(verb)
            return done
        except RuntimeError as refusal:
            told = str(refusal).strip()
            assert REFUSAL.fullmatch(told), f"{verb}: {told}"
            assert "Traceback" not in told, f"{verb}: {told}"
            self.refusals.append(f"{verb}: {told}")
            return {"CANCELLED"}

    def blender(self, operator, **properties):
        """One of Blender's operators where it can run; its refusals are its own affair."""
        if not operator.poll():
            return False
        self._note(f"    # {operator.idname_py()} {properties}\n")
        try:
            return operator("EXEC_DEFAULT", True, **properties) == {"FINISHED"}
        except (RuntimeError, TypeError) as refusal:
            # TypeError: a choice that the object at hand does not have
            assert "Traceback" not in str(refusal), refusal
            return False

    def by_hand(self, said):
        """End a change that was made without an operator, as the interface does."""
        self._note(f"    # {said}\n")
        self.bpy.ops.ed.undo_push(message=said)

    def _there_and_back(self, before):
        ed = self.bpy.ops.ed
        ed.undo_push(message="now")
        count = int(self.rng.integers(1, 4))
        gone = 0
        while gone < count and ed.undo.poll():
            ed.undo()
            gone += 1
            self.check()
        for _ in range(gone):
            if ed.redo.poll():
                ed.redo()
        after = self.check()
        assert after == before, f"{count} undone and redone:\n{before}\n{after}"

    def _note(self, line):
        # a crash of Blender leaves no time to write it later
        self.log.write(line)
        self.log.flush()

    @property
    def scene(self):
        return self.bpy.context.scene

    @property
    def stored(self):
        return self.scene.monocell_cell

    def chance(self, share):
        return self.rng.random() < share

    def one_of(self, choices):
        choices = list(choices)
        return choices[self.rng.integers(len(choices))] if choices else None

    def things(self):
        """The objects that are modelled and in the scene."""
        return [ob for ob in self.scene.objects if self.module("scene.objects").is_modelled(ob)]

    def cell(self):
        """The scene's cell, None where an object was edited out of its kind."""
        errors, document = self.module("core.errors"), self.module("addon.cell.document")
        try:
            return document.read_scene(self.scene) if self.stored.text else None
        except errors.MonocellError:
            return None
