"""Results as tables of pandas and xarray."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ._arrays import Signal


def frame(time: Signal, signals: Mapping[str, Signal]) -> Any:
    """A data frame, indexed by time; a signal with a value for each interval has that of the last
    one twice. Units are in ``attrs["units"]``."""
    import pandas

    index = pandas.Index(np.asarray(time), name="time")
    columns = {name: held(time, it) for name, it in signals.items()}
    table = pandas.DataFrame(columns, index=index)
    table.attrs["units"] = {"time": time.unit} | {it: own.unit for it, own in signals.items()}
    return table


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
