"""What callers hand over. What is wrong with it is told before anything runs, with the name of the
argument, in the words of the command."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from numbers import Integral
from reprlib import repr as short
from typing import Any

import numpy as np

Value = float | str | Sequence[float]
"""A number in the declared unit of a name, a text such as ``"200[g]"`` or ``"radau3"``, or several
numbers."""

LEAST_RTOL = 1e-14
"""Below this rounding is larger than the tolerance."""

MOST_STARTS = 10_000
MOST_INTERVALS = 1_000_000


def given(
    values: Mapping[str, Value] | None, named: Mapping[str, Value], params: Sequence[str]
) -> list[tuple[str, float | str]]:
    """All of them, as the library takes them; ``None`` stands for what the model says."""
    if not isinstance(values, (Mapping, type(None))):
        raise TypeError(f"`values` cannot be {short(values)}; it needs values by name")
    for name in named:
        if name in (values or {}):
            raise ValueError(f"`{name}` is given twice: in `values` and by name; leave one out")
    both = {**(values or {}), **named}
    return [(name, taken(name, it, params)) for name, it in both.items() if it is not None]


def taken(name: str, value: Any, params: Sequence[str]) -> float | str:
    """A number or a text; several numbers, which no parameter has, are a list of the language."""
    if isinstance(value, str):
        return value
    number = _number(value)
    if number is not None:
        return number
    is_list = isinstance(value, Iterable) and not isinstance(value, (bytes, Mapping))
    several = [_number(it) for it in value] if is_list and name not in params else []
    if several and None not in several:
        return ", ".join(map(repr, several))
    others = "" if name in params else ", or several numbers"
    needs = f'a number, or a text such as "0.2" or "200[g]"{others}'
    raise TypeError(f"`{name}` cannot be {short(value)}; it needs {needs}")


def seconds(name: str, value: Any) -> float | None:
    """A limit of time, if there is one."""
    if value is None:
        return None
    return _checked(name, value, lambda it: it > 0, "a number of seconds above 0")


def finite(name: str, value: Any) -> float | None:
    """A number, if there is one."""
    if value is None:
        return None
    return _checked(name, value, lambda it: abs(it) < np.inf, "a finite number")


def tolerance(name: str, value: Any) -> float | None:
    """A relative tolerance, if there is one."""
    if value is None:
        return None
    needs = f"a number from {LEAST_RTOL:.0e} to 1"
    return _checked(name, value, lambda it: LEAST_RTOL <= it < 1, needs)


def difference(name: str, value: Any) -> float:
    """What is called confirmation."""
    return _checked(
        name, value, lambda it: 0 <= it < np.inf, "a finite number that is not negative"
    )


def whole(name: str, value: Any, most: int) -> int:
    """A number of things, at least one."""
    is_whole = isinstance(value, Integral) and not isinstance(value, bool)
    if not is_whole or not 1 <= value <= most:
        raise ValueError(f"`{name}` cannot be {short(value)}; it needs a whole number, 1 to {most}")
    return int(value)


def row(name: str, value: Any) -> np.ndarray:
    """Numbers in SI, one or more."""
    try:
        array = None if value is None else np.asarray(value, dtype=float)
    except (TypeError, ValueError):
        array = None
    if array is None or array.ndim > 1 or not array.size:
        raise ValueError(f"the {name} cannot be {short(value)}; needed are numbers, one or a list")
    return np.atleast_1d(array)


def _checked(name: str, value: Any, is_right: Callable[[float], bool], needs: str) -> float:
    number = _number(value)
    if number is None or not is_right(number):
        raise ValueError(f"`{name}` cannot be {short(value)}; it needs {needs}")
    return number


def _number(value: Any) -> float | None:
    """What is no number is ``None``; what NumPy and others call one is."""
    try:
        is_other = isinstance(value, (bool, np.bool_, str, bytes)) or np.ndim(value)
        return None if is_other else float(value)
    except (TypeError, ValueError, OverflowError):
        return None
