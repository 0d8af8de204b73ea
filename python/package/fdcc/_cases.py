"""The cases of a sweep, and the table of what came out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import Any

import numpy as np

from ._model import Model, compile
from ._values import Value, short

Case = Mapping[str, Value]

_REST = ("iterations", "kkt_error", "constraint_violation", "confirmed")

INTERRUPTED = {
    "status": "interrupted",
    "objective": np.nan,
    "free": {},
    "iterations": 0,
    "kkt_error": np.nan,
    "constraint_violation": np.nan,
    "confirmed": False,
}
"""The row of a case that did not run to its end."""


def read(cases: Any) -> tuple[list[str], list[Case]]:
    """The names of what differs between them, and each case."""
    if hasattr(cases, "to_dict") and hasattr(cases, "columns"):  # a table of pandas
        return list(cases.columns), cases.to_dict("records")
    if isinstance(cases, Mapping):
        return list(cases), _of_columns(cases)
    try:
        found = [dict(case) for case in cases]
    except (TypeError, ValueError):
        needs = "a table, a dictionary of lists, or dictionaries"
        raise TypeError(f"`cases` cannot be {short(cases)}; it needs {needs}") from None
    return list(dict.fromkeys(name for case in found for name in case)), found


def _of_columns(columns: Mapping[str, Any]) -> list[Case]:
    """A single value goes with every row, as on the command line."""
    is_single = {name: isinstance(it, str) or not np.iterable(it) for name, it in columns.items()}
    lists = {name: list(it) for name, it in columns.items() if not is_single[name]}
    lengths = {len(column) for column in lists.values()} or {1 if columns else 0}
    if len(lengths) > 1:
        raise ValueError("the columns of `cases` have different lengths")
    return [
        {name: columns[name] if is_single[name] else lists[name][at] for name in columns}
        for at in range(lengths.pop())
    ]


def frame(
    model: Model, names: list[str], cases: Sequence[Case], rows: Sequence[Any], confirmed: bool
) -> Any:
    """A row for each case: what was given in the declared units of parameters, all else in SI."""
    import pandas

    free = model.names["free"]
    given = {name: _column(model, name, [case.get(name) for case in cases]) for name in names}
    first = {
        "status": [row["status"] for row in rows],
        "objective": [_float(row["objective"]) for row in rows],
    }
    found = {name: [_float(row["free"].get(name)) for row in rows] for name in free}
    rest = {name: [row[name] for row in rows] for name in _REST[: 4 if confirmed else 3]}
    table = pandas.DataFrame({**given, **first, **found, **rest})
    table.index.name = "case"
    declared = {name: unit for name, _, unit, _ in model._model.units}
    units = {name: model.units.get(name, "") for name in ("objective", *free)}
    table.attrs["units"] = {**{name: declared.get(name, "") for name in names}, **units}
    return table


def _float(value: float | None) -> float:
    return np.nan if value is None else value


def _column(model: Model, name: str, values: list[Any]) -> list[Any]:
    """Texts with units as numbers, and numbers beside words as words: a column is of one kind."""
    if not any(isinstance(it, str) for it in values):
        return values
    if name in model.names["params"]:
        return [_in_declared(it, model.scale(name)) for it in values]
    return [it if it is None else str(it) for it in values]


def _in_declared(value: Any, scale: float) -> Any:
    if not isinstance(value, str):
        return value
    number, bracket, unit = value.partition("[")
    try:
        return float(number) * (_si(unit.rstrip(" ]")) / scale if bracket else 1.0)
    except ValueError:  # a case that did not run, or its text would have been refused
        return value


@lru_cache
def _si(unit: str) -> float:
    """How many SI units one of these is: a model knows."""
    text = f"param q = 1 [{unit}] time t in [0, 1] state x start 0 dynamics {{ x' = 1 }}"
    return compile(text).scale("q")
