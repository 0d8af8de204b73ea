"""A bar while a solve runs, where tqdm is there and somebody sees it."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

Report = Callable[[int, float, float, int], None]

_DELAY = 1.0
"""Who waits for less than so many seconds wants no bar."""


@contextmanager
def progress(name: str, is_wanted: bool | None) -> Iterator[Report | None]:
    """What the solver calls; ``None`` if nobody is to see anything."""
    if is_wanted is False or is_wanted is None and not _is_seen():
        yield None
        return
    try:
        from tqdm.auto import tqdm
    except ImportError:
        if is_wanted:
            raise ImportError("progress needs the package tqdm: pip install tqdm") from None
        yield None
        return
    delay = 0.0 if is_wanted else _DELAY
    with tqdm(desc=name, unit=" iterations", delay=delay, leave=False) as bar:

        def report(iteration: int, objective: float, violation: float, intervals: int) -> None:
            figures = f"objective {objective:.6g}, violation {violation:.1e}, N {intervals}"
            bar.set_postfix_str(figures, refresh=False)
            bar.update()

        yield report


def _is_seen() -> bool:
    return sys.stderr.isatty() or "ipykernel" in sys.modules
