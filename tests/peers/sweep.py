#!/usr/bin/env python3
"""The race car over widths of the layer and the track, friction, N and starting T: IPOPT and fdcc on the same discrete problem and guess.

    python3 tests/peers/sweep.py fdcc target/release/fdcc > runs-of-fdcc.csv     (216 runs: also N = 4000)
    python3 tests/peers/sweep.py ipopt > tests/peers/sweep.csv                   (144 runs)
    python3 tests/peers/sweep.py compare runs-of-fdcc.csv tests/peers/sweep.csv

sweep.csv is by CasADi 3.8.2 with IPOPT 3.14.19 and MUMPS 5.8.2, on a busy machine: its seconds are no measure.
"""

import csv
import itertools
import json
import re
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
MODEL = HERE.parent.parent / 'tests' / 'reference' / 'racecar.fdc'
HEAD = ['T', 'sigma', 'width', 'muN', 'N', 'status', 'objective', 'iterations', 'seconds']


def cases(counts):
    """All combinations."""
    return itertools.product((4, 6, 10), (0.1, 0.05, 0.025), (0.3, 0.5, 1, 2), (1, 4), counts)


def ours(binary, folder, case):
    """One run of fdcc; the starting T is part of the text."""
    start, sigma, width, friction, n = case
    model = Path(folder) / f'racecar_{start}.fdc'
    model.write_text(re.sub(r'guess 6', f'guess {start}', MODEL.read_text()))
    done = subprocess.run([binary, 'solve', str(model), '--json', '--log', 'none', '--no-verify', '--set', f'w={width}', '--set', f'muN={friction}',
                           '--method', f'sigma={sigma}', '--method', f'N={n}'], capture_output=True, text=True)
    found = json.loads(done.stdout)
    return found['status'], found['objective'], found['iterations'], found['seconds']['solve']


def peer(case):
    """One run of IPOPT."""
    start, sigma, width, friction, n = case
    done = subprocess.run([sys.executable, str(HERE / 'racecar.py'), '--sigma', str(sigma), '--N', str(n), '--width', str(width), '--muN', str(friction),
                           '--T0', str(start), '--max-iter', '5000'], capture_output=True, text=True)
    found = json.loads(done.stdout.strip().split('\n')[-1])
    return 'solved' if found['success'] else found['status'], found['objective'], found['iterations'], found['t_wall_s']


def read(path):
    """Rows by case."""
    with open(path, newline='') as file:
        return {tuple(float(row[name]) for name in HEAD[:5]): row for row in csv.DictReader(file)}


def summary(name, rows):
    """Fraction solved and iterations."""
    solved = [row for row in rows if row['status'] == 'solved']
    iterations = sorted(int(row['iterations']) for row in solved)
    print(f'| {name} | {len(solved)} of {len(rows)} | {statistics.median(iterations):.0f} | {iterations[int(0.9 * len(iterations))]} | {iterations[-1]} |')


def compare(path_of_fdcc, path_of_ipopt):
    """The table of both, and how often the objective of fdcc is as good."""
    fdcc, ipopt = read(path_of_fdcc), read(path_of_ipopt)
    common = sorted(set(fdcc) & set(ipopt))
    print('| | solved | iterations: median | 90th percentile | worst |\n|---|---|---|---|---|')
    summary('fdcc, all', list(fdcc.values()))
    summary('fdcc, where IPOPT ran', [fdcc[case] for case in common])
    summary('IPOPT', [ipopt[case] for case in common])
    both = [case for case in common if fdcc[case]['status'] == ipopt[case]['status'] == 'solved']
    gaps = [(float(fdcc[case]['objective']) - float(ipopt[case]['objective'])) / float(ipopt[case]['objective']) for case in both]
    print(f'\nobjective of fdcc as good as that of IPOPT (to 1e-6) or better: {sum(gap <= 1e-6 for gap in gaps)} of {len(both)}; better by more than that: {sum(gap < -1e-6 for gap in gaps)}')


def main(what, *rest):
    """Runs one solver, or compares."""
    if what == 'compare':
        return compare(*rest)
    writer = csv.writer(sys.stdout, lineterminator='\n')
    writer.writerow(HEAD)
    with tempfile.TemporaryDirectory() as folder:
        for case in cases((250, 1000) if what == 'ipopt' else (250, 1000, 4000)):
            writer.writerow([*case, *(peer(case) if what == 'ipopt' else ours(rest[0], folder, case))])
            sys.stdout.flush()


if __name__ == '__main__':
    main(*sys.argv[1:])
