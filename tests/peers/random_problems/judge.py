"""What each word of fdcc's verdict is worth, by measures that are not fdcc's."""

import math

import numpy as np

import ipopt
from closed_forms import equality_optimum
from curvature import gain_along_curvature
from discrete import Discrete
from replay import replay

VIOLATION, WORSE = 1e-6, 1e-6
NO_OPTIMUM = 1.15  # of the true optimum: more than what a grid and a layer cost
SOLVED = ('solved', 'acceptable')


class Judgement:
    """The words that are wrong, each with its reason, and the row of the table."""

    def __init__(self, problem, result, rng, headline):
        self.problem, self.result, self.rng, self.headline = problem, result, rng, headline
        self.wrong, self.notes = [], []
        self.status = result['status']
        self.discrete = Discrete(problem)
        self.references = ipopt.answers(self.discrete, rng, 0 if problem.convex else 2)
        self.z = self.read()
        self.known = self.best()
        self.judge()

    def read(self):
        """fdcc's answer as the variables of the discrete problem; None if it is not there."""
        problem, result = self.problem, self.result
        try:
            z = self.discrete.completed([result['states'][s.name] for s in problem.states],
                                        [result['controls'][c.name] for c in problem.controls],
                                        [result['free'][u.name] for u in problem.unknowns])
        except (KeyError, TypeError, ValueError):
            return None
        return z if z is not None and len(z) == self.discrete.z.numel() and np.all(np.isfinite(z)) else None

    def best(self):
        """The least objective that is known: closed form or IPOPT's."""
        if self.problem.truth == 'unbounded':
            return None
        found = [answer.objective for answer in self.references if answer.feasible]
        closed = [self.problem.optimum, equality_optimum(self.discrete)]
        return min(found + [value for value in closed if value is not None], default=None)

    def judge(self):
        truth = self.problem.truth
        if self.status in SOLVED:
            self.judge_solved()
        if self.status == 'infeasible' and (truth in ('feasible', 'unbounded') or self.reference_solved()):
            if 'from this guess' not in self.headline:
                why = 'a feasible trajectory is known, and the verdict is not limited to the guess'
                self.wrong.append(('infeasible', why))
        if self.status == 'unbounded' and truth != 'unbounded':
            self.wrong.append(('unbounded', f'the problem is {"infeasible" if truth == "infeasible" else "bounded"}'))
        if (self.result.get('verification') or {}).get('confirmed') and self.z is not None:
            self.judge_confirmed()

    def judge_solved(self):
        if self.problem.truth == 'unbounded':
            return self.wrong.append(('solved', 'the objective is unbounded below'))
        if self.z is None:
            return self.wrong.append(('solved', 'the answer is not finite, or not complete'))
        violation = self.discrete.violation(self.z)
        if violation > VIOLATION:
            return self.wrong.append(('solved', f'constraint violation {violation:.1e} of the size of its terms'))
        if self.problem.truth == 'infeasible':
            return self.wrong.append(('solved', 'the problem is infeasible by construction'))
        self.value, self.size = self.discrete.value(self.z)
        told = self.result['objective']
        if told is None or abs(told - self.value) > WORSE * self.size:
            self.wrong.append(('solved', f'the objective is told as {told}, and is {self.value:.9g} at the answer'))
        excess = (self.value - self.known) / self.size if self.known is not None else -math.inf
        if self.result.get('global') and excess > WORSE:
            self.wrong.append(('global', f'objective {self.value:.9g}; {self.known:.9g} is known'))
        elif self.problem.convex and excess > WORSE:
            self.wrong.append(('solved', f'objective {self.value:.9g}; the global optimum is {self.known:.9g}'))
        elif not self.problem.convex:
            self.judge_local(excess)

    def judge_local(self, excess):
        """A point that is worse than another may be a local minimum; then nothing nearby is better."""
        lowest, steps = self.descend(1 if excess <= WORSE else 40)
        if self.value - lowest > WORSE * self.size:
            down = f'objective {self.value:.9g}; {steps} small steps lead down to {lowest:.9g}'
            return self.wrong.append(('solved', down))
        gain = gain_along_curvature(self.discrete, self.z) if self.problem.sigma is None else 0.0
        if gain > WORSE * self.size:
            curved = f'negative curvature: a step of 1 % gains {gain:.1e} of {self.size:.1e}'
            return self.wrong.append(('solved', curved))
        if excess > WORSE:
            self.notes.append(f'a local minimum {self.value:.9g}, the best known is {self.known:.9g}')

    def descend(self, limit):
        """Goes down in steps of at most 2 % from fdcc's answer."""
        z, lowest = self.z, self.value
        for step in range(limit):
            answer = ipopt.box(self.discrete, z, 0.02, self.rng)
            if not answer.feasible or lowest - answer.objective <= 1e-8 * self.size:
                return lowest, step
            z, lowest = answer.z, answer.objective
        return lowest, limit

    def judge_confirmed(self):
        """Against our own replay; twice of what was asked is allowed, since sizes can be measured in several ways."""
        problem, asked = self.problem, 2 * self.result['verification']['asked']
        states, controls, _, unknowns = self.discrete.split(self.z)
        duration = self.discrete.duration(unknowns)
        true = replay(problem, states[:, 0], controls, unknowns, duration)
        if true is None:
            return self.notes.append('confirmed; our own replay gave up')
        moves = np.maximum(np.ptp(true, axis=1), [1e-3 * s.move for s in problem.states])
        gaps = np.abs(states - true).max(axis=1) / moves
        if gaps.max() > asked:
            worst = problem.states[int(gaps.argmax())].name
            self.wrong.append(('confirmed', f'`{worst}` is off by {gaps.max():.1e} of its movement'))
        self.judge_conditions(self.discrete.point(true, controls, unknowns), asked)
        self.judge_optimality()

    def judge_optimality(self):
        """A confirmed trajectory that is far from the true optimum has to be told, in the field `optimality`."""
        contradicted = (self.result.get('optimality') or {}).get('contradicted', False)
        best, objective = self.problem.true_optimum, self.result['objective']
        if best is not None and objective > NO_OPTIMUM * best and not contradicted:
            why = f'objective {objective:.9g}, the true optimum is {best:.9g}, and nothing is said to contradict'
            self.wrong.append(('confirmed', why))

    def judge_conditions(self, z, asked):
        """All rows but the equations, and bounds, along the replay."""
        rows, sides = self.discrete.violations(z)
        worst = max(rows[self.discrete.equations:].max(initial=0.0), sides.max(initial=0.0))
        if worst > asked:
            self.wrong.append(('confirmed', f'a condition is violated by {worst:.1e} of the size of its terms'))

    def reference_solved(self):
        return any(answer.solved for answer in self.references)

    def failed(self):
        """An honest failure where IPOPT succeeds, from the same guess or from controls near 0."""
        bounded = self.problem.truth not in ('infeasible', 'unbounded')
        return bounded and self.status not in SOLVED and any(answer.solved for answer in self.references[:2])
