"""What the peers share: implicit Euler on a uniform grid, `Sgn` smoothed by the cubic kernel, IPOPT through CasADi.

The right side is taken at the new time, the integral of the cost at the right end of each interval, and path
constraints hold at every grid point after the start. Each script prints one JSON line.
"""

import argparse
import json

import casadi as ca


def sgn(z, sigma):
    """The integral of the kernel 3/4 (1 - r^2)."""
    r = ca.fmax(-1, ca.fmin(1, z / sigma))
    return (3 * r - r**3) / 2


def arguments(sigma, intervals):
    parser = argparse.ArgumentParser()
    parser.add_argument('--sigma', type=float, default=sigma)
    parser.add_argument('--N', type=int, default=intervals)
    parser.add_argument('--verbose', action='store_true')
    return parser.parse_args()


def solve(options, rate, start, end, bounds, cost, duration, guess, path=None, path_bounds=None, state_bounds=None):
    """`rate`, `cost` and `path` are functions of (x, u); `duration` is a number or (lower, upper, guess)."""
    n, count = options.N, len(start)
    x = [ca.MX.sym(f'x{k}', count) for k in range(n + 1)]
    u = [ca.MX.sym(f'u{k}') for k in range(n)]
    free = isinstance(duration, tuple)
    total = ca.MX.sym('T') if free else duration
    h = total / n
    inf = float('inf')
    rows, low, high = [], [], []
    objective = total if cost is None else 0
    for k in range(n):
        rows.append(x[k + 1] - x[k] - h * rate(x[k + 1], u[k]))
        low += [0] * count
        high += [0] * count
        if path is not None:
            rows.append(path(x[k + 1], u[k]))
            low.append(path_bounds[0])
            high.append(path_bounds[1])
        if cost is not None:
            objective += h * cost(x[k + 1], u[k])
    for index, value in end.items():
        rows.append(x[n][index])
        low.append(value)
        high.append(value)
    state_low, state_high = state_bounds or ([-inf] * count, [inf] * count)
    variables = ca.vertcat(*x, *u, *([total] if free else []))
    lower = list(start) + state_low * n + [bounds[0]] * n + ([duration[0]] if free else [])
    upper = list(start) + state_high * n + [bounds[1]] * n + ([duration[1]] if free else [])
    first = [value for k in range(n + 1) for value in guess(k / n)] + [sum(bounds) / 2] * n
    first += [duration[2]] if free else []
    solver = ca.nlpsol('solver', 'ipopt', {'x': variables, 'f': objective, 'g': ca.vertcat(*rows)}, {
        'print_time': False, 'expand': True, 'ipopt.tol': 1e-10, 'ipopt.max_iter': 5000, 'ipopt.sb': 'yes',
        'ipopt.bound_relax_factor': 0, 'ipopt.print_level': 5 if options.verbose else 0})
    found = solver(x0=first, lbx=lower, ubx=upper, lbg=low, ubg=high)
    stats = solver.stats()
    print(json.dumps({'sigma': options.sigma, 'N': n, 'objective': float(found['f']), 'iterations': stats['iter_count'],
                      'status': stats['return_status'], 'casadi': ca.__version__}))
