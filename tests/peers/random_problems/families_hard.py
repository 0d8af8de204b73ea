"""Families that ask for a particular word: wide bounds, redundant conditions, infeasible, unbounded."""

from draw import linear, names, number, power, scheme, squares, trajectory
from expressions import call, lift, name
from problem import INF, Condition, Control, Problem, State, at_end


def wide_bounds(rng):
    """The optimum lies at numbers of size 1; the bounds are 1e5 to 1e9 away, on one side or on both."""
    wide, other = power(rng, 5, 9), power(rng, 5, 9)
    low = rng.choice([0.0, -wide, -number(rng, 0, 3)])
    high = other if low > -10 or rng.random() < 0.7 else number(rng, 2, 5)
    n, u = rng.randint(1, 3), name('u')
    x = names('x', n)
    bend = rng.choice([lift(0), 0.1 * call('sin', x[0]), -0.2 * x[0]**3, 0.3 * x[0]])
    states = [State(f'x{i + 1}', x[i + 1] if i + 1 < n else u + bend, number(rng, -0.5, 0.5)) for i in range(n)]
    if rng.random() < 0.3:
        states[0].low, states[0].high = rng.choice([(-wide, other), (-wide, 5.0), (-3.0, other)])
    goal = number(rng, 0.1, 10) * (at_end('x1') - number(rng, 0.5, 3))**2
    problem = Problem('wide_bounds', states, [Control('u', low, high)], (u - number(rng, 0, 2))**2, goal,
                      number(rng, 0.5, 2), N=rng.choice([5, 20, 50, 200]), scheme=scheme(rng, implicit=True))
    problem.convex = all(word not in problem.text() for word in ('sin', '^ 3'))
    return problem


def redundant(rng):
    """Ends and paths that are said twice, follow from others, hold with equality, or have a gradient of 0."""
    n, u = rng.randint(1, 3), name('u')
    x = names('x', n)
    states = [State(f'x{i + 1}', linear(rng, x) + number(rng, 0.5, 2) * u, number(rng, -1, 1)) for i in range(n)]
    problem = Problem('redundant', states, [Control('u', -2.0, 2.0)], squares(rng, x) + 0.1 * u**2, None,
                      number(rng, 0.5, 2), N=rng.choice([10, 20, 40]), scheme=scheme(rng))
    final = trajectory(problem, rng)[0][:, -1]
    goal, scale = float(final[0]), power(rng, -3, 3)
    first = Condition(x[0], goal, goal)
    kinds = {
        'twice': [first, Condition(scale * x[0], scale * goal, scale * goal)],
        'sum': [first, Condition(x[-1], float(final[-1]), float(final[-1])),
                Condition(x[0] + x[-1], goal + float(final[-1]), goal + float(final[-1]))],
        'squeezed': [Condition(x[0], goal, INF), Condition(x[0], -INF, goal)],
        'square': [Condition((x[0] - goal)**2, -INF, 0.0)],
        'square_equal': [Condition((x[0] - goal)**2, 0.0, 0.0)],
        'corner': [first, Condition(x[0], goal, goal + 1)],
        'loose': [first, Condition(x[0]**2, -INF, goal**2)],
    }
    problem.family, kind = 'redundant', rng.choice(list(kinds))
    problem.ends = kinds[kind]
    if rng.random() < 0.5:
        problem.paths = [Condition(u, -2.0, 2.0), Condition(scale * u, -2.5 * scale, 2.5 * scale)]
    if rng.random() < 0.3:
        problem.integrals = [Condition(u**2, -INF, 5 * problem.span)]
    problem.convex = 'square' not in kind and not problem.integrals and kind != 'loose'
    return problem


def infeasible(rng):
    """No trajectory can meet the conditions, by more than rounding."""
    x, u, width = name('x'), name('u'), number(rng, 0.5, 3)
    bend = rng.choice([lift(0), 0.2 * call('sin', x), -0.5 * x**3])
    span, gap = number(rng, 0.5, 2), rng.choice([0.01, 0.1, 1.0, 10.0])
    far = width * span + 0.2 * span + gap
    state = State('x', u + bend, 0.0)
    running = rng.choice([u**2, u**2 + x**2, (u - x)**2])
    problem = Problem('infeasible', [state], [Control('u', -width, width)], running, None, span,
                      N=rng.choice([10, 30]), scheme=scheme(rng, implicit=True), truth='infeasible')
    kinds = [[Condition(x, far, far)], [Condition(x, far, INF)], [Condition(x, 0.1, 0.1), Condition(x, 0.1 + gap, INF)],
             [Condition(x**2, -INF, -gap)]]
    problem.ends = rng.choice(kinds)
    if rng.random() < 0.3:
        problem.paths = [Condition(u**2 + x**2, width**2 + far**2 + gap, INF)]
    return problem


def unbounded(rng):
    """Controls without bounds, and a cost that falls for ever along them."""
    x, u, w = name('x'), name('u'), name('w')
    a = number(rng, -1, 1)
    kinds = [(u, None), (None, at_end('x')), (-u**2, None), (w**2 - u**2, None), (u * w, None),
             (w**2 - 0.5 * x**2 - u**2, None), (-x**2, at_end('x')), (w**2 + u, None)]
    running, mayer = rng.choice(kinds)
    free_end = [] if rng.random() < 0.7 or mayer is not None else [Condition(x, 1.0, 1.0)]
    state = State('x', u + a * x, number(rng, -1, 1))
    if free_end and running.text() == 'u':
        state.rate = w + a * x
    return Problem('unbounded', [state], [Control('u'), Control('w')], running, mayer, number(rng, 0.5, 2),
                   N=rng.choice([5, 20]), scheme=scheme(rng), ends=free_end, truth='unbounded')
