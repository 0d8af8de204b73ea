"""More closed forms of models of tests/classics/switched, each with its derivation."""

from math import asinh, cos, cosh, exp, hypot, inf, log, sin, sinh, sqrt

import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq, fsolve, minimize, minimize_scalar

import true_optimum_formulas as formulas
from true_optimum_formulas import hermite

G = 9.81


def least(f, *starts):
    """The least value over some numbers, from several starts."""
    exact = {'xatol': 1e-13, 'fatol': 1e-16, 'maxiter': 10000, 'maxfev': 20000}
    found = [minimize(f, start, method='Nelder-Mead', options=exact) for start in starts]
    best = min(found, key=lambda r: r.fun)
    return best.fun, best.x


def stribeck():
    """v'^2 - mu^2 does not change at v = 0.3 (H), v' falls with one slope: a, b to t1; the way back is symmetric."""
    def rows(q):
        a, b, t = q
        rest = 1 - t
        return [a * t - b * t * t / 2 - 0.3, (a - b * t)**2 - 0.2 - (b * rest)**2,
                a * t * t / 2 - b * t**3 / 6 + 0.3 * rest + b * rest**3 / 3 - 1]
    a, b, t = fsolve(rows, [3, 3, 0.1], xtol=1e-14)
    rest = 1 - t
    J = 2 * ((a**3 - (a - b * t)**3) / (3 * b) + b * b * rest**3 / 3 + 0.36 * t + 0.16 * rest)
    return J, [t, 2 - t], {}


def hard_pull():
    """12 to t, then 12 - k s for a time; v and x at its end give k and that time, and t is where the cost is least."""
    a = (12 - 0.31 * 2 * G) / 2

    def last(t):
        time = brentq(lambda s: a * (t + s)**2 / 2 - 2 * a * (t + s) * s / 6 - 1, 0.1, 4, xtol=1e-15)
        return 4 * a * (t + time) / time**2, time

    def cost(t):
        k, time = last(t)
        return 144 * t + (12**3 - (12 - k * time)**3) / (3 * k)
    J, (t,) = least(lambda q: cost(q[0]), [0.02])
    return J, [], {'arcs': [t]}


def stay():
    """A push that moves it costs 1.9^2 per time at least, and gains less than 1.6 of the way: 1.6*(4.2 - 1.9)*2.4 < 1.9^2."""
    return 0.0, [], {}


def to_the_bound():
    """The way is covered with the largest acceleration -3.1, then braked with 6.08."""
    gain, loss = 4.59 - 0.82 - 0.67, 4.59 + 0.82 + 0.67
    T = sqrt(2 * 1.2 * (1 / gain + 1 / loss))
    return T, [], {'T': T, 'arcs': [T * loss / (gain + loss)]}


def three_gears():
    """4 until v = 4, 2 until v = 8, 1 until half of the way, and back."""
    last = -8 + sqrt(64 + 2 * (40 - 2 - 12))
    T = 2 * (3 + last)
    return T, [1, 3, T - 3, T - 1], {'T': T, 'arcs': [T / 2]}


def hysteresis_car():
    """5 until 15, 15 until 25, there, -15 until 10, -5: 63.33 m and the rest at 25."""
    way = 22.5 + (625 - 225) / 30 + (625 - 100) / 30 + 10
    on = (150 - way) / 25
    times = np.cumsum([3, 10 / 15, on, 1, 2])
    return times[-1], [times[0], times[3]], {'T': times[-1], 'arcs': [times[1], times[2]]}


def three_media():
    """Straight lines: least over the two places where they cross."""
    T, (a, b) = least(lambda q: hypot(q[0], 1) + hypot(q[1], 1) / 2 + 2 * hypot(3 - q[0] - q[1], 1), [0.5, 1.5])
    return T, [hypot(a, 1), hypot(a, 1) + hypot(b, 1) / 2], {'T': T}


def lens():
    """Straight lines: least over the angles at which the circle is crossed, near 172 and -3 degrees."""
    def legs(q):
        a, b = (cos(q[0]), sin(q[0])), (cos(q[1]), sin(q[1]))
        return [hypot(a[0] + 2, a[1] - 0.3), hypot(a[0] - b[0], a[1] - b[1]) / 0.75, hypot(2 - b[0], -0.2 - b[1])]
    T, q = least(lambda q: sum(legs(q)), [3.0, -0.05])
    return T, [legs(q)[0], sum(legs(q)[:2])], {'T': T}


def rain_front():
    """Constant speeds: over the time D at which it is at D/2."""
    J, (D,) = least(lambda q: (q[0] / 2 + 1)**2 / q[0] + 2 * q[0] + (2.5 - q[0] / 2)**2 / (3 - q[0]), [1.0])
    return J, [D], {}


def speed_cap_time():
    """1.5 until 0.8, there, -2.5."""
    up, down = 0.8 / 1.5, 0.8 / 2.5
    on = (2 - 0.4 * (up + down)) / 0.8
    return up + on + down, [], {'T': up + on + down, 'arcs': [up, up + on]}


def bryson_denham_friction(l=0.1, mu=0.5):
    """To the wall in tau, a cubic with the effort h(tau) + mu^2 tau - 2 mu, and back: h' = -4 (tau - 3 l)^2/tau^4."""
    tau = brentq(lambda s: 2 * (3 * l - s) - mu * s * s, 0.05, 0.3, xtol=1e-16)
    return hermite(tau, l, 1, 0) + mu**2 * tau, [tau, 1 - tau], {}


def touch_friction(l=0.2, mu=0.5):
    """As before with tau = 1/2: it does not rest."""
    return hermite(0.5, l, 1, 0) + mu**2 / 2, [0.5], {}


def furthest():
    """x(T) = integral((T - t) (u - mu)), so u is proportional to T - t."""
    return sqrt(8 / 3) - 0.6, [], {}


def billiard():
    """The ball has the speed 1 when it hits, as friction stops the other after 1; over the time t before."""
    t = sqrt(7) - 1
    return t + 2 + hermite(t, 1, 0, 1), [t], {'T': t + 2}


def gear_loss():
    """T + integral(u^2) is least for u = 1: 2 to the speed 2, and 2 2.2 from 1.8 to 4; each second costs 2."""
    return 12.8, [2], {'T': 6.4}


def doses():
    """Exponentials from 2, 1 + dose, 1 + dose; least over the dose."""
    def cost(dose):
        c, t, J = 2.0, 0.0, 0.0
        for given in range(3):
            h = min(log(c) if given < 2 else inf, 2.5 - t)
            J += c * c * (1 - exp(-2 * h)) / 2 - 3.2 * c * (1 - exp(-h)) + 2.56 * h
            t, c = t + h, c * exp(-h) + dose
        return J
    r = minimize_scalar(cost, bounds=(1.2, 1.4), method='bounded', options={'xatol': 1e-13})
    return r.fun, [log(2), log(2) + log(1 + r.x)], {'dose': r.x}


def power_limit():
    """u = 2 until v = 1/2, then u = 1/v until w, then -2."""
    def gain(f, w):
        return quad(f, 0.5, w, epsabs=1e-14)[0]

    def way(w):
        return 0.25 / 3.4 + gain(lambda v: v / (1 / v - 0.3), w) + w * w / 4.6
    w = brentq(lambda w: way(w) - 2, 0.6, 3.2, xtol=1e-15)
    first, second = 0.5 / 1.7, gain(lambda v: 1 / (1 / v - 0.3), w)
    T = first + second + w / 2.3
    return T, [], {'T': T, 'arcs': [first, first + second]}


def graze_in():
    """Two cubics that touch the zone at half time."""
    return 2 * hermite(1.1, 0.5, 1, 0), [], {}


def narrow_toll():
    """One speed before and behind, another one inside for d."""
    J, (d,) = least(lambda q: 1.996**2 / (3 - q[0] / 1e4) + 0.16 / q[0] + 0.03 * q[0], [2.0])
    first = (3 - d / 1e4) / 1.996
    return J, [first, first + d / 1e4], {}


def fuel_stop():
    """Full push at 1.7, then rolling at -0.3: v^2/2 (1/1.7 + 1/0.3) = 1."""
    v = sqrt(2 / (1 / 1.7 + 1 / 0.3))
    return 2 * v / 1.7, [], {}


def fuel_abs():
    """As before: one control in place of two."""
    return fuel_stop()


def singular_brake(T=5):
    """-1 until x'' = x can be followed: x = A cosh(T - t), v = -A sinh(T - t), where lambda_v = 0."""
    t = brentq(lambda t: (1 - 0.4 * t * t) * sinh(T - t) - 0.8 * t * cosh(T - t), 0.1, 2, xtol=1e-16)
    A = 0.8 * t / sinh(T - t)
    J = quad(lambda s: (1 - 0.4 * s * s)**2 + 0.64 * s * s, 0, t, epsabs=1e-15)[0] + A * A * sinh(2 * (T - t)) / 2
    return J, [], {'arcs': [t]}


def place_border():
    """Constant speeds before and behind c, which is reached after D."""
    J, (c, D) = least(lambda q: q[0]**2 / q[1] + ((3 - q[0]) / (2 - q[1]) + 0.6)**2 * (2 - q[1])
                      + 0.3 * q[0]**2, [2, 1])
    return J, [D], {'c': c}


def tariff():
    """heat = c exp(t/2)/price, which warms by 1.5 after losses."""
    unit = exp(1) - 1 + (exp(2) - exp(1)) / 3
    c = 1.5 * exp(1) / unit
    return c * c * unit, [1], {}


def thrust_hopper():
    """In each of three flights u = max(0, a (s - t)), a from where it ends: least over D and s of each."""
    def flight(v, drop, D, s):
        m = min(s, D)
        a = (drop - v * D + G * D * D / 2) / (D * s * m - (D + s) * m * m / 2 + m**3 / 3)
        return v - G * D + a * (s * m - m * m / 2), a * a * (s**3 - (s - m)**3) / 3

    def cost(q):
        v, first = flight(0, -1, q[0], q[1])
        v, second = flight(-0.8 * v, 0, q[2], q[3])
        return first + second + flight(-0.8 * v, 1, 2 - q[0] - q[2], q[4])[1]
    q = [0.45262, 0.04538, 0.98209, 0.57196, 0.56529]
    for _ in range(5):
        J, q = least(cost, q)
    return J, [q[0], q[0] + q[2]], {'arcs': [q[1], q[0] + q[3]]}


def two_edges():
    """Straight lines: over the place on the first border and that on the second one."""
    def legs(q):
        return [hypot(1, 1 - q[0]), hypot(q[1], q[0]) / 1.5, hypot(1 - q[1], 1) / 2]
    T, q = least(lambda q: sum(legs(q)), [0.2, 0.1])
    return T, [legs(q)[0], sum(legs(q)[:2])], {'T': T}


def dir_reverse():
    """On a straight line it is `turn_round`."""
    return formulas.turn_round()


def valley():
    """Beside the diagonal one pays; on it, through the corner, it goes at one speed."""
    return 4, [1], {}


def ratchet():
    """u = v' + 1.2 while it slides for D = sqrt(5), and 0 at rest."""
    D = sqrt(5)
    return 12 / D**3 + 1.44 * D, [D], {}


def nearly_together():
    """As `relay`, from 1 and from 1.01."""
    starts = [1, 1.01]
    return sum(a * sqrt(1 + a * a) + asinh(a) - 2 * a for a in starts), [asinh(a) for a in starts], {}


def twins_apart():
    """As `twins`, from -1 and from -1.005, each on its own."""
    def one(a):
        return least(lambda q: (a / q[0] - 1)**2 * q[0] + 1 / (1.5 - q[0]), [0.65])
    (J, (D,)), (K, (E,)) = one(1), one(1.005)
    return J + K, sorted([D, E]), {}
