#!/usr/bin/env python3
"""The belt and the three blocks of tests/benches/simulation.rs by SciPy: solve_ivp from event to event.

The modes are written by hand, in plain Python numbers, which is the fastest way to use solve_ivp. Of all methods and tolerances
that end within 1e-9 the fastest counts. `ENDS` are those of DOP853 at a tolerance of 1e-13.
"""

import math
import re
import subprocess
import time

import numpy as np
from scipy.integrate import solve_ivp


def event(function, direction):
    function.terminal, function.direction = True, direction
    return function


def arcs(system, first, last, state, tolerance, method):
    """Follows a system from event to event."""
    t, mode, events, evaluations = first, system.begin(first, state), 0, 0
    while True:
        rate, conditions = system.mode(mode)
        arc = solve_ivp(rate, (t, last), state, method=method, rtol=tolerance, atol=tolerance * 1e-2, events=conditions)
        evaluations += arc.nfev
        t, state = arc.t[-1], arc.y[:, -1]
        if arc.status != 1:
            return state, events, evaluations
        fired = next(index for index, times in enumerate(arc.t_events) if len(times))
        mode, state = system.after(mode, fired, t, state)
        events += 1


class Belt:
    """x'' = -x + Sgn(0.2 - x') / (1 + 3 |0.2 - x'|); mode 0 sticks, 1 and -1 slip."""

    span, start = (0.0, 100.0), [0.0, 0.0]

    def begin(self, t, state):
        return 1

    def mode(self, side):
        if side == 0:
            rate = lambda t, y: (y[1], 0.0)
            return rate, [event(lambda t, y: 1 - y[0], -1)]
        rate = lambda t, y: (y[1], -y[0] + side / (1 + 3 * abs(0.2 - y[1])))
        return rate, [event(lambda t, y: 0.2 - y[1], -side)]

    def after(self, side, fired, t, state):
        if side == 0:
            return 1, state
        state[1] = 0.2
        return (0 if abs(state[0]) <= 1 else -side), state


class Blocks:
    """Three contacts with s in Sgn(psi), v' = F(t) + D s; sliding contacts hold psi' = 0."""

    span, start = (0.0, 50.0), [0.0, 0.0, 0.0]
    by_selector = np.array([[-3.0, 2.0, 0.0], [0.0, -2.0, 0.5], [0.0, 0.0, -0.5]])
    normals = np.array([[1.0, 0.0, 0.0], [-1.0, 1.0, 0.0], [0.0, -1.0, 1.0]])

    def solved(self, mode):
        """Selectors a + b cos t."""
        a, b = np.array(mode, float), np.zeros(3)
        held = [i for i in range(3) if mode[i] == 0]
        if held:
            matrix = (self.normals @ self.by_selector)[np.ix_(held, held)]
            a[held] = np.linalg.solve(matrix, -(self.normals @ self.by_selector @ a)[held])
            b[held] = np.linalg.solve(matrix, -(self.normals @ [8.0, 0, 0])[held])
        return a, b

    def begin(self, t, state):
        return self.consistent((0, 0, 0), (0, 1, 2), t)

    def consistent(self, mode, undecided, t):
        """The combination of sides whose rates fit."""
        for number in range(3 ** len(undecided)):
            sides = list(mode)
            for place, contact in enumerate(undecided):
                sides[contact] = (0, 1, -1)[number // 3**place % 3]
            a, b = self.solved(sides)
            s = a + b * math.cos(t)
            rate = self.normals @ (np.array([8 * math.cos(t), 0, 0]) + self.by_selector @ s)
            fits = lambda i: abs(s[i]) <= 1 + 1e-9 if sides[i] == 0 else sides[i] * rate[i] > 1e-9
            if all(fits(i) for i in undecided):
                return tuple(sides)
        raise RuntimeError("no mode")

    def mode(self, mode):
        a, b = self.solved(mode)
        f = (self.by_selector @ a).tolist()
        g = (self.by_selector @ b + [8.0, 0, 0]).tolist()

        def rate(t, y):
            c = math.cos(t)
            return f[0] + g[0] * c, f[1] + g[1] * c, f[2] + g[2] * c

        def condition(i):
            if mode[i] == 0:
                return event(lambda t, y: 1 - abs(a[i] + b[i] * math.cos(t)), -1)
            return event((lambda t, y: y[0]) if i == 0 else (lambda t, y: y[i] - y[i - 1]), -mode[i])

        return rate, [condition(i) for i in range(3)]

    def after(self, mode, fired, t, state):
        a, b = self.solved(mode)
        if mode[fired] == 0:
            sides = list(mode)
            sides[fired] = 1 if a[fired] + b[fired] * math.cos(t) > 0 else -1
            return tuple(sides), state
        undecided = tuple(i for i in range(3) if mode[i] == 0 or i == fired)
        mode = self.consistent(mode, undecided, t)
        for i in range(3):
            if mode[i] == 0:
                state[i] = 0.0 if i == 0 else state[i - 1]
        return mode, state


ENDS = {Belt: [0.770205160072, 0.2], Blocks: [0.995087486661, 0.148262802897, -0.481028802150]}
NAMES = {Belt: "belt", Blocks: "three_blocks"}
ACCURACY = 1e-9


def timed(system, tolerance, method):
    """The least time of five, and the error at the end."""
    best = math.inf
    for _ in range(5):
        begin = time.perf_counter()
        state, events, evaluations = arcs(system, *system.span, list(system.start), tolerance, method)
        best = min(best, time.perf_counter() - begin)
    error = max(abs(a - b) for a, b in zip(state, ENDS[type(system)]))
    print(f"{NAMES[type(system)]:12} {method:7} rtol {tolerance:.0e}  {1e3 * best:8.2f} ms  error {error:.1e}  "
          f"{evaluations:6} evaluations  {events} events", flush=True)
    return best, error


def ours(name):
    """The fastest run of the benchmark, in seconds."""
    command = ["cargo", "bench", "-q", "-p", "fdcc-tests", "--bench", "simulation", "--", name]
    text = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    found = re.search(rf"{name}\s+([0-9.]+) (ns|µs|ms|s)", text)
    return float(found.group(1)) * {"ns": 1e-9, "µs": 1e-6, "ms": 1e-3, "s": 1}[found.group(2)]


def main():
    for system in [Belt(), Blocks()]:
        runs = [timed(system, 10.0**-digits, method) for method in ["RK45", "DOP853", "LSODA"] for digits in range(8, 14)]
        fastest = min(seconds for seconds, error in runs if error <= ACCURACY)
        own = ours(NAMES[type(system)])
        print(f"{NAMES[type(system)]}: solve_ivp {1e3 * fastest:.2f} ms, fdcc {1e3 * own:.3f} ms, ratio {fastest / own:.0f}")


if __name__ == "__main__":
    main()
