#!/usr/bin/env python3
"""Whether certified answers depend on where the search begins: other first widths and other grids of the smoothed stage.

    cargo build --release && python3 tests/peers/independence.py target/release/fdcc docs/method/independence.md

Each model of tests/classics/switched that names no method is solved as it is, then with `continue sigma` of four first widths
on three grids. A few minutes; nothing but the command is needed.
"""

import json
import subprocess
import sys
from pathlib import Path

FOLDER = Path(__file__).resolve().parents[1] / 'classics' / 'switched'
WIDTHS = (0.3, 0.1, 0.03, 0.01)
GRIDS = (100, 200, 400)
SAME = 1e-8

HEAD = '''# Where the search begins

The optimum of the true system does not depend on the smoothed problem, but what is found first does: `fdcc/src/solve/true_optimum/structure.rs` reads the modes and arcs to begin with from it. {models} models of `tests/classics/switched` were solved as they are, then with first widths {widths} (`--method continue=W --method sigma=0`) and `N` = {grids}: {runs}
runs each. This page is written by

```sh
python3 tests/peers/independence.py target/release/fdcc docs/method/independence.md
```

**{same} of {all} runs ({percent:.1f} %) end at the same optimum, to 1e-8; {other} at another one that is certified, too; {none} are not certified, and say so.** Where an optimum is another one it is a local one by the headline, as the first is.

| model | J | the same | another | J of the others | not certified |
|---|---|---|---|---|---|
'''


def objective(fdcc, path, *words):
    """That of a certified answer; None where there is none."""
    methods = [part for word in words for part in ('--method', word)]
    command = [fdcc, 'solve', path, '--json', '--log', 'none', '--time-limit', '60', '--no-verify', *methods]
    done = subprocess.run(command, capture_output=True, text=True)
    document = json.loads(done.stdout)
    certificate = document.get('certificate') or {}
    return document['objective'] if certificate.get('certified') else None


def row_of(fdcc, path):
    """The counts of one model, and the objectives of other optima; None where the first is not certified."""
    first = objective(fdcc, path)
    if first is None:
        return None
    same, others, none = 0, [], 0
    for width in WIDTHS:
        for grid in GRIDS:
            found = objective(fdcc, path, f'continue={width}', 'sigma=0', f'N={grid}')
            if found is None:
                none += 1
            elif abs(found - first) <= SAME * max(abs(first), 1e-8):
                same += 1
            else:
                others.append(found)
    return path.stem, first, same, others, none


def distinct(values):
    """Of values that are the same to 1e-8 one each, ascending."""
    kept = []
    for value in sorted(values):
        if not kept or abs(value - kept[-1]) > SAME * abs(value):
            kept.append(value)
    return kept


def page(rows):
    runs = len(WIDTHS) * len(GRIDS)
    same, other, none = (sum(count(row) for row in rows) for count in (
        lambda row: row[2], lambda row: len(row[3]), lambda row: row[4]))
    numbers = lambda all: ', '.join(f'{it:g}' for it in all)
    text = HEAD.format(
        models=len(rows), widths=numbers(WIDTHS), grids=numbers(GRIDS), runs=runs, same=same, other=other, none=none,
        all=runs * len(rows), percent=100 * same / (runs * len(rows)))
    for name, first, same, others, none in rows:
        text += f'| {name} | {first:.9g} | {same} | {len(others)} | {", ".join(f"{it:.9g}" for it in distinct(others))} | {none} |\n'
    return text


def main():
    rows = []
    for path in sorted(FOLDER.glob('*.fdc')):
        if 'method' in path.read_text():
            continue
        row = row_of(sys.argv[1], path)
        print(path.stem, *(row[1:] if row else ['not certified']), flush=True)
        rows += [row] if row else []
    Path(sys.argv[2]).write_text(page(rows))


main()
