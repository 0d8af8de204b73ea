"""Phases with links for CasADi and IPOPT: Radau collocation of five stages, controls free at every node.

A phase is written over real time: `rate`, `cost` and `path` are functions of (t, x, u, p), columns of states,
controls and the unknowns of the whole problem. Nothing here is shared with fdcc.
"""

from dataclasses import dataclass, field
from typing import Callable

import casadi as ca

INF = float('inf')
STAGES = 5


@dataclass
class Phase:
    """One phase of a problem."""

    times: Callable  # p -> (begin, end)
    rate: Callable
    guess: Callable  # s in [0, 1] -> states
    start: list = None  # first values, None for each that is open
    bounds: list = field(default_factory=list)  # of the controls
    controls: list = None  # their guess, or the middle of the bounds
    state_bounds: dict = field(default_factory=dict)  # index: (lower, upper)
    cost: Callable = None
    path: Callable = None
    path_bounds: list = field(default_factory=list)
    N: int = 10


@dataclass
class Problem:
    """`links` maps (from, to) to the function (x_last, p) -> x_first."""

    phases: dict
    unknowns: dict = field(default_factory=dict)  # name: (lower, upper, guess)
    links: dict = field(default_factory=dict)
    ends: Callable = None  # (first, last, p) -> [(expression, lower, upper)]; first and last by the names of the phases
    mayer: Callable = None  # (first, last, p)
    scale: float = 1.0  # of the objective, for IPOPT
    maximize: bool = False
    tol: float = 1e-11  # IPOPT's
    tell: Callable = None  # (first, last, p) -> {name: value}, key numbers beside the unknowns


class Program:
    """A nonlinear program that grows row by row."""

    def __init__(self):
        self.x, self.low, self.high, self.first, self.rows, self.row_low, self.row_high = ([] for _ in range(7))

    def variable(self, name, bounds, first):
        """A column of unknowns."""
        x = ca.MX.sym(name, len(first))
        self.x.append(x)
        self.low += [b[0] for b in bounds]
        self.high += [b[1] for b in bounds]
        self.first += first
        return x

    def row(self, expression, low=0.0, high=0.0):
        """Conditions, each within the same bounds."""
        self.rows.append(ca.vec(expression))
        self.row_low += [low] * expression.numel()
        self.row_high += [high] * expression.numel()


def radau():
    """Nodes, derivatives of the interpolant at these, and weights of the quadrature on [0, 1]."""
    nodes = ca.collocation_points(STAGES, 'radau')
    slopes, _, weights = ca.collocation_coeff(nodes)
    return nodes, slopes, weights


def functions(phase, count):
    """Right side with running cost, and path."""
    states = len(phase.guess(0))
    t, x, u, p = (ca.SX.sym(name, size) for name, size in zip('txup', (1, states, len(phase.bounds), count)))
    rate = ca.vertcat(*phase.rate(t, x, u, p))
    cost = phase.cost(t, x, u, p) if phase.cost else ca.SX(0)
    path = ca.vertcat(*phase.path(t, x, u, p)) if phase.path else ca.SX(0, 1)
    return ca.Function('f', [t, x, u, p], [rate, cost, path])


def add_phase(program, name, phase, p, refine):
    """The collocation of one phase; its first and last state and its cost."""
    nodes, slopes, weights = radau()
    n, flow = phase.N * refine, functions(phase, p.numel())
    begin, end = phase.times(p)
    h = (end - begin) / n
    count = len(phase.guess(0))
    inside = [phase.state_bounds.get(i, (-INF, INF)) for i in range(count)]
    start = phase.start or [None] * count
    fixed = [b if value is None else (value, value) for value, b in zip(start, inside)]
    controls = phase.controls or [sum(b) / 2 for b in phase.bounds]
    guess = [g if value is None else value for value, g in zip(start, phase.guess(0))]
    first = x = program.variable(f'{name}0', fixed, guess)
    cost = 0
    for k in range(n):
        points = [x]
        for c in nodes:
            points.append(program.variable(f'{name}x', inside, list(map(float, phase.guess((k + c) / n)))))
        points = ca.horzcat(*points)
        tangents = ca.mtimes(points, slopes)
        for j, c in enumerate(nodes):
            u = program.variable(f'{name}u', phase.bounds, list(map(float, controls)))
            rate, running, path = flow(begin + (k + c) * h, points[:, j + 1], u, p)
            program.row(tangents[:, j] - h * rate)
            cost += h * weights[j] * running
            for i, (low, high) in enumerate(phase.path_bounds):
                program.row(path[i], low, high)
        x = points[:, -1]
    return first, x, cost


def solve(problem, refine=1, verbose=False):
    """IPOPT's status, the objective, and the key numbers by their names."""
    program = Program()
    limits = list(problem.unknowns.values())
    p = program.variable('p', [b[:2] for b in limits], [float(b[2]) for b in limits])
    first, last, cost = {}, {}, 0
    for name, phase in problem.phases.items():
        first[name], last[name], running = add_phase(program, name, phase, p, refine)
        cost += running
    for (here, there), reset in problem.links.items():
        program.row(first[there] - ca.vertcat(*reset(last[here], p)))
    for expression, low, high in problem.ends(first, last, p) if problem.ends else []:
        program.row(expression, low, high)
    objective = cost + (problem.mayer(first, last, p) if problem.mayer else 0)
    sense = -1 if problem.maximize else 1
    x = ca.veccat(*program.x)
    solver = ca.nlpsol('solver', 'ipopt', {
        'x': x, 'f': sense * problem.scale * objective, 'g': ca.vertcat(*program.rows)}, {
        'print_time': False, 'ipopt.sb': 'yes', 'ipopt.print_level': 5 if verbose else 0, 'ipopt.tol': problem.tol,
        'ipopt.acceptable_iter': 0, 'ipopt.bound_relax_factor': 0, 'ipopt.max_iter': 2000})
    found = solver(x0=program.first, lbx=program.low, ubx=program.high, lbg=program.row_low, ubg=program.row_high)
    told = problem.tell(first, last, p) if problem.tell else {}
    names = [*problem.unknowns, *told]
    values = ca.Function('values', [x], [ca.vertcat(objective, p, *told.values())])(found['x'])
    numbers = [float(value) for value in values.full().ravel()]
    return solver.stats()['return_status'], dict(zip(['objective', *names], numbers))
