"""Results in notebooks."""

from __future__ import annotations

from collections.abc import Iterable
from html import escape
from typing import Any


def table(title: str, rows: Iterable[tuple[str, Any, str]]) -> str:
    """Names, numbers and units under a title."""
    lines = (
        f"<tr><td>{escape(name)}</td><td>{escape(_shown(value))}</td><td>{escape(unit)}</td></tr>"
        for name, value, unit in rows
    )
    return f"<p><b>{escape(title)}</b></p><table>{''.join(lines)}</table>"


def _shown(value: Any) -> str:
    return f"{value:.9g}" if isinstance(value, float) else f"{len(value)} numbers"
