"""The right side of a model in given modes: selectors of held surfaces keep psi' at 0.

Modes: -1, 0, 1 of a surface; of a direction 0 (held) or 1 (moving). Rates of surfaces are exact, by a complex step.
"""

from itertools import product

import numpy as np

STEP = 1e-30
STICKS = 5e-8  # a hold may begin where its selector is larger than 1 by less


class System:
    """A model with its unknowns; states are in SI, the running cost is one more state."""

    def __init__(self, model, unknowns):
        self.model, self.p = model, unknowns
        self.rate = model.function([model.rates[s.name] for s in model.states] + [model.running])
        self.scalars = [name[2:] for name in model.selectors() if name.startswith('s_')]
        self.vectors = list(model.directions)
        self.near = [1e-300] * len(self.vectors)  # a direction is 0 below this, and points where it sets out
        parts = [part for pair in model.directions.values() for part in pair]
        self.formulas = model.function([model.surfaces[name] for name in self.scalars] + parts)
        self.count = len(self.scalars)
        self.none = [0.0] * (self.count + len(parts))

    def psi(self, t, x):
        values = self.formulas(t, x[:len(self.model.states)], self.nothing, self.p, self.none)
        return [complex(v).real for v in values]

    @property
    def nothing(self):
        return [0.0] * len(self.model.controls)

    def turn(self, t, x, f):
        """psi' along f."""
        moved = [a + STEP * 1j * b for a, b in zip(x, f)]
        moved = moved[:len(self.model.states)]
        values = self.formulas(t + STEP * 1j, moved, self.nothing, self.p, self.none)
        return [complex(v).imag / STEP for v in values]

    def raw(self, t, x, u, s):
        return [complex(v).real for v in self.rate(t, x[:len(self.model.states)], u, self.p, s)]

    def places(self, modes):
        """The selectors that are unknown."""
        held = [i for i in range(self.count) if modes[i] == 0]
        for j in range(len(self.vectors)):
            held += [self.count + 2 * j, self.count + 2 * j + 1] if modes[self.count + j] == 0 else []
        return held

    def selectors(self, t, x, u, modes, way=None):
        """All selectors; `way` is where a direction points that is at 0."""
        s = [float(m) for m in modes[:self.count]]
        psi = self.psi(t, x) if self.vectors else []
        for j in range(len(self.vectors)):
            a, b = psi[self.count + 2 * j:self.count + 2 * j + 2]
            size = np.hypot(a, b)
            unit = (a / size, b / size) if size > self.near[j] else way[j] if way else (0.0, 0.0)
            s += [0.0, 0.0] if modes[self.count + j] == 0 else list(unit)
        held = self.places(modes)
        if held:
            self.solve(t, x, u, s, held)
        return s

    def solve(self, t, x, u, s, held):
        """psi' = 0, affine in each selector: Newton's method."""
        for _ in range(1 if len(held) == 1 else 4):
            base = self.turn(t, x, self.raw(t, x, u, s))
            columns = []
            for i in held:
                s[i] += 1.0
                moved = self.turn(t, x, self.raw(t, x, u, s))
                s[i] -= 1.0
                columns.append([moved[k] - base[k] for k in held])
            right = [base[k] for k in held]
            if len(held) == 1:
                s[held[0]] -= right[0] / columns[0][0] if columns[0][0] else float('inf')
                return
            change = np.linalg.lstsq(np.array(columns).T, -np.array(right), rcond=1e-12)[0]
            for i, d in zip(held, change):
                s[i] += d

    def strain(self, s, modes):
        """The largest size of a selector that holds."""
        sizes = [abs(s[i]) for i in range(self.count) if modes[i] == 0]
        sizes += [np.hypot(*s[self.count + 2 * j:self.count + 2 * j + 2]) for j in range(len(self.vectors))
                  if modes[self.count + j] == 0]
        return max(sizes, default=0.0)

    def consistent(self, t, x, u, modes, here, way=None, slack=1e-6):
        """Whether a motion with these modes can begin, where the surfaces `here` are 0."""
        s = self.selectors(t, x, u, modes, way)
        if not np.all(np.isfinite(s)) or self.strain(s, modes) > 1 + STICKS:
            return False
        turn = self.turn(t, x, self.raw(t, x, u, s))
        size = max(map(abs, turn), default=0.0) + 1e-9
        return all(modes[i] * turn[i] > -slack * size for i in here if i < self.count and modes[i] != 0) and \
            self.directions_move(t, x, u, modes, here, s, turn)

    def directions_move(self, t, x, u, modes, here, s, turn):
        """A direction that is 0 moves where its vector is not balanced."""
        for i in here:
            if i >= self.count and modes[i] == 1:
                at = self.count + 2 * (i - self.count)
                if turn[at] * s[at] + turn[at + 1] * s[at + 1] < 0:
                    return False
        return True

    def choices(self, t, x, u, modes, here, way=None):
        """All consistent modes."""
        ranges = [((0, 1, -1) if i < self.count else (0, 1)) if i in here else (m,) for i, m in enumerate(modes)]
        return [c for c in product(*ranges) if self.consistent(t, x, u, c, here, way)]

    def ways(self, t, x, u, modes):
        """Where each direction would set out: along the selector that it would need at rest."""
        rest = tuple(modes[:self.count]) + (0,) * len(self.vectors)
        s = self.selectors(t, x, u, rest)
        pairs = [s[self.count + 2 * j:self.count + 2 * j + 2] for j in range(len(self.vectors))]
        return [tuple(np.array(v) / max(np.hypot(*v), 1e-300)) for v in pairs]
