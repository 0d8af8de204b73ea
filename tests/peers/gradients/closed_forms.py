"""The derivatives of tests/gradients/ that have a closed form: each output by hand as a formula, differentiated by SymPy.

Prints the cases of all files, or of those that are named.
"""

import sys

from sympy import N, Rational, atan, cosh, diff, exp, integrate, log, pi, simplify, sin, solve, sqrt, symbols


def rows(title, of, output, values, seconds=(), given=(), zeros=()):
    """A case: all first derivatives by `values`, the second ones that are asked for (`all` of them if so said)."""
    names = list(values)
    at = {symbols(name): value for name, value in values.items()}
    show = lambda formula: N(formula.subs(at), 18)
    print('case', title)
    for line in given:
        print(line)
    if of:
        print('of', of)
    spoken = lambda name: name[:-6] + '(start)' if name.endswith('_start') else name
    for name in names:
        print('by', spoken(name), '=', show(diff(output, symbols(name))))
    if seconds == 'all':
        seconds = [(a, b) for i, a in enumerate(names) for b in names[i:]]
    for a, b in seconds:
        print('second', spoken(a), spoken(b), '=', show(diff(output, symbols(a), symbols(b))))
    print()


def drift():
    """Example (a2)."""
    alpha, x0, t = symbols('alpha x0 t')
    switch = -x0 / (2 + alpha)
    before, after = x0 + (2 + alpha) * t, alpha * (t - switch)
    objective = (after.subs(t, 2) - Rational(5, 3)) ** 2
    objective += integrate(before**2, (t, 0, switch)) + integrate(after**2, (t, switch, 2))
    rows('(a2), its objective', None, objective, {'x0': -1, 'alpha': 1}, 'all')


def circle():
    """Example (d): on the arc sin p + 2 cos p = 2 x + y + t, whatever mixture keeps the state there; behind it (1, -1) t."""
    x, y, t = symbols('x_start y_start T')
    q = 2 * x + y + t
    # sin p + 2 cos p = q with p from pi downwards to pi/4: p = atan(1/2) + acos(q/sqrt 5)
    p_cos = (2 * q - sqrt(5 - q**2)) / 5
    p_sin = (q + 2 * sqrt(5 - q**2)) / 5
    values = {'x_start': -Rational(3, 10), 'y_start': Rational(1, 5), 'T': Rational(3, 2)}
    for name, output in (('x', p_cos), ('y', p_sin)):
        rows(f'(d), {name}(T) on the arc, to the second order', f'{name}(end)', output, values, 'all', ['set T = 1.5'])
    after = 1 / sqrt(2) + t - 3 / sqrt(2) + 2 * x + y
    values['T'] = 4
    for name, output in (('x', after), ('y', sqrt(2) - after)):
        rows(f'(d), {name}(T) after the exit, to the second order', f'{name}(end)', output, values, 'all')


def floor_ball():
    """Two bounces, then h = floor + w s - g s^2/2 with w = e^2 v."""
    e, h0, floor, g, last = symbols('e h0 floor g T')
    first = sqrt(2 * (h0 - floor) / g)
    s = last - first - 2 * e * first
    w = e**2 * g * first
    values = {'e': Rational(1, 2), 'h0': Rational(6, 5), 'floor': Rational(1, 5), 'g': 10, 'T': 1}
    rows('parabolas', 'h(end)', floor + w * s - g * s**2 / 2, values, 'all')


def stacked_blocks():
    """All three move from f1/k on, the top slips at t2, the middle at t3."""
    k, f1, f2, f3, m, last, t = symbols('k f1 f2 f3 m T t')
    t1 = f1 / k
    t2 = (f1 + (m + 2) * f3) / k
    t3 = (f1 + f3 + (m + 1) * (f2 - f3)) / k
    together = integrate((k * t - f1) / (m + 2), (t, t1, t2))
    below = together + integrate((k * t - f1 - f3) / (m + 1), (t, t2, t3))
    v1 = below + integrate((k * t - f1 - f2) / m, (t, t3, last))
    v2 = below + (f2 - f3) * (last - t3)
    v3 = together + f3 * (last - t2)
    values = {'k': 1, 'f1': 3, 'f2': 2, 'f3': Rational(1, 2), 'm': 1, 'T': 8}
    for name, output in (('v1', v1), ('v2', v2), ('v3', v3)):
        rows(f'{name}(T), polynomials in t from slip to slip', f'{name}(end)', simplify(output), values, 'all')


def drag():
    """Up like a tangent, down from the top like a hyperbolic cosine."""
    g, c, v0 = symbols('g c v0')
    top = log(1 + c * v0**2 / g) / (2 * c)
    turn = atan(v0 * sqrt(c / g)) / sqrt(g * c)
    down = log(cosh(sqrt(g * c) * (2 - turn))) / c
    values = {'g': 10, 'c': Rational(2, 5), 'v0': 8}
    rows('a tangent, then a hyperbolic cosine', None, top - down, values, 'all')


def two_springs():
    """Half a swing on each side, then a part of the third."""
    soft, stiff, v0, last = symbols('soft stiff v0 T')
    both = pi / sqrt(soft) + pi / sqrt(stiff)
    x = v0 * sin(sqrt(stiff) * (last - pi / sqrt(soft))) / -sqrt(stiff)
    values = {'soft': 1, 'stiff': 9, 'v0': Rational(3, 2), 'T': 4}
    rows('the soft spring, then the stiff one', None, x, values, 'all')
    x = v0 * sin(sqrt(soft) * (last - both)) / sqrt(soft)
    rows('both, then the soft one again', None, x, values | {'T': 5}, 'all', ['set T = 5'])


def saturated():
    """Two parabolas, then an exponential beyond b."""
    a, b, k, t = symbols('a b k t')
    # x = a^2/2 + a s + k s^2/2 with s = t - a reaches b at s1; then y = x - b solves y' = y + a + k s
    s1 = (-a + sqrt(a**2 + 2 * k * (b - a**2 / 2))) / k
    s, s2 = symbols('s s2')
    y = (a + k * s1 + k) * exp(s2 - s1) - (a + k * s2 + k)
    values = {'a': Rational(1, 2), 'b': 2, 'k': 3}
    rows('parabolas, then an exponential', None, b + y.subs(s2, 2 - a), values, 'all')


def friction_work():
    """A triangle above and one below."""
    mu, v0, force = symbols('mu v0 F')
    turn = v0 / (force + mu)
    work = mu * (v0 * turn + (force - mu) * (3 - turn) ** 2)
    rows('two triangles', None, work, {'mu': 2, 'v0': 4, 'F': 3}, 'all')


def both_held():
    """Example (f): x is held from t1 on, y from t2 on; the product of the selectors by moments."""
    a, b, c, d, x0, y0, last = symbols('a b c d x0 y0 T')
    t1 = x0 / (c + d - a)
    s = (a - d) / c
    t2 = t1 + (y0 + (b + d - c) * t1) / (c - b - d * s)
    p, q = symbols('p q')
    held = solve([a - c * p - d * q, b + d * p - c * q], [p, q])
    p, q = held[p], held[q]
    rate = lambda p, q: p + 2 * q + p * q
    z = 4 * t1 + rate(s, 1) * (t2 - t1) + rate(p, q) * (last - t2)
    values = {'a': Rational(3, 10), 'b': Rational(2, 5), 'c': 2, 'd': Rational(1, 2), 'x0': 1, 'y0': 1, 'T': 2}
    assert abs(N(z.subs({symbols(k): v for k, v in values.items()})) - 3.06214532871972318) < 1e-14
    rows('(f), z(T)', 'z(end)', z, values, 'all')


def pushed():
    """Slides, comes to rest in the second quarter, rests through the third, breaks away in the fourth."""
    mu, v0, last = symbols('mu v0 T')
    u = symbols('u[0] u[1] u[2] u[3]')
    quarter = last / 4
    v1 = v0 + (u[0] - mu) * quarter
    rest = v1 / (mu - u[1])
    x = (v0 + v1) * quarter / 2 + v1 * rest / 2 + (u[3] - mu) * quarter**2 / 2
    cost = u[0] * quarter + u[1] * rest + u[1] ** 2 / mu * (quarter - rest) + u[2] ** 2 / mu * quarter + u[3] * quarter
    values = {'mu': 1, 'v0': Rational(3, 10), 'T': 4, 'u[0]': Rational(3, 2), 'u[1]': -Rational(1, 2)}
    values |= {'u[2]': Rational(1, 4), 'u[3]': 3}
    given = ['control 0 1.5', 'control 1 -0.5', 'control 2 0.25', 'control 3 3']
    rows('x(T), parabolas; the force jumps at rest', 'x(end)', x, values, 'all', given)
    rows('with the selector u/mu at rest', 'x(end) + work(end)', x + cost, values, 'all', given)
    v1 = v0 + u[0] - mu
    rest = v1 / (mu - u[1])
    x = (v0 + v1) / 2 + v1 * rest / 2 + (u[3] - mu) * (last - 3) ** 2 / 2
    rows('the same force, which jumps at 1, 2 and 3 whenever the end is', 'x(end)', x, values, 'all', [*given, 'fixed times'])


def comes_to_rest():
    """The area under all arcs is a geometric series, (2/3) v^3/g^2 for each."""
    e, h0, floor, g = symbols('e h0 floor g')
    fall = sqrt(2 * (h0 - floor) / g)
    area = Rational(2, 3) * (h0 - floor) * fall + Rational(2, 3) * (g * fall) ** 3 / g**2 * e**3 / (1 - e**3)
    rows('a geometric series', None, floor + 3 * floor + area, {'e': Rational(1, 2), 'h0': 1, 'floor': 0, 'g': 10})


def energy():
    """Example (e3)."""
    mu, d, last = symbols('mu d T')
    values = {'mu': Rational(1, 2), 'd': 1, 'T': 3}
    rows('(e3), the energy: J = (mu^2 T + 12 d^2/T^3)/2', None, (mu**2 * last + 12 * d**2 / last**3) / 2, values, 'all')
    rows('(e3), the end is reached for all mu and T', 'x(end)', d, values)


def bang_bang():
    """Example (e1) and (e0) until shortly before the end."""
    force, mu, x0, v0, turn, last = symbols('U mu x0 v0 turn T')
    cross = -v0 / (force + mu)
    top = (force - mu) * (turn - cross)
    rest = last - turn
    v = top - (force + mu) * rest
    x = x0 + v0 * cross / 2 + top * (turn - cross) / 2 + top * rest - (force + mu) * rest**2 / 2
    values = {'U': 2, 'mu': Rational(1, 2), 'x0': 0, 'v0': -1, 'turn': Rational(7, 5), 'T': Rational(19, 10)}
    for name, output in (('x', x), ('v', v)):
        rows(f'(e1), {name}(T), parabolas', f'{name}(end)', output, values, 'all')


def breaks_away():
    """v = pull s^2/2 with s = T - mu/pull."""
    mu, pull, last = symbols('mu pull T')
    s = last - mu / pull
    values = {'mu': 1, 'pull': 1, 'T': 3}
    rows('v(T)', 'v(end)', pull * s**2 / 2, values, 'all')
    rows('x(T)', 'x(end)', pull * s**3 / 6, values, 'all')


def friction_wall():
    """Example (a1)."""
    x0 = symbols('x0')
    rows('(a1), rests', 'x(end)', 0 * x0, {'x0': 1}, 'all')
    rows('(a1), on its way', 'x(end)', x0 - 2, {'x0': 3}, 'all', ['set x0 = 3'])
    rows('(a1), rests, from below', 'x(end)', 0 * x0, {'x0': -Rational(1, 2)}, 'all', ['set x0 = -0.5'])


if __name__ == '__main__':
    cases = [drift, circle, floor_ball, stacked_blocks, drag, two_springs, saturated, friction_work, both_held, pushed]
    for case in [*cases, comes_to_rest, energy, bang_bang, breaks_away, friction_wall]:
        if case.__name__ in (sys.argv[1:] or case.__name__):
            print('==', case.__name__)
            case()
