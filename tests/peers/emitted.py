#!/usr/bin/env python3
"""The functions that `fdcc emit` writes, called by CasADi as external functions.

    python3 tests/peers/emitted.py target/release/fdcc

Each model is written as C, compiled, and transcribed with implicit Euler of nothing but the emitted functions: `dynamics`, `path`,
`boundary`, `guess`, `numbers`. IPOPT solves it with their exact Jacobians and Hessians, from the guess of the model and from the solution
of `fdcc solve`, which has the same discrete problem: there it has to stay. From the guess it may find another local optimum. Before
that the derivatives are compared with central differences.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

import casadi as ca
import numpy as np

MODELS = Path(__file__).resolve().parent.parent.parent / 'models'
# Model, smoothing width, intervals, states at the old time.
ROWS = [('block', 0.1, 50, ()), ('racecar', 0.1, 250, (4,)), ('stacked', 0.1, 50, ()), ('turbo', 1.0, 100, ()), ('regulator', None, 100, ())]
LARGEST_DIFFERENCE = 1e-6


def settings(width, intervals):
    """The same for both commands."""
    words = ['--method', 'scheme=implicit_euler', '--method', f'N={intervals}']
    return words + (['--method', f'sigma={width}'] if width is not None else [])


def emitted(command, name, folder, changes):
    """The library of a model."""
    source, library = folder / f'{name}.c', folder / f'{name}.so'
    subprocess.run([command, 'emit', str(MODELS / f'{name}.fdc'), '--lang', 'c', '--out', str(source), *changes], check=True)
    subprocess.run(['cc', '-std=c99', '-O2', '-ffp-contract=off', '-fPIC', '-shared', '-Wall', '-Werror', '-pedantic',
                    str(source), '-o', str(library), '-lm'], check=True)
    return str(library)


class Functions:
    """Those of a model, called by the names of their inputs."""

    def __init__(self, name, library):
        self.name, self.library, self.external = name, library, {}
        text = Path(library).with_suffix('.c').read_text()
        for function in ('dynamics', 'path', 'boundary', 'guess', 'numbers'):
            if f' int {name}_{function}(' in text:
                self.external[function] = ca.external(f'{name}_{function}', library)
        self.numbers = {key: value.full().ravel() for key, value in self.external['numbers'].call({}).items()}

    def has(self, function):
        return function in self.external

    def __call__(self, function, **inputs):
        external = self.external[function]
        return external.call({key: inputs[key] for key in external.name_in()})


def largest_difference(functions):
    """Of the derivatives from those by differences, for random inputs."""
    random, worst = np.random.default_rng(1), 0.0
    for function in ('dynamics', 'path', 'boundary'):
        if not functions.has(function):
            continue
        exact = functions.external[function]
        inputs = [ca.DM(random.uniform(0.4, 0.8, exact.sparsity_in(i).shape)) for i in range(exact.n_in())]
        outputs = [ca.DM.zeros(exact.sparsity_out(i)) for i in range(exact.n_out())]
        seeds = [ca.DM(random.uniform(-1, 1, exact.sparsity_out(i).shape)) for i in range(exact.n_out())]
        for of, at in ((exact, inputs + outputs), (exact.reverse(1), None)):
            at = at or inputs + outputs + seeds + [ca.DM.zeros(*of.sparsity_out(i).shape) for i in range(of.n_out())]
            found = of.jacobian()(*at)
            values = at[:of.n_in()]
            for i in range(of.n_in()):
                if not of.is_diff_in(i) or (of is not exact and exact.n_in() <= i < exact.n_in() + exact.n_out()):
                    continue
                for entry in range(values[i].numel()):
                    sides = []
                    for step in (1e-6, -1e-6):
                        moved = [ca.DM(value) for value in values]
                        moved[i][entry] += step
                        sides.append(of.call(moved))
                    for o in range(of.n_out()):
                        wanted = ((sides[0][o] - sides[1][o]) / 2e-6).full().ravel()
                        column = found[o * of.n_in() + i][:, entry].full().ravel()
                        worst = max(worst, np.max(np.abs(column - wanted) / (1 + np.abs(wanted)), initial=0.0))
    return worst


def guessed(functions, intervals):
    """States, controls and unknowns of the guess of the model."""
    numbers = functions.numbers
    states, q, p = len(numbers['x_lower']), numbers.get('q', np.zeros(0)), numbers.get('p', np.zeros(0))
    values = [functions('guess', t=k / intervals, q=q, p=p)['value'].full().ravel() for k in range(intervals + 1)]
    return [value[:states] for value in values], [value[states:] for value in values[:-1]], q


def solution(document):
    """The same of a solution."""
    columns = [np.array(list(document[key].values())).T for key in ('states', 'controls')]
    return columns[0], columns[1], np.array(list(document['free'].values()))


def solve(functions, intervals, lagged, begin, barrier):
    """The optimal objective by IPOPT, and its iterations."""
    numbers = functions.numbers
    states, controls = len(numbers['x_lower']), len(numbers.get('u_lower', ()))
    unknowns, p = len(numbers.get('q', ())), numbers.get('p', np.zeros(0))
    x = ca.MX.sym('x', states, intervals + 1)
    u, q = ca.MX.sym('u', controls, intervals), ca.MX.sym('q', unknowns)
    step, cost, rows, lower, upper = 1 / intervals, 0, [], [], []

    def bound(value, low, high):
        rows.append(value), lower.append(low), upper.append(high)

    for k in range(intervals):
        at = ca.vertcat(*[x[i, k if i in lagged else k + 1] for i in range(states)])
        right = functions('dynamics', t=(k + 1) * step, x=at, u=u[:, k], q=q, p=p)
        bound(x[:, k] + step * right['rate'] - x[:, k + 1], np.zeros(states), np.zeros(states))
        cost += step * right.get('cost', 0)
        if functions.has('path'):
            path = functions('path', t=(k + 1) * step, x=x[:, k + 1], u=u[:, k], q=q, p=p)
            bound(path['g'], numbers['path_lower'], numbers['path_upper'])
    ends = functions('boundary', x0=x[:, 0], xf=x[:, -1], q=q, p=p)
    cost += ends['cost']
    if 'g' in ends:
        bound(ends['g'], numbers['boundary_lower'], numbers['boundary_upper'])

    fixed = ~np.isnan(numbers['x0'])
    of_states = [np.tile(numbers[side], (intervals + 1, 1)) for side in ('x_lower', 'x_upper')]
    for side in of_states:
        side[0, fixed] = numbers['x0'][fixed]
    of_controls = [np.tile(numbers.get(side, []), (intervals, 1)) for side in ('u_lower', 'u_upper')]
    limits = [np.concatenate((of_states[i].ravel(), of_controls[i].ravel(), numbers.get(name, [])))
              for i, name in enumerate(('q_lower', 'q_upper'))]
    begin = np.concatenate([np.ravel(part) for part in begin])
    problem = {'x': ca.vertcat(ca.vec(x), ca.vec(u), q), 'f': cost, 'g': ca.vertcat(*rows)}
    options = {'print_time': False, 'ipopt': {'print_level': 0, 'tol': 1e-8, 'max_iter': 3000, 'mu_init': barrier}}
    solver = ca.nlpsol('solver', 'ipopt', problem, options)
    found = solver(x0=begin, lbx=limits[0], ubx=limits[1], lbg=np.concatenate(lower), ubg=np.concatenate(upper))
    statistics = solver.stats()
    if not statistics['success']:
        raise SystemExit(f'{functions.name}: {statistics["return_status"]}')
    return float(found['f']), statistics['iter_count']


def main():
    command, failed = sys.argv[1], False
    print('| model | N | derivatives against differences | from the guess | iterations | from the solution | iterations | `fdcc solve` | difference |')
    print('|---|---|---|---|---|---|---|---|---|')
    with tempfile.TemporaryDirectory() as folder:
        for name, width, intervals, lagged in ROWS:
            changes = settings(width, intervals)
            functions = Functions(name, emitted(command, name, Path(folder), changes))
            slopes = largest_difference(functions)
            done = subprocess.run([command, 'solve', str(MODELS / f'{name}.fdc'), '--json', '--no-verify', *changes],
                                  capture_output=True, text=True)
            document = json.loads(done.stdout)
            own = document['objective']
            first, iterations = solve(functions, intervals, lagged, guessed(functions, intervals), 0.1)
            again, more = solve(functions, intervals, lagged, solution(document), 1e-6)
            difference = abs(again - own) / abs(own)
            failed |= difference > LARGEST_DIFFERENCE or slopes > 1e-5
            print(f'| {name} | {intervals} | {slopes:.1e} | {first:.9g} | {iterations} | {again:.9g} | {more} | {own:.9g} | {difference:.1e} |',
                  flush=True)
    return failed


if __name__ == '__main__':
    sys.exit(main())
