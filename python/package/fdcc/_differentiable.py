"""Simulations and solves as functions of numbers with their derivatives, for libraries that
differentiate: the values of parameters are in their declared units, as everywhere; those of controls
and of what is computed in SI."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from typing import Any, TypeVar

import numpy as np

from ._controls import Controls
from ._model import Model
from ._values import Value

Point = Mapping[str, np.ndarray]
Function = Callable[[Point], tuple[float, dict[str, np.ndarray]]]
"""From arrays by name to a number, and its derivatives by each of them."""

Differentiable = TypeVar("Differentiable")
"""What a library that differentiates calls with a dictionary of numbers and arrays."""


def functions(
    differentiable: Callable[[Function], Differentiable],
) -> tuple[Callable[..., Differentiable], Callable[..., Differentiable]]:
    """``simulate`` and ``solve`` of such a library, which makes ``differentiable`` what has a value
    and derivatives."""

    def simulate(
        model: Model,
        of: str | None = None,
        *,
        u: Controls = None,
        values: Mapping[str, Value] | None = None,
        **named: Value,
    ) -> Differentiable:
        """The value of an expression such as ``"x(end)"`` on the true system, in SI; that of the
        objective if it is left out. ``u`` and values are as for :meth:`fdcc.Model.simulate`."""
        return differentiable(simulated(model, of, u, {**(values or {}), **named}))

    def solve(model: Model, **options: Any) -> Differentiable:
        """The objective of the optimum, in SI; options are those of :meth:`fdcc.Model.solve`."""
        return differentiable(solved(model, options))

    return simulate, solve


def simulated(
    model: Model, of: str | None, u: Controls, values: Mapping[str, Value]
) -> Function:
    """The value of an expression at the end of a simulation, and its exact gradient."""

    def function(point: Point) -> tuple[float, dict[str, np.ndarray]]:
        params, controls = _sorted(model, point)
        driven = controls if controls else u
        given = {**values, **{name: float(it) for name, it in params.items()}}
        found = model.grad(of, list(point), u=driven, values=given)
        if found.value is None:
            return _nothing(point, "the simulation does not reach its last time")
        if not found.trusted:
            nothing = _nothing(point, "there is no derivative here that can be trusted")
            return found.value, nothing[1]
        return found.value, {
            name: np.asarray(found._values[name]) * (model.scale(name) if name in params else 1.0)
            for name in point
        }

    return function


def solved(model: Model, options: Mapping[str, Any]) -> Function:
    """The objective of an optimum, and its derivatives by parameters."""

    def function(point: Point) -> tuple[float, dict[str, np.ndarray]]:
        params, controls = _sorted(model, point)
        if controls:
            raise ValueError(f"`{next(iter(controls))}` is a control, which the optimum chooses")
        own = dict(options)
        values = {**own.pop("values", {}), **{name: float(it) for name, it in params.items()}}
        found = model.solve(values=values, progress=False, **own)
        if not found.is_solved:
            return _nothing(point, f"the status is {found.status!r}")
        by = found.sensitivities
        return float(found.objective), {
            name: np.asarray(by[name] * model.scale(name)) for name in point
        }

    return function


def _sorted(model: Model, point: Point) -> tuple[dict[str, Any], dict[str, Any]]:
    """What of it are parameters, and what controls."""
    params = {name: it for name, it in point.items() if name in model.names["params"]}
    controls = {name: it for name, it in point.items() if name in model.names["controls"]}
    for name in point:
        if name not in params and name not in controls:
            raise ValueError(f"{name!r} is no parameter or control of {model.name}")
    return params, controls


def _nothing(point: Point, why: str) -> tuple[float, dict[str, np.ndarray]]:
    warnings.warn(f"{why}: NaN is returned", RuntimeWarning, stacklevel=3)
    return np.nan, {name: np.full(np.shape(it), np.nan) for name, it in point.items()}
