# SPDX-License-Identifier: GPL-3.0-or-later
"""The one place where what core refuses becomes Blender's red message and a cancelled operator."""

from functools import wraps

from ..core.errors import MonocellError


def refuses(execute):
    """Wrap an operator's `execute`: a MonocellError is reported, and nothing else is caught."""

    @wraps(execute)
    def translated(self, context):
        try:
            return execute(self, context)
        except MonocellError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}

    return translated
