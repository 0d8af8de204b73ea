#!/usr/bin/env python3
"""How time and memory of a solve grow with the number of intervals and with the number of states.

    python3 tests/peers/growth.py target/release/fdcc      (writes docs/growth.csv and docs/growth.svg)

Intervals: the race car, sigma 0.1. States: a train of masses and springs whose first mass is pushed and slides with friction, brought to a given place at
rest with little effort. Time is that of the solver on one core, memory the most that the process held.
"""

import csv
import json
import math
import os
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
DOCS = HERE.parent.parent / 'docs'
RACECAR = (HERE.parent.parent / 'tests' / 'reference' / 'racecar.fdc').read_text()
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


def measured(binary):
    """One row for each solve: what grows, how far, and what it took."""
    cases = [('intervals', n, n, RACECAR, [f'N={n}']) for n in INTERVALS]
    cases += [('states', 2 * masses, 1000, chain(masses), []) for masses in MASSES]
    for what, size, intervals, text, changes in cases:
        found, memory = run(binary, text, changes)
        seconds, factorisations = found['seconds']['solve'], found['counts']['factorizations']
        yield what, size, found['status'], found['iterations'], factorisations, f'{seconds:.4g}', f'{1e6 * seconds / intervals:.4g}', f'{memory / intervals:.4g}'


def panel(left, title, points):
    """A log-log plot of seconds over size, 300 wide, from `left` on; the dashed line is linear growth from the first point."""
    xs, ys = [math.log10(x) for x, _ in points], [math.log10(y) for _, y in points]
    low, high, floor, top = min(xs), max(xs), math.floor(min(ys)), math.ceil(max(ys))
    at = lambda x, y: f'{left + 50 + 230 * (x - low) / (high - low):.1f},{250 - 210 * (y - floor) / (top - floor):.1f}'
    line = ' '.join(at(x, y) for x, y in zip(xs, ys))
    reach = min(high, low + top - ys[0])
    parts = [f'<text x="{left + 165}" y="20" text-anchor="middle">{title}</text>',
             f'<polyline fill="none" stroke="#bbb" stroke-dasharray="4" points="{at(low, ys[0])} {at(reach, ys[0] + reach - low)}"/>',
             f'<polyline fill="none" stroke="#06c" stroke-width="2" points="{line}"/>']
    for x, (size, _) in zip(xs, points):
        parts.append(f'<text x="{at(x, floor).split(",")[0]}" y="268" text-anchor="middle">{size:g}</text>')
    for y in range(floor, top + 1):
        parts.append(f'<text x="{left + 42}" y="{float(at(low, y).split(",")[1]) + 4}" text-anchor="end">{10.0**y:g} s</text>')
    return parts


def main(binary):
    """Writes docs/growth.csv and docs/growth.svg, and prints the table."""
    os.sched_setaffinity(0, {sorted(os.sched_getaffinity(0))[-1]})
    head = ('grows', 'size', 'status', 'iterations', 'factorisations', 'solver s', 'us for each interval', 'kB for each interval')
    rows = list(measured(binary))
    with open(DOCS / 'growth.csv', 'w', newline='') as file:
        csv.writer(file, lineterminator='\n').writerows([head, *rows])
    curve = lambda what: [(row[1], float(row[5])) for row in rows if row[0] == what]
    body = panel(0, 'seconds over intervals', curve('intervals')) + panel(320, 'seconds over states, 1000 intervals', curve('states'))
    style = 'font-family="sans-serif" font-size="12"'
    (DOCS / 'growth.svg').write_text(f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 640 280" {style}>\n' + '\n'.join(body) + '\n</svg>\n')
    print('| ' + ' | '.join(head) + ' |\n' + '|---' * len(head) + '|')
    for row in rows:
        print('| ' + ' | '.join(str(cell) for cell in row) + ' |')


if __name__ == '__main__':
    main(*sys.argv[1:])
