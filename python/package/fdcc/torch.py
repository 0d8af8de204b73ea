"""Simulations and solves as functions that PyTorch differentiates.

Both are called with a dictionary of what they depend on, by name: numbers for parameters, in their
declared units, and tensors for controls, in SI. Their derivatives are those of
:meth:`fdcc.Model.grad` and the sensitivities of the optimum, not those of steps of an integrator or
iterations of a solver. Where there is no derivative it is NaN, with a warning.

>>> import fdcc, fdcc.torch, torch
>>> m = fdcc.compile("param x0 = -1  time t in [0, 2]  state x start x0  surface zero = x"
...     "  dynamics { x' in 2 - Sgn(zero) }")
>>> x0 = torch.tensor(-1.0, dtype=torch.float64, requires_grad=True)
>>> fdcc.torch.simulate(m, "x(end)")({"x0": x0}).backward()
>>> round(x0.grad.item(), 9)
0.333333333
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import torch

from ._differentiable import Function, functions

class _Host(torch.autograd.Function):
    """A function of tensors that the library computes."""

    @staticmethod
    def forward(ctx: Any, function: Function, names: list[str], *tensors: torch.Tensor) -> Any:
        arrays = {name: it.detach().cpu().double().numpy() for name, it in zip(names, tensors)}
        value, derivatives = function(arrays)
        ctx.save_for_backward(*(torch.as_tensor(derivatives[name]).to(it)
                                for name, it in zip(names, tensors)))
        return torch.as_tensor(value).to(tensors[0])

    @staticmethod
    def backward(ctx: Any, by: torch.Tensor) -> Any:
        return (None, None, *(by * it for it in ctx.saved_tensors))


def _differentiable(function: Function) -> Callable[[Mapping[str, Any]], torch.Tensor]:
    def value(point: Mapping[str, Any]) -> torch.Tensor:
        tensors = [
            it if isinstance(it, torch.Tensor) else torch.tensor(it, dtype=torch.float64)
            for it in point.values()
        ]
        return _Host.apply(function, list(point), *tensors)

    return value


simulate, solve = functions(_differentiable)
