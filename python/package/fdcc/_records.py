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
    """Values under names, in the order of the model; they are attributes, too, where a word of
    Python has an underscore behind it, as ``from_``.

    >>> import fdcc
    >>> m = fdcc.compile("time t in [0, 1]  param a = 2  state x start 0  dynamics { x' = a }")
    >>> ends = m.simulate().end
    >>> list(ends), round(ends["x"], 9), ends.x == ends["x"]
    (['time', 'x'], 2.0, True)
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

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        own = name[:-1] if iskeyword(name[:-1]) else name
        if own not in self._values:
            raise AttributeError(no_such(name, list(self._values)))
        return self._values[own]

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *(name for name in self._values if name.isidentifier())]

    def __contains__(self, name: object) -> bool:
        return name in self._values

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def __setattr__(self, name: str, value: Any) -> None:
        raise AttributeError("a result cannot be changed")

    def __reduce__(self) -> Any:
        return (type(self), (self._values,))

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self._values!r})"

    def _ipython_key_completions_(self) -> list[str]:
        return list(self)


class Record(Named[Any]):
    """An object of a JSON document."""

    __slots__ = ()

    def to_dict(self) -> dict[str, Any]:
        """The same as dictionaries and lists, for ``json.dumps`` and others.

        >>> import fdcc
        >>> m = fdcc.compile("time t in [0, 1]  state x start 0  dynamics { x' = 1 }")
        >>> m.simulate(t=[0, 1]).document.to_dict()["time"]
        [0.0, 1.0]
        """
        return _plain(self)

    def __repr__(self) -> str:
        return f"{{{', '.join(f'{name!r}: {_short(it)}' for name, it in self.items())}}}"


class Diagnostics(tuple):
    """Findings in a text; as text they are their drawing."""

    drawing: str

    def __new__(cls, findings: str, drawing: str) -> "Diagnostics":
        self = super().__new__(cls, read(findings))
        self._findings, self.drawing = findings, drawing.rstrip()
        return self

    def __getnewargs__(self) -> tuple[str, str]:
        return self._findings, self.drawing

    def __str__(self) -> str:
        return self.drawing or "nothing wrong"

    __repr__ = __str__

    def _repr_html_(self) -> str:
        return f"<pre>{escape(str(self))}</pre>"


class Result:
    """What was found. It cannot be changed, so that a copy is the same; entries of its document are
    attributes, too."""

    __slots__ = ()

    document: Record

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_") or name == "document":
            raise AttributeError(name)
        if name not in self.document:
            own = [it for it in dir(type(self)) if not it.startswith("_")]
            raise AttributeError(no_such(name, sorted({*own, *self.document})))
        return getattr(self.document, name)

    def __setattr__(self, name: str, value: Any) -> None:
        raise AttributeError("a result cannot be changed")

    def __copy__(self) -> Any:
        return self

    def __deepcopy__(self, memo: Any) -> Any:
        return self


def read(text: str) -> Any:
    """A JSON text as records and tuples; ``null`` is ``None``."""
    return frozen(json.loads(text))


def frozen(value: Any) -> Any:
    """The same, not to be changed."""
    if isinstance(value, dict):
        return Record({name: frozen(it) for name, it in value.items()})
    if not isinstance(value, list):
        return value
    # Most lists are long and have nothing but numbers.
    has_parts = not {dict, list}.isdisjoint(map(type, value))
    return tuple(map(frozen, value)) if has_parts else tuple(value)


def _plain(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {name: _plain(it) for name, it in value.items()}
    return [_plain(it) for it in value] if isinstance(value, tuple) else value


_SHORT = 72
"""An entry that takes more characters is shown by its size."""


def _short(value: Any) -> str:
    """An entry of a record, for people."""
    text = "" if isinstance(value, tuple) and len(value) > _SHORT else repr(value)
    if text and len(text) <= _SHORT:
        return text
    if isinstance(value, str):
        return f"{text[:_SHORT]}...{text[0]}"
    return f"<{len(value)} {'names' if isinstance(value, Record) else 'entries'}>"


def no_such(name: str, known: list[str], role: str = "") -> str:
    """Why there is nothing of a name, among states or the like."""
    missing = f"there is no {f'{role} {name!r}' if role else repr(name)}"
    near = get_close_matches(name, known, 1)
    if near:
        return f"{missing}; did you mean {near[0]!r}?"
    return f"{missing}; there is {', '.join(known) or 'nothing'}"
