"""A slow reference for systems with switches and resets, with 25 digits: what the scripts beside this one share.

Between events the solution is a Taylor series (mpmath), scanned for events with a small step; a selector on a sliding arc solves
`psi' = 0`; at an event all 3^k combinations of sides of the surfaces that meet are tried, and exactly one must be consistent.
Each script gives the rates of its surfaces by hand and prints the lines of `tests/simulations/NAME.expected`.
"""

from itertools import product

from mpmath import findroot, lu_solve, matrix, mp, mpf, nstr, odefun, sign

mp.dps = 25
TINY = mpf(10) ** -18


class System:
    """`rate(t, x, s)`; `surfaces[name] = (psi(t, x), psi'(t, x, x'))`; `jumps[name, direction] = reset(t, x)`."""

    def __init__(self, states, rate, surfaces, jumps=None):
        self.states, self.rate, self.jumps = states, rate, jumps or {}
        self.names = list(surfaces)
        self.psi = [psi for psi, _ in surfaces.values()]
        self.psi_rate = [rate for _, rate in surfaces.values()]

    def rates(self, t, x, s):
        """psi' of every surface."""
        f = self.rate(t, x, s)
        return [rate(t, x, f) for rate in self.psi_rate]

    def selectors(self, t, x, modes):
        """-1 and 1 as they are; for each 0 the value that keeps psi' at 0, by Newton's method (affine in each selector)."""
        s = [mpf(mode) for mode in modes]
        held = [i for i, mode in enumerate(modes) if mode == 0]
        for _ in range(1 if len(held) < 2 else 6):
            if not held:
                break
            r = self.rates(t, x, s)
            columns = []
            for j in held:
                moved = [value + (i == j) for i, value in enumerate(s)]
                columns.append([after - before for after, before in zip(self.rates(t, x, moved), r)])
            b = matrix([[column[i] for column in columns] for i in held])
            change = lu_solve(b, matrix([-r[i] for i in held]))
            for i, d in zip(held, change):
                s[i] += d
        return s

    def next_modes(self, t, x, modes, here):
        """The only consistent sides of the surfaces `here`."""
        found = []
        for sides in product((-1, 0, 1), repeat=len(here)):
            trial = list(modes)
            for i, side in zip(here, sides):
                trial[i] = side
            try:
                s = self.selectors(t, x, trial)
            except ZeroDivisionError:
                continue
            r = self.rates(t, x, s)
            if all(abs(s[i]) < 1 if trial[i] == 0 else trial[i] * r[i] > TINY for i in here):
                found.append(trial)
        assert len(found) == 1, (t, x, here, found)
        return found[0]


def crossing(before, after, is_start):
    """The name of a change of mode."""
    if after == 0:
        return 'starts_sliding' if is_start else 'enters_sliding'
    return ('leaves_' if before == 0 else 'crosses_') + ('up' if after > 0 else 'down')


class Run:
    """A system on its way; `modes` are -1, 0, 1. `hint` gives sides where the rates vanish at the start."""

    def __init__(self, system, start, first=0, hint=None):
        self.system, self.t, self.x = system, mpf(first), [mpf(value) for value in start]
        psi = [psi(self.t, self.x) for psi in system.psi]
        self.modes = [int(sign(value)) for value in psi]
        here = [i for i, mode in enumerate(self.modes) if mode == 0]
        if hint:
            self.modes = list(hint)
        elif here:
            self.modes = system.next_modes(self.t, self.x, self.modes, here)
        for i in here:
            if self.modes[i] == 0:
                self.say(i, 'starts_sliding')

    def say(self, surface, kind):
        print('event', nstr(self.t, 18), self.system.names[surface], kind)

    def conditions(self, t, x):
        """Positive while the modes last."""
        s = self.system.selectors(t, x, self.modes) if 0 in self.modes else self.modes
        beside = lambda i, mode: mode * self.system.psi[i](t, x)
        return [beside(i, mode) if mode else 1 - abs(s[i]) for i, mode in enumerate(self.modes)]

    def to(self, last, step):
        """Follows the system, event by event, looking for events with a step."""
        last, step = mpf(last), mpf(step)
        while self.t < last:
            modes = list(self.modes)
            flow = odefun(lambda t, x: self.system.rate(t, x, self.system.selectors(t, x, modes)), self.t, self.x)
            low = self.t
            while low < last:
                high = min(low + step, last)
                reached = [i for i, g in enumerate(self.conditions(high, flow(high))) if g < -TINY]
                if reached:
                    break
                low = high
            else:
                self.t, self.x = last, flow(last)
                return self
            self.event(*min(self.root(flow, i, low, high) for i in reached), flow)
        return self

    def root(self, flow, surface, low, high):
        if low == self.t:
            low += (high - low) / 1000
            assert self.conditions(low, flow(low))[surface] > 0, 'an event right behind an event'
        g = lambda t: self.conditions(t, flow(t))[surface]
        return findroot(g, (low, high), solver='anderson', tol=mpf(10) ** -40), surface

    def event(self, time, surface, flow):
        self.t, self.x = time, flow(time)
        before = list(self.modes)
        if before[surface] == 0:
            s = self.system.selectors(time, self.x, before)
            self.modes[surface] = int(sign(s[surface]))
            self.say(surface, crossing(0, self.modes[surface], False))
            return
        name = self.system.names[surface]
        direction = 'falling' if before[surface] > 0 else 'rising'
        if (name, direction) in self.system.jumps:
            self.jump(surface, self.system.jumps[name, direction])
            return
        here = [i for i, mode in enumerate(before) if mode == 0 or i == surface]
        self.modes = self.system.next_modes(time, self.x, before, here)
        for i in here:
            if self.modes[i] != before[i]:
                self.say(i, crossing(before[i], self.modes[i], False))

    def jump(self, surface, reset):
        self.x = reset(self.t, self.x)
        self.say(surface, 'jump')
        for i, psi in enumerate(self.system.psi):
            value = psi(self.t, self.x)
            if abs(value) > TINY:
                self.modes[i] = int(sign(value))

    def done(self):
        for name, value in zip(self.system.states, self.x):
            print(name, '=', nstr(value, 18))
        print()
