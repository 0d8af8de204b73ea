"""Results as tables of pandas and xarray."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ._arrays import Signal


def frame(time: Signal, signals: Mapping[str, Signal], jumps: Sequence[Any] = ()) -> Any:
    """A data frame, indexed by time; a signal with a value for each interval has that of the last
    one twice, and a jump has two rows. Units are in ``attrs["units"]``."""
    import pandas

    times, columns = both_sides(time, signals, jumps)
    table = pandas.DataFrame(columns, index=pandas.Index(times, name="time"))
    table.attrs["units"] = {"time": time.unit} | {it: own.unit for it, own in signals.items()}
    return table


def both_sides(
    time: Signal, signals: Mapping[str, Signal], jumps: Sequence[Any]
) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Times, and a value of each signal at each of them. A jump has two rows, before it and after
    it: in the first one a control has the value of the interval that ends, a report none."""
    rows = {int(np.argmin(np.abs(np.asarray(time) - it.time))): it.before for it in jumps}
    order = [row for row in range(len(time)) for _ in range(1 + (row in rows))]
    first = [at for at, row in enumerate(order) if row in rows and order[at + 1 :][:1] == [row]]

    def column(name: str, signal: Signal) -> np.ndarray:
        values = held(time, signal)[order]
        for at in first:
            is_held = len(signal) < len(time)
            values[at] = rows[order[at]].get(name, values[at - 1] if is_held else np.nan)
        return values

    return np.asarray(time)[order], {name: column(name, it) for name, it in signals.items()}


def held(time: Signal, signal: Signal) -> np.ndarray:
    """A value at each time, the last of an interval at its end as well."""
    values = np.asarray(signal)
    return values if len(values) == len(time) else np.append(values, values[-1:])


def dataset(time: Signal, signals: Mapping[str, Signal]) -> Any:
    """A dataset over ``time``; a signal with a value for each interval is over ``interval``, where
    each begins."""
    import xarray

    def variable(signal: Signal) -> Any:
        axis = "time" if len(signal) == len(time) else "interval"
        return (axis, np.asarray(signal), {"units": signal.unit})

    named = {name: variable(it) for name, it in signals.items()}
    has_intervals = any(axis == "interval" for axis, *_ in named.values())
    begins = {"interval": variable(time[:-1])} if has_intervals else {}
    return xarray.Dataset(named, {"time": variable(time), **begins})
