"""Many solves of one model, here or on the workers of a cluster."""

from __future__ import annotations

import json
import time
from collections.abc import Iterator, Sequence
from contextlib import closing, suppress
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from . import _fdcc
from ._cases import INTERRUPTED, Case, frame, read
from ._model import Model
from ._progress import seen
from ._values import MOST_STARTS, Value, difference, given, seconds, whole
from ._workers import Workers, workers

_SECONDS = 1.0
"""About so long a worker is busy with what it gets at a time."""

_MOST = 10_000
"""No more cases are sent at a time."""


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
        lists, where a single value goes with every row; or an iterable of dictionaries.
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

    The columns are those of the cases, in the declared units of parameters, so that they can be
    given again; and ``status``, ``objective``, the unknowns, ``iterations``, ``kkt_error`` and
    ``constraint_violation``, in SI. Units are in ``attrs["units"]``.

    Ctrl-C raises nothing: the rows that ran are in the table, and the others have the status
    ``interrupted``.

    >>> import fdcc
    >>> m = fdcc.compile("time t in [0, 1]  param w = 1  state x start 0"
    ...     "  control u in [-1, 1]  dynamics { x' = u }  end x == 0.5"
    ...     "  minimize integral(w * u^2)")
    >>> table = fdcc.sweep(m, {"w": [1, 2, 4]}, N=20)
    >>> list(table["status"]), [round(it, 6) for it in table["objective"]]
    (['solved', 'solved', 'solved'], [0.25, 0.5, 1.0])
    """
    import pandas  # noqa: F401  What makes the table is asked for before hours of work.

    names, table = read(cases)
    params = model.names["params"]
    fixed = tuple(given(values, named, params))
    for name, _ in fixed:
        if name in names:
            raise ValueError(f"`{name}` is swept twice: in `cases`, and for all; leave one out")
    whole("starts", starts, MOST_STARTS)
    gap = difference("gap", gap) if confirmed else None
    limit = seconds("time_limit", time_limit)
    job = _Job(_Text.of(model), fixed, starts, limit, gap)
    own = [given(case, {}, params) for case in table]
    found: list[Any] = [INTERRUPTED] * len(own)
    with seen(model.name, len(own), progress) as done, suppress(KeyboardInterrupt):
        with closing(_each(job, own, workers(client))) as each:
            for first, rows in each:
                found[first : first + len(rows)] = map(json.loads, rows)
                done(len(rows))
    return frame(model, names, table, found, confirmed)


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
        own = [[*self.fixed, *case] for case in cases]
        rows = compiled.solve(own, threads, self.starts, self.time_limit, self.gap)
        return rows, time.monotonic() - begin


@lru_cache(maxsize=4)
def _compiled(text: _Text) -> _fdcc.Cases:
    """The model, read and compiled once in each process."""
    return _fdcc.Cases(_fdcc.Model(text.name, text.text.encode(), dict(text.data) or None))


def _each(job: _Job, cases: Sequence[Any], pool: Workers) -> Iterator[tuple[int, list[str]]]:
    """The rows as they come, each list with the number of its first one."""
    waiting: dict[Any, tuple[int, int]] = {}
    at, size = 0, 1
    try:
        while at < len(cases) or waiting:
            while at < len(cases) and len(waiting) < 2 * pool.count:
                end = min(at + size, len(cases))
                waiting[pool.submit(job, cases[at:end])] = (at, end)
                at = end
            task, (rows, took) = pool.next(list(waiting))
            first, end = waiting.pop(task)
            size = _size(end - first, took, len(cases) - at, pool.count)
            yield first, rows
    finally:
        pool.cancel(list(waiting))


def _size(cases: int, took: float, left: int, count: int) -> int:
    """How many cases are to be sent next, if so many took so long."""
    size = min(cases * _SECONDS / max(took, 1e-6), 8 * cases, left / (2 * count))
    return max(1, min(int(size), _MOST))
