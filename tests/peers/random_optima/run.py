#!/usr/bin/env python3
"""Random models with switches: certified answers are simulated by SciPy, and better neighbours are looked for.

    python3 tests/peers/random_optima/run.py target/release/fdcc --count 500 --table docs/method/random-optima.md

It needs numpy and scipy. A false certificate, a crash or a hang gives exit code 1. With `--rows FILE` each judged model
is one line of JSON there, and a second run of the same build goes on where the first was stopped; `--models FOLDER`
keeps the models that are not certified or judged wrong; `--every N` takes every N-th; `--seconds S` stops after S seconds.
"""

import argparse
import hashlib
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True
os.environ.setdefault('OMP_NUM_THREADS', '1')
os.environ.setdefault('OPENBLAS_NUM_THREADS', '1')

from answer import Answer  # noqa: E402
from descent import GAIN, gain  # noqa: E402
from generate import generate  # noqa: E402
from replayed import replayed, wrong  # noqa: E402
from table import page, summary  # noqa: E402

LIMIT = 60  # seconds of one solve


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('fdcc')
    parser.add_argument('--seed', type=int, default=1)
    parser.add_argument('--first', type=int, default=0)
    parser.add_argument('--count', type=int, default=500)
    parser.add_argument('--every', type=int, default=1)
    parser.add_argument('--seconds', type=float)
    parser.add_argument('--rows', type=pathlib.Path)
    parser.add_argument('--models', type=pathlib.Path)
    parser.add_argument('--table', type=pathlib.Path)
    return parser.parse_args()


def solved(fdcc, path):
    """The document, the exit code and the seconds; what went wrong in place of a document, as text."""
    begin = time.monotonic()
    command = [fdcc, 'solve', str(path), '--json', '--log', 'none', '--time-limit', str(LIMIT)]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=LIMIT + 20)
    except subprocess.TimeoutExpired:
        return f'no answer in {LIMIT + 20} s', None, time.monotonic() - begin
    seconds = time.monotonic() - begin
    try:
        return json.loads(done.stdout), done.returncode, seconds
    except json.JSONDecodeError:
        return done.stderr[:300] or 'no document', done.returncode, seconds


def judged(model, rng, document):
    """What is wrong with a certified answer, in words; and the figures of the checks."""
    answer = Answer(model, document)
    figures, _ = replayed(answer)
    found = wrong(figures)
    better, simulations = gain(answer, rng)
    found += [f'a neighbour is better by {better:.1e}'] if better > GAIN else []
    return found, {**figures, 'gain': better, 'simulations': simulations}


def row_of(fdcc, key, path):
    """All that is kept of one model."""
    build, seed, index = key
    model, rng = generate(seed, index)
    path.write_text(model.text())
    document, code, seconds = solved(fdcc, path)
    row = {'build': build, 'seed': seed, 'index': index, 'family': model.family, 'seconds': round(seconds, 3)}
    row['wrong'] = []
    if isinstance(document, str):
        return {**row, 'status': 'no document', 'certified': False, 'wrong': [document]}
    certificate = document.get('certificate') or {}
    row |= {'status': document['status'], 'objective': document['objective'],
            'certified': certificate.get('certified', False),
            'failing': [check['check'] for check in certificate.get('checks', []) if not check['passes']]}
    if (document['status'] == 'solved') != row['certified'] or (code == 0) != row['certified']:
        row['wrong'].append(f'status {document["status"]}, exit code {code}, certified {row["certified"]}')
    if row['certified']:
        try:
            found, row['figures'] = judged(model, rng, document)
            row['wrong'] += found
        except ArithmeticError as unable:
            row['unjudged'] = str(unable)
    return row


def earlier(path):
    """The rows of a run that was stopped."""
    if path is None or not path.exists():
        return {}
    rows = map(json.loads, path.read_text().splitlines())
    return {(row['build'], row['seed'], row['index']): row for row in rows}


def keep(folder, row, text):
    """The model of a row that is not certified, or wrong."""
    if folder is not None and (row['wrong'] or not row['certified']):
        folder.mkdir(parents=True, exist_ok=True)
        word = 'wrong' if row['wrong'] else row['status']
        (folder / f'{word}-{row["seed"]}-{row["index"]}-{row["family"]}.fdc').write_text(text)


def main():
    options, begin = arguments(), time.monotonic()
    build = hashlib.sha256(pathlib.Path(options.fdcc).read_bytes()).hexdigest()[:12]
    done, rows = earlier(options.rows), []
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / 'model.fdc'
        for index in range(options.first, options.first + options.count, options.every):
            if options.seconds and time.monotonic() - begin > options.seconds:
                break
            key = (build, options.seed, index)
            row = done.get(key)
            if row is None:
                row = row_of(options.fdcc, key, path)
                keep(options.models, row, path.read_text())
                if options.rows:
                    with options.rows.open('a') as file:
                        file.write(json.dumps(row) + '\n')
            rows.append(row)
            for why in row['wrong']:
                print(f'{row["seed"]} {index} {row["family"]}: {why}', flush=True)
    print(summary(rows))
    if options.table:
        options.table.write_text(page(rows))
    return 1 if any(row['wrong'] for row in rows) else 0


if __name__ == '__main__':
    sys.exit(main())
