"""The second check: whether controls near those of an answer, which meet all conditions, do better on the true system.

Derivatives are differences of simulations. A step is believed only if it was simulated, meets the conditions, and has a
lower objective.
"""

import numpy as np
from scipy.optimize import linprog

from perturb import Needle, Neighbourhood
from replayed import size_of_cost
from simulate import Simulation

SMALL = 1e-3  # of a range, or of the time
GAIN = 1e-6  # of the objective: less is not told
MET = 1e-8  # a condition, relative


class Descent:
    """Gradients by differences, and the best step that was found."""

    def __init__(self, answer, rng):
        self.near = Neighbourhood(answer, rng)
        self.rng = np.random.default_rng(rng.randrange(2**31))
        n = len(self.near.directions)
        self.start = self.near.measured(np.zeros(n))
        if self.start is None:
            raise ArithmeticError('the answer cannot be simulated')
        self.allowed = max(MET, 10 * self.start[2])
        self.size = max(abs(self.start[0]), abs(answer.objective), size_of_cost(answer))
        self.slopes()
        self.effort = np.abs(self.gradient) + 1e-2 * np.abs(self.gradient).max(initial=1e-300)
        self.price = np.zeros(len(self.jacobian))  # what the objective costs for each equation
        self.best = (0.0, None)

    def slopes(self):
        """Of objective and equations, for each direction; those without a motion, or past a bound, are left out."""
        rows, usable = [], []
        for k in range(len(self.near.directions)):
            step = np.zeros(len(self.near.directions))
            step[k] = SMALL
            found = self.near.measured(step)
            if found is not None and np.all(np.isfinite(found[1])):
                usable.append(k)
                rows.append(np.append((found[0] - self.start[0]) / self.size, found[1] - self.start[1]) / SMALL)
        self.usable, rows = np.array(usable), np.array(rows)
        self.gradient, self.jacobian = rows[:, 0], rows[:, 1:].T
        moving = np.abs(rows).max(axis=1) > 1e-9
        self.usable, self.gradient = self.usable[moving], self.gradient[moving]
        self.jacobian = self.jacobian[:, moving]
        # What a rest at the end keeps at 0 depends on nothing but rounding.
        self.jacobian[np.abs(self.jacobian) < 1e-7] = 0.0
        self.free = np.abs(self.jacobian).max(axis=1, initial=0.0) > 1e-5
        self.jacobian = self.jacobian[self.free]
        self.sides = [self.side(row, self.paired()) for row in self.jacobian]

    def paired(self):
        """The columns of directions that have an opposite, side by side."""
        kinds = [self.near.directions[k] for k in self.usable]
        return [i for i in range(len(kinds) - 1) if not isinstance(kinds[i], Needle) and self.usable[i] % 2 == 0 and
                self.usable[i + 1] == self.usable[i] + 1]

    def side(self, row, pairs):
        """1 or -1 where an equation is left to one side only, as by a mass that rests before the end: it is made linear."""
        stuck = [i for i in pairs if min(abs(row[i]), abs(row[i + 1])) < 1e-3 * max(abs(row[i]), abs(row[i + 1]))]
        if not pairs or 2 * len(stuck) < len(pairs):
            return 0
        for i in stuck:
            large, small = (i, i + 1) if abs(row[i]) > abs(row[i + 1]) else (i + 1, i)
            seen, row[small] = np.sign(row[large]), -row[large]
        return int(seen)

    def steps(self):
        """Down the steepest slope with the equations kept, by linear programs: of few directions; and at random."""
        n = len(self.usable)
        for size in (1e-4, 1e-3, 5e-3, 2e-2):
            found = self.program(self.gradient, np.zeros(len(self.jacobian)), size)
            if found is not None:
                self.price = self.shadow
                yield found.x
        for scale in (0.003, 0.03):
            for _ in range(2):
                step = np.zeros(n)
                step[self.rng.integers(0, n, 2)] = scale * self.rng.random(2)
                yield step

    def program(self, cost, right, size):
        """The cheapest directions with jacobian d = right and at most `size` in all; None if there are none."""
        sides = np.array(self.sides, int)
        both, one = sides == 0, sides != 0
        rows = np.vstack([np.ones((1, len(cost))), sides[one, None] * self.jacobian[one]])
        equal = (self.jacobian[both], right[both]) if both.any() else (None, None)
        found = linprog(cost, rows, [size, *(sides[one] * right[one])], *equal)
        if found.status != 0:
            return None
        self.shadow = np.zeros(len(sides))
        self.shadow[one] = np.abs(found.ineqlin.marginals[1:])
        if both.any():
            self.shadow[both] = np.abs(found.eqlin.marginals)
        return found

    def corrected(self, step):
        """The step with its equations met by Newton's method; what was measured there."""
        whole = np.zeros(len(self.near.directions))
        for _ in range(6):
            self.last = step
            whole[self.usable] = step
            found = self.near.measured(whole)
            if found is None or not np.all(np.isfinite(found[1])):
                return None
            if not len(found[1]) or np.abs(found[1]).max() < MET:
                return found
            change = self.program(self.effort, -found[1][self.free], 0.2)
            if change is None:
                return None
            step = step + change.x
        return found

    def search(self):
        """The largest relative gain of a step that meets the conditions; 0 if there is none."""
        if not len(self.usable):
            return 0.0
        for step in self.steps():
            found = self.corrected(step)
            if found is None or found[2] > self.allowed or np.abs(found[1]).max(initial=0.0) > 1e-6:
                continue
            gain = self.gain(self.start, found)
            if gain > self.best[0]:
                self.best = (gain, self.last)
        return self.best[0] if self.best[0] < GAIN else self.seen_exactly()

    def seen_exactly(self):
        """The gain of the best step, both sides simulated by SciPy; 0 if it does not meet the conditions there."""
        whole = np.zeros(len(self.near.directions))
        before = self.near.measured(whole, Simulation)
        whole[self.usable] = self.best[1]
        after = self.near.measured(whole, Simulation)
        if not before or not after or after[2] > self.allowed:
            return 0.0
        return self.gain(before, after)

    def gain(self, before, after):
        """The relative gain, less twice what the residuals of the equations may be worth."""
        residuals = (np.abs(after[1]) + np.abs(before[1]))[self.free]
        return (before[0] - after[0]) / self.size - 2 * float(self.price @ residuals)


def gain(answer, rng):
    """By how much a neighbour is better, and how many simulations were made."""
    descent = Descent(answer, rng)
    return descent.search(), descent.near.count
