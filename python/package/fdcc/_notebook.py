"""Models in the cells of a notebook."""

from __future__ import annotations

from typing import Any

from ._errors import ModelError
from ._model import compile


def load_ipython_extension(shell: Any) -> None:
    """What ``%load_ext fdcc`` does: cells that begin with ``%%fdc NAME`` are models.

    The model is then the variable ``NAME``; where it has a mistake the drawing of it is shown, and
    there is no variable of that name.
    """

    def fdc(line: str, cell: str) -> Any:
        name = line.strip() or "model"
        if not name.isidentifier():
            raise ValueError(f"`%%fdc {line}`: write the name of a variable, as in `%%fdc block`")
        shell.user_ns.pop(name, None)
        try:
            model = compile(cell, name=name)
        except ModelError as error:
            return error.diagnostics
        shell.user_ns[name] = model
        return model.diagnostics or None

    shell.register_magic_function(fdc, magic_kind="cell", magic_name="fdc")
