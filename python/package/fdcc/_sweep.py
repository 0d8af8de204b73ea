"""Many solves of one model, here or on the workers of a cluster."""

from __future__ import annotations

import json
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from . import _fdcc
from ._model import Model, Value, _given
from ._progress import seen
from ._workers import Workers, workers

Case = Mapping[str, Value]

_SECONDS = 1.0
"""About so long a worker is busy with what it gets at a time."""

_MOST = 10_000
"""No more cases are sent at a time."""

_REST = ("iterations", "kkt_error", "constraint_violation", "confirmed")


def sweep(
    model: Model,
    cases: Any,
    client: Any = None,
    *,
    starts: int = 1,
    time_limit: float | None = None,
    confirmed: bool = False,
    gap: float = 1e-3,
    progress: bool | None = None,
    values: Case | None = None,
    **named: Value,
) -> Any:
    """Solves for many cases; a ``pandas.DataFrame`` with a row for each, in their order.

    A case is values of parameters and keys of the method by name. It begins at the solution for the
    parameters of the model, never at another case, so that the table is the same to the bit
    wherever it is computed on machines of one kind.

    Parameters
    ----------
    cases
        A table with a column for each name, such as a ``pandas.DataFrame`` or a dictionary of
        lists; or an iterable of dictionaries.
    client
        Who solves: all processors of this machine if left out; a ``dask.distributed.Client``, the
        module ``ray``, a ``joblib.Parallel``, or any executor of ``concurrent.futures``. Each
        worker compiles the model once. What a worker has when it dies is solved by another one.
    starts, time_limit
        As for :meth:`Model.solve`, for each case.
    confirmed, gap
        Whether to replay each case on the true system, with the largest difference that is called
        confirmation; the result is the column ``confirmed``.
    progress
        Whether to show a bar, if ``tqdm`` is there; if left out, in terminals and notebooks.
    values, named
        Values for all cases.

    The columns are those of the cases, with the values that were given, ``status``, ``objective``,
    the unknowns, ``iterations``, ``kkt_error`` and ``constraint_violation``, in SI; units are in
    ``attrs["units"]``.

    >>> import fdcc
    >>> m = fdcc.compile("time t in [0, 1]  param w = 1  state x start 0"
    ...     "  control u in [-1, 1]  dynamics { x' = u }  end x == 0.5"
    ...     "  minimize integral(w * u^2)")
    >>> table = fdcc.sweep(m, {"w": [1, 2, 4]}, N=20)
    >>> list(table["status"]), [round(it, 6) for it in table["objective"]]
    (['solved', 'solved', 'solved'], [0.25, 0.5, 1.0])
    """
    import pandas

    table = _rows(cases)
    fixed = _given({**(values or {}), **named})
    job = _Job(_Text.of(model), tuple(fixed), starts, time_limit, gap if confirmed else None)
    given = [_given(case) for case in table]
    found: list[Any] = [None] * len(given)
    with seen(model.name, len(given), progress) as done:
        for first, rows in _each(job, given, workers(client)):
            found[first : first + len(rows)] = rows
            done(len(rows))
    return _frame(pandas, model, table, [json.loads(row) for row in found])


@dataclass(frozen=True)
class _Text:
    """What makes a model again elsewhere."""

    name: str
    text: str
    data: tuple[tuple[str, str], ...]

    @classmethod
    def of(cls, model: Model) -> "_Text":
        name, text = model._model.source
        return cls(name, text, tuple(model._model.data))


@dataclass(frozen=True)
class _Job:
    """What all cases share."""

    model: _Text
    fixed: tuple[tuple[str, float | str], ...]
    starts: int
    time_limit: float | None
    gap: float | None

    def __call__(self, cases: Sequence[Any], threads: int | None) -> tuple[list[str], float]:
        """Solves some cases, wherever it is called; with the seconds that it took."""
        begin = time.monotonic()
        compiled = _compiled(self.model)
        given = [[*self.fixed, *case] for case in cases]
        rows = compiled.solve(given, threads, self.starts, self.time_limit, self.gap)
        return rows, time.monotonic() - begin


@lru_cache(maxsize=4)
def _compiled(text: _Text) -> _fdcc.Cases:
    """The model, read and compiled once in each process."""
    return _fdcc.Cases(_fdcc.Model(text.name, text.text.encode(), dict(text.data) or None))


def _each(job: _Job, given: Sequence[Any], pool: Workers) -> Iterator[tuple[int, list[str]]]:
    """The rows as they come, each list with the number of its first one."""
    waiting: dict[Any, tuple[int, int]] = {}
    at, size = 0, 1
    while at < len(given) or waiting:
        while at < len(given) and len(waiting) < 2 * pool.count:
            end = min(at + size, len(given))
            waiting[pool.submit(job, given[at:end])] = (at, end)
            at = end
        task, (rows, seconds) = pool.next(list(waiting))
        first, end = waiting.pop(task)
        size = _size(end - first, seconds, len(given) - at, pool.count)
        yield first, rows


def _size(cases: int, seconds: float, left: int, count: int) -> int:
    """How many cases are to be sent next, if so many took so long."""
    size = min(cases * _SECONDS / max(seconds, 1e-6), 8 * cases, left / (2 * count))
    return max(1, min(int(size), _MOST))


def _rows(cases: Any) -> list[Case]:
    if hasattr(cases, "to_dict") and hasattr(cases, "columns"):  # a table of pandas
        return cases.to_dict("records")
    if isinstance(cases, Mapping):
        columns = {name: list(column) for name, column in cases.items()}
        lengths = {len(column) for column in columns.values()}
        if len(lengths) > 1:
            raise ValueError("the columns of `cases` have different lengths")
        return [dict(zip(columns, row)) for row in zip(*columns.values())]
    return [dict(case) for case in cases]


def _frame(pandas: Any, model: Model, cases: list[Case], rows: list[dict[str, Any]]) -> Any:
    def entries(case: Case, row: dict[str, Any]) -> dict[str, Any]:
        first = {name: row[name] for name in ("status", "objective")}
        rest = {name: row[name] for name in _REST if name in row}
        return {**case, **first, **row["free"], **rest}

    table = pandas.DataFrame([entries(case, row) for case, row in zip(cases, rows)])
    table.index.name = "case"
    names = {"objective": "objective", **{name: name for name in model.names["free"]}}
    table.attrs["units"] = {name: model.units.get(own, "") for name, own in names.items()}
    return table
