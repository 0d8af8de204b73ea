"""What stands in the JSON documents of the command, under the same names, and not to be changed."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from difflib import get_close_matches
from html import escape
from keyword import iskeyword
from typing import Any, Generic, TypeVar

T = TypeVar("T")


class Named(Mapping[str, T], Generic[T]):
    """Values under names, in the order of the model.

    >>> import fdcc
    >>> m = fdcc.compile("time t in [0, 1]  param a = 2  state x start 0  dynamics { x' = a }")
    >>> ends = m.simulate().end
    >>> list(ends), round(ends["x"], 9)
    (['time', 'x'], 2.0)
    >>> ends["y"]
    Traceback (most recent call last):
    KeyError: "there is no 'y'; there is time, x"
    """

    __slots__ = ("_values",)

    _values: dict[str, T]

    def __init__(self, values: Mapping[str, T] | Sequence[tuple[str, T]] = ()) -> None:
        object.__setattr__(self, "_values", dict(values))

    def __getitem__(self, name: str) -> T:
        try:
            return self._values[name]
        except KeyError:
            raise KeyError(no_such(name, list(self._values))) from None

    def __contains__(self, name: object) -> bool:
        return name in self._values

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def __setattr__(self, name: str, value: Any) -> None:
        raise AttributeError("a result cannot be changed")

    def __reduce__(self):
        return (type(self), (self._values,))

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self._values!r})"

    def _ipython_key_completions_(self) -> list[str]:
        return list(self)


class Record(Named[Any]):
    """An object of a JSON document: its entries are attributes, too; one that is a word of Python
    with an underscore behind it, as ``from_``."""

    __slots__ = ()

    def __getattr__(self, name: str) -> Any:
        try:
            return self._values[name[:-1] if iskeyword(name[:-1]) else name]
        except KeyError:
            raise AttributeError(no_such(name, list(self._values))) from None

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *(name for name in self._values if name.isidentifier())]


class Diagnostics(tuple):
    """Findings in a text; ``str`` is their drawing."""

    drawing: str

    def __new__(cls, findings: str, drawing: str) -> "Diagnostics":
        self = super().__new__(cls, read(findings))
        self.drawing = drawing.rstrip()
        return self

    def __str__(self) -> str:
        return self.drawing or "nothing wrong"

    def _repr_html_(self) -> str:
        return f"<pre>{escape(str(self))}</pre>"


def read(text: str) -> Any:
    """A JSON text as records and tuples; ``null`` is ``None``."""
    return frozen(json.loads(text))


def frozen(value: Any) -> Any:
    """The same, not to be changed."""
    if isinstance(value, dict):
        return Record({name: frozen(it) for name, it in value.items()})
    return tuple(map(frozen, value)) if isinstance(value, list) else value


def no_such(name: str, known: list[str]) -> str:
    """Why there is nothing of a name."""
    near = get_close_matches(name, known, 1)
    if near:
        return f"there is no {name!r}; did you mean {near[0]!r}?"
    return f"there is no {name!r}; there is {', '.join(known) or 'nothing'}"
