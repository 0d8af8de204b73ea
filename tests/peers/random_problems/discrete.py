"""The discrete problem of docs/method/transcription.md in CasADi, and measures at any point."""

import casadi as ca
import numpy as np

from problem import INF
from steps import Advance, collocation, function, step


class Discrete:
    """Variables: states at all grid points, controls of all intervals, inner states of collocation, unknowns."""

    def __init__(self, problem):
        self.problem, self.n = problem, problem.N
        tableau = collocation(problem.scheme)
        self.stages = len(tableau[1]) if tableau else 0
        self.counts = len(problem.states), len(problem.controls), len(problem.unknowns)
        nx, nu, np_ = self.counts
        self.x, self.u = ca.MX.sym('x', nx, self.n + 1), ca.MX.sym('u', nu, self.n)
        self.inner, self.p = ca.MX.sym('y', nx * self.stages, self.n), ca.MX.sym('p', np_)
        self.rows, self.row_sizes, self.low, self.high, self.equations = [], [], [], [], 0
        self.transcribe()
        self.build()

    def duration(self, unknowns):
        """The last time."""
        if isinstance(self.problem.span, str):
            return unknowns[[u.name for u in self.problem.unknowns].index(self.problem.span)]
        return self.problem.span

    def transcribe(self):
        problem, n, (nx, nu, _) = self.problem, self.n, self.counts
        h = ca.MX(self.duration(self.p)) / n
        old, new, times, unknowns = self.x[:, :-1], self.x[:, 1:], ca.DM(range(n)).T * h, ca.repmat(self.p, 1, n)
        parts = step(problem).map(n)(times, ca.repmat(h, 1, n), old, new, self.inner, self.u, unknowns)
        for i, state in enumerate(problem.states):
            self.equation(new[i, :], old[i, :], parts[0][i, :], parts[2][i, :], state)
            for j in range(self.stages):
                k = j * nx + i
                self.equation(self.inner[k, :], old[i, :], parts[1][k, :], parts[3][k, :], state)
        sums, sizes = ca.sum2(parts[0][nx:, :]), ca.sum2(ca.fabs(parts[2][nx:, :]))
        for i, c in enumerate(problem.integrals):
            self.add(sums[1 + i], c.low, c.high, sizes[1 + i])
        self.conditions(times + h, unknowns)
        value, size = function(problem, [problem.mayer])(0, self.x[:, n], ca.MX.zeros(nu), self.p)
        self.objective, self.objective_size = sums[0] + value, sizes[0] + size

    def equation(self, new, old, increment, size, state):
        """new = old + increment on all intervals."""
        largest = ca.mmax(ca.fabs(new) + ca.fabs(old) + ca.fabs(size))
        self.add(new - old - increment, 0, 0, largest, state.move)
        self.equations += self.n

    def conditions(self, times, unknowns):
        """Path conditions at grid points and nodes (they have no time in them), and end conditions.

        The size of an end condition is that of its terms along the whole trajectory, since `v == 0` has no other.
        """
        problem, (nx, nu, _) = self.problem, self.counts
        largest = ca.vertcat(*(ca.mmax(ca.fabs(self.x[i, :])) for i in range(nx)))
        inner = [self.inner[j * nx:(j + 1) * nx, :] for j in range(self.stages)]
        for c in problem.paths:
            f = function(problem, [c.expression]).map(self.n)
            for states in [self.x[:, 1:]] + (inner[:-1] if problem.scheme.startswith('radau') else inner):
                values, sizes = f(times, states, self.u, unknowns)
                self.add(values, c.low, c.high, ca.mmax(ca.fabs(sizes)))
        for c in problem.ends:
            f, none = function(problem, [c.expression]), ca.MX.zeros(nu)
            value, size = f(0, self.x[:, -1], none, self.p)[0], f(0, largest, none, self.p)[1]
            self.add(value, c.low, c.high, ca.fabs(size))

    def add(self, values, low, high, size, floor=0.0):
        """Rows of one kind; their common size is that of the largest."""
        count = values.numel()
        bound = max([abs(side) for side in (low, high) if abs(side) < INF], default=0.0)
        self.rows.append(ca.vec(values))
        self.row_sizes.append(ca.repmat(ca.fmax(size, max(bound, 1e-3 * floor, 1e-300)), count, 1))
        self.low += [low] * count
        self.high += [high] * count

    def build(self):
        """The program, bounds of variables, measures at a point."""
        self.z, g = ca.veccat(self.x, self.u, self.inner, self.p), ca.vertcat(*self.rows)
        self.measures = ca.Function(
            'm', [self.z], [self.objective, self.objective_size, g, ca.vertcat(*self.row_sizes)]).expand()
        program = ca.Function('nlp', [self.z], [self.objective, g]).expand()
        z = ca.SX.sym('z', self.z.numel())
        objective, g = program(z)
        self.program = {'x': z, 'f': objective, 'g': g}
        self.low, self.high = np.array(self.low), np.array(self.high)
        self.lower, self.upper = (self.bounds_of(side) for side in ('low', 'high'))
        self.solvers = {}

    def bounds_of(self, side):
        problem, n = self.problem, self.n
        inside = [getattr(s, side) for s in problem.states]
        first = [getattr(s, side) if s.start is None else s.start for s in problem.states]
        controls = [getattr(c, side) for c in problem.controls]
        unknowns = [getattr(u, side) for u in problem.unknowns]
        return np.array(first + inside * n + controls * n + inside * self.stages * n + unknowns)

    def point(self, states, controls, unknowns, inner=None):
        """The variables from arrays states x (N + 1), controls x N, unknowns; inner states are old ones if left out."""
        states = np.asarray(states, float)
        inner = np.tile(states[:, :-1], (self.stages, 1)) if inner is None else inner
        parts = [states.T.ravel(), np.asarray(controls).T.ravel(), np.asarray(inner).T.ravel(), np.asarray(unknowns)]
        return np.concatenate(parts).astype(float)

    def split(self, z):
        """States x (N + 1), controls x N, inner states x N, unknowns."""
        (nx, nu, _), n = self.counts, self.n
        places = np.cumsum([nx * (n + 1), nu * n, nx * self.stages * n])
        states, controls, inner, unknowns = np.split(z, places)
        return states.reshape(n + 1, nx).T, controls.reshape(n, nu).T, inner.reshape(n, -1).T, unknowns

    def completed(self, states, controls, unknowns):
        """As `point`, with the inner states that the equations of each step give; None where these have no root."""
        if not self.stages:
            return self.point(states, controls, unknowns)
        advance, h = Advance(self.problem), self.duration(unknowns) / self.n
        states, controls = np.asarray(states, float), np.asarray(controls, float)
        found = [advance(k * h, h, states[:, k], controls[:, k], unknowns, states[:, k + 1]) for k in range(self.n)]
        if None in found:
            return None
        return self.point(states, controls, unknowns, np.array([inner for _, inner in found]).T)

    def sizes(self, z):
        """A size for each variable: that of its kind along the trajectory."""
        states, controls, _, unknowns = self.split(np.abs(z))
        states, controls = states.max(axis=1), controls.max(axis=1)
        inner = np.tile(states, self.stages * self.n)
        kinds = np.concatenate([np.tile(states, self.n + 1), np.tile(controls, self.n), inner, unknowns])
        return np.maximum(kinds, 1e-6 * max(1e-12, kinds.max()))

    def violations(self, z):
        """Of all rows relative to the size of their terms, and of all bounds relative to that of their variable."""
        _, _, g, sizes = (np.array(part).ravel() for part in self.measures(z))
        rows = np.maximum(0, np.maximum(self.low - g, g - self.high)) / sizes
        sides = np.maximum(0, np.maximum(self.lower - z, z - self.upper)) / self.sizes(z)
        return rows, sides

    def violation(self, z):
        """The largest of them."""
        return max(part.max(initial=0.0) for part in self.violations(z))

    def value(self, z):
        """The objective and the size of its terms."""
        objective, size = (float(part) for part in self.measures(z)[:2])
        return objective, max(abs(objective), abs(size), self.problem.objective_floor)
