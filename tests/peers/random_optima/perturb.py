"""Neighbours of an answer: hats on its controls, short pieces with other values, stretched time, other starts.

Every direction has a size of 0 or more, so a kink of the objective at the answer is seen from each side.
"""

import bisect

import numpy as np

from replayed import beyond, outcome, sizes_of, starts, violation, condition_sizes
from quick import Quick
from simulate import Delicate

HATS = 6


class Hat:
    """A control is raised or lowered around a knot, by a part of its range."""

    def __init__(self, control, knot, sign):
        self.control, self.knot, self.sign = control, knot, sign

    def times(self, size):
        return [self.knot - 1 / HATS, self.knot, self.knot + 1 / HATS]

    def change(self, s, u, ranges, size):
        part = 1 - abs(s - self.knot) * HATS
        if part > 0:
            u[self.control] += self.sign * size * part * (ranges[self.control][1] - ranges[self.control][0])


class Needle:
    """Other controls on a short piece that begins or ends at a time; its length is the size."""

    def __init__(self, at, side, values):
        self.at, self.side, self.values = at, side, values

    def ends(self, size):
        return (self.at, self.at + size) if self.side > 0 else (self.at - size, self.at)

    def times(self, size):
        return list(self.ends(size))

    def change(self, s, u, ranges, size):
        begin, end = self.ends(size)
        if begin <= s < end:
            u[:] = self.values


class Unknown:
    """An unknown, or a free start, is larger or smaller by a part of its size."""

    def __init__(self, place, scale):
        self.place, self.scale = place, scale

    def times(self, size):
        return []

    def change(self, s, u, ranges, size):
        pass


class Neighbourhood:
    """All directions at an answer, and what comes of a step."""

    def __init__(self, answer, rng):
        self.answer, self.model, self.rng = answer, answer.model, rng
        self.sizes = sizes_of(answer)
        self.ranges = [(c.low * c.si, c.high * c.si) for c in self.model.controls]
        self.last = answer.time[-1]
        self.base = [t / self.last for t in answer.breaks()]
        # Those with an opposite come first, in pairs.
        self.directions = self.hats() + self.unknowns() + self.needles()
        self.count = 0

    def hats(self):
        return [Hat(j, k / HATS, sign) for j in range(len(self.ranges)) for k in range(HATS + 1) for sign in (1, -1)]

    def needles(self):
        """At each break the controls of its other side; there and elsewhere, others."""
        found, answer = [], self.answer
        events = [span['from'] / self.last for spans in answer.document['surfaces'].values() for span in spans]
        places = sorted({*self.base, *events})
        for s in places[:8]:
            k = answer.interval(s * self.last)
            if s > 0:
                after = answer.controls(s * self.last, k)
                found += [Needle(s, -1, after)]
            if s < 1 and k > 0:
                found += [Needle(s, 1, answer.controls(s * self.last, k - 1))]
        for s in [*places[:4], *(self.rng.random() for _ in range(2))]:
            for part in (0.0, 0.5, 1.0):
                values = [low + part * (high - low) for low, high in self.ranges]
                if len(values) > 1:
                    self.rng.shuffle(values)
                found.append(Needle(s, 1 if s < 0.99 else -1, values))
        return found

    def unknowns(self):
        values = self.answer.unknowns
        found = [Unknown(k, sign * max(abs(v), 1e-9)) for k, v in enumerate(values) for sign in (1, -1)]
        for k, state in enumerate(self.model.states):
            if state.start is None:
                found += [Unknown((k,), sign * self.sizes[k]) for sign in (1, -1)]
        return found

    def measured(self, step, kind=Quick):
        """(objective, relative residuals of equations, largest violation of inequalities); None if there is no motion."""
        self.count += 1
        used = [(d, size) for d, size in zip(self.directions, step) if size > 0]
        unknowns, begin = list(self.answer.unknowns), list(starts(self.answer))
        for d, size in used:
            if isinstance(d, Unknown) and isinstance(d.place, tuple):
                begin[d.place[0]] += size * d.scale
            elif isinstance(d, Unknown):
                unknowns[d.place] += size * d.scale
        bounds = [(q.low * q.si * (1 - 1e-9), q.high * q.si * (1 + 1e-9)) for q in self.model.unknowns]
        if any(not low <= v <= high for (low, high), v in zip(bounds, unknowns)):
            return None
        names = [u.name for u in self.model.unknowns]
        last = unknowns[names.index('T')] if 'T' in names else self.last
        breaks = sorted({*self.base, *(t for d, size in used for t in d.times(size) if 0 < t < 1)})
        changes = [(d, size) for d, size in used if not isinstance(d, Unknown)]
        controls = self.controls(changes, last)
        try:
            run = kind(self.model, unknowns, controls, [s * last for s in breaks], begin, sizes=self.sizes)
        except Delicate:
            return None
        objective, gaps, senses, _ = outcome(self.model, unknowns, run.x[:-1], run.x[-1])
        scaled = np.array(gaps) / condition_sizes(self.model, self.sizes)
        equal = np.array([g for g, sense in zip(scaled, senses) if sense == '=='])
        most = max([violation(g, sense) for g, sense in zip(scaled, senses) if sense != '=='] +
                   [beyond(self.model, run, self.sizes)])
        return objective, equal, most

    def controls(self, changes, last):
        """The changed controls over time; needles come last, and bounds hold."""
        changes = sorted(changes, key=lambda pair: isinstance(pair[0], Needle))
        answer, ranges, grid = self.answer, self.ranges, list(self.answer.time)

        def controls(t):
            s = min(max(t / last, 0.0), 1.0)
            k = min(max(bisect.bisect_right(grid, s * self.last) - 1, 0), len(grid) - 2)
            u = answer.controls(s * self.last, k)
            for d, size in changes:
                d.change(s, u, ranges, size)
            return [min(max(v, low), high) for v, (low, high) in zip(u, ranges)]
        return controls
