#!/usr/bin/env python3
"""The table of docs/comparison.md: models/block.fdc by CasADi and IPOPT, friction smoothed, and by fdcc.

    python3 tests/peers/comparison.py target/release/fdcc

The peer is direct collocation at three Radau points on each interval, controls constant on it, friction
`tanh(v/sigma)`; each width alone, and each begun at the solution for the width before it. What the controls do on
the true system is computed here, by the motion of a block under constant forces, which has a closed form.
"""

import json
import subprocess
import sys
import time

import casadi as ca
import numpy as np

MASS, GRIP, BOUND, DURATION, GOAL = 2.0, 0.3 * 2.0 * 9.81, 12.0, 4.0, 1.0
WIDTHS = [0.1, 0.03, 0.01, 0.003, 0.001]
INTERVALS, DEGREE = 100, 3


def problem(sigma):
    """The discrete problem: its solver, its bounds, and where the controls stand."""
    h = DURATION / INTERVALS
    points = [0.0, *ca.collocation_points(DEGREE, 'radau')]
    slopes, _, _ = ca.collocation_coeff(points[1:])
    rate = lambda x, force: ca.vertcat(x[1], (force - GRIP * ca.tanh(x[1] / sigma)) / MASS)
    x = ca.MX.sym('x', 2, INTERVALS * DEGREE + 1)
    force = ca.MX.sym('F', INTERVALS)
    rows = [x[:, 0], x[:, -1] - ca.vertcat(GOAL, 0)]
    for k in range(INTERVALS):
        states = x[:, k * DEGREE : (k + 1) * DEGREE + 1]
        rates = ca.horzcat(*(rate(states[:, j], force[k]) for j in range(1, DEGREE + 1)))
        rows.append(ca.vec(ca.mtimes(states, ca.DM(slopes)) - h * rates))
    variables = ca.vertcat(ca.vec(x), force)
    solver = ca.nlpsol('solver', 'ipopt', {'x': variables, 'f': h * ca.sumsqr(force), 'g': ca.vertcat(*rows)}, {
        'print_time': False, 'expand': True, 'ipopt.print_level': 0, 'ipopt.sb': 'yes', 'ipopt.tol': 1e-8,
        'ipopt.max_iter': 3000})
    count = 2 * (INTERVALS * DEGREE + 1)
    free = [float('inf')] * count
    bounds = {'lbx': [-it for it in free] + [-BOUND] * INTERVALS, 'ubx': free + [BOUND] * INTERVALS, 'lbg': 0, 'ubg': 0}
    return solver, bounds, count


def straight():
    """The guess of fdcc: from start to end at a constant speed of the path, no force."""
    path = np.linspace(0, GOAL, INTERVALS * DEGREE + 1)
    return np.concatenate([np.column_stack([path, 0 * path]).ravel(), np.zeros(INTERVALS)])


def slide(x, v, force, left):
    """A block under a constant force for the time `left`, with friction as a set."""
    while left > 0:
        side = np.sign(v) if v != 0 else np.sign(force) * (abs(force) > GRIP)
        if side == 0:
            return x, 0.0
        a = (force - side * GRIP) / MASS
        stop = -v / a if v * a < 0 else float('inf')
        dt = min(left, stop)
        x, v, left = x + v * dt + a * dt**2 / 2, (0.0 if stop <= left else v + a * dt), left - dt
    return x, v


def replay(forces):
    x = v = 0.0
    for force in forces:
        x, v = slide(x, v, force, DURATION / len(forces))
    return x, v


def peer(sigma, guess):
    solver, bounds, count = problem(sigma)
    begin = time.perf_counter()
    answer = solver(x0=guess, **bounds)
    seconds = time.perf_counter() - begin
    values = np.array(answer['x']).ravel()
    status = solver.stats()['return_status']
    x, v = replay(values[count:])
    return {'solved': status == 'Solve_Succeeded', 'status': status, 'objective': float(answer['f']), 'iterations':
            solver.stats()['iter_count'], 'seconds': seconds, 'end': x, 'speed': v, 'values': values}


def row(name, it):
    print(f"| {name} | {it['objective']:.4f} | {it['end']:.4f} | {it['iterations']} | {it['seconds']:.2f} | "
          f"{'yes' if it['solved'] else it['status']} |")


def main():
    print('| | objective | replay ends at | iterations | s | solved |\n|---|---|---|---|---|---|')
    guess = straight()
    for sigma in WIDTHS:
        row(f'CasADi, sigma {sigma:g}, from the guess', peer(sigma, straight()))
    for sigma in WIDTHS:
        answer = peer(sigma, guess)
        row(f'CasADi, sigma {sigma:g}, from the width before', answer)
        guess = answer['values']
    begin = time.perf_counter()
    done = subprocess.run([sys.argv[1], 'solve', 'models/block.fdc', '--json', '--log', 'none'], capture_output=True)
    seconds = time.perf_counter() - begin
    answer = json.loads(done.stdout)
    checked = answer['verification']
    row('fdcc', {'objective': answer['objective'], 'end': GOAL + (checked['differs'] or {}).get('difference', 0.0),
                 'iterations': answer['iterations'], 'seconds': seconds, 'solved': answer['certificate']['certified']})


main()
