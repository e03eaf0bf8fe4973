# SPDX-License-Identifier: GPL-3.0-or-later
"""Where core's refusals become Blender's: an operator's method in, one that reports errors out."""

from functools import wraps

from ..core.errors import MonocellError


def refuses(execute):
    """Wrap an operator's `execute`: a MonocellError is reported, and nothing else is caught."""

    @wraps(execute)
    def translated(self, context):
        try:
            return execute(self, context)
        except MonocellError as error:
            return _told(self, error)

    return translated


def refuses_to_start(invoke):
    """The same for an operator's `invoke`, whose arguments Blender counts."""

    @wraps(invoke)
    def translated(self, context, event):
        try:
            return invoke(self, context, event)
        except MonocellError as error:
            return _told(self, error)

    return translated


def _told(operator, error):
    operator.report({"ERROR"}, str(error))
    return {"CANCELLED"}
