"""The true system under fdcc's controls, by SciPy: interval by interval, dry friction from event to event."""

import math

import numpy as np
from scipy.integrate import solve_ivp

TIGHT = 1e-10


THIN = 1e-7  # of a typical size: the layer that stands for `Sgn` where several surfaces act at once


def source(e, names):
    """Python code of an expression; `Sgn` is the selector `s`, or with names['layer'] a layer of that width."""
    if e.kind == 'number':
        return repr(e.value)
    if e.kind == 'name':
        return names[e.value]
    if e.kind == 'Sgn':
        return f'tanh({source(e.parts[0], names)} / {names["layer"]})' if 'layer' in names else 's'
    parts = [source(part, names) for part in e.parts]
    if e.kind in '+-*/^':
        return f'({parts[0]} {e.kind.replace("^", "**")} {parts[1]})'
    return f'{e.kind}({parts[0]})'


def switching(e):
    """The arguments of all `Sgn`; each is linear in the states."""
    return [e.parts[0]] if e.kind == 'Sgn' else [found for part in e.parts for found in switching(part)]


class System:
    """Right side f(t, x, u, p, s) and switching function psi(x)."""

    def __init__(self, problem):
        names = {s.name: f'x[{i}]' for i, s in enumerate(problem.states)}
        names.update({c.name: f'u[{i}]' for i, c in enumerate(problem.controls)}, t='t')
        names.update({p.name: f'p[{i}]' for i, p in enumerate(problem.unknowns)})
        surfaces = [psi for s in problem.states for psi in switching(s.rate)]
        if len(surfaces) > 1:
            names['layer'] = THIN * min(s.move for s in problem.states)
        rates = ', '.join(source(s.rate, names) for s in problem.states)
        self.f = eval(f'lambda t, x, u, p, s: ({rates},)', vars(math))
        self.psi = eval(f'lambda x: {source(surfaces[0], names)}', vars(math)) if len(surfaces) == 1 else None

    def psi_rate(self, t, x, u, p, s):
        rate = self.f(t, x, u, p, s)
        return self.psi([a + b for a, b in zip(x, rate)]) - self.psi(x)

    def holding(self, t, x, u, p):
        """The selector that holds psi at 0; beyond [-1, 1] it cannot be held."""
        up, down = self.psi_rate(t, x, u, p, 1), self.psi_rate(t, x, u, p, -1)
        return (up + down) / (down - up)


def replay(problem, start, controls, unknowns, duration):
    """States at all grid points, states x (N + 1); None where the integrator gives up."""
    system, h = System(problem), duration / problem.N
    floors = 1e-3 * TIGHT * np.array([s.move for s in problem.states])
    states = [np.asarray(start, float)]
    for k in range(problem.N):
        u = [float(value) for value in controls[:, k]]
        arc = smooth_arc if system.psi is None else friction_arc
        new = arc(system, k * h, (k + 1) * h, states[-1], u, unknowns, floors)
        if new is None or not np.all(np.isfinite(new)):
            return None
        states.append(new)
    return np.array(states).T


def integrate(system, t, last, x, u, p, s, floors, event=None):
    """One arc with a selector that is a number, or a function of (t, x)."""
    selector = s if callable(s) else lambda t, x: s
    rate = lambda t, x: system.f(t, x, u, p, selector(t, x))
    try:
        return solve_ivp(rate, (t, last), x, method='LSODA' if event is None else 'DOP853', rtol=TIGHT, atol=floors,
                         events=event)
    except (OverflowError, ValueError, ZeroDivisionError):
        return None


def smooth_arc(system, t, last, x, u, p, floors):
    found = integrate(system, t, last, x, u, p, 0, floors)
    return found.y[:, -1] if found is not None and found.success else None


def friction_arc(system, t, last, x, u, p, floors):
    """Slips with s = 1 or -1, or sticks, until psi or the holding selector says otherwise."""
    near = 1e4 * floors.max()
    for _ in range(100):
        s = 1.0 if system.psi(x) > near else -1.0
        if abs(system.psi(x)) <= near:
            s = system.holding(t, x, u, p)
            s = math.copysign(1, s) if abs(s) > 1 + 1e-9 else None
        hold = lambda t, x: system.holding(t, x, u, p)
        if s is None:
            ends = lambda t, x: 1 + 1e-6 - abs(hold(t, x))
        else:
            ends = lambda t, x, s=s: s * system.psi(x) + near / 2
        ends.terminal, ends.direction = True, -1
        found = integrate(system, t, last, x, u, p, hold if s is None else s, floors, ends)
        if found is None or not found.success:
            return None
        t, x = found.t[-1], found.y[:, -1]
        if t >= last - 1e-14 * abs(last):
            return x
    return None
