#!/usr/bin/env python3
"""The problems of tests/classics/phases once more, for CasADi and IPOPT, and their closed forms where there are any.

It solves all of them, or those that are named, each on its grid and on one of twice as many intervals, and writes their
rows of phases.csv beside this file: the objective and the unknowns on the finer grid, what the coarser grid differs by
relative to the value or 1, and the closed form. That table is by CasADi 3.8.2 with IPOPT 3.14.19 and MUMPS 5.8.2.
"""

import csv
import sys
from pathlib import Path

from phases_closed import CLOSED
from phases_flight import FLIGHT
from phases_ground import GROUND
from phases_transcription import solve

PROBLEMS = {**GROUND, **FLIGHT}
TABLE = Path(__file__).with_suffix('.csv')
HEAD = ['problem', 'quantity', 'value', 'change', 'closed_form']


def rows_of(name, verbose):
    """The rows of one problem."""
    problem, closed = PROBLEMS[name], CLOSED.get(name, {})
    (coarse_status, coarse), (status, fine) = (solve(problem, refine, verbose) for refine in (1, 2))
    if {coarse_status, status} != {'Solve_Succeeded'}:
        print(f'{name}: {coarse_status}, {status}', file=sys.stderr)
    for quantity, value in fine.items():
        change = abs(value - coarse[quantity]) / max(1.0, abs(value))
        known = repr(float(closed[quantity])) if quantity in closed else ''
        if known and abs(value - closed[quantity]) > 1e-6 * max(1.0, abs(value)):
            print(f'{name}: {quantity} is {value}, not {known}', file=sys.stderr)
        yield [name, quantity, f'{value:.12g}', f'{change:.1e}', known]


def known():
    """The rows of the table as it stands, by problem."""
    table = {}
    if TABLE.exists():
        with open(TABLE, newline='') as file:
            for row in list(csv.reader(file))[1:]:
                table.setdefault(row[0], []).append(row)
    return table


def main(names):
    """Solves and writes."""
    table = known()
    for name in names or PROBLEMS:
        table[name] = list(rows_of(name, '--verbose' in sys.argv))
        for row in table[name]:
            print(*row, flush=True)
    with open(TABLE, 'w', newline='') as file:
        rows = [row for name in sorted(table) for row in table[name]]
        csv.writer(file, lineterminator='\n').writerows([HEAD, *rows])


if __name__ == '__main__':
    main([name for name in sys.argv[1:] if name != '--verbose'])
