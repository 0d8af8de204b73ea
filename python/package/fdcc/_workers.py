"""Who does work for us: this process, or the workers of Dask, Ray, joblib and executors."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent import futures
from os import cpu_count
from typing import Any, Protocol

Work = Callable[[Sequence[Any], int | None], Any]
"""Does some cases, in so many threads; in as many as there are processors for ``None``."""

_RETRIES = 3
"""So often work is sent once more whose worker died."""


class Workers(Protocol):
    """Work is handed in, and comes back in any order."""

    count: int
    """How many work at the same time."""

    def submit(self, work: Work, cases: Sequence[Any]) -> Any:
        """Hands in work; what stands for its result, and can be a key."""

    def next(self, waiting: list[Any]) -> tuple[Any, Any]:
        """Waits for one of these; which, and its result."""

    def cancel(self, waiting: list[Any]) -> None:
        """Nobody waits for these any more."""


def workers(client: Any) -> Workers:
    """Those of a client; see :func:`fdcc.sweep`."""
    if client is None:
        return _Here()
    kind = type(client).__module__.partition(".")[0]
    if getattr(client, "__name__", "") == "ray":
        return _OnRay(client)
    if kind == "distributed":
        return _OnDask(client)
    if kind == "joblib":
        return _WithJoblib(client)
    if hasattr(client, "submit"):
        return _WithExecutor(client)
    raise TypeError(
        "`client` is a dask.distributed.Client, the module ray, a joblib.Parallel or an executor,"
        f" not {client!r}"
    )


class _Task:
    """Work that is not done yet."""

    def __init__(self, work: Work, cases: Sequence[Any]) -> None:
        self.work, self.cases = work, cases


class _Here:
    """All processors of this machine, in this process."""

    count = 1

    def submit(self, work: Work, cases: Sequence[Any]) -> _Task:
        return _Task(work, cases)

    def next(self, waiting: list[_Task]) -> tuple[_Task, Any]:
        task = waiting[0]
        return task, task.work(task.cases, None)

    def cancel(self, waiting: list[_Task]) -> None:
        pass


class _WithExecutor:
    """Threads or processes of ``concurrent.futures``. One that breaks cannot be mended."""

    def __init__(self, executor: Any) -> None:
        self._executor = executor
        self.count = getattr(executor, "_max_workers", None) or cpu_count() or 1

    def submit(self, work: Work, cases: Sequence[Any]) -> Any:
        return self._executor.submit(work, cases, 1)

    def next(self, waiting: list[Any]) -> tuple[Any, Any]:
        done = next(iter(futures.wait(waiting, return_when=futures.FIRST_COMPLETED).done))
        return done, done.result()

    def cancel(self, waiting: list[Any]) -> None:
        for task in waiting:
            task.cancel()


class _OnDask:
    """A cluster of Dask, which gives the work of a worker that died to another one."""

    def __init__(self, client: Any) -> None:
        self._client = client
        self.count = sum(client.nthreads().values()) or 1

    def submit(self, work: Work, cases: Sequence[Any]) -> Any:
        return self._client.submit(work, cases, 1, pure=False, retries=_RETRIES)

    def next(self, waiting: list[Any]) -> tuple[Any, Any]:
        from distributed import wait

        done = next(iter(wait(waiting, return_when="FIRST_COMPLETED").done))
        return done, done.result()

    def cancel(self, waiting: list[Any]) -> None:
        self._client.cancel(waiting)


class _OnRay:
    """Ray, which does the same."""

    def __init__(self, ray: Any) -> None:
        self._ray = ray
        self._do = ray.remote(max_retries=_RETRIES)(_do)
        self._works: dict[int, Any] = {}
        self.count = int(ray.cluster_resources().get("CPU", 1))

    def submit(self, work: Work, cases: Sequence[Any]) -> Any:
        if id(work) not in self._works:
            self._works[id(work)] = self._ray.put(work)
        return self._do.remote(self._works[id(work)], cases)

    def next(self, waiting: list[Any]) -> tuple[Any, Any]:
        done = self._ray.wait(waiting, num_returns=1)[0][0]
        return done, self._ray.get(done)

    def cancel(self, waiting: list[Any]) -> None:
        for task in waiting:
            self._ray.cancel(task)


class _WithJoblib:
    """A ``joblib.Parallel``: all work that waits is done at once, and once more where a worker
    died."""

    def __init__(self, parallel: Any) -> None:
        self._parallel = parallel
        self._found: dict[_Task, Any] = {}
        from joblib import effective_n_jobs

        self.count = effective_n_jobs(parallel.n_jobs)

    def submit(self, work: Work, cases: Sequence[Any]) -> _Task:
        return _Task(work, cases)

    def next(self, waiting: list[_Task]) -> tuple[_Task, Any]:
        if not self._found:
            self._found = dict(zip(waiting, self._all(waiting)))
        task = next(iter(self._found))
        return task, self._found.pop(task)

    def cancel(self, waiting: list[_Task]) -> None:
        pass

    def _all(self, waiting: list[_Task]) -> list[Any]:
        from joblib import delayed

        for attempt in range(_RETRIES + 1):
            try:
                return list(self._parallel(delayed(_do)(it.work, it.cases) for it in waiting))
            except futures.BrokenExecutor:
                if attempt == _RETRIES:
                    raise
        raise AssertionError("the last attempt returns or raises")


def _do(work: Work, cases: Sequence[Any]) -> Any:
    return work(cases, 1)
