"""Results drawn with matplotlib."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from ._arrays import Signal
from ._records import no_such

Piece = tuple[Signal, Mapping[str, Any], Iterable[tuple[float, float]]]
"""Times, signals, and spans of time that are shaded."""


def axes(pieces: Sequence[Piece]) -> Any:
    """One plot below the other, of pieces that follow one another in time; a signal with a value
    for each interval is drawn in steps, and times at which a surface is held are shaded."""
    try:
        import matplotlib.pyplot as pyplot
    except ImportError:
        raise ImportError("plots need the package matplotlib: pip install matplotlib") from None
    names = list(dict.fromkeys(name for _, signals, _ in pieces for name in signals))
    rows = max(len(names), 1)
    _, found = pyplot.subplots(rows, sharex=True, squeeze=False, figsize=(7, 1.2 + 1.4 * rows))
    own = found[:, 0]
    for plot, name in zip(own, names):
        for time, signals, held in pieces:
            if name in signals:
                _draw(plot, time, name, signals[name], held)
    own[-1].set_xlabel(titled("time", pieces[0][0].unit))
    own[0].figure.tight_layout()
    return own


def drawn(solution: Any, names: Sequence[str] | None) -> Any:
    """The same of a solution, or of its phases."""
    found = [_piece(it, names) for it in solution.phases.values() or [solution]]
    for name in names or ():
        if not any(name in signals for _, signals, _ in found):
            raise KeyError(no_such(name, solution._ipython_key_completions_()))
    return axes(found)


def _piece(solution: Any, names: Sequence[str] | None) -> Piece:
    """States and controls, or what has these names, which may begin with that of the phase."""
    if names is None:
        signals = {**solution.states, **solution.controls}
    else:
        own = {name: name.removeprefix(f"{solution._phase}.") for name in names}
        signals = {name: solution[it] for name, it in own.items() if it in solution}
    spans = (span for spans in solution.surfaces.values() for span in spans)
    held = [(span["from"], span["to"]) for span in spans if span.mode == "held"]
    return solution.time, signals, held


def _draw(plot: Any, time: Signal, name: str, signal: Any, held: Any) -> None:
    if np.ndim(signal) == 0 or len(time) - len(signal) not in (0, 1):
        raise ValueError(f"`{name}` is no signal over time, and cannot be drawn")
    # Pieces and parts of vectors: those of one colour belong together.
    for at, values in enumerate(np.reshape(signal, (len(signal), -1)).T):
        if len(values) < len(time):
            plot.stairs(values, np.asarray(time), baseline=None, color=f"C{at}")
        else:
            plot.plot(np.asarray(time), values, color=f"C{at}")
    plot.set_ylabel(titled(name, signal.unit))
    for begin, end in held:
        plot.axvspan(begin, end, color="#f4b942", alpha=0.25, linewidth=0)


def titled(name: str, unit: str) -> str:
    """``v [m/s]``"""
    return f"{name} [{unit}]" if unit else name
