"""The lexer knows every word of the compiler and reads every model."""

from pathlib import Path

from pygments.token import Error

from fdc_lexer import TOKENS, WORDS, FdcLexer

ROOT = Path(__file__).parents[2]


def test_words():
    assert WORDS.keys() == TOKENS.keys(), "editors/words.json has other kinds of words"
    for kind, token in TOKENS.items():
        for word in WORDS[kind]:
            read = next(iter(FdcLexer().get_tokens(f"{word} x")))
            assert read == (token, word), f"{kind}: {read}"


def test_names():
    for text in ["on' = 0", "on := 1", "8*on - 1", "state on start 1"]:
        assert (TOKENS["clauses"], "on") not in FdcLexer().get_tokens(text), text


def test_models():
    models = [*ROOT.glob("models/*.fdc"), *ROOT.glob("tests/classics/**/*.fdc")]
    assert len(models) > 100
    for path in models:
        text = path.read_text()
        tokens = list(FdcLexer(stripnl=False, ensurenl=False).get_tokens(text))
        assert "".join(text for _, text in tokens) == text, path
        strange = [text for token, text in tokens if token is Error]
        assert not strange, f"{path}: {strange}"


for test in [test_words, test_names, test_models]:
    test()
