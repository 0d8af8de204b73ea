"""Results drawn with matplotlib."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from ._arrays import Signal
from ._records import no_such
from ._tables import both_sides

class Line(NamedTuple):
    """A signal over times of its own; with one value less than times it is drawn in steps."""

    time: Any
    values: Any
    unit: str


class Piece(NamedTuple):
    """Signals that are drawn over each other's times, and spans of time that are shaded."""

    time_unit: str
    lines: Mapping[str, Line]
    held: Iterable[tuple[float, float]] = ()


def axes(pieces: Sequence[Piece]) -> Any:
    """One plot below the other, of pieces that follow one another in time; a signal with a value
    for each interval is drawn in steps, and times at which a surface is held are shaded."""
    try:
        import matplotlib.pyplot as pyplot
    except ImportError:
        raise ImportError("plots need the package matplotlib: pip install matplotlib") from None
    names = list(dict.fromkeys(name for piece in pieces for name in piece.lines))
    rows = max(len(names), 1)
    _, found = pyplot.subplots(rows, sharex=True, squeeze=False, figsize=(7, 1.2 + 1.4 * rows))
    own = found[:, 0]
    for plot, name in zip(own, names):
        for piece in pieces:
            if name in piece.lines:
                _draw(plot, name, piece.lines[name], piece.held)
    own[-1].set_xlabel(titled("time", pieces[0].time_unit))
    own[0].figure.tight_layout()
    return own


def drawn(solution: Any, names: Sequence[str] | None) -> Any:
    """The same of a solution, or of its phases."""
    found = [_piece(it, names) for it in solution.phases.values() or [solution]]
    for name in names or ():
        if not any(name in piece.lines for piece in found):
            raise KeyError(no_such(name, solution._ipython_key_completions_()))
    return axes(found)


def over_time(time: Signal, signals: Mapping[str, Signal]) -> Piece:
    """Signals over the same times."""
    return Piece(time.unit, {name: Line(time, it, it.unit) for name, it in signals.items()})


def _piece(solution: Any, names: Sequence[str] | None) -> Piece:
    """States and controls, or what has these names, which may begin with that of the phase."""
    if names is None:
        signals = {**solution.states, **solution.controls}
    else:
        own = {name: name.removeprefix(f"{solution._phase}.") for name in names}
        signals = {name: solution[it] for name, it in own.items() if it in solution}
    spans = (span for spans in solution.surfaces.values() for span in spans)
    held = [(span["from"], span["to"]) for span in spans if span.mode == "held"]
    lines = {name: _line(solution, name, signal) for name, signal in signals.items()}
    return Piece(solution.time.unit, lines, held)


def _line(solution: Any, name: str, signal: Any) -> Line:
    """A state with both sides of its jumps; a control through the values that define it, with a gap
    where it may jump."""
    own = name.removeprefix(f"{solution._phase}.")
    if own in solution.states and solution._jumps:
        time, columns = both_sides(solution.time, {own: signal}, solution._jumps)
        return Line(time, columns[own], signal.unit)
    nodes = solution._control_nodes
    if own in solution.controls and nodes:
        time, values = np.asarray(nodes.time), np.asarray(nodes["values"][own])
        found = solution.certificate
        switches = found.switches if found and found.certified else ()
        changes = [it.time for it in (*solution._jumps, *switches)]
        gaps = np.searchsorted(time, changes)
        return Line(np.insert(time, gaps, np.nan), np.insert(values, gaps, np.nan), signal.unit)
    return Line(solution.time, signal, getattr(signal, "unit", ""))


def _draw(plot: Any, name: str, line: Line, held: Iterable[tuple[float, float]]) -> None:
    time, values, unit = line
    if np.ndim(values) == 0 or len(time) - len(values) not in (0, 1):
        raise ValueError(f"`{name}` is no signal over time, and cannot be drawn")
    # Pieces and parts of vectors: those of one colour belong together.
    for at, own in enumerate(np.reshape(values, (len(values), -1)).T):
        if len(own) < len(time):
            plot.stairs(own, np.asarray(time), baseline=None, color=f"C{at}")
        else:
            plot.plot(np.asarray(time), own, color=f"C{at}")
    plot.set_ylabel(titled(name, unit))
    for begin, end in held:
        plot.axvspan(begin, end, color="#f4b942", alpha=0.25, linewidth=0)


def titled(name: str, unit: str) -> str:
    """``v [m/s]``"""
    return f"{name} [{unit}]" if unit else name
