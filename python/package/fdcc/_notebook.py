"""Models in the cells of a notebook."""

from __future__ import annotations

import shlex
from keyword import iskeyword
from typing import Any

from ._errors import ModelError
from ._model import compile


def load_ipython_extension(shell: Any) -> None:
    """What ``%load_ext fdcc`` does: cells that begin with ``%%fdc NAME`` are models, and
    ``%%fdc NAME --data DIR`` names the folder of their data files.

    The model is then the variable ``NAME``; where it has a mistake the drawing of it is shown, and
    there is no variable of that name.
    """

    def fdc(line: str, cell: str) -> Any:
        name, data = _read(line)
        shell.user_ns.pop(name, None)
        try:
            model = compile(cell, name=name, data=data)
        except ModelError as error:
            return error.diagnostics
        shell.user_ns[name] = model
        return model.diagnostics or None

    shell.register_magic_function(fdc, magic_kind="cell", magic_name="fdc")


def _read(line: str) -> tuple[str, str | None]:
    """The name of the variable, and the folder of data files."""
    match shlex.split(line):
        case []:
            return "model", None
        case [name, *rest] if name.isidentifier() and not iskeyword(name):
            match rest:
                case []:
                    return name, None
                case ["--data", data]:
                    return name, data
    raise ValueError(
        f"`%%fdc {line}`: write the name of a variable, as in `%%fdc block`, and perhaps the folder"
        " of its data files, as in `%%fdc block --data measured`"
    )
