"""Chains of phases whose modes are given, for CasADi and IPOPT: collocation at five Gauss nodes, free durations."""

from dataclasses import dataclass

import casadi as ca
import numpy as np

from phases_transcription import INF, Program
from true_optimum_model import functions, steps_of, symbols

NODES = ca.collocation_points(5, 'legendre')
SLOPES, ENDING, WEIGHTS = ca.collocation_coeff(NODES)
PINS = {'^': 1, '_': 0}


def limits(model, step):
    """Bounds of the controls of a phase."""
    pins = step.pins.ljust(len(model.bounds), '~')
    return [(b[PINS[c]],) * 2 if c in PINS else b for b, c in zip(model.bounds, pins)]


def guesses(model, place, earlier=None):
    """s in [0, 1] of a phase -> states and controls to begin with, those of an earlier answer if there is one."""
    middle = [sum(b) / 2 if max(map(abs, b)) < INF else 0.0 for b in model.bounds]
    if not earlier:
        def at(s):
            return place[0] + (place[1] - place[0]) * s
        return lambda s: model.guess(at(s)), lambda s: model.controls(at(s)) if model.controls else middle
    elements, last = earlier
    n = len(elements)
    states = np.array([e[2] for e in elements] + [last])
    controls = np.concatenate([e[3].T for e in elements])
    nodes = [(k + c) / n for k in range(n) for c in NODES]
    return [lambda s, table=table, ats=ats: [np.interp(s, ats, column) for column in table.T]
            for table, ats in ((states, np.linspace(0, 1, n + 1)), (controls, nodes))]


def add_phase(program, model, step, span, p, guess, N):
    """One phase from the time span[0] on for span[1]; its first and last state, its cost, and its grid."""
    flow, count = functions(model, step.modes, step.arc), len(model.guess(0))
    inside = [model.state_bounds.get(i, (-INF, INF)) for i in range(count)]
    selectors = [(-1.0, 1.0)] * flow.size1_in(3)
    first = x = program.variable('x', [(-INF, INF)] * count, list(map(float, guess[0](0.0))))
    cost, grid, begin, h = 0, [], span[0], span[1] / N
    for k in range(N):
        at = [(k + c) / N for c in NODES]
        inner = [program.variable('x', inside, list(map(float, guess[0](a)))) for a in at]
        points = ca.horzcat(x, *inner)
        tangents, us = ca.mtimes(points, SLOPES), []
        for j, c in enumerate(NODES):
            u = program.variable('u', limits(model, step), list(map(float, guess[1](at[j]))))
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
        leaves = model.jumps[after.jump][0] == i if after.jump else a != b
        if a != '0' and leaves:
            for row in rows[sum(sizes[:i]):sum(sizes[:i + 1])]:
                program.row(row)
    program.row(first - (ca.vertcat(*model.jumps[after.jump][1](t, last, p)) if after.jump else last))
    if after.touch:
        program.row(ca.vertcat(*model.touches[after.touch](t, last, p)))
    if after.arc and after.arc != before.arc:
        program.row(ca.vertcat(*model.arcs[after.arc][0](t, last, p)))
    if model.joined and before.modes == after.modes and not after.jump:
        ends = lagrange(grids[0][-1][3], 1.0), lagrange(grids[1][0][3], 0.0)
        for i, (b, c) in enumerate(zip(limits(model, before), limits(model, after))):
            if (b[0] == b[1]) != (c[0] == c[1]) or before.arc != after.arc:
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

    @property
    def times(self):
        """When phases change."""
        return list(np.cumsum(self.durations)[:-1])


def end_of(answer, i):
    """The last state of a phase, or the first of the next one."""
    return answer.elements[i + 1][0][2] if i + 1 < len(answer.elements) else answer.ends


def solve(model, sequence, refine=1, verbose=False, earlier=None, tol=1e-11):
    """The optimum with the modes of a sequence, from an earlier answer with the same if there is one."""
    program, steps = Program(), steps_of(sequence, len(symbols(model)[3]))
    boxes = list(model.unknowns.values())
    numbers = list(earlier.unknowns.values()) if earlier else [float(b[2]) for b in boxes]
    p = program.variable('p', [b[:2] for b in boxes], [float(n) for n in numbers])
    low, high, whole = model.T
    told = [s.duration for s in steps]
    share = earlier.durations if earlier else [d if d is not None else whole / len(steps) for d in told]
    share = share if earlier else [whole * d / sum(share) for d in share]
    D = program.variable('D', [(0.0, high)] * len(steps), share)
    places = [float(a) for a in np.concatenate([[0], np.cumsum(share)]) / sum(share)]
    t, cost, phases = 0, 0, []
    for i, step in enumerate(steps):
        known = earlier and (earlier.elements[i], end_of(earlier, i))
        guess = guesses(model, places[i:i + 2], known)
        phases.append(add_phase(program, model, step, (t, D[i]), p, guess, model.N * refine))
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
    near = {'ipopt.mu_init': 1e-7, 'ipopt.bound_push': 1e-8, 'ipopt.bound_frac': 1e-8} if earlier else {}
    solver = ca.nlpsol('solver', 'ipopt', nlp, {
        **near,
        'print_time': False, 'ipopt.sb': 'yes', 'ipopt.print_level': 5 if verbose else 0, 'ipopt.tol': tol,
        'ipopt.acceptable_iter': 0, 'ipopt.bound_relax_factor': 0, 'ipopt.max_iter': 500,
        'ipopt.max_cpu_time': 30})
    found = solver(x0=program.first, lbx=program.low, ubx=program.high, lbg=program.row_low, ubg=program.row_high)
    tables = [phase[3] for phase in phases]
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
    return Answer(solver.stats()['return_status'], float(value), dict(zip(model.unknowns, numbers.full().ravel())),
                  list(lengths.full().ravel()), last_state.full().ravel(), elements)
