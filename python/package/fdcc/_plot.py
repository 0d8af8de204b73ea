"""Results drawn with matplotlib."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from ._arrays import Signal


def axes(
    time: Signal, signals: Mapping[str, Signal], held: Iterable[tuple[float, float]] = ()
) -> Any:
    """One plot below the other; a signal with a value for each interval is drawn in steps, and
    times at which a surface is held are shaded."""
    try:
        import matplotlib.pyplot as pyplot
    except ImportError:
        raise ImportError("plots need the package matplotlib: pip install matplotlib") from None
    rows = max(len(signals), 1)
    _, found = pyplot.subplots(rows, sharex=True, squeeze=False, figsize=(7, 1.2 + 1.4 * rows))
    own = found[:, 0]
    for plot, (name, signal) in zip(own, signals.items()):
        values = np.asarray(signal)
        if len(values) < len(time):
            plot.stairs(values, np.asarray(time), baseline=None)
        else:
            plot.plot(np.asarray(time), values)
        plot.set_ylabel(titled(name, signal.unit))
        for begin, end in held:
            plot.axvspan(begin, end, color="#f4b942", alpha=0.25, linewidth=0)
    own[-1].set_xlabel(titled("time", time.unit))
    own[0].figure.tight_layout()
    return own


def titled(name: str, unit: str) -> str:
    """``v [m/s]``"""
    return f"{name} [{unit}]" if unit else name
