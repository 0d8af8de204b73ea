"""Chains of phases whose modes are given, for CasADi and IPOPT: collocation at five Gauss nodes, free durations.

A surface is above, below or held in a phase (`+`, `-`, `0`); where it is held its selector s is an unknown with
|s| <= 1 and d psi/dt = 0 at the nodes. Nothing is smoothed, and nothing here is shared with fdcc.
"""

from dataclasses import dataclass, field
from typing import Callable

import casadi as ca
import numpy as np

from phases_transcription import INF, Program

NODES = ca.collocation_points(5, 'legendre')
SLOPES, ENDING, WEIGHTS = ca.collocation_coeff(NODES)
PINS = {'^': 1, '_': 0}


@dataclass
class Model:
    """A problem with surfaces.

    `rate` and `cost` take (t, x, u, s, p): time, states, controls, selectors (one column for each surface) and
    unknowns; `surfaces` and `path` (which is to be positive or 0) take (t, x, p) and (t, x, u, s, p). A surface of two
    or more components is that of `Dir`: it moves (`+`) or rests (`0`). `sequences` are words such as `0 +^ +`: modes,
    then `^` or `_` for each control that is at its upper or lower bound (`~` if free), `!` and the name of a jump that
    begins the phase, `&` and the name of an arc, `:` and a guess of the duration.
    """

    start: Callable  # p -> first values, None for each that is open
    rate: Callable
    guess: Callable  # s in [0, 1] -> states
    sequences: list
    T: tuple  # (lower, upper, guess); both the same if it is given
    surfaces: Callable = lambda t, x, p: []
    bounds: list = field(default_factory=list)  # of the controls
    controls: Callable = None  # s -> their guess; the middle of the bounds otherwise
    state_bounds: dict = field(default_factory=dict)  # index: (lower, upper)
    cost: Callable = lambda t, x, u, s, p: 0
    mayer: Callable = lambda x, t, p: 0
    ends: Callable = lambda x, t, p: []  # [(expression, lower, upper, surface that implies it when held or None)]
    path: Callable = lambda t, x, u, s, p: []
    jumps: dict = field(default_factory=dict)  # name: (surface, (t, x, p) -> states afterwards)
    arcs: dict = field(default_factory=dict)  # name: (entry of (t, x, p), equation of (t, x, u, s, p))
    unknowns: dict = field(default_factory=dict)  # name: (lower, upper, guess)
    joined: bool = True  # a control reaches a bound continuously where no mode changes
    scale: float = 1.0
    N: int = 8
    note: str = ''


@dataclass
class Step:
    """One phase of a sequence."""

    modes: str
    pins: str = ''
    jump: str = ''
    arc: str = ''
    duration: float = None


def steps_of(sequence, surfaces):
    """The phases of a word like `0 +^:0.3 +`."""
    def step(word):
        word, _, duration = word.partition(':')
        word, _, arc = word.partition('&')
        word, _, jump = word.partition('!')
        return Step(word[:surfaces], word[surfaces:], jump, arc, float(duration) if duration else None)
    return [step(word) for word in sequence.split()]


def symbols(model):
    """t, x, p and what `surfaces` gives."""
    t, x = ca.SX.sym('t'), ca.SX.sym('x', len(model.guess(0)))
    p = ca.SX.sym('p', len(model.unknowns))
    return t, x, p, [ca.vertcat(*psi) if isinstance(psi, list) else ca.SX(psi) for psi in model.surfaces(t, x, p)]


def functions(model, modes, arc=''):
    """(t, x, u, z, p) -> rate, cost, d psi/dt of held surfaces, what is positive; z the selectors of held ones."""
    t, x, p, surfaces = symbols(model)
    u = ca.SX.sym('u', len(model.bounds))
    selectors, unknown, rows, positive = [], [], [], []
    for psi, mode in zip(surfaces, modes):
        if mode == '0':
            unknown.append(ca.SX.sym('s', psi.numel()))
            selectors.append(unknown[-1])
        else:
            selectors.append(psi / ca.sqrt(ca.sumsqr(psi) + 1e-30) if psi.numel() > 1 else ca.SX(1 if mode == '+' else -1))
    rate = ca.vertcat(*model.rate(t, x, u, selectors, p))
    for psi, mode, s in zip(surfaces, modes, selectors):
        if mode == '0':
            rows.append(ca.jtimes(psi, x, rate) + ca.jacobian(psi, t))
            positive += [1 - ca.sumsqr(s)] if psi.numel() > 1 else []
        elif psi.numel() == 1:
            positive.append(psi if mode == '+' else -psi)
    if arc:
        rows.append(model.arcs[arc][1](t, x, u, selectors, p))
    positive += model.path(t, x, u, selectors, p)
    cost = ca.SX(model.cost(t, x, u, selectors, p))
    return ca.Function('f', [t, x, u, ca.vertcat(ca.SX(0, 1), *unknown), p],
                       [rate, cost, ca.vertcat(ca.SX(0, 1), *rows), ca.vertcat(ca.SX(0, 1), *positive)])


def limits(model, step):
    """Bounds of the controls of a phase."""
    pins = step.pins.ljust(len(model.bounds), '~')
    return [(b[PINS[c]],) * 2 if c in PINS else b for b, c in zip(model.bounds, pins)]


def add_phase(program, model, step, span, p, place, N):
    """One phase from the time span[0] on for span[1]; its first and last state, its cost, and its grid."""
    flow, count = functions(model, step.modes, step.arc), len(model.guess(0))
    inside = [model.state_bounds.get(i, (-INF, INF)) for i in range(count)]
    selectors = [(-1.0, 1.0)] * flow.size1_in(3)
    middle = [sum(b) / 2 if max(map(abs, b)) < INF else 0.0 for b in model.bounds]
    first = x = program.variable('x', [(-INF, INF)] * count, list(map(float, model.guess(place[0]))))
    cost, grid, begin, h = 0, [], span[0], span[1] / N
    for k in range(N):
        at = [place[0] + (place[1] - place[0]) * (k + c) / N for c in NODES]
        inner = [program.variable('x', inside, list(map(float, model.guess(a)))) for a in at]
        points = ca.horzcat(x, *inner)
        tangents, us = ca.mtimes(points, SLOPES), []
        for j, c in enumerate(NODES):
            wanted = model.controls(at[j]) if model.controls else middle
            u = program.variable('u', limits(model, step), list(map(float, wanted)))
            z = program.variable('z', selectors, [0.0] * len(selectors))
            rate, running, rows, positive = flow(begin + (k + c) * h, points[:, j + 1], u, z, p)
            program.row(tangents[:, j] - h * rate)
            program.row(rows)
            program.row(positive, 0.0, INF)
            cost += h * WEIGHTS[j] * running
            us.append(u)
        grid.append((begin + k * h, h, x, ca.horzcat(*us)))
        x = ca.mtimes(points, ENDING)
    return first, x, cost, grid


def lagrange(us, c):
    """The polynomial through the nodes, at c of the element."""
    weights = [np.prod([(c - b) / (a - b) for b in NODES if b != a]) for a in NODES]
    return ca.mtimes(us, ca.DM(weights))


def boundary(program, model, before, after, last, first, t, p, grids):
    """What links two phases: a surface is 0 where it leaves + or -, and states go on or jump."""
    _, _, _, surfaces = made = symbols(model)
    value = ca.Function('psi', made[:3], [ca.vertcat(ca.SX(0, 1), *surfaces)])(t, last, p)
    rows = ca.vertsplit(value) if value.numel() else []
    sizes = [psi.numel() for psi in surfaces]
    for i, (a, b) in enumerate(zip(before.modes, after.modes)):
        jumps = after.jump and model.jumps[after.jump][0] == i
        if a != '0' and (a != b or jumps):
            for row in rows[sum(sizes[:i]):sum(sizes[:i + 1])]:
                program.row(row)
    program.row(first - (ca.vertcat(*model.jumps[after.jump][1](t, last, p)) if after.jump else last))
    if after.arc and after.arc != before.arc:
        program.row(ca.vertcat(*model.arcs[after.arc][0](t, last, p)))
    if model.joined and before.modes == after.modes and not after.jump and not before.arc and not after.arc:
        ends = lagrange(grids[0][-1][3], 1.0), lagrange(grids[1][0][3], 0.0)
        for i, (b, c) in enumerate(zip(limits(model, before), limits(model, after))):
            if (b[0] == b[1]) != (c[0] == c[1]):
                program.row(ends[0][i] - ends[1][i])


@dataclass
class Answer:
    """What was found: durations by phase, states, controls by element."""

    status: str
    objective: float
    unknowns: dict
    durations: list
    ends: np.ndarray
    elements: list  # by phase: [(begin, h, first state, controls at the nodes)]
    first: list  # NLP point
    violation: float

    @property
    def times(self):
        """When phases change."""
        return list(np.cumsum(self.durations)[:-1])


def solve(model, sequence, refine=1, verbose=False, shares=None, tol=1e-11):
    """The optimum with the modes of a sequence."""
    program, steps = Program(), steps_of(sequence, len(symbols(model)[3]))
    boxes = list(model.unknowns.values())
    p = program.variable('p', [b[:2] for b in boxes], [float(b[2]) for b in boxes])
    low, high, whole = model.T
    told = [s.duration for s in steps]
    share = shares or [d if d is not None else whole / len(steps) for d in told]
    share = [whole * d / sum(share) for d in share]
    D = program.variable('D', [(0.0, high)] * len(steps), share)
    places = [float(a) for a in np.concatenate([[0], np.cumsum(share)]) / sum(share)]
    t, cost, phases = 0, 0, []
    for i, step in enumerate(steps):
        phases.append(add_phase(program, model, step, (t, D[i]), p, places[i:i + 2], model.N * refine))
        cost += phases[-1][2]
        t = t + D[i]
        if i:
            boundary(program, model, steps[i - 1], step, phases[i - 1][1], phases[i][0], t - D[i], p,
                     (phases[i - 1][3], phases[i][3]))
    for i, value in enumerate(model.start(p)):
        if value is not None:
            program.row(phases[0][0][i] - value)
    program.row(t, low, high)
    last = phases[-1][1]
    for expression, least, most, surface in model.ends(last, t, p):
        if surface is None or steps[-1].modes[surface] != '0':
            program.row(expression, least, most)
    objective = cost + model.mayer(last, t, p)
    x = ca.veccat(*program.x)
    nlp = {'x': x, 'f': model.scale * objective, 'g': ca.vertcat(*program.rows)}
    solver = ca.nlpsol('solver', 'ipopt', nlp, {
        'print_time': False, 'ipopt.sb': 'yes', 'ipopt.print_level': 5 if verbose else 0, 'ipopt.tol': tol,
        'ipopt.acceptable_iter': 0, 'ipopt.bound_relax_factor': 0, 'ipopt.max_iter': 500,
        'ipopt.max_cpu_time': 30})
    found = solver(x0=program.first, lbx=program.low, ubx=program.high, lbg=program.row_low, ubg=program.row_high)
    tables = [[(*element[:2], *element[2:]) for element in phase[3]] for phase in phases]
    flat = [entry for table in tables for element in table for entry in element]
    *values, last_state = ca.Function('v', [x], [ca.vec(ca.MX(e)) for e in flat] + [last])(found['x'])
    arrays = [v.full() for v in values]
    elements, at, controls = [], 0, len(model.bounds)
    for table in tables:
        rows = []
        for _ in table:
            b, h, first, us = arrays[at:at + 4]
            rows.append((float(b[0, 0]), float(h[0, 0]), first.ravel(), us.reshape((5, controls)).T))
            at += 4
        elements.append(rows)
    value, numbers, lengths = ca.Function('o', [x], [objective, p, D])(found['x'])
    g = found['g'].full().ravel()
    violation = max(0.0, np.max(np.array(program.row_low) - g), np.max(g - np.array(program.row_high)))
    return Answer(solver.stats()['return_status'], float(value), dict(zip(model.unknowns, numbers.full().ravel())),
                  list(lengths.full().ravel()), last_state.full().ravel(), elements, found['x'].full().ravel(), violation)
