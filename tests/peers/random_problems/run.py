#!/usr/bin/env python3
"""Random problems: what fdcc says about each, judged by CasADi with IPOPT, closed forms and SciPy.

    python3 tests/peers/random_problems/run.py target/release/fdcc --count 1000 --table docs/random-problems.md

It needs casadi, numpy and scipy. A wrong word gives exit code 1. With `--rows FILE` each judged problem is one line of
JSON there, and a second run of the same build goes on where the first was stopped; `--models FOLDER` keeps the models
that are judged wrong or failed; `--seconds S` stops after S seconds.
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

import ipopt  # noqa: E402
from discrete import Discrete  # noqa: E402
from generate import generate  # noqa: E402
from judge import Judgement  # noqa: E402
from table import page, summary  # noqa: E402

LIMIT = 20  # seconds of one solve


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('fdcc')
    parser.add_argument('--seed', type=int, default=1)
    parser.add_argument('--first', type=int, default=0)
    parser.add_argument('--count', type=int, default=1000)
    parser.add_argument('--seconds', type=float)
    parser.add_argument('--rows', type=pathlib.Path)
    parser.add_argument('--models', type=pathlib.Path)
    parser.add_argument('--table', type=pathlib.Path)
    return parser.parse_args()


def solve(fdcc, path, *options):
    """fdcc's standard output and error; None if it does not come to an end."""
    command = [fdcc, 'solve', str(path), '--log', 'none', '--time-limit', str(LIMIT), *options]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=3 * LIMIT)
    except subprocess.TimeoutExpired:
        return None, 'no answer'
    return done.stdout, done.stderr


def digest(path):
    """What tells one build of fdcc from another."""
    return hashlib.sha256(pathlib.Path(path).read_bytes()).hexdigest()[:12]


def judged(fdcc, key, path):
    """The row of one problem, and its model."""
    build, seed, index = key
    problem, rng = generate(seed, index)
    path.write_text(problem.text())
    row = {'build': build, 'seed': seed, 'index': index, 'family': problem.family, 'truth': problem.truth}
    output, said = solve(fdcc, path, '--json')
    try:
        result = json.loads(output)
    except (TypeError, json.JSONDecodeError):
        if said.startswith('FDC0410'):
            return contradicted(row, problem, rng), problem
        return {**row, 'status': 'no result', 'wrong': [['solved', said[:300]]], 'notes': [], 'failed': True}, problem
    headline = ''
    if result['status'] == 'infeasible':
        headline = ' '.join(solve(fdcc, path))
    judgement = Judgement(problem, result, rng, headline)
    reference = judgement.references[0]
    return {**row, 'status': result['status'], 'global': result.get('global', False),
            'confirmed': (result.get('verification') or {}).get('confirmed', False), 'objective': result['objective'],
            'contradicted': (result.get('optimality') or {}).get('contradicted', False), 'known': judgement.known,
            'iterations': result['iterations'], 'seconds': result['seconds']['solve'],
            'ipopt': reference.status, 'ipopt_iterations': reference.iterations, 'wrong': judgement.wrong,
            'notes': judgement.notes, 'failed': bool(judgement.failed())}, problem


def contradicted(row, problem, rng):
    """The row of a problem whose conditions `check` calls contradictory: wrong if IPOPT solves it."""
    wrong = []
    if problem.truth != 'infeasible' and any(answer.solved for answer in ipopt.answers(Discrete(problem), rng, 0)):
        wrong = [['infeasible', 'FDC0410, but IPOPT solves it']]
    nothing = {'iterations': 0, 'seconds': 0.0, 'ipopt': '', 'ipopt_iterations': 0, 'notes': []}
    return {**row, **nothing, 'status': 'infeasible', 'global': False, 'confirmed': False, 'objective': None,
            'contradicted': False, 'known': None, 'wrong': wrong, 'failed': False}


def earlier(path):
    """The rows of a run that was stopped."""
    if path is None or not path.exists():
        return {}
    rows = map(json.loads, path.read_text().splitlines())
    return {(row['build'], row['seed'], row['index']): row for row in rows}


def keep(folder, row, problem):
    """The model of a row that is wrong or failed, with what is wrong in comments."""
    if folder is None or not (row['wrong'] or row['failed']):
        return
    folder.mkdir(parents=True, exist_ok=True)
    word = f'wrong-{row["index"]}-{row["wrong"][0][0]}' if row['wrong'] else f'failed-{row["index"]}-{row["status"]}'
    lines = [f'# {word}: {why}' for word, why in row['wrong']]
    lines.append(f'# {row["status"]} {row.get("objective")}; known: {row.get("known")}; IPOPT: {row.get("ipopt")}')
    (folder / f'{word}.fdc').write_text('\n'.join(lines) + '\n' + problem.text())


def main():
    options, begin = arguments(), time.time()
    done, build, rows = earlier(options.rows), digest(options.fdcc), []
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / 'model.fdc'
        for index in range(options.first, options.first + options.count):
            if options.seconds and time.time() - begin > options.seconds:
                break
            key = (build, options.seed, index)
            row = done.get(key)
            if row is None:
                row, problem = judged(options.fdcc, key, path)
                keep(options.models, row, problem)
                if options.rows:
                    with options.rows.open('a') as file:
                        file.write(json.dumps(row) + '\n')
            rows.append(row)
            for word, why in row['wrong']:
                print(f'{row["seed"]} {index} {row["family"]}: wrong "{word}": {why}', flush=True)
    print(summary(rows))
    if options.table:
        options.table.write_text(page(rows))
    return 1 if any(row['wrong'] for row in rows) else 0


if __name__ == '__main__':
    sys.exit(main())
