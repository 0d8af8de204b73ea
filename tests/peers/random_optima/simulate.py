"""The true system under given controls, from event to event, by SciPy's DOP853 with dense output.

At each break and event the modes are chosen anew among those that are consistent; where several are, as planned.
"""

import numpy as np
from scipy.integrate import solve_ivp

from filippov import System

TOLERANCE = 1e-10
NEAR = 1e-9  # of the size of a surface: it counts as 0
SLACK = 1e-7  # a hold breaks where its selector is larger than 1 by this
MOST = 60  # events


class Delicate(ArithmeticError):
    """No motion is consistent, or events pile up."""


class Simulation:
    """States with the running cost, at the breaks and at samples between them."""

    def __init__(self, model, unknowns, controls, breaks, start, planned=None, jumps=(), sizes=None):
        self.system, self.model, self.controls = System(model, unknowns), model, controls
        self.planned, self.jumps = planned or (lambda name, t: None), list(jumps)
        self.samples, self.nodes, self.events = [], [], 0
        self.watched = model.function([model.surfaces[surface] for _, surface, *_ in model.jumps])
        self.resets = {name: model.function(list(values.values())) for name, *_, values in model.jumps}
        self.states = [s.name for s in model.states]
        spans = [max(abs(c.high), abs(c.low)) * c.si for c in model.controls]
        self.cost_size = min(1.0, 1e-3 * max(spans)**2 * breaks[-1])  # of units in which it may be tiny
        self.scale = sizes if sizes is not None else np.maximum(np.abs(start), 1e-3)
        self.psi_sizes = self.surface_sizes(start)
        n = self.system.count
        self.system.near = [NEAR * size for size in self.psi_sizes[n::2]]
        self.seen, self.jumped = [], []
        self.x = np.append(np.array(start, float), 0.0)
        self.t, self.last = breaks[0], breaks[-1]
        for until in breaks[1:]:
            if until - self.t > 1e-11 * abs(breaks[-1]):
                self.advance(until)
            self.nodes.append(self.x[:-1].copy())

    def surface_sizes(self, start):
        """How much each surface changes where the states change by their sizes."""
        sizes = []
        base = np.array(self.system.psi(0.0, list(start)))
        for k, scale in enumerate(self.scale):
            moved = list(start)
            moved[k] += scale
            sizes.append(np.abs(np.array(self.system.psi(0.0, moved)) - base))
        return np.maximum(np.max(sizes, axis=0), 1e-12) if len(base) else base

    def here(self, psi):
        """The surfaces and directions that are 0."""
        n, found = self.system.count, []
        found += [i for i in range(n) if abs(psi[i]) <= NEAR * self.psi_sizes[i]]
        for j in range(len(self.system.vectors)):
            part = slice(n + 2 * j, n + 2 * j + 2)
            if np.hypot(*psi[part]) <= NEAR * max(self.psi_sizes[part]):
                found.append(n + j)
        return found

    def modes(self, until):
        """The modes that begin now."""
        psi, n = self.system.psi(self.t, self.x), self.system.count
        modes = [1 if v > 0 else -1 for v in psi[:n]] + [1] * len(self.system.vectors)
        here = self.here(psi)
        self.way = None
        if not here:
            return tuple(modes)
        soon = self.t + 1e-9 * (until - self.t)
        u = self.controls(soon)
        if self.system.vectors:
            self.way = self.system.ways(self.t, self.x, u, modes)
        found = self.system.choices(self.t, self.x, u, tuple(modes), here, self.way)
        if not found:
            raise Delicate(f'no motion from t = {self.t:.9g}')
        names = self.system.scalars + self.system.vectors
        middle = self.t + 1e-3 * (until - self.t)
        plan = tuple(self.planned(name, middle) for name in names)
        return max(found, key=lambda c: sum(c[i] == plan[i] for i in here))

    def advance(self, until):
        """To the next break, through all events."""
        while until - self.t > 1e-11 * self.last:
            self.jump_if_planned()
            modes = self.modes(until)
            self.seen += [(self.t, modes)] if not self.seen or self.seen[-1][1] != modes else []
            times, states, event = self.run(modes, until)
            self.samples.append((times, states))
            self.t, self.x = times[-1], states[:, -1].copy()
            if event is not None:
                self.events += 1
                self.t = until if until - self.t < 1e-9 * self.last else self.t
                if event >= self.own:
                    self.jump(self.model.jumps[event - self.own])
                if self.events > MOST:
                    raise Delicate(f'events pile up at t = {self.t:.9g}')

    def jump_if_planned(self):
        """A jump at a break: its surface is 0 there, and nearly was before."""
        if not self.jumps or abs(self.t - self.jumps[0][1]) > 1e-8 * max(self.t, 1e-300):
            return
        jump = next(j for j in self.model.jumps if j[0] == self.jumps[0][0])
        self.jump(jump)

    def jump(self, jump):
        """The reset."""
        name, _, _, _, values = jump
        new = self.resets[name](self.t, self.x[:-1], self.controls(self.t), self.system.p, self.system.none)
        for state, value in zip(values, new):
            self.x[self.states.index(state)] = complex(value).real
        self.jumped.append((name, self.t))
        if self.jumps and self.jumps[0][0] == name:
            self.jumps.pop(0)

    def run(self, modes, until):
        """Times and states until an event or `until`, and which event; by shorter steps if one was gone over unseen."""
        system, way = self.system, self.way

        def rate(t, x):
            u = self.controls(t)
            return system.raw(t, x, u, system.selectors(t, x, u, modes, way))
        events, step = self.leaving(modes) + self.striking(), until - self.t
        while True:
            part = solve_ivp(rate, (self.t, until), self.x, method='DOP853', rtol=TOLERANCE, max_step=step,
                             atol=0.1 * TOLERANCE * np.append(self.scale, self.cost_size), events=events or None,
                             dense_output=True)
            if part.status < 0 or not np.all(np.isfinite(part.y)):
                raise Delicate(f'the motion cannot be followed from t = {self.t:.9g}')
            if not events or step < 1e-4 * until or not self.unseen(events, part):
                break
            step /= 4
        met = next((i for i, times in enumerate(part.t_events or []) if len(times)), None)
        return part.t, part.y, met if part.status == 1 else None

    def unseen(self, events, part):
        """Whether an event lies between the steps: the function is on the wrong side at a sample."""
        span = part.t[-1] - part.t[0]
        times = part.t[0] + span * np.linspace(0.02, 0.98, 25)
        return any(e(t, part.sol(t)) * -e.direction < -e.limit for e in events for t in times)

    def leaving(self, modes):
        """Surfaces that are reached, and holds that break."""
        system, events = self.system, []
        for i in range(system.count):
            if modes[i] != 0:
                events.append(event(lambda t, x, i=i: system.psi(t, x)[i], -modes[i], 1e-8 * self.psi_sizes[i]))
        for j in range(len(system.vectors)):
            if modes[system.count + j] == 1:
                at = system.count + 2 * j
                rest = 0.1 * NEAR * max(self.psi_sizes[at:at + 2])
                events.append(event(lambda t, x, at=at: np.hypot(*system.psi(t, x)[at:at + 2]) - rest, -1, 10 * rest))
        if system.places(modes):
            events.append(event(lambda t, x: 1 + SLACK - system.strain(
                system.selectors(t, x, self.controls(t), modes, self.way), modes), -1, SLACK))
        self.own = len(events)
        return events

    def striking(self):
        """Jumps that are still allowed."""
        events = []
        for k, (name, _, sense, count, _) in enumerate(self.model.jumps):
            allowed = sum(done == name for done, _ in self.jumped) < count

            def psi(t, x, k=k, allowed=allowed):
                if not allowed:
                    return 1.0
                values = self.watched(t, x[:-1], self.system.nothing, self.system.p, self.system.none)
                return complex(values[k]).real
            events.append(event(psi, (-1 if sense == 'falling' else 1) if allowed else -1, 1e-8))
        return events


def event(function, direction, limit):
    """For solve_ivp; `limit` is what counts as on the wrong side."""
    def value(t, x):
        return function(t, x)
    value.terminal, value.direction, value.limit = True, direction, limit
    return value
