"""Simulations of the true system."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import Any

from . import _fdcc, _saved, _tables
from ._arrays import Number, Signal
from ._html import table
from ._records import Named, Record, Result, read
from ._values import short
from ._vectors import find


class Simulation(Result):
    """What the true system does; all numbers are in SI.

    ``r["x"]`` is a state, ``r["pos"]`` a vector, its parts along the last axis. Other entries of the
    document of ``fdcc simulate --json`` are attributes of the same names.
    """

    time: Signal
    """When the states are reported; at a jump the same time twice. Shape ``(n,)``."""

    states: Named[Signal]
    """The states at these times, each of shape ``(n,)``."""

    def __init__(
        self, simulation: _fdcc.Simulation | _saved.Simulation, units: Mapping[str, str]
    ) -> None:
        if not isinstance(simulation, (_fdcc.Simulation, _saved.Simulation)):
            raise TypeError(f"`Model.simulate` makes a simulation; {short(simulation)} is none")
        set = self.__dict__.__setitem__
        set("_simulation", simulation)
        set("units", units)
        set("time", Signal(simulation.time(), "time", units.get("time", "")))
        states = simulation.states()
        set("states", Named({it: Signal(column, it, units.get(it, "")) for it, column in states}))

    def __reduce__(self) -> Any:
        return (_read_again, (self._simulation.json(), self.units))

    @cached_property
    def document(self) -> Record:
        """Everything that ``fdcc simulate --json`` prints, under the same names."""
        return read(self._simulation.json())

    @property
    def t(self) -> Signal:
        """The same as ``time``."""
        return self.time

    @property
    def status(self) -> str:
        """``completed``, or why the last time was not reached."""
        return self.document.status

    @property
    def events(self) -> tuple[Record, ...]:
        """What happened, in the order of time: ``time``, ``surface``, ``kind``, ``before``,
        ``after``."""
        return self.document.events

    @property
    def end(self) -> Named[Number]:
        """The last time, and the states then."""
        return self._numbers("end")

    @property
    def integrals(self) -> Named[Number]:
        """The values of the integrals of the objective."""
        return self._numbers("integrals")

    @property
    def objective(self) -> Number | None:
        """The objective, if there is one and the last time was reached."""
        value = self.document.objective
        return None if value is None else Number(value, self.units.get("objective", ""))

    def _numbers(self, entry: str) -> Named[Number]:
        values = self.document[entry].items()
        return Named({name: Number(it, self.units.get(name, "")) for name, it in values})

    def __getitem__(self, name: str) -> Signal:
        return self.time if name in ("t", "time") else find(name, [self.states])

    def to_pandas(self) -> Any:
        """A ``pandas.DataFrame``: a column for each state, indexed by ``time``."""
        return _tables.frame(self.time, self.states)

    def to_xarray(self) -> Any:
        """An ``xarray.Dataset`` over ``time``; units are the attribute ``units``."""
        return _tables.dataset(self.time, self.states)

    def plot(self, names: Sequence[str] | str | None = None) -> Any:
        """Draws the states over time with matplotlib; returns its axes, one for each name."""
        from ._plot import axes, over_time

        wanted = [names] if isinstance(names, str) else names
        signals = self.states if wanted is None else {it: self[it] for it in wanted}
        return axes([over_time(self.time, signals)])

    def __repr__(self) -> str:
        events = len(self.events)
        found = f"{self.status}, {events} event{'' if events == 1 else 's'}"
        return f"<fdcc.Simulation {self.document.model}: {found}>"

    def _repr_html_(self) -> str:
        return table(repr(self)[1:-1], ((name, it, it.unit) for name, it in self.end.items()))


def _read_again(text: str, units: Mapping[str, str]) -> Simulation:
    return Simulation(_saved.Simulation(text), units)
