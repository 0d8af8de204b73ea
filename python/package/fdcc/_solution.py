"""Solutions, asked by name."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property
from os import PathLike, fspath
from pathlib import Path
from typing import Any

from . import _fdcc, _saved, _tables
from ._arrays import Number, Signal, per
from ._records import Named, Record, Result, no_such, read
from ._values import difference, short
from ._vectors import find


class Solution(Result):
    """A solution, or the best iterate where there is none; all numbers are in SI.

    ``s["x"]`` is a state, control, report, unknown or parameter; ``s["pos"]`` a vector, its parts
    along the last axis; ``s["boost.h"]`` is of a phase. What stands in the document of
    ``fdcc solve --json`` is an attribute of the same name, such as ``s.iterations``,
    ``s.method.sigma``, ``s.jumps``. It can be saved, loaded, copied and pickled.

    >>> import fdcc
    >>> m = fdcc.compile("time t in [0, 1] [s]  state x [m] start 0"
    ...     "  control v in [-1, 1] [m/s]  dynamics { x' = v }  end x == 0.5  minimize integral(v^2)")
    >>> s = m.solve(N=10)
    >>> s
    <fdcc.Solution model: solved, objective 0.25 m^2/s>
    >>> s.t.shape, s["x"].shape, s.u["v"].shape, s.costates["x"].shape
    ((11,), (11,), (10,), (11,))
    >>> s["y"]
    Traceback (most recent call last):
    KeyError: "there is no 'y'; there is time, x, v"
    """

    def __init__(
        self, solution: _fdcc.Solution | _saved.Solution, phase: str | None = None
    ) -> None:
        if not isinstance(solution, (_fdcc.Solution, _saved.Solution)):
            raise TypeError(
                "`Model.solve` makes a solution, and `fdcc.Solution.load(path)` reads a saved one;"
                f" {short(solution)} is neither"
            )
        self.__dict__.update(_solution=solution, _phase=phase)

    @classmethod
    def load(cls, path: str | PathLike[str]) -> "Solution":
        """Reads what :meth:`save` or ``fdcc solve --out`` wrote.

        >>> import fdcc, os, tempfile
        >>> m = fdcc.compile("time t in [0, 1]  state x start 0  control u in [-1, 1]"
        ...     "  dynamics { x' = u }  end x == 0.5  minimize integral(u^2)")
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     path = os.path.join(folder, "r.sol.json")
        ...     m.solve(N=10).save(path)
        ...     s = fdcc.Solution.load(path)
        >>> s.status, s["x"].shape, m.solve(N=10, warm=s).is_solved
        ('solved', (11,), True)
        """
        try:
            return cls(_saved.Solution(Path(path).read_text(encoding="utf-8")))
        except (KeyError, TypeError, ValueError) as error:
            raise ValueError(f"{fspath(path)} is not a solution: {error!r}") from None

    def __reduce__(self) -> Any:
        return (_read_again, (self._solution.json(), self._phase))

    @property
    def model(self) -> str:
        """The name of the model, or of the phase."""
        return self._solution.model

    @property
    def status(self) -> str:
        """How the solve ended: ``solved``, ``acceptable``, ``uncertified``, ``infeasible``, ``none_found``,
        ``unbounded``, ``iteration_limit``, ``time_limit``, ``interrupted``, ``not_finite``,
        ``numerical_failure``."""
        return self._solution.status

    @property
    def is_solved(self) -> bool:
        """Whether it can be used: solved, or nearly as accurate as asked for."""
        return self._solution.is_solved

    @property
    def objective(self) -> Number:
        """The objective as the model writes it: what is maximised is not negated."""
        return Number(self._solution.objective, self.units.get("objective", ""))

    @cached_property
    def confirmed(self) -> bool:
        """Whether a replay on the true system confirms it to 0.1 % and nothing contradicts that it
        is an optimum. The replay is made when it is first asked for."""
        return self._solution.confirmed()

    @property
    def certificate(self) -> Record | None:
        """What was checked to show that it is an optimum of the true system: whether it is
        ``certified``, and the ``checks``, each with its ``figure``, its ``limit`` and whether it
        ``passes``. ``None`` where nobody looked for one: a model without surfaces or objective, or
        that names a width."""
        return self.document.get("certificate")

    @cached_property
    def units(self) -> Named[str]:
        """The SI unit of each name; ``""`` for a plain number."""
        return Named(dict(self._solution.units))

    def _signals(self, columns: list[tuple[str, _fdcc.Column]]) -> Named[Signal]:
        unit = self.units.get
        return Named({name: Signal(column, name, unit(name, "")) for name, column in columns})

    @cached_property
    def time(self) -> Signal:
        """The grid points, one more than intervals. Shape ``(N + 1,)``; of a model with phases its
        ends."""
        return Signal(self._solution.time(), "time", self.units.get("time", ""))

    @property
    def t(self) -> Signal:
        """The same as ``time``."""
        return self.time

    @cached_property
    def states(self) -> Named[Signal]:
        """The states at the grid points, each of shape ``(N + 1,)``; after a jump where one
        happens."""
        return self._signals(self._solution.states())

    @cached_property
    def controls(self) -> Named[Signal]:
        """The controls on the intervals, each of shape ``(N,)``."""
        return self._signals(self._solution.controls())

    @property
    def u(self) -> Named[Signal]:
        """The same as ``controls``."""
        return self.controls

    @cached_property
    def costates(self) -> Named[Signal]:
        """The derivatives of the objective by the states at the grid points, each of shape
        ``(N + 1,)``."""
        of = self.units.get("objective", "")
        columns = self._solution.costates()
        return Named({name: Signal(it, name, self._per(of, name)) for name, it in columns})

    @cached_property
    def report(self) -> Named[Signal]:
        """What the model reports, at the grid points or on the intervals."""
        return self._signals(self._solution.report())

    @cached_property
    def hamiltonian(self) -> Signal | Named[Any]:
        """The Hamiltonian on the intervals. Shape ``(N,)``; of a model with phases that of each, by
        name."""
        if self.phases:
            return Named({name: it.hamiltonian for name, it in self.phases.items()})
        of = self.units.get("objective", "")
        return Signal(self._solution.hamiltonian(), "hamiltonian", self._per(of, "time"))

    @cached_property
    def free(self) -> Named[Number]:
        """The unknowns that were found."""
        return self._numbers(self._solution.free)

    @cached_property
    def params(self) -> Named[Number]:
        """The parameters that were given."""
        return self._numbers(self._solution.params)

    @cached_property
    def sensitivities(self) -> Named[Number]:
        """The derivatives of the optimal objective by the parameters, where it is solved."""
        of = self.units.get("objective", "")
        found = self.document.get("sensitivities", {}).items()
        return Named({name: Number(it, self._per(of, name)) for name, it in found})

    def derivative(self, by: str) -> Record:
        """How the optimum moves with a parameter, by the matrix of its optimality conditions:
        ``free``, ``junctions`` (where the solution switches or something reaches or leaves a bound,
        each with its ``time`` and ``derivative``), ``time``, and ``states`` and ``controls`` at
        times that stay the same; of a model with phases these are in ``phases``. All in SI. An
        optimum with a kink there, or that is no strict minimum, raises ``ValueError``.

        >>> import fdcc
        >>> m = fdcc.compile("time t in [0, 1]  param a = 2  state x start 0  control u"
        ...     "  dynamics { x' = u }  end x == a  minimize integral(u^2)")
        >>> by_a = m.solve().derivative("a")
        >>> round(by_a.controls["u"][0], 6), round(by_a.states["x"][-1], 6)
        (1.0, 1.0)
        """
        return read(self._solution.derivative(by))

    def _per(self, of: str, name: str) -> str:
        return per(of, self.units.get(name, ""))

    def _numbers(self, pairs: list[tuple[str, float]]) -> Named[Number]:
        return Named({name: Number(it, self.units.get(name, "")) for name, it in pairs})

    @property
    def surfaces(self) -> Named[tuple[Record, ...]]:
        """The spans of time of each surface in one ``mode``, ``from`` one time ``to`` another."""
        phase = self._phase
        return (self.document.phases[phase] if phase else self.document).surfaces

    @cached_property
    def switches(self) -> tuple[Record, ...]:
        """When surfaces change their mode, in the order of time: ``surface``, ``time``, and the
        modes ``from`` (``it.from_``) and ``to``. They are located where it is certified."""
        changes = (
            {"surface": surface, "time": later["from"], "from": first.mode, "to": later.mode}
            for surface, spans in self.surfaces.items()
            for first, later in zip(spans, spans[1:])
        )
        return tuple(Record(it) for it in sorted(changes, key=lambda it: it["time"]))

    @property
    def arcs(self) -> Named[tuple[Record, ...]]:
        """The spans of time of each control at a bound or between, ``mode`` ``min``, ``max`` or
        ``free``, where it is certified; else none."""
        found = self.certificate
        return found.arcs if found and found.certified else Named()

    @cached_property
    def phases(self) -> Named["Solution"]:
        """The solutions of the phases, by name; all signals are theirs."""
        return Named({it.model: Solution(it, it.model) for it in self._solution.phases()})

    @cached_property
    def document(self) -> Record:
        """Everything that ``fdcc solve --json`` prints, under the same names; the same for a phase
        as for the whole."""
        return read(self._solution.json())

    def __getitem__(self, name: str) -> Any:
        if name in ("t", "time"):
            return self.time
        phase, _, own = name.partition(".")
        if own and phase in self.phases:
            return self.phases[phase][own]
        try:
            return find(name, self._roles)
        except KeyError:
            raise KeyError(no_such(name, self._ipython_key_completions_())) from None

    def __contains__(self, name: str) -> bool:
        try:
            self[name]
        except KeyError:
            return False
        return True

    @property
    def _roles(self) -> tuple[Mapping[str, Any], ...]:
        return self.states, self.controls, self.report, self.free, self.params

    def _ipython_key_completions_(self) -> list[str]:
        own = [name for named in self._roles for name in named]
        of_phases = [
            f"{phase}.{name}"
            for phase, it in self.phases.items()
            for name in (*it.states, *it.controls, *it.report)
        ]
        return ["time", *own, *of_phases]

    def verify(self, gap: float = 1e-3) -> Record | None:
        """What the controls do on the true system: whether it is ``confirmed``, and by how much
        states differ and conditions are violated. ``gap`` is the largest difference that is called
        confirmation, as a part of how far states move and how large terms are. ``None`` where the
        model cannot be simulated.

        >>> import fdcc
        >>> m = fdcc.compile("time t in [0, 1]  state x start 0  control u in [-1, 1]"
        ...     "  dynamics { x' = u }  end x == 0.5  minimize integral(u^2)")
        >>> m.solve(N=10).verify(gap=1e-6).confirmed
        True
        """
        return read(self._solution.verification(difference("gap", gap)))

    def save(self, path: str | PathLike[str]) -> None:
        """Writes what ``fdcc solve`` writes as ``.sol.json``: :meth:`load` and ``fdcc verify`` read
        it, and ``warm`` and ``u`` take its path. A table is that of :meth:`to_pandas`."""
        if Path(path).suffix.lower() in (".csv", ".html", ".xlsx", ".parquet"):
            other = "`to_pandas()` has tables, and `fdcc report` makes a page of what was saved"
            raise ValueError(f"{fspath(path)} would be a JSON document; {other}")
        Path(path).write_text(self._solution.json(), encoding="utf-8")

    def to_pandas(self) -> Any:
        """A ``pandas.DataFrame``: a column for each state, control and report, indexed by ``time``,
        with two rows for a jump; of a model with phases a frame for each, by name."""
        if self.phases:
            return Named({name: it.to_pandas() for name, it in self.phases.items()})
        signals = {**self.states, **self.controls, **self.report}
        return _tables.frame(self.time, signals, self._jumps)

    @property
    def _jumps(self) -> Sequence[Any]:
        return () if self._phase else self.document.get("jumps", ())

    @property
    def _control_nodes(self) -> Record | None:
        """The ``time`` and the ``values`` that define controls that are not constant on intervals."""
        own = self.document.phases[self._phase] if self._phase else self.document
        return own.get("control_nodes")

    def to_xarray(self) -> Any:
        """An ``xarray.Dataset``: states, costates (``costate(x)``) and reports over ``time``,
        controls and reports of controls over ``interval``, where each begins; units are the
        attribute ``units``. Of a model with phases a dataset for each, by name."""
        if self.phases:
            return Named({name: it.to_xarray() for name, it in self.phases.items()})
        costates = {f"costate({name})": it for name, it in self.costates.items()}
        signals = {**self.states, **costates, **self.controls, **self.report}
        data = _tables.dataset(self.time, signals)
        return data.assign_attrs(model=self.model, status=self.status, objective=self.objective)

    def plot(self, names: Sequence[str] | str | None = None) -> Any:
        """Draws states and controls over time with matplotlib, the times shaded at which a surface
        is held; returns its axes, one for each name. Phases follow one another."""
        from ._plot import drawn

        return drawn(self, [names] if isinstance(names, str) else names)

    def __str__(self) -> str:
        return f"{repr(self)[1:-1]}, {self._solution.words()}"

    def __repr__(self) -> str:
        unit = self.objective.unit
        value = f"{self.objective:.9g}{' ' + unit if unit else ''}"
        return f"<fdcc.Solution {self.model}: {self.status}, objective {value}>"

    def _repr_html_(self) -> str:
        return self._solution.html()


def _read_again(text: str, phase: str | None) -> Solution:
    return Solution(_saved.Solution(text, phase), phase)
