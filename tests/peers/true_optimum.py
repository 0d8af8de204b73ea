#!/usr/bin/env python3
"""True optima, nothing smoothed, of models with Sgn, Dir, match or jump: their modes given, their switches located.

It solves all cases, or those that are named, with each of several sequences of modes, plays the answers on the true
system with events located by scipy, takes the best that survives, solves it on elements half as long, and writes
true_optimum.csv beside this file. A closed form, where there is one, is what the table gives; the program confirms it.
CasADi 3.8 with IPOPT and MUMPS; nothing is shared with fdcc.
"""

import csv
import sys
from pathlib import Path

from true_optimum_cases import CASES
from true_optimum_model import steps_of
from true_optimum_replay import excess, replay
from true_optimum_transcription import solve

TABLE = Path(__file__).with_suffix('.csv')
HEAD = ['model', 'objective', 'switching_times', 'arc_times', 'numbers', 'modes', 'source', 'unique', 'change',
        'replay']
BEYOND = 1e-6  # of controls between nodes, relative to their bounds


def size(model):
    """A length of the states, for gaps."""
    return max(1.0, max(abs(v) for s in (0, 0.25, 0.5, 0.75, 1) for v in model.guess(s)))


def best_of(model, verbose):
    """The best answer that solved and is replayed: (answer, sequence, gap, modes that were seen)."""
    found = []
    for sequence in model.sequences:
        answer = solve(model, sequence, verbose=verbose)
        told = f'  {sequence:40} {answer.status} {answer.objective:.12g}'
        if answer.status == 'Solve_Succeeded':
            try:
                gap, _, seen = replay(model, sequence, answer)
            except ArithmeticError as error:
                gap, seen = float('inf'), str(error)
            beyond = excess(model, answer)
            told += f' replay {gap:.0e} {seen} beyond {beyond:.0e}'
            if gap < model.gap * size(model) and beyond < BEYOND:
                found.append((answer, sequence, gap, seen))
        print(told, flush=True)
    if not found:
        raise SystemExit('no sequence led to an answer that its replay confirms')
    least = min(f[0].objective for f in found)
    near = [f for f in found if f[0].objective < least + 1e-7 * max(1.0, abs(least))]
    return min(near, key=lambda f: len(f[1].split()))


def times_of(model, sequence, answer):
    """When modes change or states jump, and when controls do, without phases that have shrunk to nothing."""
    surfaces = len(model.surfaces(0, model.guess(0), [0.0] * len(model.unknowns)))
    whole, clock, before, switches, arcs = sum(answer.durations), 0.0, None, [], []
    for step, duration in zip(steps_of(sequence, surfaces), answer.durations):
        if duration > 1e-7 * whole:
            if before:
                (switches if step.jump or step.modes != before else arcs).append(clock)
            before = step.modes
        clock += duration
    return switches, arcs


def joined(numbers):
    """Numbers as text."""
    return ';'.join(f'{n:.10g}' for n in numbers)


def row_of(name, case, verbose):
    """The row of one model."""
    if case.skipped:
        return [name, '', '', '', '', '', case.skipped, '', '', '']
    J, times, known = case.closed() if case.closed else (None, None, {})
    known = dict(known)
    arcs, modes, change, gap = known.pop('arcs', []), '', '', ''
    source = 'closed form' if case.closed else 'this program'
    if case.problem:
        model = case.problem()
        coarse, modes, _, _ = best_of(model, verbose)
        answer = solve(model, modes, refine=2, earlier=coarse)
        if answer.status != 'Solve_Succeeded':
            print(f'{name}: {answer.status} on the finer grid', file=sys.stderr)
        gap = f'{replay(model, modes, answer)[0]:.0e}'
        own = case.sense * answer.objective
        change = f'{abs(answer.objective - coarse.objective) / max(1.0, abs(own)):.0e}'
        if case.closed and abs(own - J) > 1e-7 * max(1.0, abs(J)):
            print(f'{name}: {own} is not {J}', file=sys.stderr)
        source += ', this program' if case.closed else ''
        if J is None:
            J, known = own, {**({} if model.T[0] == model.T[1] else {'T': sum(answer.durations)}), **answer.unknowns}
        if times is None or not case.closed:
            times, arcs = times_of(model, modes, answer)
        modes = ' '.join(word.split(':')[0] for word in modes.split())
    numbers = ';'.join(f'{k}={v:.10g}' for k, v in known.items())
    return [name, f'{J:.12g}', joined(times or []), joined(arcs), numbers, modes, source, case.unique, change, gap]


def known():
    """The table as it stands, by model."""
    if not TABLE.exists():
        return {}
    with open(TABLE, newline='') as file:
        return {row[0]: row for row in list(csv.reader(file))[1:]}


def main(names):
    """Solves and writes."""
    table = known()
    for name in names or CASES:
        table[name] = row_of(name, CASES[name], '--verbose' in sys.argv)
        print(*table[name], flush=True)
        with open(TABLE, 'w', newline='') as file:
            csv.writer(file, lineterminator='\n').writerows([HEAD, *(table[n] for n in sorted(table))])


if __name__ == '__main__':
    main([name for name in sys.argv[1:] if name != '--verbose'])
