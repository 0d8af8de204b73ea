"""Gradients of the true system."""

from __future__ import annotations

from functools import cached_property
from typing import Any

from . import _fdcc, _saved
from ._arrays import Number, Signal, per
from ._html import table
from ._records import Named, Record, Result, no_such, read
from ._values import short

_START = "(start)"


class Gradient(Result, Named[Any]):
    """The derivatives of an expression by each name, in SI.

    By a control it is an array: one number for each row of controls. Other entries of the document
    of ``fdcc grad --json`` are attributes of the same names; what others would compute is in
    ``compare``.
    """

    __slots__ = ("__dict__",)

    def __init__(
        self, gradient: _fdcc.Gradient | _saved.Gradient, second: bool = False
    ) -> None:
        if not isinstance(gradient, (_fdcc.Gradient, _saved.Gradient)):
            raise TypeError(f"`Model.grad` makes a gradient; {short(gradient)} is none")
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

    @cached_property
    def _in_units(self) -> dict[str, Signal | Number]:
        """The units are in the document, which takes as long as the gradient."""
        units = self.document.get("units", {})

        def unit(name: str) -> str:
            return per(units.get("objective", ""), units.get(name.removesuffix(_START), ""))

        derivatives = self._gradient.derivatives()
        return {it[0]: _numbers(*it, unit(it[0])) for it in derivatives}

    def __getitem__(self, name: str) -> Signal | Number:
        if name in self._values:
            return self._in_units[name]
        raise KeyError(no_such(name, list(self._values)) if self._values else self._missing())

    def _missing(self) -> str:
        """Why there is no derivative at all."""
        if self.value is not None:
            return "; ".join(["there is no derivative", *self.document.warnings])
        status = self.document.status
        stopped = self.document.get(status, {})
        when = f" at the time {stopped['time']:.9g}" if "time" in stopped else ""
        return f"there is no derivative: the trajectory stops{when} with the status {status!r}"

    def __reduce__(self) -> Any:
        return (_read_again, (self._gradient.json(self._second), self._second))

    def __repr__(self) -> str:
        return f"<fdcc.Gradient {self._values!r}{'' if self.trusted else ', not to be trusted'}>"

    def _repr_html_(self) -> str:
        of = f"the derivatives of {self.document.of}{'' if self.trusted else ', not to be trusted'}"
        return table(of, ((name, it, it.unit) for name, it in self.items()))


def _numbers(
    name: str, is_control: bool, column: _fdcc.Column, unit: str = ""
) -> Signal | Number:
    rows = Signal(column, name, unit)
    return rows if is_control else Number(rows[0], unit)


def _read_again(text: str, second: bool) -> Gradient:
    return Gradient(_saved.Gradient(text), second)
