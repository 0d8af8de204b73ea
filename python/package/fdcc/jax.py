"""Simulations and solves as functions that JAX differentiates.

Both are called with a dictionary of what they depend on, by name: numbers for parameters, in their
declared units, and arrays for controls, in SI. Their derivatives are those of :meth:`fdcc.Model.grad`
and the sensitivities of the optimum, not those of steps of an integrator or iterations of a solver.
Where there is no derivative it is NaN, with a warning. They work under ``jit`` and ``vmap``; with 64
bits where ``jax_enable_x64`` is set.

>>> import fdcc, fdcc.jax, jax
>>> m = fdcc.compile("param x0 = -1  time t in [0, 2]  state x start x0  surface zero = x"
...     "  dynamics { x' in 2 - Sgn(zero) }")
>>> end = fdcc.jax.simulate(m, "x(end)")
>>> round(float(jax.grad(end)({"x0": -1.0})["x0"]), 6)
0.333333
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from ._differentiable import Function, functions

def _differentiable(function: Function) -> Callable[[Mapping[str, Any]], jax.Array]:
    def both(point: dict[str, jax.Array]) -> tuple[jax.Array, dict[str, jax.Array]]:
        kind = jnp.result_type(float)
        shapes = {name: jax.ShapeDtypeStruct(jnp.shape(it), kind) for name, it in point.items()}

        def host(point: dict[str, jax.Array]) -> tuple[Any, Any]:
            arrays = {name: np.asarray(it, dtype=float) for name, it in point.items()}
            value, derivatives = function(arrays)
            cast = np.dtype(kind).type
            return cast(value), {name: it.astype(kind) for name, it in derivatives.items()}

        shape = (jax.ShapeDtypeStruct((), kind), shapes)
        return jax.pure_callback(host, shape, point, vmap_method="sequential")

    @jax.custom_vjp
    def value(point: dict[str, jax.Array]) -> jax.Array:
        return both(point)[0]

    def backward(derivatives: dict[str, jax.Array], by: jax.Array) -> tuple[Any]:
        return ({name: by * it for name, it in derivatives.items()},)

    value.defvjp(both, backward)
    return lambda point: value({name: jnp.asarray(it, float) for name, it in point.items()})


simulate, solve = functions(_differentiable)
