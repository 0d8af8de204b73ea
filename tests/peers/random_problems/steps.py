"""One step of each scheme in CasADi, with the sizes of its terms."""

import casadi as ca
import numpy as np

# weights, places of the nodes in a step, blends between its old and its new state
NODES = {
    'euler': [(1, 0, 0)], 'implicit_euler': [(1, 1, 1)], 'midpoint': [(1, 0.5, 0.5)],
    'trapezoid': [(0.5, 0, 0), (0.5, 1, 1)],
}


def collocation(scheme):
    """Butcher's matrix, weights and places of `radau3` and the like; None for schemes without inner variables."""
    if scheme in NODES or scheme == 'rk4':
        return None
    places = ca.collocation_points(int(scheme[-1]), {'radau': 'radau', 'gauss': 'legendre'}[scheme[:-1]])
    derivatives, _, weights = ca.collocation_coeff(places)
    # sum_j X_j l_j'(c_i) = h f_i with X_0 = x; its inverse is Butcher's matrix.
    matrix = np.linalg.inv(np.array(derivatives)[1:, :].T)
    return matrix, np.array(weights).ravel(), np.array(places)


def cubic(sigma):
    """`Sgn` smoothed by the integral of the kernel 3/4 (1 - r^2)."""
    def sgn(z):
        r = ca.fmax(-1, ca.fmin(1, z / sigma))
        return (3 * r - r**3) / 2
    return sgn


def symbols(problem):
    """Names of everything, and the columns t, x, u, p; `x(end)` and `x` are the same, for conditions at the end."""
    t, x = ca.SX.sym('t'), ca.SX.sym('x', len(problem.states))
    u, p = ca.SX.sym('u', len(problem.controls)), ca.SX.sym('p', len(problem.unknowns))
    names = {item.name: p[i] for i, item in enumerate(problem.unknowns)}
    names.update({s.name: x[i] for i, s in enumerate(problem.states)})
    names.update({f'{s.name}(end)': x[i] for i, s in enumerate(problem.states)})
    names.update({c.name: u[i] for i, c in enumerate(problem.controls)}, t=t)
    if problem.sigma is not None:
        names['Sgn'] = cubic(problem.sigma.value)
    return names, (t, x, u, p)


def function(problem, expressions):
    """(t, x, u, p) -> values and sizes of their terms."""
    names, inputs = symbols(problem)
    values = ca.vertcat(*(ca.SX(e.evaluate(names)) for e in expressions))
    sizes = ca.vertcat(*(ca.SX(e.size(names)) for e in expressions))
    return ca.Function('f', inputs, [values, sizes])


def step(problem):
    """(t, h, x, y, inner, u, p) -> increments of states and integrals, of inner states, and the sizes of both."""
    rates, integrands = [s.rate for s in problem.states], [c.expression for c in problem.integrals]
    f = function(problem, rates + [problem.running] + integrands)
    nx, tableau = len(problem.states), collocation(problem.scheme)
    _, (t, x, u, p) = symbols(problem)
    h, y, inner = ca.SX.sym('h'), ca.SX.sym('y', nx), ca.SX.sym('inner', nx * len(tableau[1]) if tableau else 0)
    stage_increments = [ca.SX(0, 1), ca.SX(0, 1)]
    if tableau:
        matrix, weights, places = tableau
        stages = [f(t + c * h, inner[i * nx:(i + 1) * nx], u, p) for i, c in enumerate(places)]
        stage_increments = [ca.vertcat(*(sum(h * absolute(a, k) * stages[j][k][:nx] for j, a in enumerate(row))
                                         for row in matrix)) for k in (0, 1)]
        weighted = list(zip(weights, stages))
    elif problem.scheme == 'rk4':
        stages = [f(t, x, u, p)]
        for place in (0.5, 0.5, 1):
            stages.append(f(t + place * h, x + place * h * stages[-1][0][:nx], u, p))
        weighted = list(zip((1 / 6, 1 / 3, 1 / 3, 1 / 6), stages))
    else:
        weighted = [(w, f(t + c * h, (1 - b) * x + b * y, u, p)) for w, c, b in NODES[problem.scheme]]
    increments = [sum(h * w * stage[k] for w, stage in weighted) for k in (0, 1)]
    return ca.Function('step', [t, h, x, y, inner, u, p],
                       [increments[0], stage_increments[0], increments[1], stage_increments[1]])


def absolute(a, k):
    """The factor of a value (k = 0), or of a size."""
    return abs(a) if k else a


class Advance:
    """The new state, and the inner ones, from the old: Newton's method on the equations of a step."""

    def __init__(self, problem):
        self.problem, self.step, self.nx = problem, step(problem), len(problem.states)
        inner = self.step.size1_in(4)
        counts = np.cumsum([0, 1, 1, self.nx, len(problem.controls), len(problem.unknowns)])
        unknown, q = ca.SX.sym('y', self.nx + inner), ca.SX.sym('q', counts[-1])
        t, h, x, u, p = (q[a:b] for a, b in zip(counts, counts[1:]))
        y, stages = unknown[:self.nx], unknown[self.nx:]
        increment, stage_increments, _, _ = self.step(t, h, x, y, stages, u, p)
        self.olds = inner // self.nx
        self.places = collocation(problem.scheme)[2] if inner else []
        residual = y - x - increment[:self.nx]
        if inner:
            residual = ca.vertcat(residual, stages - ca.repmat(x, self.olds, 1) - stage_increments)
        self.equations = ca.Function('r', [unknown, q], [residual, ca.jacobian(residual, unknown)])

    def __call__(self, t, h, x, u, p, goal=None):
        """New state and inner states, or None. `goal` is about where the step leads, if that is known."""
        q, places = np.concatenate([[t, h], x, u, p]), [1.0, *self.places]
        found = np.concatenate([x + c * ((x if goal is None else goal) - x) for c in places])
        size = max(np.abs(found).max(), 1e-300)
        for _ in range(100):
            residual, jacobian = (part.full() for part in self.equations(found, q))
            if not (np.all(np.isfinite(residual)) and np.all(np.isfinite(jacobian))):
                return None
            change = np.linalg.lstsq(jacobian, -residual.ravel(), rcond=None)[0]
            share = self.shortened(found, change, q, np.abs(residual).max())
            found, size = found + share * change, max(size, np.abs(found).max())
            if np.abs(change).max() <= 1e-14 * size:
                break
        return (found[:self.nx], found[self.nx:]) if np.abs(change).max() <= 1e-10 * size else None

    def shortened(self, found, change, q, before):
        """Half of a step, and half of that, until the equations are met better: kinks of friction need it."""
        share = 1.0
        while share > 1e-3 and not np.abs(self.equations(found + share * change, q)[0].full()).max() <= before:
            share /= 2
        return share
