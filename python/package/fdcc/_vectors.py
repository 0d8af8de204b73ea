"""Vectors, whose parts have names of their own: ``pos`` has ``pos.x`` and ``pos.y``."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from ._arrays import restored
from ._records import no_such


def find(name: str, roles: Sequence[Mapping[str, Any]]) -> Any:
    """What one of these has under a name; a vector is an array whose last axis is its parts."""
    for named in roles:
        if name in named:
            return named[name]
        parts = [named[it] for it in _parts(name, named)]
        if parts:
            return restored(np.stack(parts, axis=-1), name, parts[0].unit)
    raise KeyError(no_such(name, [it for named in roles for it in named]))


def entry(role: str, own: Any, name: str, known: Sequence[str]) -> Any:
    """What a caller gives for a state or control, or for the vector whose part that is."""
    if name in own:
        return own[name]
    vector = name.rpartition(".")[0]
    if not vector or vector not in own:
        raise ValueError(f"there is no value of the {role} {name!r}; needed is {', '.join(known)}")
    parts, values = _parts(vector, known), np.asarray(own[vector])
    if np.shape(values)[-1:] != (len(parts),):
        raise ValueError(f"the {role} {vector!r} needs {len(parts)} parts, {', '.join(parts)}")
    return values[..., parts.index(name)]


def refuse_others(role: str, own: Iterable[str], known: Sequence[str]) -> None:
    """Tells of what stands there that is no state or control."""
    vectors = {name.rpartition(".")[0] for name in known}
    for name in own:
        if name not in known and name not in vectors:
            raise ValueError(no_such(name, list(known), role))


def _parts(vector: str, known: Iterable[str]) -> list[str]:
    return [name for name in known if name.startswith(f"{vector}.")]
