# SPDX-License-Identifier: GPL-3.0-or-later
"""What holds a world of its own and gives it back: `with` calls its `close` at the end."""

from __future__ import annotations

from abc import ABC, abstractmethod
from contextlib import AbstractContextManager


class Closing(AbstractContextManager["Closing"], ABC):
    """A context manager that is itself what `with` gives, and closes whatever happens."""

    @abstractmethod
    def close(self) -> None:
        """Give back what is held."""

    def __exit__(self, *error: object) -> None:
        self.close()
