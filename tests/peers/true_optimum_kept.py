"""More models of tests/classics/switched with friction and switches, for true_optimum_transcription.py."""

from math import pi

import casadi as ca

from true_optimum_model import Model
from true_optimum_models import slide
from true_optimum_switched import given, square, straight, to


def pick(s, below, above):
    """What `match` takes."""
    return (below + above) / 2 + s * (above - below) / 2


def rest_at(d, slip=0):
    """x == d and v == 0, the latter implied by a hold of the surface `slip`."""
    return lambda x, t, p: [(x[0], d, d, None), (x[1], 0, 0, slip)]


def timed(x, t, p):
    """The duration."""
    return t


def road():
    """A rise of 1 from 1 on, a fall of 0.5 from 2 on."""
    return Model(start=lambda p: [0, 0], T=given(5), bounds=[(-10, 10)], cost=square, ends=rest_at(3, 2),
                 rate=lambda t, x, u, s, p: [x[1], u[0] - pick(s[0], 0, 1) + pick(s[1], 0, 1.5) - 0.3 * s[2]],
                 surfaces=lambda t, x, p: [x[0] - 1, x[0] - 2, x[1]], guess=lambda s: slide(s, 3, 5),
                 sequences=['--+ +-+ +++', '--0 --+ +-+ +++', '--+ +-+ +++ ++0', '--+ +-+ +++ ++-'])


def two_pedals():
    def rate(t, x, u, s, p):
        return [x[1], pick(s[0], 5, 3) * u[0] - 5 * u[1]]
    return Model(start=lambda p: [0, 0], T=given(30), bounds=[(0, 1)] * 2, cost=square, rate=rate, ends=to(500, 0),
                 surfaces=lambda t, x, p: [x[1] - 15], guess=lambda s: slide(s, 500, 30),
                 controls=lambda s: [0.2, 0.2],
                 sequences=['-~_ +~_ +_~ -_~', '-~_ +~_ +__ +_~ -_~', '-~_ 0~_ +~_ +_~ -_~'])


def turbo_effort():
    return Model(start=lambda p: [0, 0], T=(1, 60, 20), bounds=[(-5, 5)], ends=to(200, 0), mayer=timed,
                 cost=lambda t, x, u, s, p: 0.1 * u[0]**2, surfaces=lambda t, x, p: [x[1] - 10],
                 rate=lambda t, x, u, s, p: [x[1], pick(s[0], 1, 3) * u[0]], guess=lambda s: slide(s, 200, 20),
                 sequences=['-:4 +:12 -:4', '-^:4 -:2 +:12 -:4', '-^ + -_', '-:4 +:12 0:1 -:4'])


def three_gears():
    def rate(t, x, u, s, p):
        return [x[1], (4 - pick(s[0], 0, 2) - pick(s[1], 0, 1)) * u[0]]
    return Model(start=lambda p: [0, 0], T=(1, 60, 12), bounds=[(-1, 1)], ends=to(80, 0), mayer=timed, rate=rate,
                 surfaces=lambda t, x, p: [x[1] - 4, x[1] - 8], guess=lambda s: slide(s, 80, 12), N=4,
                 sequences=['--^:1 +-^:2 ++^:2 ++_:2 +-_:2 --_:1'])


def three_media():
    def rate(t, x, u, s, p):
        speed = pick(s[0], 1, 2) - pick(s[1], 0, 1.5)
        return [speed * ca.cos(u[0]), speed * ca.sin(u[0])]
    return Model(start=lambda p: [0, 0], T=(1, 20, 5), bounds=[(-4, 4)], guess=straight([0, 0], [3, 3]),
                 ends=to(3, 3),
                 rate=rate, surfaces=lambda t, x, p: [x[1] - 1, x[1] - 2], mayer=timed, controls=lambda s: [0.8],
                 sequences=['-- +- ++', '-- 0- +- ++'])


def lens():
    return Model(start=lambda p: [-2, 0.3], T=(1, 20, 5), bounds=[(-4, 4)], guess=straight([-2, 0.3], [2, -0.2]),
                 rate=lambda t, x, u, s, p: [pick(s[0], 0.75, 1) * f(u[0]) for f in (ca.cos, ca.sin)],
                 surfaces=lambda t, x, p: [x[0]**2 + x[1]**2 - 1], mayer=timed, controls=lambda s: [0.0],
                 ends=to(2, -0.2), sequences=['+ - +', '+ - 0 +', '+ 0 - +'])


def rain_front():
    return Model(start=lambda p: [-1], T=given(3), bounds=[(-5, 5)], guess=straight([-1], [2.5]), ends=to(2.5),
                 rate=lambda t, x, u, s, p: [u[0]], surfaces=lambda t, x, p: [x[0] - 0.5 * t],
                 cost=lambda t, x, u, s, p: u[0]**2 + pick(s[0], 2, 0), sequences=['- +', '- 0 +'])


def roof():
    return Model(start=lambda p: [-1, 0], T=given(3), bounds=[(-5, 5)], cost=square, ends=rest_at(1, 1),
                 rate=lambda t, x, u, s, p: [x[1], u[0] + 0.8 * s[0] - 0.3 * s[1]],
                 surfaces=lambda t, x, p: [x[0], x[1]], guess=lambda s: [2 * s - 1, slide(s, 2, 3)[1]],
                 sequences=['-+ ++', '-0 -+ ++', '-- -+ ++', '-+ ++ +0', '-+ ++ +-'])


def swing_up():
    def guess(*rows):
        return straight(*rows)
    return Model(start=lambda p: [0, 0], T=given(6), bounds=[(-3, 3)], cost=square, ends=rest_at(pi), N=12,
                 rate=lambda t, x, u, s, p: [x[1], -4 * ca.sin(x[0]) + u[0] - 0.2 * s[0]],
                 surfaces=lambda t, x, p: [x[1]],
                 guess=straight([0, 0], [0.5, 0], [-1, 0], [-0.5, 2], [1.5, 0], [0, -2], [-2, 0], [0, 3], [3.1, 0]),
                 sequences=['+ - +', '- +', '0 - +', '- + - +', '+ 0 - +'])


def rougher():
    return Model(start=lambda p: [0, 0], T=given(2), bounds=[(-20, 20)], cost=square, ends=rest_at(1),
                 rate=lambda t, x, u, s, p: [x[1], u[0] - (0.3 + 0.4 * x[0]) * s[0]],
                 surfaces=lambda t, x, p: [x[1]], guess=lambda s: slide(s, 1, 2),
                 sequences=['+', '0 +', '+ 0', '- +'])


def speed_cap_time():
    return Model(start=lambda p: [0, 0], T=(0.5, 10, 3), bounds=[(-2, 2)], mayer=timed, ends=rest_at(2),
                 joined=False,
                 rate=lambda t, x, u, s, p: [x[1], u[0] - 0.5 * s[0]], surfaces=lambda t, x, p: [x[1]], N=4,
                 path=lambda t, x, u, s, p: [0.8 - x[1]], guess=lambda s: slide(s, 2, 3),
                 arcs={'v': (lambda t, x, p: [x[1] - 0.8], lambda t, x, u, s, p: u[0] - 0.5 * s[0])},
                 sequences=['+^ +~&v +_', '+^ +_'])


def bryson_denham_friction():
    rest = {'x': (lambda t, x, p: [x[0] - 0.1, x[1]], lambda t, x, u, s, p: u[0])}
    return Model(start=lambda p: [0, 1], T=given(1), bounds=[(-30, 30)], ends=to(0, -1), joined=False,
                 cost=lambda t, x, u, s, p: u[0]**2 / 2, rate=lambda t, x, u, s, p: [x[1], u[0] - 0.5 * s[0]],
                 surfaces=lambda t, x, p: [x[1]], path=lambda t, x, u, s, p: [0.1 - x[0]], arcs=rest,
                 guess=straight([0, 1], [0.1, 0], [0.1, 0], [0, -1]), sequences=['+ 0 -'])


def furthest():
    return Model(start=lambda p: [0, 0, 0], T=given(2), bounds=[(-3, 3)], mayer=lambda x, t, p: -x[0],
                 ends=lambda x, t, p: [(x[2], -1, 1, None)], guess=straight([0, 0, 0], [1, 0.6, 1]),
                 rate=lambda t, x, u, s, p: [x[1], u[0] - 0.3 * s[0], u[0]**2], surfaces=lambda t, x, p: [x[1]],
                 controls=lambda s: [0.5], sequences=['+', '0 +', '+ 0'])


def curling():
    return Model(start=lambda p: [0, p[0]], T=(1, 20, 4), bounds=[(0, 0.2)], unknowns={'v0': (0.1, 5, 1.1)},
                 rate=lambda t, x, u, s, p: [x[1], -(0.3 - u[0]) * s[0]], surfaces=lambda t, x, p: [x[1]],
                 cost=lambda t, x, u, s, p: 4 * u[0]**2, mayer=lambda x, t, p: p[0]**2, ends=rest_at(2),
                 guess=straight([0, 1.1], [2, 0]), sequences=['+^ +', '+', '+^ + +_', '+ +_'])


def slow_motor():
    return Model(start=lambda p: [0, 0, 0], T=given(2), bounds=[(-6, 6)], cost=square, ends=rest_at(1),
                 rate=lambda t, x, u, s, p: [x[1], 2 * x[2] - 0.8 * s[0], (u[0] - x[2] - 0.3 * x[1]) / 0.5],
                 surfaces=lambda t, x, p: [x[1]], guess=straight([0, 0, 0.4], [0.5, 0.7, 0.7], [1, 0, 0]),
                 sequences=['0:0.3 +', '0:0.3 + 0:0.3', '- 0 +'])


def breakaway():
    return Model(start=lambda p: [0.5, 0], T=given(4), bounds=[(-5, 5)], ends=to(1),
                 cost=lambda t, x, u, s, p: u[0]**2
                 + x[0]**2, rate=lambda t, x, u, s, p: [x[1] - s[0], u[0]], surfaces=lambda t, x, p: [x[0]],
                 guess=straight([0.5, 0], [0, 0.2], [0, 0.8], [1, 2]),
                 sequences=['+ 0 +', '+', '+ - 0 +'])


def free_throw():
    return Model(start=lambda p: [0, p[0]], T=(0.5, 8, 2), bounds=[(-4, 4)], unknowns={'v0': (-2, 4, 1)},
                 rate=lambda t, x, u, s, p: [x[1], u[0] - 0.2 - 0.1 * x[1] - 0.4 * s[0]], cost=square,
                 mayer=lambda x, t, p: t + 0.5 * p[0]**2, surfaces=lambda t, x, p: [x[1]], ends=rest_at(2),
                 guess=straight([0, 1], [2, 0]), sequences=['+', '+ 0', '- +'])


def ratchet():
    return Model(start=lambda p: [0, 0], T=given(4), bounds=[(-6, 6)], cost=square, ends=rest_at(1),
                 rate=lambda t, x, u, s, p: [x[1], u[0] - 1 - pick(s[0], -3, 0.2)], surfaces=lambda t, x, p: [x[1]],
                 guess=lambda s: slide(s, 1, 4), sequences=['+', '+ 0', '0 +'])


def drying_joint():
    return Model(start=lambda p: [0, 0], T=given(3), bounds=[(-10, 10)], cost=square, ends=rest_at(1),
                 rate=lambda t, x, u, s, p: [x[1], u[0] - (0.1 + 0.4 * t) * s[0]], surfaces=lambda t, x, p: [x[1]],
                 guess=lambda s: slide(s, 1, 3), sequences=['+', '+ 0', '0 + 0', '+ 0 +'])


def start_choice():
    return Model(start=lambda p: [p[0], 0], T=given(3), bounds=[(-2, 2)], cost=square, unknowns={'x0': (-3, 0, -1)},
                 rate=lambda t, x, u, s, p: [x[1], u[0] - 0.5 * s[0]], surfaces=lambda t, x, p: [x[1]],
                 mayer=lambda x, t, p: p[0]**2, ends=rest_at(1), guess=lambda s: slide(s, 1, 3),
                 sequences=['+', '+ 0', '0 +'])


def saddle():
    """Which side of a hill to pass by: the reward grows with the distance."""
    return Model(start=lambda p: [0, 0], T=given(4), bounds=[(-3, 3)], ends=lambda x, t, p: [(x[1], 0, 0, None)],
                 rate=lambda t, x, u, s, p: [pick(s[0], 1, 0.5), u[0]], surfaces=lambda t, x, p: [x[0] - 1],
                 cost=lambda t, x, u, s, p: u[0]**2 - 1.2 * x[1]**2, guess=straight([0, 0], [1.5, 5], [2.5, 0]),
                 sequences=['-^:1 +^:1 +:1 +_:1', '-^:1 +^:1 +_:2'])


def to_and_fro():
    """A spring, dry friction, and a mean square of the place; it begins anywhere."""
    return Model(start=lambda p: [0, p[0], 0], T=given(4), bounds=[(-10, 10)], cost=square,
                 unknowns={'v': (-3, 3, 1.5)},
                 rate=lambda t, x, u, s, p: [x[1], u[0] - 0.2 * s[0] - x[0], x[0]**2],
                 surfaces=lambda t, x, p: [x[1]],
                 ends=lambda x, t, p: [(x[0], 0, 0, None), (x[1] - p[0], 0, 0, None), (x[2], 2, 2, None)],
                 guess=straight([0, 1.5, 0], [1, 0, 0.5], [0, -1.5, 1], [-1, 0, 1.5], [0, 1.5, 2]),
                 sequences=['+ - +', '+ 0 - +', '+ - 0 +'])


def dip():
    return Model(start=lambda p: [1.5], T=given(4), bounds=[(-10, 10)], surfaces=lambda t, x, p: [x[0]],
                 rate=lambda t, x, u, s, p: [u[0] - 0.5 * s[0]],
                 guess=lambda s: [0.95 + 0.9 * ca.cos(4 * pi * s)], N=12,
                 cost=lambda t, x, u, s, p: (x[0] - 0.9 - ca.cos(pi * t))**2 + 0.05 * u[0]**2,
                 sequences=['+', '+:1 0:0.1 +:1.9 0:0.1 +:1', '+:1 0:0.1 +:3', '+:3 0:0.1 +:1',
                 '+:1 -:0.1 +:1.9 -:0.1 +:1'])


def stacked_reverse():
    return Model(start=lambda p: [0, 0, 1, 1], T=given(3), bounds=[(-20, 20)], cost=square,
                 surfaces=lambda t, x, p: [x[3] - x[2]],
                 rate=lambda t, x, u, s, p: [x[2], x[3], (u[0] + .8 * s[0]) / 2, -.8 * s[0]], scale=0.1,
                 guess=straight([0, 0, 1, 1], [0.3, 0.5, 0, 0.2], [0.1, 0.3, -.5, -.3], [0, .2, 0, 0]),
                 ends=lambda x, t, p: [(x[0], 0, 0, None), (x[1], .2, .2, None), (x[2], 0, 0, None),
                 (x[3] - x[2], 0, 0, 0)],
                 sequences=['+ 0', '0 + 0', '+:2 0:0.3 -:1', '0:0.2 +:2 -:1', '- + 0', '+ - 0'])


def load_lets_go():
    """In km and min, but for the objective: in m^2/s^3."""
    return Model(start=lambda p: [0, 0, 0, 0], T=given(2.1), bounds=[(-2.84, 2.84)],
                 cost=lambda t, x, u, s, p: u[0]**2 * 1000**2 / 60**3,
                 surfaces=lambda t, x, p: [x[1] - x[3], x[3]], ends=to(0.69, 0),
                 rate=lambda t, x, u, s, p: [x[1], u[0] - 0.87 * s[0], x[3], 0.87 * s[0] - 0.17 * s[1]],
                 guess=straight([0, 0, 0, 0], [0.3, 0.5, 0.2, 0.4], [0.69, 0, 0.6, 0.1]),
                 sequences=['0+ -+', '++ 0+ -+', '++ 0+', '0+ ++ 0+ -+', '0+', '++ 0+ -+ -0', '++ -+'])
