#!/usr/bin/env python3
"""Runs the programs of docs/recipes/from-casadi.md and from-nosnoc.md, and what fdcc says of their forces: both print what
the pages say. A page is skipped with a word where its package is not there.

    python3 tests/peers/recipes.py target/release/fdcc
"""

import importlib.util
import re
import subprocess
import sys
import tempfile
from pathlib import Path

RECIPES = Path(__file__).parents[2] / 'docs' / 'recipes'
NUMBER = re.compile(r'-?\d+\.\d+(?:e[+-]?\d+)?')


def block(page, tag, word):
    """The first block of the page with this tag that has the word in it."""
    blocks = re.findall(rf'^```{tag}\n(.*?)^```', page, re.S | re.M)
    return next(it for it in blocks if word in it)


def agree(printed, written):
    """Whether two texts have the same words and nearly the same numbers; smaller than 1e-9 is rounding."""
    numbers = [[float(it) for it in NUMBER.findall(text)] for text in (printed, written)]
    words = [NUMBER.sub('', text).split() for text in (printed, written)]
    near = (abs(a - b) <= 1e-9 + 1e-5 * abs(b) for a, b in zip(*numbers))
    return words[0] == words[1] and len(numbers[0]) == len(numbers[1]) and all(near)


def check(what, printed, written):
    if not agree(printed, written):
        sys.exit(f'{what} prints\n{printed}\nand not\n{written}')


def check_page(package, fdcc):
    name = f'from-{package}.md'
    page = (RECIPES / name).read_text()
    with tempfile.TemporaryDirectory() as folder:
        run = lambda *words: subprocess.run(words, cwd=folder, check=True, capture_output=True, text=True).stdout
        Path(folder, 'crate.fdc').write_text(block(page, 'fdc', 'model crate'))
        program = block(page, 'python', f'import {package}')
        check(f'{name}: the program', run(sys.executable, '-W', 'ignore', '-c', program),
              re.search(r'prints `(objective .*?)`', page)[1])
        command, told = block(page, 'text', '--control forces.csv').split('\n', 1)
        check(f'{name}: {command}', run(fdcc, *command.removeprefix('$ fdcc ').split()), told)
    print(f'{name} is well')


def main():
    fdcc = str(Path(sys.argv[1]).resolve())
    for package in ('casadi', 'nosnoc'):
        if importlib.util.find_spec(package):
            check_page(package, fdcc)
        else:
            print(f'from-{package}.md is skipped: there is no {package}')


main()
