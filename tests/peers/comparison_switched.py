#!/usr/bin/env python3
"""The second table of docs/comparison.md: four problems with known optima by CasADi, nosnoc and fdcc.

    pip install casadi nosnoc
    python3 tests/peers/comparison_switched.py target/release/fdcc

Controls of the peers are constant on each of 30 intervals. CasADi: three Radau points on each, `tanh(psi/sigma)` with
sigma falling from 0.1 to 0.001, each solve begun at the one before. nosnoc: its defaults (two finite elements with two
Radau points on each interval) and either of its representations; where the last time is unknown it is a global
variable that multiplies the right side.
"""

import json
import subprocess
import sys
import time
import warnings

import casadi as ca
import nosnoc
import numpy as np

WIDTHS = [0.1, 0.03, 0.01, 0.003, 0.001]
INTERVALS = 30
INF = float('inf')
GRIP = 0.3 * 9.81

# below, above: the right side where psi is negative, positive. A duration of three numbers is free: bounds and guess.
PROBLEMS = {
    'models/block': dict(
        start=[0, 0], psi=lambda x: x[1], bound=12, duration=4, cost=lambda x, u: u**2, optimum=65.9568257099,
        below=lambda x, u: (x[1], u / 2 + GRIP), above=lambda x, u: (x[1], u / 2 - GRIP),
        end=lambda x: ca.vertcat(x[0] - 1, x[1]), guess=[1, 0]),
    'tests/classics/switched/relay': dict(
        start=[1], psi=lambda x: x[0], bound=0.5, duration=2, cost=lambda x, u: x[0]**2 + u**2, optimum=0.2955871494,
        below=lambda x, u: (u + 1,), above=lambda x, u: (u - 1,), end=None, guess=[0]),
    'models/coulomb_reverse': dict(
        start=[0, -1], psi=lambda x: x[1], bound=2, duration=(0.1, 10, 3), cost=None, optimum=2,
        below=lambda x, u: (x[1], u + 0.5), above=lambda x, u: (x[1], u - 0.5),
        end=lambda x: ca.vertcat(x[0] - 1, x[1]), guess=[1, 0]),
    'models/turbo': dict(
        start=[0, 0], psi=lambda x: x[1] - 10, bound=5, duration=(1, 60, 15), cost=None, optimum=40 / 3,
        below=lambda x, u: (x[1], u), above=lambda x, u: (x[1], 3 * u), limits=[INF, 20],
        end=lambda x: ca.vertcat(x[0] - 200, x[1]), guess=[200, 0]),
}


def collocation(it, sigma, n, degree=3):
    """The discrete problem of CasADi, a function from a guess to an answer."""
    size, free = len(it['start']), isinstance(it['duration'], tuple)
    points = ca.collocation_points(degree, 'radau')
    slopes, _, weights = ca.collocation_coeff(points)
    x, u, total = ca.MX.sym('x', size, n * degree + 1), ca.MX.sym('u', n), ca.MX.sym('T')
    h = (total if free else it['duration']) / n
    rows, objective = [x[:, 0] - ca.DM(it['start'])], (total if free else 0)
    for k in range(n):
        states = x[:, k * degree : (k + 1) * degree + 1]
        for j in range(degree):
            at = states[:, j + 1]
            below, above = (ca.vertcat(*it[side](at, u[k])) for side in ('below', 'above'))
            s = ca.tanh(it['psi'](at) / sigma)
            rows.append(ca.mtimes(states, ca.DM(slopes)[:, j]) - h * ((1 - s) * below + (1 + s) * above) / 2)
            if it['cost']:
                objective += h * float(weights[j]) * it['cost'](at, u[k])
    if it['end']:
        rows.append(it['end'](x[:, -1]))
    count = n * degree + 1
    limits = it.get('limits', [INF] * size) * count
    low, high, guess = it['duration'] if free else (0, 0, 0)
    lower = [-b for b in limits] + [-it['bound']] * n + [low]
    upper = limits + [it['bound']] * n + [high]
    path = [a + (b - a) * i / (count - 1) for i in range(count) for a, b in zip(it['start'], it['guess'])]
    solver = ca.nlpsol('solver', 'ipopt', {'x': ca.vertcat(ca.vec(x), u, total), 'f': objective, 'g': ca.vertcat(*rows)},
                       {'print_time': False, 'ipopt.print_level': 0, 'ipopt.sb': 'yes', 'expand': True})
    run = lambda first: (solver(x0=first, lbx=lower, ubx=upper, lbg=0, ubg=0), solver.stats())
    return run, path + [0] * n + [guess]


def by_casadi(it, n):
    answer, iterations = None, 0
    for sigma in WIDTHS:
        run, guess = collocation(it, sigma, n)
        answer, stats = run(guess if answer is None else answer['x'])
        iterations += stats['iter_count']
    return float(answer['f']), iterations, stats['success']


def by_nosnoc(it, n, representation):
    size, free = len(it['start']), isinstance(it['duration'], tuple)
    x, u, total = ca.SX.sym('x', size), ca.SX.sym('u'), ca.SX.sym('T')
    pace = total if free else 1
    sides = ca.horzcat(*(pace * ca.vertcat(*it[side](x, u)) for side in ('above', 'below')))
    model = nosnoc.NosnocModel(
        x=x, F=[sides], c=[it['psi'](x)], S=[np.array([[1], [-1]])], x0=np.array(it['start'], float), u=u,
        **({'v_global': total} if free else {}))
    limits = np.array(it.get('limits', [INF] * size))
    low, high, guess = it['duration'] if free else (0, 0, 0)
    ocp = nosnoc.NosnocOcp(
        lbu=np.array([-it['bound']]), ubu=np.array([it['bound']]), lbx=-limits, ubx=limits,
        **({'f_q': it['cost'](x, u)} if it['cost'] else {}), **({'g_terminal': it['end'](x)} if it['end'] else {}),
        **({'f_terminal': total, 'lbv_global': np.array([low]), 'ubv_global': np.array([high]),
            'v_global_guess': np.array([guess])} if free else {}))
    options = nosnoc.NosnocOpts()
    options.terminal_time, options.N_stages, options.print_level = (1 if free else it['duration']), n, 0
    options.pss_mode = representation
    answer = nosnoc.NosnocSolver(options, model, ocp).solve()
    return float(answer['cost_val']), int(np.sum(answer['nlp_iter'])), answer['status'] == nosnoc.Status.SUCCESS


def by_fdcc(name):
    done = subprocess.run([sys.argv[1], 'solve', f'{name}.fdc', '--json', '--log', 'none'], capture_output=True)
    answer = json.loads(done.stdout)
    return answer['objective'], answer['iterations'], answer['certificate']['certified']


def main():
    warnings.simplefilter('ignore')
    print('| | | objective | off by | iterations | s | solved |\n|---|---|---|---|---|---|---|')
    for name, it in PROBLEMS.items():
        tools = {
            'CasADi': (by_casadi, it, INTERVALS),
            'nosnoc, Stewart': (by_nosnoc, it, INTERVALS, nosnoc.PssMode.STEWART),
            'nosnoc, step': (by_nosnoc, it, INTERVALS, nosnoc.PssMode.STEP),
            'fdcc': (by_fdcc, name),
        }
        for tool, (by, *given) in tools.items():
            begin = time.perf_counter()
            objective, iterations, solved = by(*given)
            seconds, off = time.perf_counter() - begin, objective / it['optimum'] - 1
            print(f"| {name} | {tool} | {objective:.6f} | {off:.1e} | {iterations} | {seconds:.2f} | "
                  f"{'yes' if solved else 'no'} |", flush=True)


main()
