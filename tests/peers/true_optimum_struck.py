"""Models of tests/classics/switched with jumps, for true_optimum_transcription.py."""

import casadi as ca

from true_optimum_kept import timed
from true_optimum_model import Model
from true_optimum_switched import G, given, square, straight, to


def paddle():
    """The paddle's position and speed are the third and fourth state."""
    stroke = {'stroke': (0, lambda t, x, p: [x[0], x[3] - 0.8 * (x[1] - x[3]), x[2], x[3]])}
    return Model(start=lambda p: [1, 0, 0, 0], T=given(1.2), bounds=[(-100, 100)], cost=square, jumps=stroke,
                 rate=lambda t, x, u, s, p: [x[1], -G, x[3], u[0]], surfaces=lambda t, x, p: [x[0] - x[2]],
                 ends=lambda x, t, p: [(x[0], 1.5, 1.5, None), (x[2], 0, 0, None), (x[3], 0, 0, None)], scale=0.1,
                 guess=straight([1, 0, 0, 0], [0.1, -4, 0.1, 1], [1, 3, 0, 0], [1.5, 0, 0, 0]),
                 sequences=['+:0.4 +!stroke:0.8'])


def billiard():
    hit = {'hit': (0, lambda t, x, p: [x[0], x[3], x[2], x[1]])}
    return Model(start=lambda p: [0, 0, 1, 0], T=(1, 10, 4), bounds=[(-5, 5)], cost=square, jumps=hit, mayer=timed,
                 rate=lambda t, x, u, s, p: [x[1], u[0], x[3], -0.5 * s[1]], N=4,
                 surfaces=lambda t, x, p: [x[0] - x[2], x[3]],
                 guess=straight([0, 0, 1, 0], [1, 0.5, 1, 0.5], [1, 0, 2, 0]),
                 ends=lambda x, t, p: [(x[2], 2, 2, None), (x[3], 0, 0, None)], sequences=['-0:2 -+!hit:2'])


def fan():
    jumps = {'off': (0, lambda t, x, p: [x[0], 0]), 'on': (1, lambda t, x, p: [x[0], 1])}
    return Model(start=lambda p: [18, 1], T=given(3), bounds=[(-3, 3)], cost=square, jumps=jumps, ends=to(20.5),
                 rate=lambda t, x, u, s, p: [8 * x[1] + u[0] - 0.3 * (x[0] - 5), 0],
                 surfaces=lambda t, x, p: [x[0] - 21, x[0] - 19], guess=straight([18, 1], [21, 0.5], [20.5, 0]),
                 sequences=['--:0.3 -+:0.6 -+!off:0.5 -+!on:0.5 -+!off:.3', '--:0.3 -+:0.6 -+!off:0.5 -+!on:0.5',
                 '--:0.3 -+:0.6 -+!off:2',
                            '-- -+'])


def doses():
    jumps = {'give': (0, lambda t, x, p: [x[0] + p[0]])}
    return Model(start=lambda p: [2], T=given(2.5), jumps=jumps, cost=lambda t, x, u, s, p: (x[0] - 1.6)**2,
                 rate=lambda t, x, u, s, p: [-x[0]], surfaces=lambda t, x, p: [x[0] - 1],
                 unknowns={'dose': (0.5, 2.5, 1.2)},
                 guess=straight([2], [1], [2], [1]),
                 sequences=['+:0.7 +!give:0.6 +!give:0.6 -:0.5', '+:0.7 +!give:0.8 +!give:0.9'])


def ricochet():
    jumps = {'hit': (0, lambda t, x, p: [x[0], x[1], 0.7 * x[2], -0.6 * x[3]])}
    return Model(start=lambda p: [0, 1, p[0], 0], T=given(1), bounds=[(-20, 20)] * 2, cost=square, jumps=jumps,
                 rate=lambda t, x, u, s, p: [x[2], x[3], u[0], u[1] - G], surfaces=lambda t, x, p: [x[1]],
                 mayer=lambda x, t, p: p[0]**2, unknowns={'vx': (0, 10, 3)}, ends=to(2, 0.8),
                 guess=straight([0, 1, 3, 0], [1, 0.1, 3, -3], [1, 0.1, 2, 3], [2, 0.8, 2, 0]),
                 sequences=['+', '+:0.4 +!hit:0.6'])


def moving_wall():
    jumps = {'hit': (0, lambda t, x, p: [x[0], -0.2 - 0.6 * (x[1] + 0.2)])}
    return Model(start=lambda p: [0, 1.5], T=given(2), bounds=[(-10, 10)], cost=square, jumps=jumps,
                 rate=lambda t, x, u, s, p: [x[1], u[0] - 0.4 * s[1]],
                 surfaces=lambda t, x, p: [x[0] - 1 + 0.2 * t, x[1]],
                 guess=straight([0, 1.5], [0.9, 1], [0.8, -0.6], [0, 0]),
                 ends=lambda x, t, p: [(x[0], 0, 0, None), (x[1], 0, 0, 1)],
                 sequences=['-+:0.6 --!hit:1.4', '-+:0.6 --!hit:1 -0:0.4', '-+:0.6 --', '-+:0.6 -0:0.3 --'])


def pendulum_wall():
    jumps = {'hit': (0, lambda t, x, p: [x[0], -0.7 * x[1]])}
    return Model(start=lambda p: [1, 0], T=given(2), bounds=[(-10, 10)], cost=square, jumps=jumps, ends=to(1, 0),
                 rate=lambda t, x, u, s, p: [x[1], -G * ca.sin(x[0]) + u[0]], surfaces=lambda t, x, p: [x[0]],
                 guess=straight([1, 0], [0.3, -2], [0.5, 1], [0.3, -1], [1, 0]),
                 sequences=['+:0.6 +!hit:0.8 +!hit:0.6', '+ +!hit', '+'])


def ball_on_belt():
    jumps = {'hit': (0, lambda t, x, p: [x[0], x[1], (x[2] + 1) / 2, -0.7 * x[3]])}
    return Model(start=lambda p: [0, 1, 0, 0], T=(0.5, 3, 1.3), bounds=[(-3, 3)], cost=square, jumps=jumps,
                 mayer=timed,
                 rate=lambda t, x, u, s, p: [x[2], x[3], u[0], -G], surfaces=lambda t, x, p: [x[1]],
                 ends=to(1.5, 0.2),
                 guess=straight([0, 1, 0, 0], [0.5, 0.1, 1, -3], [1, 0.5, 1, 0], [1.5, 0.2, 1, -1]),
                 sequences=['+:0.45 +!hit:0.6 +!hit:0.3', '+:0.45 +!hit:0.6 +!hit:0.05'])


def furthest_jump():
    def rate(t, x, u, s, p):
        return [x[2], x[3], u[0], u[1] - G, ca.sumsqr(u)]
    jumps = {'hit': (0, lambda t, x, p: [x[0], x[1], 0.9 * x[2], -0.7 * x[3], x[4]])}
    return Model(start=lambda p: [0, 1, 1, 0, 0], T=given(1.5), bounds=[(-10, 10)] * 2, rate=rate, jumps=jumps,
                 surfaces=lambda t, x, p: [x[1]], mayer=lambda x, t, p: -x[0], controls=lambda s: [2.0, 0.1],
                 ends=lambda x, t, p: [(x[1], 0.1, 9, None), (x[4], -1, 4, None)],
                 guess=straight([0, 1, 1, 0, 0], [1, 0.1, 2, -3, 1], [2, 0.5, 3, 0, 2], [3, 0.1, 3, 2, 4]),
                 sequences=['+:0.45 +!hit:0.65 +!hit:0.4', '+:.45 +!hit:.6 +!hit:.3 +!hit:0.15'])


def slip_then_hit():
    """The surfaces are the seam, the buffer and the slip."""
    def rate(t, x, u, s, p):
        return [x[1], u[0] - (0.75 + 0.25 * s[0]) * s[2]]
    jumps = {'hit': (1, lambda t, x, p: [x[0], -0.6 * x[1]])}
    return Model(start=lambda p: [0, 2], T=(0.5, 6, 3), bounds=[(-3, 3)], cost=square, jumps=jumps, rate=rate,
                 mayer=lambda x, t, p: 0.2 * t, surfaces=lambda t, x, p: [x[0] - 0.5, x[0] - 1, x[1]],
                 ends=lambda x, t, p: [(x[0], 0.2, 0.2, None), (x[1], 0, 0, 2)],
                 guess=straight([0, 2], [0.5, 1.8], [1, 0], [0.5, -1], [0.2, 0]),
                 sequences=['--+:0.3 +-+:0.3 +--!hit:0.6 ---:0.9', '--+:0.3 +-+:0.3 +--!hit:0.6 ---:0.9 --0:0.1',
                 '--+ +-+ +-- ---'])


def hit_and_hold():
    jumps = {'hit': (0, lambda t, x, p: [x[0], -.1 * x[1]])}
    return Model(start=lambda p: [0, 1], T=given(3), bounds=[(-5, 5)], cost=square, jumps=jumps,
                 surfaces=lambda t, x, p: [x[0] - .8, x[1]],
                 rate=lambda t, x, u, s, p: [x[1], u[0] - .3 * s[1]], guess=straight([0, 1], [.8, 0], [0, 0]),
                 ends=lambda x, t, p: [(x[0], 0, 0, None), (x[1], 0, 0, 1)],
                 sequences=['-+:1 --!hit:2', '-+:1 --', '-+:1 -0:.1 --', '-+:1 --!hit:2 -0'])


def jump_cost():
    jumps = {'back': (0, lambda t, x, p: [.5, .5 * x[1], x[2] + 0.1])}
    return Model(start=lambda p: [0, 1, 0], T=given(2), bounds=[(-5, 5)], mayer=lambda x, t, p: x[2],
                 jumps=jumps, surfaces=lambda t, x, p: [x[0] - 1],
                 rate=lambda t, x, u, s, p: [x[1], u[0], u[0]**2],
                 guess=straight([0, 1, 0], [1, .8, 0], [.8, 0, 0.3]), ends=to(.8, 0),
                 sequences=['-', '- -!back', '- -!back -!back'])
