"""Controls that Python hands over."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np

from ._earlier import lent
from ._records import Named
from ._solution import Solution
from ._values import row, short
from ._vectors import entry, refuse_others

if TYPE_CHECKING:
    from ._model import Model

Controls = Solution | str | PathLike[str] | Mapping[str, Any] | None
"""A solution, the path of a saved one, or values of each control in SI."""


@contextmanager
def driver(u: Controls, model: "Model") -> Iterator[Any]:
    """The controls as the library takes them: times, and a row of values for each."""
    if u is None or isinstance(u, (Solution, str, PathLike)):
        with lent("u", u) as earlier:
            yield earlier
    elif model.names["phases"]:
        raise ValueError("each phase has controls of its own: `u` takes a solution or its path")
    else:
        yield _rows(u, model.names["controls"])


def _rows(own: Any, names: tuple[str, ...]) -> tuple[list[float] | None, list[list[float]]]:
    if not hasattr(own, "keys"):
        needs = "a solution, the path of a saved one, or values of each control by name"
        raise TypeError(f"`u` cannot be {short(own)}; it needs {needs}")
    if isinstance(own, (dict, Named)):  # tables have columns of other names, too
        refuse_others("control", (name for name in own if name != "t"), names)
    columns = [row(f"control {name!r}", entry("control", own, name, names)) for name in names]
    lengths = {len(column) for column in columns} - {1}
    if len(lengths) > 1:
        raise ValueError(f"the controls have different lengths: {sorted(lengths)}")
    rows = np.stack(np.broadcast_arrays(*columns), axis=1)
    times = row("times `t`", own["t"]).tolist() if "t" in own else None
    return times, rows.tolist()
