"""Models in closed loop."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from . import _fdcc
from ._arrays import Number
from ._records import Named
from ._values import finite, row, seconds, short, taken
from ._vectors import entry, find, refuse_others


@dataclass(frozen=True)
class Step:
    """What a controller found; all numbers are in SI."""

    controls: Named[Number]
    """The first value of each control."""

    status: str
    """As of a solution; ``time_limit`` where the budget was too short."""

    is_solved: bool
    """Whether it can be used as an optimum."""

    objective: Number
    """Of the optimum, or of the best iterate."""

    interval: Number
    """For so long the controls are meant."""

    violation: float
    """Of the constraints."""

    iterations: int
    """Of the solver."""

    def __getitem__(self, name: str) -> Any:
        """The value of a control; of a vector an array."""
        return find(name, [self.controls])


class Controller:
    """Solves a model once for each state that it is told, from the solution before.

    >>> import fdcc
    >>> m = fdcc.compile("time t in [0, 1]  param goal = 0.5  state x start 0"
    ...     "  control u in [-1, 1]  dynamics { x' = u }"
    ...     "  minimize integral((x - goal)^2 + 0.1 * u^2)")
    >>> mpc = m.controller(N=20)
    >>> x = 0.0
    >>> for _ in range(100):
    ...     step = mpc.step({"x": x}, budget=0.1)
    ...     x += step.interval * step["u"]
    >>> round(x, 2), step.status
    (0.5, 'solved')
    >>> mpc.set(goal=-0.5)
    >>> mpc.step([x])["u"] < 0
    True
    """

    def __init__(self, controller: _fdcc.Controller, units: Mapping[str, str], title: str) -> None:
        if not isinstance(controller, _fdcc.Controller):
            raise TypeError(f"`Model.controller` makes a controller; {short(controller)} is none")
        self._controller, self._units, self._title = controller, units, title
        self.states, self.controls, self.signals = map(tuple, controller.names)

    def set(self, **values: float | str) -> None:
        """Other values of parameters, in their declared units, from the next step on."""
        self._controller.set([(name, taken(name, it, list(values))) for name, it in values.items()])

    def step(
        self,
        state: Mapping[str, Any] | Sequence[float],
        budget: float | None = None,
        ref: Mapping[str, Any] | Sequence[float] | float | None = None,
        now: float | None = None,
    ) -> Step:
        """Solves from a state, in SI: by name, or in the order of ``states``. After ``budget``
        seconds it is the best iterate. Ctrl-C raises ``KeyboardInterrupt``, and the next step is
        as good as any.

        ``ref`` has the values of signals, in SI, which hold until others are given: by name, or
        those of the only one; a number, or one for each point of the grid. A signal without values
        is what the text says, from the time ``now`` on.

        >>> import fdcc
        >>> m = fdcc.compile("time t in [0, 1]  signal r = 0  state x start 0"
        ...     "  control u in [-5, 5]  dynamics { x' = u }"
        ...     "  minimize integral((x - r)^2 + 0.001 * u^2)")
        >>> mpc = m.controller(N=4)
        >>> mpc.step([0.0], ref=[0, 0.2, 0.4, 0.6, 0.8])["u"] > 0
        True
        >>> mpc.step([0.0], ref={"r": -1})["u"] < 0
        True
        """
        if ref is not None or now is not None:
            self._controller.set_signals(self._signals(ref), finite("now", now))
        if isinstance(state, Mapping):
            refuse_others("state", state, self.states)
            state = [entry("state", state, name, self.states) for name in self.states]
        values = row("state", state).tolist()
        controls, status, is_solved, objective, interval, *rest = self._controller.step(
            values, seconds("budget", budget)
        )
        named = {name: self._number(name, it) for name, it in zip(self.controls, controls)}
        figures = self._number("objective", objective), self._number("time", interval)
        return Step(Named(named), status, is_solved, *figures, *rest)

    def _signals(self, ref: Any) -> list[tuple[str, list[float]]]:
        """The values of each component of the signals that are given."""
        if ref is None:
            return []
        if not isinstance(ref, Mapping):
            if len(self.signals) != 1:
                known = ", ".join(self.signals) or "none"
                raise ValueError(f"`ref` needs the names of signals: the model has {known}")
            ref = {self.signals[0]: ref}
        given = []
        for name, values in ref.items():
            parts = [it for it in self.signals if it.startswith(f"{name}[")]
            columns = np.asarray(values).T if parts and name not in self.signals else [values]
            names = parts if parts and name not in self.signals else [name]
            if len(columns) != len(names):
                raise ValueError(f"the signal {name!r} needs {len(names)} parts in its last axis")
            given += [(it, row("signal", of).tolist()) for it, of in zip(names, columns)]
        return given

    def _number(self, name: str, value: float) -> Number:
        return Number(value, self._units.get(name, ""))

    def __repr__(self) -> str:
        states, controls = ", ".join(self.states), ", ".join(self.controls)
        return f"<fdcc.Controller {self._title}: {states} to {controls}>"
