"""Controls that Python hands over."""

from __future__ import annotations

from collections.abc import Mapping
from os import PathLike, fspath
from typing import TYPE_CHECKING, Any

import numpy as np

from ._solution import Solution

if TYPE_CHECKING:
    from ._model import Model

Controls = Solution | str | PathLike[str] | Mapping[str, Any] | None
"""A solution, the path of a saved one, or values of each control in SI."""


def driver(u: Controls, model: "Model") -> Any:
    """The controls as the library takes them: times, and a row of values for each."""
    if u is None:
        return None
    if isinstance(u, Solution):
        return u._solution
    if isinstance(u, (str, PathLike)):
        return fspath(u)
    own: Any = u  # a table of pandas has entries, too
    names = model.names["controls"]
    missing = [name for name in names if name not in own]
    if missing:
        raise ValueError(f"`u` has no values of the control {missing[0]!r}")
    columns = [np.atleast_1d(np.asarray(own[name], dtype=float)) for name in names]
    rows = np.stack(np.broadcast_arrays(*columns), axis=1)
    times = [float(it) for it in own["t"]] if "t" in own else None
    return times, rows.tolist()
