"""Closed forms of models of tests/classics/switched, each with its derivation."""

from math import asinh, exp, log, sqrt

from scipy.optimize import brentq, minimize_scalar


def hermite(h, d, v0, v1):
    """The least integral of the squared acceleration of x'' = a over d in h, between the speeds v0 and v1."""
    return (12 * d**2 - 12 * d * h * (v0 + v1) + 4 * h**2 * (v0**2 + v0 * v1 + v1**2)) / h**3


def moving(c, h, *ways):
    """Effort of v' in u - c Dir(v) that never rests: u = v' + c v/|v|, so that 2 c times the change of |v| is added.

    Each way is (d, v0, v1), one for each direction of the plane.
    """
    speeds = [sqrt(sum(way[i]**2 for way in ways)) for i in (1, 2)]
    return sum(hermite(h, *way) for way in ways) + 2 * c * (speeds[1] - speeds[0]) + c**2 * h


def turn_round():
    """The speed of the cubic, (5 t/3 - 1) (1 - t/3), is 0 at 3/5."""
    return moving(0.5, 3, (1, -1, 0)), [0.6], {}


def puck_aside():
    """It never rests."""
    return moving(0.5, 2, (0, 1, 0), (1, 0, 0)), [], {}


def relay():
    """H = x^2 + u^2 + lambda (u - 1) = 0 with u = -lambda/2, so u = 1 - sqrt(1 + x^2); held at 0 it costs nothing."""
    return sqrt(2) + asinh(1) - 2, [asinh(1)], {}


def toll():
    """Constant speeds: 1/D1 + D1 + 1/D2 + 3 D2 with D1 + D2 = 3."""
    D = brentq(lambda D: -1 / D**2 + 1 + 1 / (3 - D)**2 - 3, 1.6, 2.9, xtol=1e-15)
    return 1 / D + D + 1 / (3 - D) + 3 * (3 - D), [D], {}


def shoreline():
    """Snell: the sines of the angles to the normal are as the speeds, 1 and 2."""
    x = brentq(lambda x: x / sqrt(1 + x**2) - (2 - x) / sqrt(1 + (2 - x)**2) / 2, 0, 2, xtol=1e-15)
    first = sqrt(1 + x**2)
    T = first + sqrt(1 + (2 - x)**2) / 2
    return T, [first], {'T': T}


def overdrive():
    """Full gas: 2 a second until 2, then v' = 3 - v/4."""
    T = 1 + 4 * log(2.5 / 1.75)
    return T, [1], {'T': T}


def uphill_soon():
    """Up at 3 - 1.5, down at -4.5: v^2 = 4/(1/1.5 + 1/4.5) at the top."""
    v = sqrt(4 / (1 / 1.5 + 1 / 4.5))
    return v / 1.5 + v / 4.5, [], {'T': v / 1.5 + v / 4.5, 'arcs': [v / 1.5]}


def ridge():
    """u = d/D + 1/2 below and d/D - 1/2 above: d1^2/D1 + d1 + d2^2/D2 - d2 + T/4, least at one speed, 3/4."""
    return 1.5**2 / 2 + (0.5 - 1) + 0.25 * 2, [0.5 / 0.75], {}


def speed_limit(c=0.5, V=0.45, T=3):
    """u = v' + c; v is a parabola for tau at both ends and V between: 4/3 V tau + V (T - 2 tau) = 1."""
    tau = 1.5 * (T - 1 / V)
    return 8 * V**2 / (3 * tau) + c**2 * T, [], {'arcs': [tau, T - tau]}


def free_time():
    """T + (c^2 T + 12/T^3)/2 with c = 1/2 is least at T^4 = 18/(1 + 1/8) = 16."""
    return 3, [], {'T': 2}


def twins():
    """Twice (1/D1 - 1)^2 D1 + 1/D2 with D1 + D2 = 3/2, for both at once."""
    D = brentq(lambda D: -1 / D**2 + 1 + 1 / (1.5 - D)**2, 0.5, 0.9, xtol=1e-15)
    return 2 * (1 / D - 2 + D + 1 / (1.5 - D)), [D], {}


def heater(T=1.8, loss=0.3, outside=5.0):
    """w = a + b exp(-loss t) on each piece: off at 21, on at 19; the integral of (w - 20)^2 over the power p."""
    def integral(start, level, h):
        a, b = level - 20, start - level
        e, square = 1 - exp(-loss * h), 1 - exp(-2 * loss * h)
        return a * a * h + 2 * a * b * e / loss + b * b * square / (2 * loss)

    def times(p):
        level = outside + p / loss
        return log((level - 18) / (level - 21)) / loss, log(16 / 14) / loss, level

    def cost(p):
        rise, fall, level = times(p)
        return integral(18, level, rise) + integral(21, outside, fall) + integral(19, level, T - rise - fall)
    p = minimize_scalar(cost, bounds=(6, 12), method='bounded', options={'xatol': 1e-12}).x
    rise, fall, level = times(p)
    last = level + (19 - level) * exp(-loss * (T - rise - fall))
    assert last < 21
    return cost(p), [rise, rise + fall], {'p': p}
