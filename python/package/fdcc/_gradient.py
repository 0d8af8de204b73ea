"""Gradients of the true system."""

from __future__ import annotations

from functools import cached_property
from typing import Any

from . import _fdcc
from ._arrays import Number, Signal
from ._records import Named, Record, read


class Gradient(Named[Any]):
    """The derivatives of an expression by each name, in SI.

    By a control it is an array: one number for each row of controls. Other entries of the document
    of ``fdcc grad --json`` are attributes of the same names; what others would compute is in
    ``compare``.
    """

    __slots__ = ("__dict__",)

    def __init__(self, gradient: _fdcc.Gradient, second: bool = False) -> None:
        self.__dict__.update(_gradient=gradient, _second=second)
        derivatives = gradient.derivatives()
        super().__init__({it[0]: _numbers(*it) for it in derivatives})

    @property
    def value(self) -> float | None:
        """What was differentiated; ``None`` where the trajectory does not reach the last time."""
        return self._gradient.value

    @property
    def trusted(self) -> bool:
        """Whether there is a derivative, both ways to compute it agree, and the trajectory stays
        on no kink."""
        return self._gradient.trusted

    @cached_property
    def document(self) -> Record:
        """Everything that ``fdcc grad --json`` prints, under the same names."""
        return read(self._gradient.json(self._second))

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        return getattr(self.document, name)

    def __repr__(self) -> str:
        return f"<fdcc.Gradient {self._values!r}{'' if self.trusted else ', not to be trusted'}>"


def _numbers(name: str, is_control: bool, column: _fdcc.Column) -> Signal | Number:
    rows = Signal(column, name, "")
    return rows if is_control else Number(rows[0])
