"""Exceptions."""

from __future__ import annotations

from ._records import Diagnostics


class ModelError(ValueError):
    """A model has a mistake. Its text is what ``fdcc check`` draws.

    >>> import fdcc
    >>> try:
    ...     fdcc.compile("time t in [0, 1]  state x start 0  dynamics { x' = y }")
    ... except fdcc.ModelError as error:
    ...     print(error.diagnostics[0].code, error.diagnostics[0].message)
    FDC0101 nothing called `y` here
    """

    diagnostics: Diagnostics
    """What is wrong, as data: ``code``, ``severity``, ``message``, ``line``, ``column``, ``help``,
    ``labels``, ``fixes``."""

    def __init__(self, text: str, diagnostics: str) -> None:
        super().__init__(text.rstrip())
        self._data = diagnostics
        self.diagnostics = Diagnostics(diagnostics, text)

    def __reduce__(self):
        return (ModelError, (str(self), self._data))
