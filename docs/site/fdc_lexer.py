"""Highlights `fdc` for Pygments, with the words of editors/words.json, which the compiler writes."""

import json
from pathlib import Path

from pygments.lexer import RegexLexer, bygroups, words
from pygments.lexers import LEXERS
from pygments.token import (
    Comment, Keyword, Name, Number, Operator, Punctuation, String, Whitespace,
)

__all__ = ["FdcLexer"]

WORDS = json.loads((Path(__file__).parents[2] / "editors" / "words.json").read_text())
# The token of each kind of words.
TOKENS = {
    "items": Keyword.Declaration,
    "keywords": Keyword,
    "functions": Name.Builtin,
    "constants": Name.Constant,
    "clauses": Keyword.Pseudo,
}
DECLARATIONS = "model|param|const|let|fn|data|free|time|state|control|surface|jump|path|phase"
DECLARED = rf"\b({DECLARATIONS})([ ]+)(?!in\b)([^\W\d]\w*)"
# Clauses are words in their places only. In a formula, or before an equation, they are names.
IS_NO_NAME = r"(?<![*/+\-(^])(?<![*/+\-(^] )"
IS_NO_LEFT_SIDE = r"\b(?!\s*(?:'|:=))"


def known(kind):
    prefix = IS_NO_NAME if kind == "clauses" else r"\b"
    suffix = IS_NO_LEFT_SIDE if kind == "clauses" else r"\b"
    return words(WORDS[kind], prefix=prefix + r"\b", suffix=suffix), TOKENS[kind]


class FdcLexer(RegexLexer):
    """Models of `fdcc`."""

    name = "fdc"
    aliases = ["fdc"]
    filenames = ["*.fdc"]
    tokens = {
        "root": [
            (r"#.*", Comment.Single),
            (r'"[^"\n]*"', String),
            (DECLARED, bygroups(Keyword.Declaration, Whitespace, Name)),
            *map(known, TOKENS),
            # A unit has a letter and no comma; an interval has a comma.
            (r"\[[^\],\n\d]*[A-Za-z%][^\],\n]*\]", Keyword.Type),
            (r"\d+(\.\d+)?([eE][+-]?\d+)?", Number),
            (r"[A-Za-z_]\w*", Name),
            (r"=>|->|:=|<=|>=|==|\+-|[-+*/^<>=']", Operator),
            (r"[()\[\]{},.:;|]", Punctuation),
            (r"\s+", Whitespace),
        ]
    }


def register():
    """Makes the language known to Pygments by its name."""
    LEXERS["FdcLexer"] = (__name__, FdcLexer.name, FdcLexer.aliases, FdcLexer.filenames, [])
