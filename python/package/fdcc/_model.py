"""Models: read, solved, simulated, differentiated."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from html import escape
from os import PathLike, fspath
from pathlib import Path
from typing import Any

import numpy as np

from . import _fdcc
from ._controller import Controller
from ._controls import Controls, driver
from ._earlier import lent
from ._gradient import Gradient
from ._progress import progress as _progress
from ._records import Diagnostics, Named, Record, no_such
from ._simulation import Simulation
from ._solution import Solution
from ._values import MOST_INTERVALS, MOST_STARTS, Value, given, row, seconds
from ._values import short, tolerance, whole

Data = str | PathLike[str] | Mapping[str, str]
"""A folder of data files, or their texts under the names that models give them."""


def compile(text: str, *, name: str = "model", data: Data | None = None) -> "Model":
    """The model that a text describes; ``name`` stands in messages.

    ``data`` has the data files: a folder, or their texts by name.

    >>> import fdcc
    >>> m = fdcc.compile("time t in [0, 1]  state x start 0  dynamics { x' = 1 }")
    >>> m.names["states"]
    ('x',)
    """
    if not isinstance(text, str):
        needs = "the text of a model; `fdcc.Model(path)` reads a file"
        raise TypeError(f"`text` cannot be {short(text)}; it needs {needs}")
    return Model._of(_fdcc.Model(name, text.encode(), _texts(data)))


def check(model: str | PathLike[str], *, data: Data | None = None) -> Diagnostics:
    """Everything that is wrong with a text, or with a file ``*.fdc``.

    >>> import fdcc
    >>> found = fdcc.check("time t in [0, 1]  state x start 0  dynamics { x' = y }")
    >>> [it.severity for it in found]
    ['error']
    """
    name, content, folder = _read(model)
    return Diagnostics(*_fdcc.check(name, content, _texts(folder if data is None else data)))


def _read(model: str | PathLike[str]) -> tuple[str, bytes, str | None]:
    """The name and the content of a file or of a text, and the folder of the first."""
    if isinstance(model, str) and "\n" in model or not fspath(model).endswith(".fdc"):
        return "model", str(model).encode(), None
    path = Path(model)
    return str(path), path.read_bytes(), str(path.parent)


def _texts(data: Data | None) -> dict[str, str] | str | None:
    if not isinstance(data, Mapping):
        return None if data is None else fspath(data)
    for name, text in data.items():
        if not isinstance(text, str):
            own = type(text).__name__
            raise TypeError(f"`data`: {name!r} needs the text of the file, not of type {own}")
    return dict(data)


def _read_again(name: str, text: str, data: dict[str, str]) -> "Model":
    return compile(text, name=name, data=data or None)


class Model:
    """A model without mistakes, from a file.

    ``data`` is the folder of its data files, that of the model if left out, or their texts by name.

    Raises :class:`ModelError` if the model has a mistake.
    """

    __slots__ = ("_model", "names", "units")

    _model: _fdcc.Model

    names: Record
    """The names of ``states``, ``controls``, ``params``, ``free`` unknowns, ``surfaces``,
    ``report`` and ``phases``."""

    units: Named[str]
    """The SI unit of each name, that of its values in results; ``""`` for a plain number. Empty
    where the model has no units at all."""

    def __init__(self, path: str | PathLike[str], *, data: Data | None = None) -> None:
        file = Path(path)
        folder = file.parent if data is None else data
        self._set(_fdcc.Model(str(file), file.read_bytes(), _texts(folder)))

    @classmethod
    def _of(cls, model: _fdcc.Model) -> "Model":
        self = cls.__new__(cls)
        self._set(model)
        return self

    def _set(self, model: _fdcc.Model) -> None:
        set = object.__setattr__
        set(self, "_model", model)
        set(self, "names", Record({role: tuple(names) for role, names in model.names}))
        set(self, "units", Named({name: si for name, si, *_ in model.units}))

    def __setattr__(self, name: str, value: Any) -> None:
        raise AttributeError("a model cannot be changed; solve it with other values")

    def __reduce__(self) -> Any:
        return (_read_again, (*self._model.source, dict(self._model.data)))

    @property
    def name(self) -> str:
        """The name that the model gives itself."""
        return self._model.name

    @property
    def text(self) -> str:
        """The text."""
        return self._model.source[1]

    @property
    def diagnostics(self) -> Diagnostics:
        """Warnings and advice about the text."""
        return Diagnostics(*self._model.diagnostics)

    def scale(self, name: str) -> float:
        """How many SI units one of the declared unit of a name is: 0.001 for ``[g]``.

        >>> import fdcc
        >>> m = fdcc.compile("param m = 200 [g]  time t in [0, 1]  state x start 0"
        ...                  "  dynamics { x' = m / 1[kg] }")
        >>> m.scale("m")
        0.001
        """
        known = [own for names in self.names.values() for own in names]
        scales = {own: scale for own, _, _, scale in self._model.units}
        if name not in known and name not in scales:
            raise KeyError(no_such(name, known))
        return scales.get(name, 1.0)

    def solve(
        self,
        *,
        warm: Solution | str | PathLike[str] | None = None,
        starts: int = 1,
        time_limit: float | None = None,
        progress: bool | None = None,
        values: Mapping[str, Value] | None = None,
        **named: Value,
    ) -> Solution:
        """Solves; that nothing is found is no error, but a status.

        Parameters and keys of the method are given by name: ``muN=1.2, N=1000, scheme="radau3"``;
        those that are no names of Python, or are called as an option here, as ``values={"p.x": 1}``.
        A number is in the declared unit. With other values of parameters nothing is compiled anew.

        Parameters
        ----------
        warm
            Begin at another solution, with its multipliers where the grid is the same; or at one
            that was saved as ``.sol.json``.
        starts
            From how many starting points: the guess or ``warm``, and random variations of it.
        time_limit
            Seconds after which it stops with the best iterate, as Ctrl-C does.
        progress
            Whether to show a bar, if ``tqdm`` is there; if left out, in terminals and notebooks for
            what takes longer than a second.

        >>> import fdcc
        >>> m = fdcc.compile("time t in [0, 1]  param w = 1  state x start 0"
        ...     "  control u in [-1, 1]  dynamics { x' = u }  end x == 0.5"
        ...     "  minimize integral(w * u^2)")
        >>> s = m.solve(N=20)
        >>> round(m.solve(w=2, N=20, warm=s).objective, 6)
        0.5
        """
        own, starts = self._given(values, named), whole("starts", starts, MOST_STARTS)
        limit = seconds("time_limit", time_limit)
        with lent("warm", warm) as earlier, _progress(self.name, progress) as report:
            return Solution(self._model.solve(own, earlier, starts, limit, report))

    def _given(
        self, values: Mapping[str, Value] | None, named: Mapping[str, Value]
    ) -> list[tuple[str, float | str]]:
        return given(values, named, self.names["params"])

    def controller(
        self, N: int, *, values: Mapping[str, Value] | None = None, **named: Value
    ) -> Controller:
        """A controller with so many intervals, for closed loops; it solves the smoothed problem, so
        a model with surfaces names its ``sigma``."""
        own, N = self._given(values, named), whole("N", N, MOST_INTERVALS)
        title = f"{self.name}, {N} interval{'' if N == 1 else 's'}"
        return Controller(_fdcc.Controller(self._model, own, N), self.units, title)

    def simulate(
        self,
        *,
        u: Controls = None,
        t: Sequence[float] | np.ndarray | None = None,
        rtol: float | None = None,
        time_limit: float | None = None,
        values: Mapping[str, Value] | None = None,
        **named: Value,
    ) -> Simulation:
        """Simulates the true system, with every event located.

        Parameters
        ----------
        u
            The controls, in SI: a solution or the path of a saved one, whose parameters and
            unknowns are taken, too; an object with a column or entry for each control, each value
            held for an equal part of the time, or from the time in the entry ``t`` on, with an
            array for a vector, whose last axis is its parts; the guess of the model if left out. A
            model with phases takes a solution or its path.
        t
            When states are reported, ascending and in SI; at all steps and between long ones, if
            left out, and in a model with phases.
        rtol
            The relative tolerance of one step; 1e-10 if left out.
        time_limit
            Seconds after which it stops with the trajectory so far, as Ctrl-C does.
        values
            Of parameters and unknowns, in their declared units; by name, too: ``T=3``.

        >>> import fdcc, numpy as np
        >>> m = fdcc.compile("time t in [0, 2]  state v start 1  surface slip = v"
        ...     "  control F in [-9, 9] guess 0  dynamics { v' in F - 2 * Sgn(slip) }")
        >>> r = m.simulate(t=[0, 0.25, 2])
        >>> np.round(np.abs(r["v"]), 9), r.events[0].surface
        (array([1. , 0.5, 0. ]), 'slip')
        >>> round(m.simulate(u={"F": [4, 0]}).end["v"], 9)
        1.0
        """
        own, limit = self._given(values, named), seconds("time_limit", time_limit)
        times = None if t is None else row("times `t`", t).tolist()
        with driver(u, self) as controls:
            found = self._model.simulate(own, controls, times, tolerance("rtol", rtol), limit)
        return Simulation(found, self.units)

    def grad(
        self,
        of: str | None = None,
        wrt: Sequence[str] = (),
        *,
        u: Controls = None,
        second: bool = False,
        rtol: float | None = None,
        values: Mapping[str, Value] | None = None,
        **named: Value,
    ) -> Gradient:
        """Differentiates the true system exactly, through all its events.

        Parameters
        ----------
        of
            An expression that has a value at the end, such as ``"x(end)"``; the objective if left
            out.
        wrt
            Names of parameters, unknowns and controls, and ``x(start)``; all parameters and
            unknowns if left out.
        u
            The controls, as in :meth:`simulate`.
        second
            Whether the second derivatives are wanted, too.

        >>> import fdcc
        >>> m = fdcc.compile("time t in [0, 2]  state x start -1  surface zero = x"
        ...     "  dynamics { x' in 2 - Sgn(zero) }")
        >>> g = m.grad("x(end)", wrt=["x(start)"])
        >>> round(g["x(start)"], 9), g.trusted
        (0.333333333, True)
        """
        names = [wrt] if isinstance(wrt, str) else list(wrt)
        own = self._given(values, named)
        with driver(u, self) as controls:
            found = self._model.grad(own, of, names, controls, tolerance("rtol", rtol))
        return Gradient(found, second)

    def __repr__(self) -> str:
        def count(role: str, noun: str) -> str:
            number = len(self.names[role])
            return f"{number} {noun}{'' if number == 1 else 's'}"

        nouns = {"states": "state", "controls": "control", "surfaces": "surface"}
        return f"<fdcc.Model {self.name}: {', '.join(count(*it) for it in nouns.items())}>"

    def _repr_html_(self) -> str:
        warnings = self.diagnostics
        found = warnings._repr_html_() if warnings else ""
        return f"<p><b>{escape(repr(self)[1:-1])}</b></p><pre>{escape(self.text)}</pre>{found}"
