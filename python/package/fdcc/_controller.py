"""Models in closed loop."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from . import _fdcc
from ._arrays import Number
from ._records import Named


@dataclass(frozen=True)
class Step:
    """What a controller found; all numbers are in SI."""

    controls: Named[Number]
    """The first value of each control."""

    status: str
    """As of a solution; ``time_limit`` where the budget was too short."""

    is_solved: bool
    """Whether it can be used as an optimum."""

    objective: float
    """Of the optimum, or of the best iterate."""

    interval: float
    """For so long the controls are meant."""

    violation: float
    """Of the constraints."""

    iterations: int
    """Of the solver."""

    def __getitem__(self, name: str) -> Number:
        return self.controls[name]


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

    def __init__(self, controller: _fdcc.Controller, units: Mapping[str, str]) -> None:
        self._controller, self._units = controller, units
        self.states, self.controls = map(tuple, controller.names)

    def set(self, **values: float | str) -> None:
        """Other values of parameters, in their declared units, from the next step on."""
        self._controller.set(list(values.items()))

    def step(
        self, state: Mapping[str, float] | Sequence[float], budget: float | None = None
    ) -> Step:
        """Solves from a state, in SI: by name, or in the order of ``states``. After ``budget``
        seconds it is the best iterate."""
        if isinstance(state, Mapping):
            state = [state[name] for name in self.states]
        values = np.asarray(state, dtype=float).tolist()
        controls, *rest = self._controller.step(values, budget)
        named = zip(self.controls, controls)
        units = self._units
        return Step(Named({name: Number(it, units.get(name, "")) for name, it in named}), *rest)
