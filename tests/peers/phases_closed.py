"""Closed forms of problems of tests/classics/phases, or the optimum of a formula with one or two unknowns.

The derivation stands beside each; where a minimum of a formula is taken, by scipy.
"""

from math import cosh, exp, log, pi, sin, sinh, sqrt, tanh

import numpy as np
from scipy.integrate import quad_vec
from scipy.linalg import expm
from scipy.optimize import minimize, minimize_scalar


def hermite(h, x0, v0, x1, v1):
    """The least integral of the squared acceleration between two states of x'' = u in the time h: the cubic's."""
    d = x1 - x0
    return (12 * d**2 - 12 * d * h * (v0 + v1) + 4 * h**2 * (v0**2 + v0 * v1 + v1**2)) / h**3


def cost_to_go(a, b, after, time):
    """P of the cost P x^2 for x' = a x + b u and the integral of x^2 + u^2, with `after` x^2 at the end (Riccati)."""
    s = sqrt(a * a + b * b)
    c, d = cosh(s * time), sinh(s * time)
    return (after * (s * c + a * d) + d) / (s * c - a * d + b * b * after * d)


def tide():
    """Straight legs through moving water: the u of each is constant, u = (way - drift)/duration."""
    def cost(d):
        clock, total = 0.0, 0.0
        for way, h in zip((1, -2, 1), (d[0], d[1], 6 - d[0] - d[1])):
            total += (way - (sin(clock + h) - sin(clock)))**2 / h
            clock += h
        return total
    starts = [(a / 2, b / 2) for a in range(1, 8) for b in range(1, 8) if a + b < 11]
    found = [minimize(cost, s, method='Nelder-Mead', bounds=[(0.5, 4)] * 2,
                      options={'xatol': 1e-12, 'fatol': 1e-15, 'maxiter': 4000}) for s in starts]
    best = min(found, key=lambda f: f.fun)
    return {'objective': best.fun, 'D1': best.x[0], 'D2': best.x[1], 'D3': 6 - sum(best.x)}


def throw(e=0.8, g=9.81):
    """By the speed upwards: time to the bounce, time from there down to h = 1, and vx from both."""
    def times(vy):
        w = sqrt(vy**2 + 3 * g)
        return (vy + w) / g, (e * w + sqrt((e * w)**2 - 2 * g)) / g

    def cost(vy):
        return (6 / sum(times(vy)))**2 + vy**2
    vy = minimize_scalar(cost, bounds=(0.1, 9), method='bounded', options={'xatol': 1e-13}).x
    t1, t2 = times(vy)
    return {'objective': cost(vy), 'vx': 6 / (t1 + t2), 'vy': vy, 'T1': t1, 'T2': t2}


def two_stages(c=2500, g=9.81):
    """Full thrust until each stage is empty: the rocket equation and its integral over time."""
    def burn(full, empty, time, v):
        r = full / empty
        return v * time + c * time * (1 - log(r) / (r - 1)) - g * time**2 / 2, v + c * log(r) - g * time
    h1, v1 = burn(1500, 700, 50, 0)
    h2, v2 = burn(400, 120, 87.5, v1)
    return {'objective': h1 + h2 + v2**2 / (2 * g), 'T1': 50, 'T2': 87.5, 'T3': v2 / g}


def sounding_rocket(c=2800, g=9.81):
    """Full thrust in each of three stages, by the fuel of the second and the third; 4900 kg of all may be burnt."""
    def burn(state, fuel, push):
        h, v, m = state
        time, r = fuel * c / push, m / (m - fuel)
        climb = v * time + c * time * (1 - log(r) / (r - 1)) - g * time**2 / 2 if fuel else 0
        return h + climb, v + c * log(r) - g * time, m - fuel

    def height(second, third):
        h, v, m = burn((0, 0, 10000), 4900 - second - third, 2e5)
        h, v, m = burn((h, v, m - 800), second, 6e4)
        h, v, m = burn((h, v, m - 300), third, 1.5e4)
        return h + v**2 / (2 * g)
    found = minimize(lambda b: -height(*b), (300, 200), method='Nelder-Mead',
                     options={'xatol': 1e-10, 'fatol': 1e-12, 'maxiter': 4000})
    second, third = found.x
    return {'objective': -found.fun, 'T1': (4900 - second - third) * c / 2e5, 'T2': second * c / 6e4,
            'T3': third * c / 1.5e4}


def gears():
    """v_s is where another second in first gear gains as much as it saves in second, after the drag of the shift."""
    k = exp(-0.03)
    v = (4 * k - 2) / (0.75 * k)
    t1, t2 = log(4 / (4 - v)), 4 * log((2 - k * v / 4) / 0.5)
    return {'objective': t1 + 0.3 + t2, 'T1': t1, 'T2': t2}


def hopper(g=9.81, kept=0.8):
    """v = g/2 lifts off; the stance costs g^2 T + 2 g (1 + kept) v + hermite, least for the T below."""
    v = g / 2
    q = 4 * (kept**2 - kept + 1)
    return {'objective': 2 * g * v * sqrt(q) + 2 * g * (1 + kept) * v, 'T': v * sqrt(q) / g}


def jump_of_dynamics():
    """The link halves x, so P of the second phase counts a quarter at the end of the first."""
    return {'objective': cost_to_go(1, 1, cost_to_go(-1, 2, 0, 2) / 4, 1)}


def hohmann(r=2):
    """Two impulses along the orbit, at the ends of half an ellipse."""
    first, second = sqrt(2 * r / (1 + r)) - 1, sqrt(1 / r) - sqrt(2 / (r * (1 + r)))
    return {'objective': first + second, 'along1': first, 'along2': second, 'away1': 0, 'away2': 0,
            'T': pi * ((1 + r) / 2)**1.5}


def walker(duration=0.8, length=0.5, kept=0.9):
    """The effort d' W^-1 d is quadratic in v(T); d is the end less where nothing would lead, W the Gramian."""
    a = np.array([[0, 1], [9.81, 0]])
    gramian = quad_vec(lambda s: np.outer(expm(a * s)[:, 1], expm(a * s)[:, 1]), 0, duration, epsabs=1e-14)[0]
    free = expm(a * duration)
    # d = row v1 + constant, from (-length/2, kept v1) to (length/2, v1)
    row = np.array([0, 1]) - free @ [0, kept]
    constant = np.array([length / 2, 0]) - free @ [-length / 2, 0]
    weight = np.linalg.inv(gramian)
    v1 = -(row @ weight @ constant) / (row @ weight @ row)
    d = row * v1 + constant
    return {'objective': d @ weight @ d, 'v1': v1}


LEVEL = 2 / (1 + exp(-1))
CHAIN = {'objective': tanh(5), 'end': 1 / cosh(5)}

CLOSED = {
    # v(1) = 21/22 and v(3) = -(3 + 2 v(1))/4 make the sum of two `hermite` least
    'via_point': {'objective': 81 / 11, 'v': 21 / 22},
    'jump_of_dynamics': jump_of_dynamics(),
    # v = sqrt(2) after a metre at 1; v^2 rises by 4 s and falls by 4 (2 - s)
    'two_limits': {'objective': sqrt(5) + sqrt(0.5), 'T1': sqrt(2)},
    # harmonic balance: (1 + i) X = 1 + U, and |X|^2 + U^2/2 is least at U = -1/2
    'forced_oscillator': {'objective': pi / 4, 'x': 0.25, 'v': 0.25},
    'hopper': hopper(),
    'throw': throw(),
    # Snell: the sines of the headings are 0.3, 0.6, 0.8, as the speeds 1, 2, 8/3
    'refraction': {'objective': 1 / sqrt(0.91) + 1.25 + 0.9375, 'T1': 1 / sqrt(0.91), 'T2': 1.25, 'T3': 0.9375},
    'gear_shift': gears(),
    'tidal_legs': tide(),
    # the sum of two `hermite`, the second twice, is least at x = 1, v = 1/3
    'meeting': {'objective': 38 / 3, 'x': 1, 'v': 1 / 3},
    # in each phase the start a with the least integral of (a exp(-t) - 1)^2 over 1
    'doses': {'objective': 4 * (1 - 2 * tanh(0.5)), 'd1': LEVEL,
              **{f'd{i}': LEVEL * (1 - exp(-1)) for i in (2, 3, 4)}},
    # Riccati: P = tanh(5 - t), x = cosh(5 - t)/cosh(5)
    'chain_10': CHAIN,
    'chain_50': CHAIN,
    # T + 12/T^3 is least at T^4 = 36
    'chain_shared': {'objective': 4 / 3 * sqrt(6), 'T': sqrt(6)},
    'two_stages': two_stages(),
    'sounding_rocket': sounding_rocket(),
    # 6.75 + 4.5 (a + b) + 3 (a^2 + a b + b^2), the sum of two `hermite`
    'periodic_tour': {'objective': 4.5, 'v0': -0.5, 'v2': -0.5},
    'walker': walker(),
    # each goes and brakes for half the time: T^2/4 and 2 T^2/4 make 10
    'meet_soon': {'objective': sqrt(40 / 3), 'T': sqrt(40 / 3), 'x': 10 / 3},
    # the ceiling binds where the second phase begins
    'ceiling_after_link': {'objective': exp(-1) - 0.0125, 'x': 0.5},
    # speeds k^(-1/3) use up 8 u1^2 + u2^2 = 3
    'two_roads': {'objective': 3, 'T1': 2, 'T2': 1},
    'hohmann': hohmann(),
}
