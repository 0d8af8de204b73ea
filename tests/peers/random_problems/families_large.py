"""Families with many states, long horizons, or numbers far from 1."""

from draw import names, number, power, scheme, trajectory
from expressions import Expression, call, lift, name, quantity, total
from problem import Condition, Control, Problem, State, at_end


def reached(problem, rng, most=4):
    """Demands of some states the end of a trajectory under some other controls."""
    found = trajectory(problem, rng)
    if found is not None:
        for i in sorted(rng.sample(range(len(problem.states)), min(most, len(problem.states)))):
            value = float(found[0][i, -1])
            problem.ends.append(Condition(name(problem.states[i].name), value, value))
    return problem


def chain(rng):
    """Masses on springs and dampers, at rest, pulled at one end by a bounded force; ends that are reachable, or not.

    Its energy is at most the work of the force, F s after the path s, so v^2 <= 2 F s, and s is at most F t^2 / 2.
    """
    n, u = rng.randint(3, 25), name('F')
    p, v = names('p', n), names('v', n)
    k, d, force, span = number(rng, 0.5, 20), number(rng, 0.05, 1), number(rng, 0.5, 3), number(rng, 1, 5)
    states = [State(f'p{i + 1}', v[i]) for i in range(n)]
    for i in range(n):
        left = p[i - 1] - p[i] if i else -1 * p[i]
        slow = v[i - 1] - v[i] if i else -1 * v[i]
        right, fast = (p[i + 1] - p[i], v[i + 1] - v[i]) if i + 1 < n else (lift(0), lift(0))
        states.append(State(f'v{i + 1}', k * (left + right) + d * (slow + fast) + (u if i == n - 1 else 0)))
    problem = Problem('chain', states, [Control('F', -force, force)], u**2, None, span,
                      N=rng.choice([20, 40]), scheme=rng.choice(['implicit_euler', 'midpoint']), convex=True)
    if rng.random() < 0.4:
        return reached(problem, rng)
    farthest = force * span * (span + span / problem.N)
    goal = float(f'{farthest * number(rng, 0.6, 3):.4g}')
    problem.ends = [Condition(p[-1], goal, goal)]
    if rng.random() < 0.5:
        problem.ends.append(Condition(v[-1], 0.0, 0.0))
    problem.truth = 'infeasible'
    return problem


def friction_chain(rng):
    """Masses on springs, each with dry friction of its own on the ground; the last is pulled."""
    n, u = rng.randint(2, 9), name('F')
    p, v = names('p', n), names('v', n)
    k, mu, force = number(rng, 1, 10), number(rng, 0.05, 0.5), number(rng, 3, 6)
    states = [State(f'p{i + 1}', v[i]) for i in range(n)]
    for i in range(n):
        springs = (p[i - 1] - p[i] if i else lift(0)) + (p[i + 1] - p[i] if i + 1 < n else 0)
        states.append(State(f'v{i + 1}', k * springs + (u if i + 1 == n else 0) - mu * Expression('Sgn', v[i])))
    goal = number(rng, 0.2, 1)
    end = 10 * (at_end(f'p{n}') - goal)**2
    return Problem('friction_chain', states, [Control('F', -force, force)], 0.1 * u**2, end, number(rng, 1, 3),
                   N=rng.choice([50, 100]), sigma=lift(number(rng, 0.01, 0.2)),
                   scheme=rng.choice(['implicit_euler', 'midpoint', 'radau2']))


def hard_reach(rng):
    """A long horizon and a system that is hard to follow, with ends that a trajectory under random controls meets."""
    x, u = names('x', 4), name('u')
    rates = rng.choice([
        [x[1], u - 3 * call('sin', x[0]) + call('sin', x[2] - x[0]),
         x[3], 2 * call('sin', x[0] - x[2]) - call('sin', x[2])],
        [x[1], (1 - x[0]**2) * x[1] - x[0] + u, x[3], (1 - x[2]**2) * x[3] - x[2] + 0.3 * x[0]],
        [x[1], x[0] - x[0]**3 - 0.1 * x[1] + u, x[3], x[2] - x[2]**3 - 0.1 * x[3] + 0.5 * x[0]],
    ])
    states = [State(f'x{i + 1}', rate, number(rng, -1, 1)) for i, rate in enumerate(rates)]
    problem = Problem('hard_reach', states, [Control('u', -4.0, 4.0)], u**2, None, number(rng, 3, 8),
                      N=rng.choice([40, 80]), scheme=scheme(rng, implicit=True))
    return reached(problem, rng)


def tank(rng):
    """Pressures about 100 bar that move a little: in Pa numbers are far from 1, and so is what counts as small."""
    p, q, u, bar = name('p'), name('q'), name('u'), ('bar', 1e5)
    base, rate, swing = number(rng, 50, 200), number(rng, 0.5, 3), number(rng, 0.5, 20)
    reach = number(rng, 0.1, 0.5) * swing * rng.choice([-1, 1])
    per_second = quantity(rate, '1/s', 1.0)
    states = [State('p', per_second * (u - p), base * 1e5, unit=bar, move=swing * 1e5),
              State('q', per_second * (p - q), base * 1e5, unit=bar, move=swing * 1e5)]
    span, goal = number(rng, 2, 5), (base + reach) * 1e5
    cost = ((u - quantity(base * 1e5, *bar)) / quantity(1e5, *bar))**2
    control = Control('u', (base - 3 * swing) * 1e5, (base + 3 * swing) * 1e5, bar)
    return Problem('tank', states, [control], cost, None, span,
                   time_unit=('s', 1.0), ends=[Condition(q, goal, goal, bar)], N=rng.choice([20, 50]), convex=True,
                   scheme=scheme(rng, implicit=True))


def heat(rng):
    """A rod heated at one end, with radiation."""
    n, u = rng.choice([5, 10, 20, 30]), name('u')
    x = names('x', n)
    k, goal = number(rng, 0.02, 0.1) * (n + 1)**2, number(rng, 0.2, 0.8)
    loss = rng.choice([0.0, number(rng, 0.05, 0.5)])
    states = []
    for i in range(n):
        left, right = x[i - 1] if i else u, x[i + 1] if i + 1 < n else 0
        rate = k * (left - 2 * x[i] + right)
        states.append(State(f'x{i + 1}', rate - loss * x[i]**3 if loss else rate))
    end = 2 * total((at_end(s.name) - goal)**2 for s in states)
    return Problem('heat', states, [Control('u', 0.0, 3.0)], power(rng, -4, -1) * u**2, end, 1.0,
                   N=rng.choice([20, 50]), convex=not loss,
                   scheme=rng.choice(['implicit_euler', 'midpoint', 'trapezoid']))
