"""A bar while a solve runs, where tqdm is there and somebody sees it."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

Report = Callable[[int, float, float, int], None]

_DELAY = 1.0
"""Who waits for less than so many seconds wants no bar."""


@contextmanager
def progress(name: str, is_wanted: bool | None) -> Iterator[Report | None]:
    """What the solver calls; ``None`` if nobody is to see anything."""
    tqdm = _bar(is_wanted)
    if tqdm is None:
        yield None
        return
    delay = 0.0 if is_wanted else _DELAY
    with tqdm(desc=name, unit=" iterations", delay=delay, leave=False) as bar:

        def report(iteration: int, objective: float, violation: float, intervals: int) -> None:
            figures = f"objective {objective:.6g}, violation {violation:.1e}, N {intervals}"
            bar.set_postfix_str(figures, refresh=False)
            bar.update()

        yield report


@contextmanager
def seen(name: str, count: int, is_wanted: bool | None) -> Iterator[Callable[[int], object]]:
    """What is called with how many of so many cases are done."""
    bar = _bar(is_wanted)
    if bar is None:
        yield lambda _: None
        return
    with bar(desc=name, total=count, unit=" cases", leave=False) as shown:
        yield shown.update


def _bar(is_wanted: bool | None) -> Any:
    """The bars of tqdm; ``None`` if nobody is to see anything."""
    if is_wanted is False or is_wanted is None and not _is_seen():
        return None
    try:
        from tqdm.auto import tqdm
    except ImportError:
        if is_wanted:
            raise ImportError("progress needs the package tqdm: pip install tqdm") from None
        return None
    return tqdm


def _is_seen() -> bool:
    return sys.stderr.isatty() or "ipykernel" in sys.modules
