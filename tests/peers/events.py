#!/usr/bin/env python3
"""Random hybrid systems whose surfaces oscillate, nearly touch 0 or leave it for a moment, by SciPy with dense sampling.

    x1' = x2,   x2' = -w^2 x1 - d x2 + A cos(W t) + P + b sum_i Sgn(psi_i),   y_i' in Sgn(psi_i)

P is 0 in every other system, else a pulse of time or of x1, between a thousandth and a twentieth of the time wide; SciPy takes steps that are short beside it.
Every psi_i depends on t and x1 alone, so it is crossed and never held. SciPy integrates between two crossings (DOP853, 1e-12); each psi is sampled 4000
times in each unit of time along its dense output, every extremum near 0 is searched, every root refined. A system in which an extremum comes
so near to 0 that the tolerances decide is counted as delicate, and not judged.

`events.py FDCC [--count 1000] [--seconds S] [--seed N]` exits with 1 if fdcc misses an event, or sees one that is not there.
Needs NumPy and SciPy.
"""

import argparse
import json
import math
import random
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq, minimize_scalar

LAST = 6.0
DENSITY = 4000
DELICATE = 1e-7
NEAR = 1e-6
BEYOND = 0.002


class Surface:
    """A function of t and x1, as Python and as a model writes it."""

    def __init__(self, draw):
        kind = draw.choice(["waves", "clock", "bands", "touches", "pulse"])
        k, c = draw.uniform(5, 60), draw.uniform(-3, 3)
        # From well separated to nearly touching.
        gap = draw.choice([-1, 1]) * 10 ** draw.uniform(-6, -1)
        if kind == "waves":
            self.text = f"sin({k!r}*x1 + {c!r}) - ({draw.choice([0.0, 1 - abs(gap), 1 + abs(gap)])!r})"
        elif kind == "clock":
            self.text = f"cos({k!r}*t + {c!r}) - ({1 - gap!r})"
        elif kind == "bands":
            self.text = f"sin({k!r}*t)*cos({0.3 * k!r}*x1) - ({draw.uniform(0.2, 0.99)!r})"
        elif kind == "touches":
            self.text = f"(x1 - ({0.3 * c!r}))^2 - ({gap!r})"
        else:
            width = 10 ** draw.uniform(-4, -1)
            self.text = f"exp(-((t - {draw.uniform(0.5, LAST - 0.5)!r})/{width!r})^2) - {draw.uniform(0.1, 0.9)!r}"
        names = {"sin": np.sin, "cos": np.cos, "exp": np.exp}
        code = compile(self.text.replace("^", "**"), "surface", "eval")
        self.value = lambda t, x1: eval(code, names, {"t": t, "x1": x1})


class Pulse:
    """A short push: its width is a part of the whole time, or of the way of x1."""

    def __init__(self, draw):
        self.width = LAST * 10 ** draw.uniform(-3, -1.3)
        self.of = draw.choice(["t", "t", "x1"])
        middle = draw.uniform(0.03, 0.97) * LAST if self.of == "t" else draw.uniform(-1, 1)
        # It changes the velocity by a number of the size of 1.
        push = draw.choice([-1, 1]) * draw.uniform(0.3, 2) / self.width
        z = f"(({self.of} - ({middle!r}))/{self.width!r})"
        shapes = [f"exp(-{z}^2)", f"(tanh({z} + 1) - tanh({z} - 1))", f"1/(1 + {z}^2)"]
        self.text = f"({push!r})*{draw.choice(shapes)}"
        code = compile(self.text.replace("^", "**"), "pulse", "eval")
        self.value = lambda t, x1: eval(code, {"exp": math.exp, "tanh": math.tanh}, {"t": t, "x1": x1})


class System:
    """A random system."""

    def __init__(self, draw):
        self.stiffness, self.damping = draw.uniform(0.5, 9), draw.uniform(0, 0.4)
        self.swing, self.frequency = draw.uniform(0, 2), draw.uniform(0.3, 5)
        self.feedback = draw.choice([0.0, 0.0, draw.uniform(-0.3, 0.3)])
        self.start = [draw.uniform(-1, 1), draw.uniform(-1, 1)]
        self.surfaces = [Surface(draw) for _ in range(draw.randint(1, 2))]
        self.pulse = Pulse(draw) if draw.random() < 0.5 else None
        # What is at rest but for the pulse takes the longest steps.
        if self.pulse and draw.random() < 0.5:
            self.stiffness = self.damping = self.swing = self.feedback = 0.0
            self.start[1] = draw.choice([0.0, self.start[1]])

    def text(self):
        count = len(self.surfaces)
        lines = ["model events", f"time t in [0, {LAST}]"]
        lines += [f"state x{i + 1} start {x!r}" for i, x in enumerate(self.start)]
        lines += [f"state y{i} start 0" for i in range(count)]
        lines += [f"surface s{i} = {it.text}" for i, it in enumerate(self.surfaces)]
        pushes = "".join(f" + ({self.feedback!r})*Sgn(s{i})" for i in range(count)) if self.feedback else ""
        rest = f"-{self.stiffness!r}*x1 - {self.damping!r}*x2 + {self.swing!r}*cos({self.frequency!r}*t)"
        rest += f" + {self.pulse.text}" if self.pulse else ""
        lines += ["dynamics {", " x1' = x2", f" x2' {'in' if pushes else '='} {rest}{pushes}"]
        lines += [f" y{i}' in Sgn(s{i})" for i in range(count)] + ["}"]
        return "\n".join(lines) + "\n"

    def rate(self, sides):
        push = self.feedback * sum(sides)

        def rate(t, x):
            force = -self.stiffness * x[0] - self.damping * x[1] + self.swing * math.cos(self.frequency * t)
            force += self.pulse.value(t, x[0]) if self.pulse else 0.0
            return [x[1], force + push]

        return rate

    def longest(self):
        """No step of SciPy passes over a pulse; of x1 it is the shorter the faster x1 is."""
        if not self.pulse:
            return 0.05
        return min(0.05, self.pulse.width / (2 if self.pulse.of == "t" else 10))

    def events(self):
        """Times, surfaces and directions of all crossings; None if the system is delicate."""
        t, x, found = 0.0, self.start, []
        values = [it.value(t, x[0]) for it in self.surfaces]
        sides = [1 if value > 0 else -1 for value in values]
        if min(map(abs, values)) < DELICATE:
            return None
        while t < LAST:
            until = LAST if not self.feedback else min(LAST, t + 1)
            arc = solve_ivp(self.rate(sides), (t, until + BEYOND), x, method="DOP853", rtol=1e-12, atol=1e-13,
                            dense_output=True, max_step=self.longest())
            crossings = [self.crossings(i, arc.sol, t, until, found) for i in range(len(sides))]
            if any(it is None for it in crossings):
                return None
            all_of_arc = sorted((time, i) for i, times in enumerate(crossings) for time in times)
            for time, i in all_of_arc[:1] if self.feedback else all_of_arc:
                sides[i] = -sides[i]
                found.append((time, f"s{i}", "crosses_up" if sides[i] > 0 else "crosses_down"))
            if self.feedback and all_of_arc:
                t = all_of_arc[0][0]
                x = arc.sol(t)
            else:
                t, x = until, arc.sol(until)
        times = [it[0] for it in found]
        return None if any(b - a < 1e-9 for a, b in zip(times, times[1:])) else found

    def crossings(self, i, sol, first, last, found):
        """All roots of a surface in an arc; None if it nearly touches 0."""
        value = lambda t: float(self.surfaces[i].value(t, sol(t)[0]))
        # Extrema at both ends of the arc are inside the grid.
        grid = np.linspace(first, last + BEYOND, max(50, int(DENSITY * (last - first))))
        soon = first + (grid[1] - first) * 10 ** np.linspace(-6, -0.01, 100)
        # A pulse may be narrower than the grid; its middle is looked at as well.
        middles = [t for t in self.middles(i) if first < t < last + BEYOND]
        grid = np.unique(np.concatenate([grid, soon, middles]))
        psi = self.surfaces[i].value(grid, sol(grid)[0])
        # What has just been crossed is 0 at the beginning.
        begins_at_root = bool(found) and found[-1][0] == first and found[-1][1] == f"s{i}"
        knots, values = list(grid), list(psi)
        step = np.abs(np.diff(psi))
        for k in range(1, len(grid) - 1):
            is_extremum = (psi[k] - psi[k - 1]) * (psi[k + 1] - psi[k]) <= 0
            # The two nearest steps may be small where the grid is uneven, and the peak between them high.
            if not is_extremum or abs(psi[k]) > 2 * max(step[max(0, k - 3):k + 3]) + DELICATE:
                continue
            sign = 1 if psi[k] >= max(psi[k - 1], psi[k + 1]) else -1
            best = minimize_scalar(lambda t: -sign * value(t), bounds=(grid[k - 1], grid[k + 1]), method="bounded",
                                   options={"xatol": 1e-12})
            if abs(best.fun) < DELICATE:
                return None
            knots.append(best.x)
            values.append(-sign * best.fun)
        order = np.argsort(knots)
        knots, values = np.asarray(knots)[order], np.asarray(values)[order]
        if abs(value(last)) < DELICATE:
            return None
        roots = []
        for k in range(1 if begins_at_root else 0, len(knots) - 1):
            if values[k] * values[k + 1] < 0:
                roots.append(brentq(value, knots[k], knots[k + 1], xtol=1e-14))
        return [root for root in roots if root <= last]

    def middles(self, i):
        """Where a pulse is highest."""
        text = self.surfaces[i].text
        return [float(text.split("t - ")[1].split(")")[0])] if text.startswith("exp") else []


def simulated(fdcc, system, folder):
    path = Path(folder) / "events.fdc"
    path.write_text(system.text())
    run = subprocess.run([fdcc, "simulate", str(path), "--json", "--log", "none"], capture_output=True, text=True)
    if run.returncode != 0:
        return run.stderr + run.stdout[:2000]
    events = json.loads(run.stdout)["events"]
    return [(it["time"], it["surface"], it["kind"]) for it in events if it["kind"] != "starts_sliding"]


def difference(known, seen):
    """Where two sequences of events differ first, in words."""
    if isinstance(seen, str):
        return seen
    for a, b in zip(known, seen):
        if abs(a[0] - b[0]) > NEAR or a[1:] != b[1:]:
            return f"{b} where SciPy has {a}"
    return None if len(known) == len(seen) else f"{len(seen)} events where SciPy has {len(known)}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("fdcc")
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--seconds", type=float, default=math.inf)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    began, judged, delicate, events, wrong = time.monotonic(), 0, 0, 0, 0
    with tempfile.TemporaryDirectory() as folder:
        number = options.seed * 1_000_000
        while judged < options.count and time.monotonic() - began < options.seconds:
            number += 1
            system = System(random.Random(number))
            known = system.events()
            if known is None:
                delicate += 1
                continue
            what = difference(known, simulated(options.fdcc, system, folder))
            judged += 1
            events += len(known)
            if what:
                wrong += 1
                print(f"system {number}: {what}\n{system.text()}")
    print(f"{judged} systems, {events} events, {delicate} more systems too delicate to judge: {wrong} differ")
    sys.exit(1 if wrong or not judged else 0)


if __name__ == "__main__":
    main()
