#!/usr/bin/env python3
"""The table of docs/performance.md of published examples of nosnoc: by nosnoc with its published settings, with twice
as many control intervals, and by fdcc. `fdcc simulate` replays the controls on the true system, whose objective is the
column `true`; `ends off` is by how much a state misses where it has to be. Seconds are those of the processor, so that
other work beside it does not count. Skipped with a word where there is no nosnoc.

    pip install nosnoc
    python3 tests/peers/nosnoc_examples.py target/release/fdcc [NAME ...]
"""

import importlib.util
import json
import re
import resource
import subprocess
import sys
import tempfile
import warnings
from pathlib import Path

if not importlib.util.find_spec('nosnoc'):
    sys.exit('skipped: there is no nosnoc')

import numpy as np

import nosnoc_problems as problems

MODELS = Path(__file__).parent / 'nosnoc_examples'
PLACES = {
    'turbo': Path(__file__).parents[2] / 'models',
    'two_pedals': MODELS,
    'motor_with_friction': MODELS,
    'sliding_mode': MODELS,
    'cart_pole': MODELS,
}


def processor():
    """Seconds so far, of this process and of those that have ended."""
    both = (resource.getrusage(it) for it in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return sum(it.ru_utime + it.ru_stime for it in both)


def fdcc(*words, text=None):
    done = subprocess.run([sys.argv[1], *words, '--json', '--log', 'none'], capture_output=True, text=True, input=text)
    return json.loads(done.stdout)


def replayed(text, end, time_and_controls, names):
    """The objective of the true system, and how far its last states are from where they have to be."""
    with tempfile.NamedTemporaryFile('w', suffix='.csv') as file:
        rows = [','.join(format(it, '.17g') for it in row) for row in time_and_controls]
        file.write('\n'.join([f't,{names}', *rows]) + '\n')
        file.flush()
        answer = fdcc('simulate', '-', '--control', file.name, text=text)
    return answer['objective'], off(end, [it for name, it in answer['end'].items() if name != 'time'])


def off(end, states):
    return max((abs(a - b) for a, b in zip(end, states) if not np.isnan(a)), default=0.0)


def row(name, tool, objective, true, miss, seconds, said):
    print(f'| {name} | {tool} | {objective:.6f} | {true:.6f} | {miss:.0e} | {seconds:.2f} | {said} |', flush=True)


def by_nosnoc(name, text, end, times):
    begin = processor()
    objective, duration, controls, is_solved = problems.solve(getattr(problems, name), times)
    seconds = processor() - begin
    text = re.sub(r'^(free T .*guess) .*', rf'\1 {duration!r}', text, flags=re.M)
    names = ','.join(re.findall(r'^control (\w+)', text, re.M))
    true, miss = replayed(text, end, controls, names)
    said = 'solved' if is_solved else 'not solved'
    row(name, f'nosnoc, {len(controls)} intervals', objective, true, miss, seconds, said)


def by_fdcc(name, path, end, setting):
    begin = processor()
    answer = fdcc('solve', str(path), *(['--method', setting] if setting else []))
    seconds, replay = processor() - begin, answer['verification']
    last = [it[-1] for it in replay['replay']['states'].values()]
    said = 'certified' if answer['certificate']['certified'] else 'not certified'
    tool = f'fdcc, {setting}' if setting else 'fdcc'
    row(name, tool, answer['objective'], replay['objective'], off(end, last), seconds, said)


def main():
    warnings.simplefilter('ignore')
    print('| | | objective | true | ends off | CPU s | |\n|---|---|---|---|---|---|---|')
    for name in sys.argv[2:] or PLACES:
        path = PLACES[name] / f'{name}.fdc'
        text, end = path.read_text(), getattr(problems, name)()[3]
        for times in (1, 2):
            by_nosnoc(name, text, end, times)
        for setting in ('', *(['N=100'] if name == 'sliding_mode' else [])):
            by_fdcc(name, path, end, setting)


main()
