"""Results that were read again: what the half of the package that is Rust offers of its own, of the
text of their documents."""

from __future__ import annotations

import json
from html import escape
from typing import Any

import numpy as np

_SOLVED = ("solved", "acceptable")

Columns = list[tuple[str, np.ndarray]]


class Solution:
    """A ``.sol.json``, or one of its phases."""

    def __init__(self, text: str, phase: str | None = None) -> None:
        self._text, self._whole = text, json.loads(text)
        self._own = self._whole if phase is None else self._whole["phases"][phase]
        self.model: str = phase or self._whole["model"]
        self.status: str = self._whole["status"]
        self.is_solved = self.status in _SOLVED
        self.objective = _number(self._whole["objective"])
        self.free = _pairs(self._whole["free"])
        self.params = _pairs(self._whole["params"])

    @property
    def units(self) -> list[tuple[str, str]]:
        units = self._whole.get("units", {})
        shown = self._whole.get("display_units", {})
        # The document has that of time under the name that the model gives it.
        time = (units[it] for it in units if it in shown and shown[it] == shown.get("time"))
        return [*units.items(), *(("time", it) for it in [*time][:1])]

    def time(self) -> np.ndarray:
        return _column(self._own["time"])

    def hamiltonian(self) -> np.ndarray:
        return _column(self._own.get("hamiltonian", []))

    def states(self) -> Columns:
        return _columns(self._own.get("states", {}))

    def costates(self) -> Columns:
        return _columns(self._own.get("costates", {}))

    def controls(self) -> Columns:
        return _columns(self._own.get("controls", {}))

    def report(self) -> Columns:
        return _columns(self._own.get("report", {}))

    def phases(self) -> list["Solution"]:
        names = self._own.get("phases", {}) if self._own is self._whole else {}
        return [Solution(self._text, name) for name in names]

    def confirmed(self) -> bool:
        is_contradicted = self._whole.get("optimality", {}).get("contradicted", False)
        return self._whole.get("verification", {}).get("confirmed", False) and not is_contradicted

    def verification(self, gap: float) -> str:
        """The replay is that of the document; what it confirms depends on the gap."""
        found = self._whole.get("verification")
        if found is None and not self.is_solved:
            raise ValueError(f"this was saved as {self.status!r}, without a replay; solve it again")
        if found is not None:
            gaps = [found["state_gap"], found["relative_violation"]]
            confirmed = None not in gaps and max(gaps) <= gap
            found = {**found, "confirmed": confirmed, "asked": gap}
        return json.dumps(found)

    def derivative(self, by: str) -> str:
        """Those that the document has: what was asked for with ``fdcc solve --wrt``."""
        found = self._whole.get("derivatives", {}).get(by)
        if found is None:
            raise ValueError(
                f"this was saved without a derivative by {by!r}; solve it again with `warm`, or by"
                f" `fdcc solve --wrt {by}`"
            )
        return json.dumps(found)

    def json(self) -> str:
        return self._text

    def html(self) -> str:
        return f"<p><b>{escape(f'{self.model}: {self.status}, {self.words()}')}</b></p>"

    def words(self) -> str:
        optimality = self._whole.get("optimality", {})
        if optimality.get("contradicted"):
            return f"{self._replayed()}, CONTRADICTED as an optimum: {optimality['says']}"
        return self._replayed()

    def _replayed(self) -> str:
        found = self._whole.get("verification")
        if found is None:
            return "not replayed on the true system"
        gaps = [found["state_gap"], found["relative_violation"]]
        if None in gaps:
            return "and its replay on the true system does not reach the end"
        if not found["confirmed"]:
            return "NOT CONFIRMED on the true system"
        how = ", phase by phase," if found.get("phase_by_phase") else ""
        return f"confirmed on the true system{how} to {max(gaps):.1e}"


class Simulation:
    """A document of ``fdcc simulate --json``, or one of its phases."""

    def __init__(self, text: str, phase: str | None = None) -> None:
        self._text, whole = text, json.loads(text)
        self._own = whole if phase is None else whole["phases"][phase]

    def time(self) -> np.ndarray | None:
        return _column(self._own["time"]) if "time" in self._own else None

    def states(self) -> Columns:
        return _columns(self._own.get("states", {}))

    def phases(self) -> list[tuple[str, "Simulation"]]:
        return [(name, Simulation(self._text, name)) for name in self._own.get("phases", {})]

    def json(self) -> str:
        return self._text


class Gradient:
    """A document of ``fdcc grad --json``."""

    def __init__(self, text: str) -> None:
        self._text, self._whole = text, json.loads(text)
        self.value: float | None = self._whole["value"]
        self.trusted: bool = self._whole["trusted"]

    def derivatives(self) -> list[tuple[str, bool, np.ndarray]]:
        found = self._whole["gradient"].items()
        return [(name, isinstance(it, list), np.atleast_1d(_column(it))) for name, it in found]

    def json(self, second: bool) -> str:
        return self._text


def _number(value: Any) -> float:
    """JSON has no infinite numbers: they are ``null``."""
    return float("nan") if value is None else value


def _pairs(values: dict[str, Any]) -> list[tuple[str, float]]:
    return [(name, _number(it)) for name, it in values.items()]


def _columns(values: dict[str, Any]) -> Columns:
    return [(name, _column(it)) for name, it in values.items()]


def _column(values: Any) -> np.ndarray:
    array = np.array(values, dtype=float)
    array.flags.writeable = False
    return array
