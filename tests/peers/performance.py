#!/usr/bin/env python3
"""The ten rows of Table 7.1 by IPOPT, by Fatrop and by fdcc, one after the other on one core.

    python3 tests/peers/performance.py target/release/fdcc [REPEATS] > table.md

Each row is solved by all three before the next one, so that a machine whose speed drifts does so for all alike; of several
repeats the fastest counts. `solver` is the time within the solver (CasADi: t_wall_total; fdcc: seconds.solve), `whole` that of the whole process.
All have the same discrete problem (Fatrop its block-structured equivalent), guess and tolerance 1e-8.
"""

import json
import os
import subprocess
import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
MODEL = HERE.parent.parent / 'tests' / 'reference' / 'racecar.fdc'
ROWS = [(0.1, 250), (0.1, 500), (0.1, 1000), (0.1, 2000), (0.05, 500), (0.05, 1000), (0.05, 2000),
        (0.025, 1000), (0.025, 2000), (0.025, 4000)]
PAPER = {row: known for row, known in zip(ROWS, (
    (5.544654, 303, 14.1), (5.549708, 531, 53.3), (5.552177, 349, 53.3), (5.553451, 420, 227.0), (5.590849, 1501, 153.5),
    (5.409497, 977, 242.2), (5.409183, 643, 300.8), (5.353886, 1240, 184.5), (5.354256, 1759, 913.2), (5.354451, 1368, 1552.8)))}


def timed(command):
    """What a command prints as JSON, and how long it took."""
    begin = time.perf_counter()
    done = subprocess.run(command, capture_output=True, text=True)
    return json.loads(done.stdout.strip().split('\n')[-1] if command[0] == sys.executable else done.stdout), time.perf_counter() - begin


def peer(solver, sigma, n):
    """Objective, iterations, solver seconds and whole process of CasADi's solvers."""
    found, whole = timed([sys.executable, str(HERE / 'racecar.py'), '--solver', solver, '--sigma', str(sigma), '--N', str(n),
                          '--max-iter', '5000'])
    return found['objective'] if found['success'] else None, found['iterations'], found['t_wall_s'], whole


def ours(binary, sigma, n):
    """The same of fdcc."""
    found, whole = timed([binary, 'solve', str(MODEL), '--json', '--log', 'none', '--no-verify', '--method', f'sigma={sigma}', '--method', f'N={n}'])
    return found['objective'] if found['status'] == 'solved' else None, found['iterations'], found['seconds']['solve'], whole


def best(runs):
    """The fastest run."""
    return min(runs, key=lambda run: run[2])


def shown(run):
    """A cell for each number."""
    objective, iterations, seconds, whole = run
    return [f'{objective:.6f}' if objective else '-', str(iterations), f'{seconds:.3g}', f'{whole:.3g}']


def main(binary, repeats=1):
    """Prints the table."""
    os.sched_setaffinity(0, {sorted(os.sched_getaffinity(0))[-1]})
    heads = ['sigma', 'N', 'paper: objective', 'iterations', 'CPU s']
    heads += [f'{who}: {what}' for who in ('IPOPT', 'Fatrop', 'fdcc') for what in ('objective', 'iterations', 'solver s', 'whole s')]
    print('| ' + ' | '.join(heads + ['IPOPT/fdcc', 'Fatrop/fdcc']) + ' |')
    print('|' + '---|' * (len(heads) + 2))
    sums = [0.0] * 6
    for sigma, n in ROWS:
        runs = [[], [], []]
        for _ in range(repeats):
            runs[0].append(peer('ipopt', sigma, n))
            runs[2].append(ours(binary, sigma, n))
            runs[1].append(peer('fatrop', sigma, n))
        ipopt, fatrop, fdcc = map(best, runs)
        sums = [a + b for a, b in zip(sums, (ipopt[2], ipopt[3], fatrop[2], fatrop[3], fdcc[2], fdcc[3]))]
        objective, iterations, seconds = PAPER[sigma, n]
        cells = [str(sigma), str(n), str(objective), str(iterations), str(seconds), *shown(ipopt), *shown(fatrop), *shown(fdcc)]
        print('| ' + ' | '.join(cells + [f'{ipopt[2] / fdcc[2]:.1f}', f'{fatrop[2] / fdcc[2]:.1f}']) + ' |', flush=True)
    s = [f'{value:.3g}' for value in sums]
    print(f'| all | | | 9091 | 3695 | | | {s[0]} | {s[1]} | | | {s[2]} | {s[3]} | | | {s[4]} | {s[5]} | {sums[0] / sums[4]:.1f} | {sums[2] / sums[4]:.1f} |')


if __name__ == '__main__':
    main(sys.argv[1], *map(int, sys.argv[2:3]))
