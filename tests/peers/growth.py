#!/usr/bin/env python3
"""How time and memory of a solve grow with the number of intervals and with the number of states.

    python3 tests/peers/growth.py target/release/fdcc > docs/growth.md

Intervals: the race car, sigma 0.1. States: a train of masses and springs whose first mass is pushed and slides with friction, brought to a given place at
rest with little effort. Time is that of the solver on one core, memory the most that the process held.
"""

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
RACECAR = (HERE.parent.parent / 'models' / 'racecar.fdc').read_text()
INTERVALS = (1000, 10_000, 100_000, 1_000_000)
MASSES = (2, 5, 10, 20)


def chain(masses):
    """A model with two states for each mass; the first is pushed, and slides with friction."""
    names = range(masses)
    rates = []
    for i in names:
        left = f'50*(x{i - 1} - x{i})' if i else '0'
        right = f'50*(x{i + 1} - x{i})' if i + 1 < masses else '0'
        push = (' in ', ' + f - Sgn(slip)') if i == 0 else (' = ', '')
        rates += [f"  x{i}' = v{i}", f"  v{i}'{push[0]}{left} + {right} - 0.5*v{i}{push[1]}"]
    states = [f'state x{i} start 0\nstate v{i} start 0' for i in names]
    missed = ' + '.join(f'(x{i}(end) - 1)^2 + v{i}(end)^2' for i in names)
    return '\n'.join([
        'model chain', 'time t in [0, 4]', *states, 'control f in [-20, 20]', 'surface slip = v0', 'dynamics {', *rates, '}',
        f'minimize 100*({missed}) + integral(f^2)/100', 'method {', '  smooth sigma = 0.1', '  grid N = 1000 scheme implicit_euler', '}', ''])


def run(binary, text, changes):
    """One solve: the document, and the most memory the process held (kB)."""
    with tempfile.TemporaryDirectory() as folder:
        model = Path(folder) / 'model.fdc'
        model.write_text(text)
        options = [part for change in changes for part in ('--method', change)]
        command = [binary, 'solve', str(model), '--json', '--log', 'none', '--no-verify', *options]
        done = subprocess.run(['/usr/bin/time', '-f', '%M', *command], capture_output=True, text=True)
        if not done.stdout.strip():
            sys.exit(done.stderr)
        return json.loads(done.stdout), int(done.stderr.strip().split('\n')[-1])


def row(first, found, memory, stages):
    """A line of a table."""
    counts, seconds = found['counts'], found['seconds']['solve']
    cells = [first, found['status'], found['iterations'], counts['factorizations'], f'{seconds:.3g}', f'{1e6 * seconds / stages:.4g}', f'{memory / 1000:.0f}', f'{memory / stages:.3g}']
    print('| ' + ' | '.join(str(cell) for cell in cells) + ' |', flush=True)


def main(binary):
    """Both tables."""
    os.sched_setaffinity(0, {sorted(os.sched_getaffinity(0))[-1]})
    print('| N | status | iterations | factorisations | solver s | us for each interval | MB | kB for each interval |')
    print('|---|---|---|---|---|---|---|---|')
    for n in INTERVALS:
        found, memory = run(binary, RACECAR, [f'N={n}'])
        row(n, found, memory, n)
    print('\n| states | status | iterations | factorisations | solver s | us for each interval | MB | kB for each interval |')
    print('|---|---|---|---|---|---|---|---|')
    for masses in MASSES:
        found, memory = run(binary, chain(masses), [])
        row(2 * masses, found, memory, 1000)


if __name__ == '__main__':
    main(*sys.argv[1:])
