"""Families whose convexity, or the lack of it, is known, with optima in closed form."""

import itertools
import math

import numpy as np

from draw import linear, names, number, power, scheme
from expressions import name, total
from problem import Control, Problem, State, at_end


def far_but_bounded(rng):
    """A linear cost whose bounds are far: bounded, with an optimum in closed form."""
    u, wide = name('u'), power(rng, 2, 8)
    low, high, span, c = -wide, wide * rng.choice([1, 2]), number(rng, 0.5, 2), number(rng, 0.1, 2)
    sign = rng.choice([-1, 1])
    return Problem('far_but_bounded', [State('x', u, 0.0, move=wide)], [Control('u', low, high)], None,
                   sign * c * at_end('x'), span, N=rng.choice([5, 20]), scheme=scheme(rng), convex=True,
                   optimum=span * c * (low if sign > 0 else -high))


def saddle(rng):
    """Quadratic forms over boxes, indefinite or nearly singular; the least value by enumeration of faces."""
    m = rng.randint(2, 3)
    turn = np.linalg.qr(np.array([[rng.gauss(0, 1) for _ in range(m)] for _ in range(m)]))[0]
    turn = turn if rng.random() < 0.5 else np.eye(m)
    values = [number(rng, 0.5, 2)] + [rng.choice([-1, 1, -1e-3, 1e-3, -1e-6, 1e-9, 0]) * number(rng, 0.5, 2)
                                      for _ in range(m - 1)]
    matrix = turn @ np.diag(values) @ turn.T
    matrix = (matrix + matrix.T) / 2
    scales = [power(rng, 0, 7) if rng.random() < 0.4 else 1.0 for _ in range(m)]
    boxes = [(-number(rng, 0.5, 2) * s, number(rng, 0.5, 2) * s) for s in scales]
    slope = [rng.choice([0, 0, number(rng, -0.1, 0.1)]) for _ in range(m)]
    u = names('u', m)
    running = total([float(matrix[i, j]) * u[i] * u[j] for i in range(m) for j in range(m) if matrix[i, j]]
                    + [slope[i] * u[i] for i in range(m) if slope[i]])
    span = number(rng, 0.5, 2)
    states = [State('x', linear(rng, u), 0.0)]
    best = least(matrix, slope, boxes)
    return Problem('saddle', states, [Control(f'u{i + 1}', *boxes[i]) for i in range(m)], running, None, span,
                   N=rng.choice([1, 5, 20]), scheme=scheme(rng), optimum=span * best,
                   convex=bool(np.linalg.eigvalsh(matrix).min() >= 0))


def least(matrix, slope, boxes):
    """The least value of v'Mv + s'v over a box: stationary points of all faces."""
    best, m = np.inf, len(boxes)
    for sides in itertools.product((None, 0, 1), repeat=m):
        v = np.array([0.0 if side is None else boxes[i][side] for i, side in enumerate(sides)])
        open_ = [i for i, side in enumerate(sides) if side is None]
        if open_:
            right = -(np.array(slope)[open_] / 2 + matrix[open_] @ v)
            v[open_] = np.linalg.lstsq(matrix[np.ix_(open_, open_)], right, rcond=None)[0]
        if all(low <= v[i] <= high for i, (low, high) in enumerate(boxes)):
            best = min(best, float(v @ matrix @ v + np.dot(slope, v)))
    return best


def double_well(rng):
    """(u^2 - a^2)^2 + b u, the same on every interval: the least value over the box, on a fine grid and by Newton."""
    a, b, u = number(rng, 0.3, 1.5), number(rng, -0.3, 0.3), name('u')
    low, high, span = -number(rng, 1, 3), number(rng, 1, 3), number(rng, 0.5, 2)
    roots = np.roots([4, 0, -4 * a**2, b])
    points = [low, high] + [float(r.real) for r in roots if abs(r.imag) < 1e-9 and low <= r.real <= high]
    best = min((p**2 - a**2)**2 + b * p for p in points)
    return Problem('double_well', [State('x', u)], [Control('u', low, high)], (u**2 - a**2)**2 + b * u, None, span,
                   N=rng.choice([5, 20]), scheme=scheme(rng), optimum=span * best)


def conjugate(rng):
    """x' = u, the integral of u^2 - c^2 x^2: convex until c T is near pi/2; u = 0 is stationary beyond that, too."""
    x, u, span = name('x'), name('u'), number(rng, 0.5, 3)
    share = rng.choice([number(rng, 0.5, 2), 1 + rng.choice([-1, 1]) * power(rng, -4, -1)])
    c = float(f'{share * math.pi / 2 / span:.6g}')
    n, how, width = rng.choice([10, 20, 50]), scheme(rng), power(rng, 0, 6)
    start, control = rng.choice([0.0, 0.0, number(rng, -1, 1)]), Control('u', -width, number(rng, 1, 2) * width)
    return Problem('conjugate', [State('x', u, start)], [control], u**2 - c**2 * x**2, None, span, N=n, scheme=how)
