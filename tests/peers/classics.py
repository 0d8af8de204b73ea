#!/usr/bin/env python3
"""The problems of tests/classics once more, for CasADi and IPOPT: same scheme, grid and guess.

It solves all of them, or those that are named, and writes their rows of classics.csv beside this file. That table is by
CasADi 3.8.2 with IPOPT 3.14.19 and MUMPS 5.8.2.
"""

import csv
import sys
from math import cosh, pi
from pathlib import Path

from casadi import cos, exp, log, sin, sqrt
from classics_transcription import INF, Problem, solve


def time_only(x0, xn, p):
    """The objective of a problem of shortest time."""
    return p[0]


def goddard(t, x, u, p):
    h, v, m = x[0], x[1], x[2]
    drag = 310 * v**2 * exp(-500 * (h - 1))
    return [v, (u[0] - drag) / m - 1 / h**2, -u[0] / 0.5]


def glider(t, x, u, p):
    vx, vy, lift = x[2], x[3], u[0]
    r = (x[0] / 100 - 2.5)**2
    rise = vy - 2.5 * (1 - r) * exp(-r)
    push = 0.5 * 14 * 1.13 * sqrt(vx**2 + rise**2) / 100
    drag = 0.034 + 0.069662 * lift**2
    return [vx, vy, -push * (lift * rise + drag * vx), push * (lift * vx - drag * rise) - 9.80665]


def robot(t, x, u, p):
    spread = ((5 - x[0])**3 + x[0]**3) / 3
    return [x[3], x[4], x[5], u[0] / 5, u[1] / (spread * sin(x[2])**2), u[2] / spread]


def catalyst(t, x, u, p):
    a, b, mix = x[0], x[1], u[0]
    return [mix * (10 * b - a), mix * (a - 10 * b) - (1 - mix) * b]


def van_der_pol(t, x, u, p):
    return [x[1], -x[0] + (1 - x[0]**2) * x[1] + u[0]]


def rayleigh(t, x, u, p):
    return [x[1], -x[0] + x[1] * (1.4 - 0.14 * x[1]**2) + 4 * u[0]]


def low_thrust(t, x, u, p):
    r, away, along = x[0], x[1], x[2]
    push = 0.1405 / (1 - 0.0749 * t)
    return [away, along**2 / r - 1 / r**2 + push * sin(u[0]), -away * along / r + push * cos(u[0])]


def crane(t, x, u, p):
    y, swing, vx, vy, w = x[1], x[2], x[3], x[4], x[5]
    return [vx, vy, w, u[0] + 17.2656 * swing, u[1], -(u[0] + 27.0756 * swing + 2 * vy * w) / y]


def mass(t, x, u, p):
    return [x[1], u[0]]


def batch(t, x, u, p):
    forward, onward = 4000 * exp(-2.5 / u[0]), 620000 * exp(-5 / u[0])
    return [-forward * x[0]**2, forward * x[0]**2 - onward * x[1]]


def tank(t, x, u, p):
    heat = (x[1] + 0.5) * exp(25 * x[0] / (x[0] + 2))
    return [-(2 + u[0]) * (x[0] + 0.25) + heat, 0.5 - x[1] - heat]


def fed_batch(t, x, u, p):
    secreted, protein, cells, sugar, volume = (x[i] for i in range(5))
    grow = 21.87 * sugar / ((sugar + 0.4) * (sugar + 62.5))
    express = sugar / (0.1 + sugar) * exp(-5 * sugar)
    secrete = 4.75 * grow / (0.12 + grow)
    dilute = u[0] / volume
    return [secrete * (protein - secreted) - dilute * secreted, express * cells - dilute * protein,
            (grow - dilute) * cells, -7.3 * grow * cells + dilute * (20 - sugar), u[0]]


def alps(t, x, u, p):
    a, b, c, d = (x[i] for i in range(4))
    return [-10 * a + u[0] + u[1], -2 * b + u[0] + 2 * u[1], -3 * c + 5 * d + u[0] - u[1], 5 * c - 3 * d + u[0] + 3 * u[1]]


def height(x):
    return x[0]**2 + x[1]**2 + x[2]**2 + x[3]**2


def valley(t):
    return sum(w * exp(-b * (t - a)**2) for w, a, b in ((3, 3, 12), (3, 6, 10), (3, 10, 6), (8, 15, 4))) + 0.01


def flying(t, x, u, p):
    one, two = u[0] - u[1], u[2] - u[3]
    return [x[2], x[3], (one + two) * cos(x[4]), (one + two) * sin(x[4]), x[5], 0.2 * (one - two)]


def cart_pole(t, x, u, p):
    angle, w = x[1], x[3]
    heavy, spin = 1 + 0.3 * sin(angle)**2, 0.5 * 0.3 * sin(angle) * w**2
    return [x[2], w, (spin + u[0] + 0.3 * 9.81 * cos(angle) * sin(angle)) / heavy,
            -(spin * cos(angle) + u[0] * cos(angle) + 1.3 * 9.81 * sin(angle)) / (0.5 * heavy)]


def two_link(t, x, u, p):
    upper, lower, elbow = x[0], x[1], x[2]
    inertia = 31 / 36 + 9 / 4 * sin(elbow)**2
    return [
        (sin(elbow) * (9 / 4 * cos(elbow) * upper**2 + 2 * lower**2) + 4 / 3 * (u[0] - u[1]) - 1.5 * cos(elbow) * u[1])
        / inertia,
        -(sin(elbow) * (7 / 2 * upper**2 + 9 / 4 * cos(elbow) * lower**2) - 7 / 3 * u[1]
          + 1.5 * cos(elbow) * (u[0] - u[1])) / inertia,
        lower - upper, upper]


LIMIT = 0.00873 * 10000**(2 / 3)
FULL = ((5.85 - 0.02) / LIMIT)**1.5


def tumor(t, x, u, p):
    return [-0.084 * x[0] * log(x[0] / x[1]), x[1] * (5.85 - (0.02 + LIMIT * x[0]**(2 / 3) + 0.15 * u[0])), u[0]]


def fishing(t, x, u, p):
    return [x[0] - x[0] * x[1] - 0.4 * x[0] * u[0], -x[1] + x[0] * x[1] - 0.2 * x[1] * u[0]]


def jackson(t, x, u, p):
    forth, onward = u[0] * (x[0] - 10 * x[1]), (1 - u[0]) * x[1]
    return [-forth, forth - onward, onward]


def shuttle(t, x, u, p):
    h, latitude, v, gamma, psi, alpha, beta = x[0], x[2], x[3], x[4], x[5], u[0], u[1]
    r, degrees = 209.029 + h, 180 / pi * alpha
    g = 0.14076539e17 / (1e10 * r**2)
    push = 0.5 * 0.002378 * exp(-h / 0.238) * (1e4 * v)**2 * 2690 / (203000 / 32.174)
    lift = push * (-0.20704 + 0.029244 * degrees)
    drag = push * (0.07854 - 0.61592e-2 * degrees + 0.621408e-3 * degrees**2)
    return [0.1 * v * sin(gamma), 0.1 * v / r * cos(gamma) * sin(psi) / cos(latitude),
            0.1 * v / r * cos(gamma) * cos(psi), 1e-4 * (-drag - g * sin(gamma)),
            lift / (1e4 * v) * cos(beta) + cos(gamma) * (0.1 * v / r - g / (1e4 * v)),
            lift / (1e4 * v * cos(gamma)) * sin(beta) + 0.1 * v / (r * cos(latitude)) * cos(gamma) * sin(psi) * sin(latitude)]


SQUARES = lambda t, x, u, p: (x[0]**2 + x[1]**2) / 2

PROBLEMS = {
    'goddard': Problem(
        [1, 0, 1], goddard, [(0, 3.5)], N=400, unknowns=[(0.01, 1, 0.5)], end={2: 0.6}, maximize=True,
        state_bounds={0: (0.9, 2), 1: (-0.1, 1), 2: (0.5, 1.1)}, mayer=lambda a, b, p: b[0],
        guess=lambda s, T: {1: s * (1 - s)}),
    'hang_glider': Problem(
        [0, 1000, 13.2275675, -1.28750052], glider, [(0, 1.4)], N=400, unknowns=[(10, 200, 100)], maximize=True,
        state_bounds={0: (0, 1500), 1: (500, 1100), 2: (0, 40), 3: (-10, 10)}, mayer=lambda a, b, p: b[0],
        end={1: 900, 2: 13.2275675, 3: -1.28750052}, guess=lambda s, T: {0: 1250 * s}),
    'particle_steering': Problem(
        [0, 0, 0, 0], lambda t, x, u, p: [x[2], x[3], 100 * cos(u[0]), 100 * sin(u[0])], [(-pi / 2, pi / 2)],
        unknowns=[(0.1, 10, 1)], end={1: 5, 2: 45, 3: 0}, mayer=time_only),
    'robot_arm': Problem(
        [4.5, 0, pi / 4, 0, 0, 0], robot, [(-1, 1)] * 3, unknowns=[(0.1, 20, 1)], mayer=time_only,
        end={0: 4.5, 1: 2 * pi / 3, 2: pi / 4, 3: 0, 4: 0, 5: 0}, state_bounds={0: (0, 5), 1: (-pi, pi), 2: (0, pi)}),
    'catalyst_mixing': Problem(
        [1, 0], catalyst, [(0, 1)], N=400, duration=1, mayer=lambda a, b, p: 1 - b[0] - b[1], maximize=True),
    'van_der_pol': Problem(
        [1, 0], van_der_pol, [(-10, 10)], N=400, duration=5, ends=lambda a, b, p: [(b[1] - b[0], 1, 1)],
        cost=lambda t, x, u, p: (x[0]**2 + x[1]**2 + u[0]**2) / 2),
    'van_der_pol_singular': Problem([0, 1], van_der_pol, [(-1, 1)], N=400, duration=4, cost=SQUARES),
    'rayleigh': Problem(
        [-5, -5], rayleigh, [(-20, 20)], N=400, duration=2.5, cost=lambda t, x, u, p: x[0]**2 + u[0]**2),
    'brachistochrone': Problem(
        [0, 10, 0], lambda t, x, u, p: [x[2] * sin(u[0]), -x[2] * cos(u[0]), 9.80665 * cos(u[0])], [(0.01, 3.13)],
        unknowns=[(0.5, 10, 2)], end={0: 10, 1: 5}, mayer=time_only, guess=lambda s, T: {2: 5 * s * T},
        guess_control=lambda s, T: [1.6]),
    'moon_lander': Problem(
        [10, -2], lambda t, x, u, p: [x[1], u[0] - 1.5], [(0, 3)], unknowns=[(1, 20, 4)], end={0: 0, 1: 0},
        state_bounds={0: (0, 20), 1: (-20, 5)}, cost=lambda t, x, u, p: u[0]),
    'low_thrust': Problem(
        [1, 0, 1], low_thrust, [(-pi, 2 * pi)], N=300, duration=3.3207, end={1: 0}, maximize=True,
        ends=lambda a, b, p: [(b[2] * sqrt(b[0]), 1, 1)], state_bounds={0: (0.5, 3), 2: (0.1, 3)},
        mayer=lambda a, b, p: b[0], guess_control=lambda s, T: [0.8 if s * T <= 1.66 else 4.6]),
    'container_crane': Problem(
        [0, 22, 0, 0, -1, 0], crane, [(-2.83374, 2.83374), (-0.80865, 0.71265)], duration=9,
        state_bounds={1: (10, 30), 3: (-2.5, 2.5), 4: (-1, 1)}, end={0: 10, 1: 14, 2: 0, 3: 2.5, 4: 0, 5: 0},
        cost=lambda t, x, u, p: (x[2]**2 + x[5]**2 + 0.01 * (u[0]**2 + u[1]**2)) / 2),
    'breakwell': Problem(
        [0, 1], mass, [(-20, 20)], duration=1, state_bounds={0: (-1, 0.1)}, end={0: 0, 1: -1},
        cost=lambda t, x, u, p: u[0]**2 / 2),
    'bryson_denham': Problem(
        [0, 1, 0], lambda t, x, u, p: [x[1], u[0], u[0]**2 / 2], [(-30, 30)], duration=1, end={0: 0, 1: -1},
        path=lambda t, x, u, p: [x[0]], path_bounds=[(-INF, 1 / 9)], mayer=lambda a, b, p: b[2]),
    'min_time': Problem([0, 0], mass, [(-1, 1)], N=100, unknowns=[(0.1, 10, 3)], end={0: 1, 1: 0}, mayer=time_only),
    'min_fuel': Problem(
        [0, 0], lambda t, x, u, p: [x[1], u[0] - u[1]], [(0, 1)] * 2, duration=3, end={0: 1, 1: 0},
        cost=lambda t, x, u, p: u[0] + u[1]),
    'hypersensitive': Problem(
        [1.5], lambda t, x, u, p: [-x[0]**3 + u[0]], [(-10, 10)], N=1000, duration=40, end={0: 1},
        cost=lambda t, x, u, p: (x[0]**2 + u[0]**2) / 2),
    'bang_bang': Problem(
        [0, 0], mass, [(-2, 1)], unknowns=[(1, 100, 40)], end={0: 300, 1: 0}, mayer=time_only,
        state_bounds={0: (-10, 300), 1: (-1, 30)}, guess_control=lambda s, T: [-0.5]),
    'batch_reactor': Problem([1, 0], batch, [(0.298, 0.398)], duration=1, mayer=lambda a, b, p: b[1], maximize=True),
    'parallel_reactions': Problem(
        [1, 0], lambda t, x, u, p: [-(u[0] + 0.5 * u[0]**2) * x[0], u[0] * x[0]], [(0, 5)], duration=1,
        mayer=lambda a, b, p: b[1], maximize=True),
    'stirred_tank': Problem(
        [0.09, 0.09], tank, [(0, 5)], duration=0.78, state_bounds={0: (-1, 1), 1: (-1, 1)},
        cost=lambda t, x, u, p: x[0]**2 + x[1]**2 + 0.1 * u[0]**2, guess_control=lambda s, T: [0.5]),
    'fed_batch': Problem(
        [0, 0, 1, 5, 1], fed_batch, [(0, 2)], N=300, duration=15, state_bounds={3: (0, 20), 4: (0.5, 15)},
        mayer=lambda a, b, p: b[0] * b[4], maximize=True, guess_control=lambda s, T: [0.5]),
    'alp_rider': Problem(
        [2, 1, 2, 1], alps, [(-500, 500)] * 2, N=4000, scheme='trapezoid', duration=20, end={0: 2, 1: 3, 2: 1, 3: -2},
        path=lambda t, x, u, p: [height(x) - valley(t)], path_bounds=[(0, INF)],
        cost=lambda t, x, u, p: 100 * height(x) + 0.01 * (u[0]**2 + u[1]**2)),
    'hanging_chain': Problem(
        [1], lambda t, x, u, p: [u[0]], [(-100, 100)], N=400, duration=1, end={0: 3},
        integrals=lambda t, x, u, p: [sqrt(1 + u[0]**2)], integral_values=[4],
        cost=lambda t, x, u, p: x[0] * sqrt(1 + u[0]**2), guess=lambda s, T: {0: 1 - 4 * s + 6 * s**2},
        guess_control=lambda s, T: [-4 + 12 * s]),
    'isoperimetric': Problem(
        [1], lambda t, x, u, p: [-sin(x[0]) + u[0]], [(-4, 4)], duration=1, end={0: 0}, state_bounds={0: (-10, 10)},
        integrals=lambda t, x, u, p: [u[0]**2], integral_values=[10], cost=lambda t, x, u, p: x[0],
        guess_control=lambda s, T: [-1]),
    'free_flying_robot': Problem(
        [-10, -10, 0, 0, pi / 2, 0], flying, [(0, 1)] * 4, duration=12, end={i: 0 for i in range(6)},
        path=lambda t, x, u, p: [u[0] + u[1], u[2] + u[3]], path_bounds=[(-INF, 1)] * 2,
        cost=lambda t, x, u, p: u[0] + u[1] + u[2] + u[3]),
    'aly_chan': Problem(
        [0, 1], mass, [(-1, 1)], N=100, duration=pi / 2, cost=lambda t, x, u, p: (x[1]**2 - x[0]**2) / 2),
    'jacobson': Problem([0, 1], mass, [(-1, 1)], duration=5, cost=SQUARES),
    'cart_pole': Problem(
        [0, 0, 0, 0], cart_pole, [(-20, 20)], duration=2, state_bounds={0: (-2, 2)}, end={0: 1, 1: pi, 2: 0, 3: 0},
        cost=lambda t, x, u, p: u[0]**2),
    'zermelo': Problem(
        [3.66, -1.86], lambda t, x, u, p: [cos(u[0]) - x[1], sin(u[0])], [(-2 * pi, 2 * pi)], unknowns=[(1, 20, 6)],
        end={0: 0, 1: 0}, mayer=time_only, guess_control=lambda s, T: [2]),
    'obstacle_avoidance': Problem(
        [0, 0], lambda t, x, u, p: [2.138 * cos(u[0]), 2.138 * sin(u[0])], [(-10, 10)], N=100, duration=1,
        state_bounds={0: (0, 2), 1: (0, 2)}, end={0: 1.2, 1: 1.6}, guess_control=lambda s, T: [0.9],
        path=lambda t, x, u, p: [(x[0] - 0.4)**2 + (x[1] - 0.5)**2, (x[0] - 0.8)**2 + (x[1] - 1.5)**2],
        path_bounds=[(0.1, INF)] * 2, cost=lambda t, x, u, p: 2.138**2 * (cos(u[0])**2 + sin(u[0])**2)),
    'two_link_arm': Problem(
        [0, 0, 0.5, 0], two_link, [(-1, 1)] * 2, unknowns=[(0.5, 10, 3)], end={0: 0, 1: 0, 2: 0.5, 3: 0.522},
        mayer=time_only),
    'dubins': Problem(
        [0, 0, pi / 2], lambda t, x, u, p: [cos(x[2]), sin(x[2]), u[0]], [(-1, 1)], unknowns=[(1, 20, 5)],
        end={0: 3, 1: 0, 2: -pi / 2}, mayer=time_only),
    'oscillator': Problem(
        [4, 0], lambda t, x, u, p: [x[1], -x[0] + u[0]], [(-1, 1)], unknowns=[(1, 20, 5)], end={0: 0, 1: 0},
        mayer=time_only),
    'soap_film': Problem(
        [cosh(0.5)], lambda t, x, u, p: [u[0]], [(-10, 10)], duration=1, end={0: cosh(0.5)},
        state_bounds={0: (0.1, 5)}, cost=lambda t, x, u, p: x[0] * sqrt(1 + u[0]**2)),
    'tumor': Problem(
        [FULL / 2, FULL / 4, 0], tumor, [(0, 75)], unknowns=[(0.1, 10, 1)], mayer=lambda a, b, p: b[0],
        state_bounds={0: (0.001, 3), 1: (0.001, 3), 2: (0, 15)}),
    'fishing': Problem(
        [0.5, 0.7], fishing, [(0, 1)], N=300, duration=12, guess=lambda s, T: {0: 1, 1: 1},
        cost=lambda t, x, u, p: (x[0] - 1)**2 + (x[1] - 1)**2),
    'mountain_car': Problem(
        [-0.5, 0], lambda t, x, u, p: [x[1], 0.001 * u[0] - 0.0025 * cos(3 * x[0])], [(-1, 1)], N=300,
        unknowns=[(10, 500, 100)], end={0: 0.5}, ends=lambda a, b, p: [(b[1], 0, INF)], mayer=time_only,
        state_bounds={0: (-1.2, 0.5), 1: (-0.07, 0.07)}),
    'jackson': Problem([1, 0, 0], jackson, [(0, 1)], duration=4, mayer=lambda a, b, p: b[2], maximize=True),
    'dielectrophoretic': Problem(
        [1, 0], lambda t, x, u, p: [x[1] * u[0] - 0.75 * u[0]**2, -x[1] + u[0]], [(-1, 1)], N=300,
        unknowns=[(1, 30, 5)], end={0: 2}, mayer=time_only, guess_control=lambda s, T: [0.1]),
    'shuttle': Problem(
        [2.6, 0, 0, 2.56, -pi / 180, pi / 2], shuttle, [(-pi / 2, pi / 2), (-pi / 2, 0.01)],
        unknowns=[(500, 4000, 2000)], end={0: 0.8, 3: 0.25, 4: -5 * pi / 180}, maximize=True,
        state_bounds={0: (0, 3), 2: (-1.5, 1.5), 3: (0.01, 3), 4: (-1.5, 1.5)},
        mayer=lambda a, b, p: 180 / pi * b[2], guess_control=lambda s, T: [0.3, -0.8]),
}


TABLE = Path(__file__).with_suffix('.csv')
HEAD = ['problem', 'status', 'objective', 'iterations']


def known():
    """The rows of the table as it stands."""
    if not TABLE.exists():
        return {}
    with open(TABLE, newline='') as file:
        return {row[0]: row for row in list(csv.reader(file))[1:]}


def main(names):
    """Solves and writes."""
    rows = known()
    for name in names or PROBLEMS:
        status, objective, iterations = solve(PROBLEMS[name], verbose='--verbose' in sys.argv)
        rows[name] = [name, status, repr(objective), iterations]
        print(*rows[name], flush=True)
    with open(TABLE, 'w', newline='') as file:
        csv.writer(file, lineterminator='\n').writerows([HEAD, *(rows[name] for name in sorted(rows))])


if __name__ == '__main__':
    main([name for name in sys.argv[1:] if name != '--verbose'])
