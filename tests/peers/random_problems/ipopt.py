"""IPOPT on the discrete problem: from several starts, from a given answer, and in a small box about it."""

import casadi as ca
import numpy as np

OPTIONS = {
    'print_time': False, 'ipopt.print_level': 0, 'ipopt.sb': 'yes', 'ipopt.tol': 1e-10, 'ipopt.bound_relax_factor': 0,
    'ipopt.max_iter': 1500, 'ipopt.max_cpu_time': 10.0, 'error_on_fail': False,
}
NEAR = {
    'ipopt.mu_init': 1e-7, 'ipopt.bound_push': 1e-8, 'ipopt.bound_frac': 1e-8, 'ipopt.slack_bound_push': 1e-8,
    'ipopt.slack_bound_frac': 1e-8,
}
FEASIBLE = 1e-8


class Answer:
    """What IPOPT found: `solved` also demands that our own measure of the violation is small. The objective is that at
    the answer, without what its small violations buy."""

    def __init__(self, discrete, found, stats):
        self.z = np.array(found['x']).ravel()
        self.status, self.iterations = stats['return_status'], stats['iter_count']
        self.multipliers = np.array(found['lam_g']).ravel()
        finite = np.all(np.isfinite(self.z))
        self.violation = discrete.violation(self.z) if finite else np.inf
        self.objective = discrete.value(self.z)[0] + self.bought(discrete) if finite else np.nan
        self.feasible = self.violation <= FEASIBLE and np.isfinite(self.objective)
        self.solved = self.status in ('Solve_Succeeded', 'Solved_To_Acceptable_Level') and self.feasible

    def bought(self, discrete):
        """What the violations of the rows are worth, by the multipliers."""
        g = np.array(discrete.measures(self.z)[2]).ravel()
        return float(np.abs(self.multipliers) @ np.maximum(0, np.maximum(discrete.low - g, g - discrete.high)))


def run(discrete, start, lower=None, upper=None, near=False):
    """One solve from `start`."""
    if near not in discrete.solvers:
        options = {**OPTIONS, **(NEAR if near else {})}
        discrete.solvers[near] = ca.nlpsol('solver', 'ipopt', discrete.program, options)
    solver = discrete.solvers[near]
    lower, upper = discrete.lower if lower is None else lower, discrete.upper if upper is None else upper
    found = solver(x0=np.clip(start, lower, upper), lbx=lower, ubx=upper, lbg=discrete.low, ubg=discrete.high)
    return Answer(discrete, found, solver.stats())


def guess(discrete, middle=True):
    """fdcc's documented guess: states straight to an end value, controls at the middle of bounds, or near 0."""
    problem, n = discrete.problem, discrete.n
    goals = {c.expression.value: c.low for c in problem.ends if c.expression.kind == 'name' and c.low == c.high}
    fraction = np.linspace(0, 1, n + 1)
    states = []
    for s in problem.states:
        first = s.start if s.start is not None else nearest(0, s)
        states.append(first + fraction * (goals.get(f'{s.name}(end)', first) - first))
    controls = [[(c.low + c.high) / 2 if middle and np.isfinite(c.high - c.low) else nearest(0, c)] * n
                for c in problem.controls]
    return discrete.point(states, controls, [u.guess for u in problem.unknowns])


def nearest(value, item):
    return min(max(value, item.low), item.high)


def answers(discrete, rng, count):
    """From fdcc's guess, from controls near 0, and from random variations of size 1."""
    starts = [guess(discrete), guess(discrete, middle=False)]
    for _ in range(count):
        push = np.array([rng.gauss(0, 1) for _ in starts[0]])
        starts.append(starts[1] + push * np.maximum(0.3, 0.5 * np.abs(starts[1])))
    found = []
    for start in starts:
        if found and np.array_equal(start, starts[0]):
            continue
        found.append(run(discrete, start))
    return found


def box(discrete, z, share, rng):
    """The best feasible point within `share` of the size of each variable about `z`, from a small push."""
    ranges = np.minimum(1.0, discrete.upper - discrete.lower)
    radius = share * np.maximum(discrete.sizes(z), 0.1 * ranges)
    lower = np.clip(z - radius, discrete.lower, discrete.upper)
    upper = np.clip(z + radius, lower, discrete.upper)
    push = np.array([rng.gauss(0, 1) for _ in z]) * 0.1 * radius
    return run(discrete, z + push, lower, upper, near=True)
