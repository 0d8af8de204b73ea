"""Families of well-behaved problems: linear-quadratic, polynomial, trigonometric, free time, bad units."""

from draw import linear, names, number, power, scheme, squares, trajectory
from expressions import call, lift, name, total
from problem import INF, Condition, Control, Problem, State, Unknown, at_end


def linear_quadratic(rng):
    """Convex: linear equations, a positive quadratic cost, perhaps bounds, perhaps ends that a trajectory meets."""
    n, m = rng.randint(1, 6), rng.randint(1, 3)
    x, u = names('x', n), names('u', m)
    bounded = rng.random() < 0.6
    states = [State(f'x{i + 1}', linear(rng, x, -1, 1, 0.6) + linear(rng, u, -2, 2, 0.7) + number(rng, -0.2, 0.2),
                    number(rng, -2, 2)) for i in range(n)]
    width = number(rng, 0.5, 3)
    controls = [Control(f'u{i + 1}', -width, width) if bounded else Control(f'u{i + 1}') for i in range(m)]
    goal = squares(rng, [at_end(s.name) for s in states], goals=True)
    unknowns = []
    if rng.random() < 0.2:
        unknowns = [Unknown('q', -2.0, 2.0, 0.0)]
        states[-1].rate, goal = states[-1].rate + name('q'), goal + (name('q') - 0.3)**2
    problem = Problem('linear_quadratic', states, controls, squares(rng, x) + squares(rng, u), goal,
                      number(rng, 0.5, 4), unknowns=unknowns, N=rng.choice([10, 20, 30, 50]), scheme=scheme(rng),
                      convex=True)
    if rng.random() < 0.2:
        states[0].start = None
        states[0].low, states[0].high = rng.choice([(-3.0, 3.0), (-1e3, 1e6)])
    return reach(problem, rng) if rng.random() < 0.5 else problem


def reach(problem, rng, share=0.5):
    """With end conditions, and perhaps path conditions, that a trajectory of the discrete problem meets."""
    found = trajectory(problem, rng)
    if found is None:
        return problem
    for i, s in enumerate(problem.states):
        if rng.random() < share:
            value = float(found[0][i, -1])
            low = value if rng.random() < 0.7 else value - 0.1 * abs(value)
            problem.ends.append(Condition(name(s.name), low, value))
    if rng.random() < 0.4:
        fence(problem, found[0], rng)
    return problem


def fence(problem, states, rng):
    """A bound of a state, or a path condition on a linear form, a little outside of a trajectory."""
    if rng.random() < 0.5:
        state = rng.randrange(len(problem.states))
        low, high = around(states[state])
        problem.states[state].low, problem.states[state].high = low, high
    else:
        weights = [number(rng, -1, 1) for _ in problem.states]
        form = total(w * name(s.name) for w, s in zip(weights, problem.states))
        low, high = around(weights @ states)
        problem.paths.append(Condition(form, low if rng.random() < 0.5 else -INF, high))


def around(values):
    """An interval that holds all values, with a fifth of their range to spare."""
    low, high = float(values.min()), float(values.max())
    spare = 0.2 * (high - low) + 0.01
    return float(f'{low - spare:.4g}'), float(f'{high + spare:.4g}')


def monomials(rng, x):
    """One or two products of two or three variables."""
    return total(monomial(rng, x) for _ in range(rng.randint(1, 2)))


def monomial(rng, x):
    product = number(rng, -0.5, 0.5) * rng.choice(x) * rng.choice(x)
    return product * rng.choice(x) if rng.random() < 0.4 else product


def polynomial(rng):
    """Cubic damping keeps the states finite."""
    n = rng.randint(1, 4)
    x, u = names('x', n), names('u', rng.randint(1, 2))
    states = [State(f'x{i + 1}', linear(rng, x) + monomials(rng, x) + linear(rng, u, 0.5, 2) - 0.3 * x[i]**3,
                    number(rng, -1, 1)) for i in range(n)]
    if rng.random() < 0.3:
        states[0].rate = states[0].rate + number(rng, 0.2, 1) * call('sin', number(rng, 1, 4) * name('t'))
    width = number(rng, 0.5, 4)
    controls = [Control(v.value, -width, width) for v in u]
    problem = Problem('polynomial', states, controls, squares(rng, x) + squares(rng, u, 0.01, 1), None,
                      number(rng, 0.5, 3), N=rng.choice([10, 20, 40]), scheme=scheme(rng))
    return reach(problem, rng) if rng.random() < 0.6 else problem


def pendulums(rng, count):
    """Angles and rates of pendulums coupled by springs; the first is driven."""
    a, w, u = names('a', count), names('w', count), name('u')
    states = []
    for i in range(count):
        pull = -number(rng, 1, 9.81) * call('sin', a[i]) - number(rng, 0.01, 0.3) * w[i]
        if i > 0:
            pull = pull + number(rng, 0.5, 3) * call('sin', a[i - 1] - a[i])
        states += [State(f'a{i + 1}', w[i], number(rng, -1, 1)), State(f'w{i + 1}', pull + (u if i == 0 else 0))]
    return states, a + w


def trigonometric(rng):
    """Driven pendulums, or a car that turns."""
    width = number(rng, 2, 12)
    controls = [Control('u', -width, width)]
    if rng.random() < 0.6:
        states, x = pendulums(rng, rng.randint(1, 3))
        running = squares(rng, x) + number(rng, 0.01, 0.5) * name('u')**2
    else:
        x, v = names('x', 3), number(rng, 0.5, 2)
        states = [State('x1', v * call('cos', x[2])), State('x2', v * call('sin', x[2])),
                  State('x3', name('u'), number(rng, -1, 1))]
        running = number(rng, 0.1, 1) * name('u')**2 + 0.1 * (x[1] - call('sin', x[0]))**2
    problem = Problem('trigonometric', states, controls, running, None, number(rng, 0.5, 3),
                      N=rng.choice([20, 40]), scheme=scheme(rng, implicit=True))
    return reach(problem, rng) if rng.random() < 0.6 else problem


def free_time(rng):
    """As fast as possible, or with a price on effort; a trajectory proves that the ends can be met."""
    a, b, u, T = number(rng, 0, 1), number(rng, -0.5, 0.5), name('u'), name('T')
    x, v = names('x', 2)
    pull = rng.choice([-a * x, b * call('sin', x), -a * v, -0.1 * v**3, lift(0)])
    states = [State('x1', v, number(rng, -1, 1)), State('x2', u + pull, number(rng, -0.5, 0.5))]
    width, duration = number(rng, 0.8, 5), number(rng, 0.5, 4)
    wide = rng.choice([1, 1, 100])
    unknown = Unknown('T', duration / 20 / wide, duration * 10 * wide, duration * number(rng, 0.7, 2))
    effort = number(rng, 0.01, 1) * u**2 if rng.random() < 0.7 else None
    problem = Problem('free_time', states, [Control('u', -width, width)], effort, T, 'T', unknowns=[unknown],
                      N=rng.choice([20, 40]), scheme=scheme(rng, implicit=True))
    found = trajectory(problem, rng, duration=duration)
    problem.ends = [Condition(name(s.name), float(found[0][i, -1]), float(found[0][i, -1]))
                    for i, s in enumerate(states)]
    return problem


def bad_units(rng):
    """A damped mass or a Duffing spring in units in which numbers are far from 1: exact scaling of a good problem."""
    length, time, force = power(rng, -6, 6), power(rng, -4, 4), power(rng, -6, 6)
    x, v, u = name('x'), name('v'), name('u')
    k, d, hard = number(rng, -1, 2), number(rng, 0, 0.5), rng.choice([0, 0, number(rng, 0.1, 1)])
    speed, push = length / time, length / time**2 / force
    rate = push * u - k / time**2 * x - d / time * v
    rate = rate - hard / time**2 / length**2 * x**3 if hard else rate
    states = [State('x', v, number(rng, -1, 1) * length, move=length),
              State('v', rate, number(rng, -1, 1) * speed, move=speed)]
    width = number(rng, 1, 4) * force
    running = 1 / force**2 / time * u**2 + number(rng, 0.1, 2) / length**2 / time * x**2
    price = power(rng, -6, 6)
    problem = Problem('bad_units', states, [Control('u', -width, width)], price * running, None,
                      number(rng, 0.5, 3) * time, N=rng.choice([20, 40]), scheme=scheme(rng), convex=not hard,
                      objective_floor=1e-4 * price)
    goal = [number(rng, -0.3, 0.3) * length, number(rng, -0.3, 0.3) * speed]
    if problem.span >= 2 * time and rng.random() < 0.7:
        problem.ends = [Condition(x, goal[0], goal[0]), Condition(v, goal[1], goal[1])]
        problem.truth = 'unknown'
    return problem


def widened(rng):
    """A problem with a price on its controls, whose bounds are moved far away."""
    problem = rng.choice([linear_quadratic, polynomial, trigonometric, free_time])(rng)
    problem.family = 'widened'
    for c in problem.controls:
        low, high, sides = -power(rng, 4, 9), power(rng, 4, 9), rng.choice(['both', 'low', 'high'])
        c.low = low if sides != 'high' or c.low == -INF else c.low
        c.high = high if sides != 'low' or c.high == INF else c.high
    if isinstance(problem.span, str) and problem.running.text() == '0':
        problem.running = 0.1 * name('u')**2
    return problem
