"""Solutions that another call begins at, or follows."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from os import PathLike, fspath
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from . import _fdcc, _saved
from ._solution import Solution
from ._values import short


@contextmanager
def lent(argument: str, earlier: Any) -> Iterator[_fdcc.Solution | str | None]:
    """A solution as the library takes it: its own, or the path of a file."""
    if not isinstance(earlier, (Solution, str, PathLike, type(None))):
        needs = "a solution, or the path of a saved one"
        raise TypeError(f"`{argument}` cannot be {short(earlier)}; it needs {needs}")
    own = earlier._solution if isinstance(earlier, Solution) else earlier and fspath(earlier)
    if not isinstance(own, _saved.Solution):
        yield own
        return
    with TemporaryDirectory() as folder:
        path = Path(folder) / "earlier.sol.json"
        path.write_text(own.json(), encoding="utf-8")
        yield str(path)
