"""Simulations of the true system."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import Any

import numpy as np

from . import _fdcc, _saved, _tables
from ._arrays import Number, Signal
from ._html import table
from ._records import Named, Record, Result, no_such, read
from ._values import short
from ._vectors import find


class Simulation(Result):
    """What the true system does; all numbers are in SI.

    ``r["x"]`` is a state, ``r["pos"]`` a vector, its parts along the last axis; ``r["fall.h"]`` is
    of a phase. Other entries of the document of ``fdcc simulate --json`` are attributes of the same
    names.

    >>> import fdcc
    >>> m = fdcc.compile(
    ...     "phase fall { time t in [0, 1]  state h start 5  dynamics { h' = -t } }"
    ...     "phase rest { time t in [1, 3]  state h  dynamics { h' = 0 } }"
    ...     "link fall -> rest { same }")
    >>> r = m.simulate()
    >>> round(float(r.phases["fall"]["h"][-1]), 9), round(float(r["rest.h"][0]), 9)
    (4.5, 4.5)
    """

    time: Signal
    """When the states are reported; at a jump the same time twice. Shape ``(n,)``; of a model with
    phases the ends."""

    states: Named[Signal]
    """The states at these times, each of shape ``(n,)``."""

    phases: Named["Simulation"]
    """What each phase does, by name, to the first that does not reach its last time; all signals
    are theirs."""

    def __init__(
        self,
        simulation: _fdcc.Simulation | _saved.Simulation,
        units: Mapping[str, str],
        phase: str | None = None,
    ) -> None:
        if not isinstance(simulation, (_fdcc.Simulation, _saved.Simulation)):
            raise TypeError(f"`Model.simulate` makes a simulation; {short(simulation)} is none")
        set = self.__dict__.__setitem__
        set("_simulation", simulation)
        set("_phase", phase)
        set("units", units)
        of_phases = simulation.phases()
        set("phases", Named({name: Simulation(it, units, name) for name, it in of_phases}))
        time = simulation.time()
        if time is None:
            pieces = list(self.phases.values())
            time = np.array([pieces[0].time[0], pieces[-1].time[-1]])
            time.flags.writeable = False
        set("time", Signal(time, "time", units.get("time", "")))
        states = simulation.states()
        set("states", Named({it: Signal(column, it, units.get(it, "")) for it, column in states}))

    def __reduce__(self) -> Any:
        return (_read_again, (self._simulation.json(), self.units, self._phase))

    @cached_property
    def document(self) -> Record:
        """Everything that ``fdcc simulate --json`` prints, under the same names; of a phase what it
        has of it."""
        whole = read(self._simulation.json())
        return whole.phases[self._phase] if self._phase else whole

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
        ``after``; of a model with phases those of all."""
        if self.phases:
            return tuple(event for it in self.phases.values() for event in it.events)
        return self.document.events

    @property
    def end(self) -> Named[Number]:
        """The last time, and the states then; of a model with phases those of the last."""
        return [*self.phases.values()][-1].end if self.phases else self._numbers("end")

    @property
    def integrals(self) -> Named[Number]:
        """The values of the integrals of the objective; of a model with phases in each."""
        return Named() if self.phases else self._numbers("integrals")

    @property
    def objective(self) -> Number | None:
        """The objective, if there is one and the last time was reached."""
        value = self.document.objective
        return None if value is None else Number(value, self.units.get("objective", ""))

    def _numbers(self, entry: str) -> Named[Number]:
        values = self.document[entry].items()
        return Named({name: Number(it, self.units.get(name, "")) for name, it in values})

    def __getitem__(self, name: str) -> Signal:
        phase, _, own = name.partition(".")
        if own and phase in self.phases:
            return self.phases[phase][own]
        if name in ("t", "time"):
            return self.time
        if self.phases:
            raise KeyError(no_such(name, self._names()))
        return find(name, [self.states])

    def _names(self) -> list[str]:
        own = (f"{phase}.{it}" for phase, own in self.phases.items() for it in own.states)
        return ["time", *self.states, *own]

    def to_pandas(self) -> Any:
        """A ``pandas.DataFrame``: a column for each state, indexed by ``time``; of a model with
        phases a frame for each, by name."""
        if self.phases:
            return Named({name: it.to_pandas() for name, it in self.phases.items()})
        return _tables.frame(self.time, self.states)

    def to_xarray(self) -> Any:
        """An ``xarray.Dataset`` over ``time``; units are the attribute ``units``. Of a model with
        phases a dataset for each, by name."""
        if self.phases:
            return Named({name: it.to_xarray() for name, it in self.phases.items()})
        return _tables.dataset(self.time, self.states)

    def plot(self, names: Sequence[str] | str | None = None) -> Any:
        """Draws the states over time with matplotlib; returns its axes, one for each name. Phases
        follow one another."""
        from ._plot import axes, over_time

        wanted = [names] if isinstance(names, str) else names
        pieces = [*self.phases.values()] or [self]
        drawn = [it._drawn(wanted) for it in pieces]
        for name in wanted or ():
            if not any(name in signals for signals in drawn):
                raise KeyError(no_such(name, self._names()))
        return axes([over_time(it.time, signals) for it, signals in zip(pieces, drawn)])

    def _drawn(self, names: Sequence[str] | None) -> Mapping[str, Signal]:
        """All states, or what has these names, which may begin with that of the phase."""
        if names is None:
            return self.states
        found = {}
        for name in names:
            try:
                found[name] = self[name.removeprefix(f"{self._phase}.")]
            except KeyError:
                pass
        return found

    def __repr__(self) -> str:
        events = len(self.events)
        found = f"{self.status}, {events} event{'' if events == 1 else 's'}"
        return f"<fdcc.Simulation {self._phase or self.document.model}: {found}>"

    def _repr_html_(self) -> str:
        return table(repr(self)[1:-1], ((name, it, it.unit) for name, it in self.end.items()))


def _read_again(text: str, units: Mapping[str, str], phase: str | None = None) -> Simulation:
    return Simulation(_saved.Simulation(text, phase), units, phase)
