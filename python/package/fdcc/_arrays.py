"""Numbers with a unit."""

from __future__ import annotations

from typing import Any

import numpy as np

from ._fdcc import Column


class Signal(np.ndarray):
    """A read-only array of 64-bit floats, in the SI unit ``unit``.

    It is the memory of the result that it belongs to. What is computed from it is an ordinary
    array; a part of it keeps name and unit.

    >>> import fdcc
    >>> m = fdcc.compile("time t in [0, 2] [s]  state x [m] start 1  dynamics { x' = 1 [m/s] }")
    >>> x = m.simulate(t=[0, 1, 2])["x"]
    >>> x
    Signal([1., 2., 3.], name='x', unit='m')
    >>> x[1:].unit, type(x + x).__name__
    ('m', 'ndarray')
    """

    name: str
    unit: str

    def __new__(cls, column: Column | np.ndarray, name: str, unit: str) -> "Signal":
        self = np.frombuffer(memoryview(column), dtype=np.float64).view(cls)
        self.name, self.unit = name, unit
        return self

    def __array_finalize__(self, source: Any) -> None:
        self.name = getattr(source, "name", "")
        self.unit = getattr(source, "unit", "")

    def __array_wrap__(self, array: Any, context: Any = None, return_scalar: bool = False) -> Any:
        plain = np.asarray(array)
        return plain[()] if return_scalar or plain.ndim == 0 else plain

    def __array_function__(self, function: Any, types: Any, args: Any, kwargs: Any) -> Any:
        result = super().__array_function__(function, types, args, kwargs)
        return np.asarray(result) if isinstance(result, Signal) else result

    def __reduce__(self) -> Any:
        return (restored, (np.array(self), self.name, self.unit))

    def __repr__(self) -> str:
        numbers = np.array2string(np.asarray(self), separator=", ", prefix="Signal(")
        return f"Signal({numbers}, name={self.name!r}, unit={self.unit!r})"


def restored(array: np.ndarray, name: str, unit: str) -> Signal:
    """A signal of numbers that belong to no result."""
    self = array.view(Signal)
    self.name, self.unit = name, unit
    self.flags.writeable = False
    return self


def per(of: str, by: str) -> str:
    """The unit of a derivative, such as ``J per kg``."""
    return f"{of or 1} per {by}" if by else of


class Number(float):
    """A float, in the SI unit ``unit``."""

    unit: str
    __slots__ = ("unit",)

    def __new__(cls, value: float, unit: str = "") -> "Number":
        self = super().__new__(cls, value)
        object.__setattr__(self, "unit", unit)
        return self

    def __setattr__(self, name: str, value: Any) -> None:
        raise AttributeError("a number of a result cannot be changed")

    def __reduce__(self) -> Any:
        return (Number, (float(self), self.unit))
