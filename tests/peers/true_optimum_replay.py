"""The controls of an answer, played on the true system by scipy: modes are found again, events are located.

A mode is chosen where it is consistent: above and below when psi leaves to that side, held when |s| <= 1 keeps psi = 0.
"""

from itertools import product

import casadi as ca
import numpy as np
from scipy.integrate import solve_ivp

from true_optimum_model import functions, steps_of, symbols
from true_optimum_transcription import NODES

NEAR = 1e-8  # of the surface
SLACK = 1e-6  # of rates and selectors: a hold that ends at |s| = 1


class System:
    """The true system of a model."""

    def __init__(self, model, p):
        t, x, ps, surfaces = symbols(model)
        self.model, self.p, self.flows = model, p, {}
        self.sizes = [psi.numel() for psi in surfaces]
        self.psi = ca.Function('psi', [t, x, ps], [ca.vertcat(ca.SX(0, 1), *surfaces)])

    def surfaces(self, t, x):
        """The value of each surface: a norm if it has more components than one."""
        value = self.psi(t, x, self.p).full().ravel()
        parts = np.split(value, np.cumsum(self.sizes)[:-1]) if self.sizes else []
        return [float(v[0]) if len(v) == 1 else float(np.linalg.norm(v)) for v in parts]

    def flow(self, modes):
        """(t, x, u) -> rate with cost, selectors, by the selectors that keep held surfaces at 0."""
        if modes not in self.flows:
            f = functions(self.model, modes)
            t, x, u, z, p = (ca.SX.sym(n, f.size1_in(i)) for i, n in enumerate('txuzp'))
            rate, cost, rows, _ = f(t, x, u, z, p)
            if z.numel():  # affine in z
                matrix = ca.jacobian(rows, z)
                found = ca.solve(matrix, -ca.substitute(rows, z, 0)) if z.numel() else z
                rate, cost = ca.substitute([rate, cost], [z], [found])
            else:
                found = z
            psi = self.psi(t, x, p)
            turn = ca.jtimes(psi, x, rate) + ca.jacobian(psi, t) if psi.numel() else psi
            self.flows[modes] = ca.Function('flow', [t, x, u, p], [ca.vertcat(rate, cost), found, turn])
        return self.flows[modes]

    def consistent(self, modes, t, x, u, value):
        """Whether a motion with these modes can begin here."""
        _, s, turn = (v.full().ravel() for v in self.flow(modes)(t, x, u, self.p))
        for i, (mode, size, psi) in enumerate(zip(modes, self.sizes, value)):
            if mode == '+' and size > 1 and psi < NEAR and self.rests(modes, i, t, x, u):
                return False
        held, at = 0, 0
        for mode, size, psi in zip(modes, self.sizes, value):
            if mode == '0':
                if np.linalg.norm(s[held:held + size]) > 1 + SLACK:
                    return False
                held += size
            elif size == 1 and abs(psi) < NEAR and (1 if mode == '+' else -1) * turn[at] < -SLACK:
                return False
            at += size
        return True

    def rests(self, modes, i, t, x, u):
        """Whether the vector surface i is kept at 0, so that it does not move."""
        modes, at = modes[:i] + '0' + modes[i + 1:], sum(n for m, n in zip(modes[:i], self.sizes) if m == '0')
        s = self.flow(modes)(t, x, u, self.p)[1].full().ravel()[at:at + self.sizes[i]]
        return np.linalg.norm(s) < 1 - SLACK

    def modes(self, t, x, u, planned):
        """The modes that begin here, those of the plan if they can."""
        value = self.surfaces(t, x)
        choices = [('0+-' if n == 1 else '0+') if abs(v) < NEAR else '+' if v > 0 else '-'
                   for v, n in zip(value, self.sizes)]
        can = [''.join(m) for m in product(*choices) if self.consistent(''.join(m), t, x, u, value)]
        if not can:
            raise ArithmeticError(f'no motion from t = {t}, x = {x}')
        return planned if planned in can else can[0]


def events_of(system, modes, u):
    """What ends a run: a surface that is reached, a hold that breaks away."""
    def reached(i, sign):
        def event(t, x):
            return sign * system.surfaces(t, x[:-1])[i] + (0 if system.sizes[i] == 1 else -NEAR / 10)
        return event

    def breaks(i, size):
        def event(t, x):
            s = system.flow(modes)(t, x[:-1], u(t), system.p)[1].full().ravel()
            return 1 + SLACK - np.linalg.norm(s[i:i + size])
        return event
    held, events = 0, []
    for i, (mode, size) in enumerate(zip(modes, system.sizes)):
        if mode == '0':
            events.append(breaks(held, size))
            held += size
        elif size == 1 or mode == '+':
            events.append(reached(i, -1 if mode == '-' else 1))
    for event in events:
        event.terminal, event.direction = True, -1
    return events


def run(system, modes, t, x, stop, u):
    """Until an event or `stop`."""
    flow = system.flow(modes)

    def rate(time, y):
        return flow(time, y[:-1], u(time), system.p)[0].full().ravel()
    return solve_ivp(rate, (t, stop), x, method='DOP853', rtol=1e-12, atol=1e-13,
                     events=events_of(system, modes, u) or None)


def polynomial(begin, h, us):
    """The controls of an element over time."""
    if not len(us):
        return lambda t: np.zeros(0)
    fit = [np.polyfit(NODES, row, len(NODES) - 1) for row in us]
    return lambda t: np.array([np.polyval(f, (t - begin) / h) for f in fit])


def excess(model, answer):
    """How far controls leave their bounds between the nodes, relative to these."""
    most = 0.0
    for begin, h, _, us in (element for phase in answer.elements for element in phase):
        u = polynomial(begin, h, us)
        values = np.array([u(begin + c * h) for c in np.linspace(0, 1, 9)])
        for i, (low, high) in enumerate(model.bounds):
            beyond = max(values[:, i].max() - high, low - values[:, i].min())
            most = max(most, beyond / max(1.0, high - low) if h > 1e-9 else 0.0)
    return most


def replay(model, sequence, answer):
    """The gap of states at the end, that of the objective's integral, and the modes that were seen."""
    system = System(model, list(answer.unknowns.values()))
    steps = steps_of(sequence, len(system.sizes))
    x, modes, seen, events = np.append(answer.elements[0][0][2], 0.0), None, [], 0
    for step, elements in zip(steps, answer.elements):
        if sum(h for _, h, _, _ in elements) < 1e-9:
            continue
        if step.jump:
            x = np.append(ca.vertcat(*model.jumps[step.jump][1](elements[0][0], ca.DM(x[:-1]), ca.DM(system.p)))
                          .full().ravel(), x[-1])
        for i, (begin, h, _, us) in enumerate(elements):
            t, stop, u = begin, begin + h, polynomial(begin, h, us)
            while stop - t > 1e-12 * max(1.0, stop):
                if i == 0 or modes is None:
                    modes = system.modes(t, x[:-1], u(t + 1e-9 * (stop - t)), step.modes)
                part = run(system, modes, t, x, stop, u)
                seen += [modes] if not seen or seen[-1] != modes else []
                t, x = part.t[-1], part.y[:, -1]
                if part.status == 1:
                    modes, events = None, events + 1
                    if events > 50:
                        raise ArithmeticError(f'events pile up at t = {t}')
    return float(np.max(np.abs(x[:-1] - answer.ends))), x, ' '.join(seen)
