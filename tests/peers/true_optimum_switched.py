"""The models of tests/classics/switched for true_optimum_transcription.py, as far as it is asked about them."""

import casadi as ca
import numpy as np

from true_optimum_models import slide
from true_optimum_model import Model

G = 9.81


def straight(*points):
    """A guess: straight from row to row."""
    at = np.linspace(0, 1, len(points))
    return lambda s: [float(np.interp(s, at, column)) for column in zip(*points)]


def to(*goal):
    """The end, state by state; None where it is open."""
    return lambda x, t, p: [(x[i], v, v, None) for i, v in enumerate(goal) if v is not None]


def given(T):
    """A given duration."""
    return (T, T, T)


def square(t, x, u, s, p):
    return ca.sumsqr(u)


def at_rest(x, t, p):
    """x == 1 and v == 0."""
    return [(x[0], 1, 1, None), (x[1], 0, 0, 0)]


def turn_round():
    return Model(start=lambda p: [0, -1], T=given(3), bounds=[(-10, 10)], cost=square, ends=at_rest,
                 rate=lambda t, x, u, s, p: [x[1], u[0] - 0.5 * s[0]], surfaces=lambda t, x, p: [x[1]],
                 guess=straight([0, -1], [0.2, 0.5], [1, 0]), sequences=['- +', '- 0 +', '- + 0', '- 0 + 0'])


def two_contacts():
    """A load is thrown on a sled: friction of 3 on the floor, of 1 under the load."""
    return Model(start=lambda p: [0, 0, 0, 1], T=given(2), bounds=[(-40, 40)], cost=square, scale=1e-2,
                 rate=lambda t, x, u, s, p: [x[2], x[3], (u[0] - 3 * s[0] + s[1]) / 2, -s[1]],
                 surfaces=lambda t, x, p: [x[2], x[3] - x[2]], guess=straight([0, 0, 0, 1], [0.3, 0.6, 0.6, 0.7],
                                                                           [0.6, 1, 0, 0]),
                 ends=lambda x, t, p: [(x[1], 0.9, 0.9, None), (x[2], 0, 0, 0), (x[3] - x[2], 0, 0, 1)],
                 sequences=['0+ ++ +0', '0+ ++ +0 00', '++ +0', '++ +0 00', '0+ ++ +0 ++ 0+', '++ +0 ++ 0+',
                            '++ +0 ++ 0+ 00', '0+ ++ 0+ 00', '++ +0 ++', '++ +0 00 +0'])


def relay():
    return Model(start=lambda p: [1], T=given(2), bounds=[(-0.5, 0.5)], rate=lambda t, x, u, s, p: [u[0] - s[0]],
                 surfaces=lambda t, x, p: [x[0]], cost=lambda t, x, u, s, p: x[0]**2 + u[0]**2,
                 guess=straight([1], [0], [0]), sequences=['+ 0', '+', '+ 0 -', '+ 0 +', '+ -'])


def puck_aside():
    return Model(start=lambda p: [0, 0, 1, 0], T=given(2), bounds=[(-10, 10)] * 2, cost=square,
                 rate=lambda t, x, u, s, p: [x[2], x[3], u[0] - 0.5 * s[0][0], u[1] - 0.5 * s[0][1]],
                 surfaces=lambda t, x, p: [[x[2], x[3]]],
                 guess=straight([0, 0, 1, 0], [0.3, 0.5, 0, 0.7], [0, 1, 0, 0]),
                 ends=lambda x, t, p: [(x[0], 0, 0, None), (x[1], 1, 1, None), (x[2], 0, 0, 0), (x[3], 0, 0, 0)],
                 sequences=['+', '+ 0', '+ 0 +', '+ 0 + 0'])


def window():
    """Above 1 it loses twice as much."""
    return Model(start=lambda p: [0], T=given(2), bounds=[(0, 10)], cost=square, ends=to(1.5),
                 guess=straight([0], [1.5]),
                 rate=lambda t, x, u, s, p: [u[0] - x[0] * (3 + s[0]) / 2], surfaces=lambda t, x, p: [x[0] - 1],
                 sequences=['- +', '- 0 +', '- + - +'])


def drag_regimes():
    def rate(t, x, u, s, p):
        return [x[1], u[0] - (1 - s[0]) / 2 * x[1] - (1 + s[0]) / 2 * x[1]**2]
    return Model(start=lambda p: [0, 0], T=given(4), bounds=[(-10, 10)], rate=rate, cost=square, ends=to(4, 0),
                 surfaces=lambda t, x, p: [x[1] - 1], guess=lambda s: slide(s, 4, 4),
                 sequences=['- + -', '-', '- 0 -', '- + 0 -', '- 0 + -'])


def cart_pole_friction():
    def rate(t, x, u, s, p):
        sin, cos = ca.sin(x[1]), ca.cos(x[1])
        a = (u[0] - 0.4 * s[0] + 0.2 * sin * (0.5 * x[3]**2 - G * cos)) / (1 + 0.2 * sin**2)
        return [x[2], x[3], a, (G * sin - a * cos) / 0.5]
    return Model(start=lambda p: [0] * 4, T=given(2), bounds=[(-20, 20)], rate=rate, cost=square,
                 surfaces=lambda t, x, p: [x[2]], N=16,
                 guess=lambda s: [slide(s, 0.5, 2)[0], 0, slide(s, 0.5, 2)[1], 0],
                 ends=lambda x, t, p: [(x[0], 0.5, 0.5, None), (x[1], 0, 0, None), (x[2], 0, 0, 0), (x[3], 0, 0, None)],
                 sequences=['-:0.2 +:1.6 -:0.2', '-:0.2 +:1.8', '+', '+:1.8 -:0.2', '0:0.1 -:0.2 +:1.6 -:0.2',
                            '-:0.2 0:0.05 +:1.6 -:0.2', '-:0.2 +:1.6 0:0.05 -:0.2'])


def two_relays():
    return Model(start=lambda p: [1, 1], T=given(3), bounds=[(-1, 1)], guess=straight([1, 1], [0, 0.2], [0, 0]),
                 rate=lambda t, x, u, s, p: [u[0] - 2 * s[0] - 0.25 * s[1], u[0] / 2 - s[1] + 0.25 * s[0]],
                 surfaces=lambda t, x, p: [x[0], x[1]],
                 cost=lambda t, x, u, s, p: x[0]**2 + x[1]**2 + u[0]**2,
                 sequences=['++ 0+ 00', '++ +0 00', '++ 0+', '++ 00', '++ -+ 0+ 00', '++ -+ -0 00', '++ -+ -- 00'])


def belt():
    """A belt that gains speed: v = t; below it friction pulls along."""
    return Model(start=lambda p: [0, 0.5], T=given(2), bounds=[(-10, 10)], cost=square, ends=to(2.5, 1),
                 rate=lambda t, x, u, s, p: [x[1], u[0] - 0.6 * s[0]], surfaces=lambda t, x, p: [x[1] - t],
                 guess=straight([0, 0.5], [2.5, 1]),
                 sequences=['+ -', '+ 0 -', '+ - 0', '+ 0', '+', '+ - 0 -', '+ - +'])


def wall():
    """The surfaces are the wall and the slip; the stroke turns the slip round."""
    hit = {'hit': (0, lambda t, x, p: [x[0], -0.5 * x[1]])}
    return Model(start=lambda p: [0, 3], T=given(2), bounds=[(-10, 10)], cost=square, jumps=hit,
                 rate=lambda t, x, u, s, p: [x[1], u[0] - 0.5 * s[1]], surfaces=lambda t, x, p: [x[0] - 1, x[1]],
                 guess=straight([0, 3], [0.9, -1], [0, 0]),
                 ends=lambda x, t, p: [(x[0], 0, 0, None), (x[1], 0, 0, 1)],
                 sequences=['-+:0.4 --!hit:1.6', '-+:0.4 --!hit:1.4 -0', '-+ --', '-+:0.4 --!hit:0.1 -0:0.1 --:1.2',
                            '-+ -0 --', '-+:0.4 --!hit:1.4 -+:0.1', '-+ -- -0'])


def shoreline():
    """Half as fast below y = 1."""
    return Model(start=lambda p: [0, 0], T=(1, 10, 2), bounds=[(-4, 4)], guess=straight([0, 0], [2, 2]), ends=to(2, 2),
                 rate=lambda t, x, u, s, p: [(3 + s[0]) / 2 * f(u[0]) for f in (ca.cos, ca.sin)],
                 surfaces=lambda t, x, p: [x[1] - 1], mayer=lambda x, t, p: t, controls=lambda s: [0.8],
                 sequences=['- +', '- 0 +', '- + - +'])


def toll():
    return Model(start=lambda p: [0, 0], T=given(3), bounds=[(-5, 5)], guess=straight([0, 0], [2, 6]), ends=to(2),
                 rate=lambda t, x, u, s, p: [u[0], u[0]**2 + 2 + s[0]], surfaces=lambda t, x, p: [x[0] - 1],
                 mayer=lambda x, t, p: x[1], sequences=['- +', '- 0 +', '- + - +'])


def ridge():
    return Model(start=lambda p: [-0.5], T=given(2), bounds=[(-3, 3)], guess=straight([-0.5], [0], [1]), ends=to(1),
                 rate=lambda t, x, u, s, p: [u[0] + 0.5 * s[0]], surfaces=lambda t, x, p: [x[0]], cost=square,
                 controls=lambda s: [1.0], sequences=['- +', '- 0 +', '-:0.5 +'])


def speed_limit():
    limit = {'v': (lambda t, x, p: [x[1] - 0.45], lambda t, x, u, s, p: u[0] - 0.5 * s[0])}
    return Model(start=lambda p: [0, 0], T=given(3), bounds=[(-10, 10)], cost=square, ends=at_rest, arcs=limit,
                 rate=lambda t, x, u, s, p: [x[1], u[0] - 0.5 * s[0]], surfaces=lambda t, x, p: [x[1]],
                 guess=lambda s: slide(s, 1, 3), path=lambda t, x, u, s, p: [0.45 - x[1]],
                 sequences=['0 + +~&v +', '+ +~&v +', '+'])


def free_time():
    return Model(start=lambda p: [0, 0], T=(0.5, 10, 3), bounds=[(-10, 10)], ends=at_rest,
                 cost=lambda t, x, u, s, p: u[0]**2 / 2, mayer=lambda x, t, p: t, surfaces=lambda t, x, p: [x[1]],
                 rate=lambda t, x, u, s, p: [x[1], u[0] - 0.5 * s[0]], guess=lambda s: slide(s, 1, 3),
                 sequences=['+', '+ 0', '0 +'])


def uphill_soon():
    return Model(start=lambda p: [0, 0], T=(0.5, 10, 2), bounds=[(-3, 3)], mayer=lambda x, t, p: t,
                 rate=lambda t, x, u, s, p: [x[1], u[0] - 1 - 0.5 * s[0]], surfaces=lambda t, x, p: [x[1]],
                 ends=lambda x, t, p: [(x[0], 2, 2, None), (x[1], 0, 0, 0)], guess=lambda s: slide(s, 2, 2),
                 sequences=['+^ +_', '+^ +_ 0', '0 +^ +_', '-_ +^ +_'])


def overdrive():
    return Model(start=lambda p: [0], T=(0.5, 10, 2), bounds=[(0, 1)], mayer=lambda x, t, p: t, ends=to(5),
                 rate=lambda t, x, u, s, p: [u[0] * ((1 - s[0]) + (1 + s[0]) / 2 * (3 - x[0] / 4))],
                 surfaces=lambda t, x, p: [x[0] - 2], guess=straight([0], [5]), sequences=['-^ +^', '-^ 0 +^', '- +'])


def twins():
    return Model(start=lambda p: [-1, -1], T=given(1.5), bounds=[(-5, 5)] * 2, cost=square, ends=to(1, 1),
                 rate=lambda t, x, u, s, p: [u[0] + (1 - s[0]) / 2, u[1] + (1 - s[1]) / 2],
                 surfaces=lambda t, x, p: [x[0], x[1]], guess=straight([-1, -1], [1, 1]),
                 sequences=['-- ++', '-- +- ++', '-- -+ ++', '-- 00 ++'])
