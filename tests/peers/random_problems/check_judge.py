#!/usr/bin/env python3
"""Whether the judge sees what is false: true answers of IPOPT, made false in every way that it looks for."""

import random
import sys

import numpy as np

sys.dont_write_bytecode = True

import ipopt  # noqa: E402
from discrete import Discrete  # noqa: E402
from draw import trajectory  # noqa: E402
from expressions import Expression, call, lift, name  # noqa: E402
from judge import Judgement  # noqa: E402
from problem import Condition, Control, Problem, State  # noqa: E402

x, u = name('x'), name('u')


def result(problem, z, status='solved', confirmed=False, proved=False):
    """What fdcc would print about a point."""
    discrete = Discrete(problem)
    states, controls, _, unknowns = discrete.split(z)
    return {'status': status, 'objective': discrete.value(z)[0], 'global': proved,
            'states': {s.name: list(row) for s, row in zip(problem.states, states)},
            'controls': {c.name: list(row) for c, row in zip(problem.controls, controls)},
            'free': {p.name: value for p, value in zip(problem.unknowns, unknowns)},
            'verification': {'confirmed': confirmed, 'asked': 1e-3}}


def pull(scheme='trapezoid', N=20, **more):
    """x' = u - sin x to 0.5, with little effort."""
    return Problem('pull', [State('x', u - call('sin', x), 1.0)], [Control('u', -3.0, 3.0)], u**2, None, 2.0,
                   ends=[Condition(x, 0.5, 0.5)], N=N, scheme=scheme, **more)


def best(problem):
    return ipopt.answers(Discrete(problem), random.Random(0), 0)[0].z


def along(problem, control):
    """The trajectory under one constant control."""
    problem.controls[0].low = problem.controls[0].high = control
    states, controls = trajectory(problem, random.Random(0))
    problem.controls[0].low, problem.controls[0].high = -3.0, 3.0
    return Discrete(problem).point(states, controls, [])


def well(a=1.0):
    return Problem('well', [State('x', u)], [Control('u', -2.0, 2.0)], (u**2 - a)**2 + 0.2 * u, None, N=5)


def conjugate():
    return Problem('conjugate', [State('x', u)], [Control('u', -1.0, 1.2)], u**2 - 4 * x**2, None, N=20)


def cases():
    """(what is said, the problem, the answer, the word that is wrong or None)."""
    honest = pull()
    z = best(honest)
    yield 'the truth', honest, result(honest, z, confirmed=True), None
    shifted = z.copy()
    shifted[5] += 1e-3
    yield 'an equation is violated', honest, result(honest, shifted), 'solved'
    yield 'a false objective', honest, {**result(honest, z), 'objective': 1.0}, 'solved'
    loose = pull()
    loose.ends = []
    yield 'not the optimum', loose, result(loose, along(loose, 0.3)), 'solved'
    yield 'a saddle', conjugate(), result(conjugate(), np.zeros(41)), 'solved'
    for truth in ('infeasible', 'unbounded'):
        yield f'solved, but {truth}', pull(truth=truth), result(honest, z), 'solved'
    yield 'infeasible, but feasible', honest, result(honest, z, 'infeasible'), 'infeasible'
    yield 'unbounded, but bounded', honest, result(honest, z, 'unbounded'), 'unbounded'
    high = best_near(well(), 1.0)
    yield 'a local minimum', well(), result(well(), high), None
    yield 'a local minimum, called global', well(), result(well(), high, proved=True), 'global'
    coarse = pull('implicit_euler', 5)
    yield 'a coarse grid, confirmed', coarse, result(coarse, best(coarse), confirmed=True), 'confirmed'
    yield 'a creeping block, confirmed', *creeping()


def best_near(problem, control):
    discrete = Discrete(problem)
    n = problem.N
    return ipopt.run(discrete, discrete.point([np.linspace(0, control, n + 1)], [[control] * n], [])).z


def creeping():
    """u = 0.5 against friction 1: the true block stays where it is, the smoothed one creeps."""
    v = name('v')
    states = [State('x', v, 0.0), State('v', u - 1.0 * Expression('Sgn', v), 0.0)]
    problem = Problem('creeping', states, [Control('u', 0.5, 0.6)], u**2, None, N=100, sigma=lift(0.1))
    return problem, result(problem, best(problem), confirmed=True), 'confirmed'


def main():
    blind = 0
    for said, problem, answer, word in cases():
        words = {found for found, _ in Judgement(problem, answer, random.Random(1), 'infeasible').wrong}
        right = words == ({word} if word else set())
        blind += not right
        print(f'{"ok" if right else "FAILED"}  {said}: {", ".join(sorted(words)) or "nothing wrong"}')
    return 1 if blind else 0


if __name__ == '__main__':
    sys.exit(main())
