# SPDX-License-Identifier: GPL-3.0-or-later
"""Work that takes its time: an operator's own function in, progress and a way out meanwhile.

The work runs in a thread and touches core only: Blender's data are read before it starts and
written after it has ended, by Blender's own thread.
"""

from __future__ import annotations

from collections.abc import Callable
from threading import Thread
from typing import Any

import bpy

from ..core.errors import InvalidValue, MonocellError

# how often Blender looks after the work, seconds
TICK = 0.08


class Stopped(Exception):
    """Ends the work that was cancelled."""


class Watch:
    """What the work tells of its progress, and what it is told: to stop.

    Called with the name of each thing it comes to.
    """

    def __init__(self, total: int) -> None:
        self.total, self.done, self.name = max(total, 1), 0, ""
        self.stopped = False

    def __call__(self, name: str) -> None:
        if self.stopped:
            raise Stopped
        self.done, self.name = self.done + 1, name

    def stop(self) -> None:
        """Let the work end at the next thing it comes to."""
        self.stopped = True

    @property
    def share(self) -> float:
        """How much is done, from 0 to 1; work that takes longer than told stays just below."""
        return min(self.done / self.total, 0.97)


class Job:
    """One piece of work in a thread. `result` raises what the work raised."""

    def __init__(self, work: Callable[[Watch], Any], total: int) -> None:
        self.watch = Watch(total)
        self._work, self._result, self._error = work, None, None
        self._thread = Thread(target=self._run, daemon=True)
        self._thread.start()

    @property
    def running(self) -> bool:
        return self._thread.is_alive()

    def ended_within(self, seconds: float) -> bool:
        """Whether the work has ended, after waiting so long for it at most."""
        self._thread.join(seconds)
        return not self.running

    def result(self) -> Any:
        """What the work returned, once it has ended."""
        self._thread.join()
        if self._error is not None:
            raise self._error
        return self._result

    def _run(self) -> None:
        try:
            self._result = self._work(self.watch)
        except BaseException as error:  # raised again where the result is asked for
            self._error = error


class WorksInBackground:
    """A mixin for operators with `prepare(context)` and `finish(context, result)`.

    `prepare` returns a title, how many things the work comes to, and the work, a function of a
    `Watch`. Called by a script the operator waits for it; pressed in a window it does not, but for
    its `patience`: what ends sooner shows no progress.
    """

    # seconds
    patience = 0.0

    def execute(self, context):
        """Do it and wait."""
        try:
            _, total, work = self.prepare(context)
            return self.finish(context, work(Watch(total)))
        except MonocellError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}

    def invoke(self, context, event):
        """Start it and come back."""
        return self.start(context, event)

    def start(self, context, event=None):
        """Begin the work, and look after it from then on."""
        state = context.window_manager.monocell_work
        if state.title and not self.patience:
            return self._refused(state)
        try:
            title, total, work = self.prepare(context)
            self._begun_with = self.state_of(context.scene)
        except MonocellError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self._job = Job(work, total)
        if self.patience and self._job.ended_within(self.patience):
            return self._ended(context, event)
        if state.title:
            self._job.watch.stop()
            return self._refused(state)
        state.title, state.share, state.name, state.cancel = title, 0.0, "", False
        self._timer = context.window_manager.event_timer_add(TICK, window=context.window)
        context.window_manager.modal_handler_add(self)
        _redraw(context)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        """Look after the work; all else goes on as ever."""
        state, watch = context.window_manager.monocell_work, self._job.watch
        if event.type == "ESC" and event.value == "PRESS":
            state.cancel = True
        if state.cancel:
            watch.stop()
        if event.type == "TIMER":
            state.share, state.name = watch.share, watch.name
            told = f"{state.title}: {watch.name}"
            context.workspace.status_text_set(f"{told}   {100 * watch.share:.0f} %   Esc cancels")
            _redraw(context)
        # what was told to stop is not waited for: it ends at its next step, and changes nothing
        if event.type != "TIMER" or (self._job.running and not watch.stopped):
            return {"RUNNING_MODAL"} if event.type == "ESC" else {"PASS_THROUGH"}
        self._end(context)
        return self._ended(context, event)

    def cancel(self, context):
        """Blender's own way out, when a file is loaded or the window closes."""
        self._job.watch.stop()
        self._end(context)

    def state_of(self, scene):
        """What the work began with, and what has to be the same when it ends."""
        return scene.session_uid, scene.monocell_cell.text

    def arrived(self, context, event, result):
        """What follows when the work is done in a window."""
        return self.finish(context, result)

    def _refused(self, state):
        self.report({"ERROR"}, f"{state.title} is still running: wait, or cancel it")
        return {"CANCELLED"}

    def _ended(self, context, event):
        try:
            if self._job.watch.stopped:
                raise Stopped
            result = self._job.result()
            if self.state_of(context.scene) != self._begun_with:
                raise InvalidValue("The cell was changed meanwhile: start again for it as it is")
            return self.arrived(context, event, result)
        except Stopped:
            self.report({"INFO"}, "Cancelled: nothing was changed")
        except MonocellError as error:
            self.report({"ERROR"}, str(error))
        return {"CANCELLED"}

    def _end(self, context):
        context.window_manager.event_timer_remove(self._timer)
        context.window_manager.monocell_work.title = ""
        # the user may have gone to another workspace meanwhile
        for workspace in bpy.data.workspaces:
            workspace.status_text_set(None)
        _redraw(context)


class OpensInBackground(WorksInBackground):
    """The same for what is often done at once, and for what is chosen in a dialog or file browser.

    Those call `execute`, and that must not freeze the window: an `invoke` that asks for something
    sets `by_hand`.
    """

    patience = 0.3
    # Blender's operators have no constructor of ours
    by_hand = False

    def execute(self, context):
        """Start where it was chosen by hand; a script waits."""
        if self.by_hand and not self.options.is_repeat:
            return self.start(context)
        return super().execute(context)


def _redraw(context):
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()
