"""The transcription of docs/method/transcription.md for any smooth problem, solved by IPOPT through CasADi.

A problem is written over real time. `rate`, `cost`, `path` and `integrals` are functions of (t, x, u, p); `x`, `u` and
`p` are columns of states, controls and unknowns.
"""

from dataclasses import dataclass, field
from typing import Callable

import casadi as ca

INF = float('inf')
# weights, places of the nodes in a step, blends between its old and its new state
NODES = {
    'implicit_euler': [(1, 1, 1)],
    'midpoint': [(1, 0.5, 0.5)],
    'trapezoid': [(0.5, 0, 0), (0.5, 1, 1)],
}


@dataclass
class Problem:
    """One row of the table."""

    start: list
    rate: Callable
    bounds: list  # of the controls
    N: int = 200
    scheme: str = 'midpoint'
    duration: object = None  # a number, or None for the first unknown
    unknowns: list = field(default_factory=list)  # (lower, upper, guess)
    end: dict = field(default_factory=dict)  # index of a state: value
    ends: Callable = None  # (x0, xN, p) -> [(expression, lower, upper)]
    state_bounds: dict = field(default_factory=dict)
    cost: Callable = None
    mayer: Callable = None  # (x0, xN, p)
    path: Callable = None
    path_bounds: list = field(default_factory=list)
    integrals: Callable = None  # of the conditions on integrals
    integral_values: list = field(default_factory=list)
    guess: Callable = None  # (s, T) -> {index of a state: value}
    guess_control: Callable = None  # (s, T) -> list
    maximize: bool = False

    def first_state(self, s, total):
        """The guess of the states at the fraction `s` of the time: straight from start to end."""
        straight = [a + s * (self.end.get(i, a) - a) for i, a in enumerate(self.start)]
        said = self.guess(s, total) if self.guess else {}
        return [self.start[i] if s == 0 else said.get(i, straight[i]) for i in range(len(straight))]

    def first_control(self, s, total):
        """The guess of the controls."""
        return self.guess_control(s, total) if self.guess_control else [sum(bounds) / 2 for bounds in self.bounds]


def vector(values):
    """A column; none at all is a column of 0 rows."""
    return ca.vertcat(*values) if values else ca.SX(0, 1)


def functions(problem):
    """Right side with running cost and integrands, and path, as functions of (t, x, u, p)."""
    t, x, u, p = (ca.SX.sym(name, size) for name, size in
                  zip('txup', (1, len(problem.start), len(problem.bounds), len(problem.unknowns))))
    rate = vector(problem.rate(t, x, u, p))
    cost = problem.cost(t, x, u, p) if problem.cost else ca.SX(0)
    integrals = vector(problem.integrals(t, x, u, p) if problem.integrals else [])
    path = vector(problem.path(t, x, u, p) if problem.path else [])
    inputs = [t, x, u, p]
    return ca.Function('f', inputs, [rate, cost, integrals]), ca.Function('g', inputs, [path])


def solve(problem, verbose=False):
    """IPOPT's status, objective and iterations."""
    n, count = problem.N, len(problem.start)
    flow, path = functions(problem)
    x = ca.MX.sym('x', count, n + 1)
    u = ca.MX.sym('u', len(problem.bounds), n)
    p = ca.MX.sym('p', len(problem.unknowns))
    total = problem.duration if problem.duration is not None else p[0]
    h = total / n
    time = ca.DM(range(n)).T / n
    defects, cost, integrals = x[:, 1:] - x[:, :-1], 0, 0
    for weight, place, blend in NODES[problem.scheme]:
        state = (1 - blend) * x[:, :-1] + blend * x[:, 1:]
        rate, running, parts = flow.map(n)((time + place / n) * total, state, u, ca.repmat(p, 1, n))
        defects -= h * weight * rate
        cost += h * weight * ca.sum2(running)
        integrals += h * weight * ca.sum2(parts)
    rows = [(ca.vec(defects), 0, 0)]
    if problem.path:
        values = path.map(n)((time + 1 / n) * total, x[:, 1:], u, ca.repmat(p, 1, n))
        rows += [(values[i, :].T, low, high) for i, (low, high) in enumerate(problem.path_bounds)]
    rows += [(x[i, n], value, value) for i, value in problem.end.items()]
    rows += [(integrals[i], value, value) for i, value in enumerate(problem.integral_values)]
    if problem.ends:
        rows += problem.ends(x[:, 0], x[:, n], p)
    mayer = problem.mayer(x[:, 0], x[:, n], p) if problem.mayer else 0
    sense = -1 if problem.maximize else 1
    return optimise(problem, (x, u, p), sense, sense * (cost + mayer), rows, verbose)


def bounds_of(problem, side):
    """Bounds of all variables; the start is fixed."""
    n, count = problem.N, len(problem.start)
    inside = [problem.state_bounds.get(i, (-INF, INF))[side] for i in range(count)]
    controls = [bounds[side] for bounds in problem.bounds]
    return list(problem.start) + inside * n + controls * n + [unknown[side] for unknown in problem.unknowns]


def optimise(problem, variables, sense, objective, rows, verbose):
    """Hands the program to IPOPT."""
    n = problem.N
    guess_of_time = problem.duration if problem.duration is not None else problem.unknowns[0][2]
    first = [value for k in range(n + 1) for value in problem.first_state(k / n, guess_of_time)]
    first += [value for k in range(n) for value in problem.first_control(k / n, guess_of_time)]
    first += [unknown[2] for unknown in problem.unknowns]
    expressions = [ca.vec(row[0]) for row in rows]
    low = ca.vertcat(*(ca.repmat(ca.DM(row[1]), e.numel(), 1) for row, e in zip(rows, expressions)))
    high = ca.vertcat(*(ca.repmat(ca.DM(row[2]), e.numel(), 1) for row, e in zip(rows, expressions)))
    program = {'x': ca.veccat(*variables), 'f': objective, 'g': ca.vertcat(*expressions)}
    solver = ca.nlpsol('solver', 'ipopt', program, {
        'print_time': False, 'ipopt.sb': 'yes', 'ipopt.print_level': 5 if verbose else 0, 'ipopt.tol': 1e-8,
        'ipopt.bound_relax_factor': 0, 'ipopt.max_iter': 3000})
    found = solver(x0=first, lbx=bounds_of(problem, 0), ubx=bounds_of(problem, 1), lbg=low, ubg=high)
    stats = solver.stats()
    return stats['return_status'], sense * float(found['f']), stats['iter_count']
