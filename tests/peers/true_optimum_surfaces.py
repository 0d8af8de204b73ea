"""Models of tests/classics/switched with several surfaces at once or `Dir`, for true_optimum_transcription.py."""

import casadi as ca

from true_optimum_kept import pick
from true_optimum_model import Model
from true_optimum_switched import given, square, straight, to


def symmetric_relays():
    return Model(start=lambda p: [1, 1], T=given(2), bounds=[(-0.8, 0.8)], surfaces=lambda t, x, p: [x[0], x[1]],
                 rate=lambda t, x, u, s, p: [u[0] - s[0], -u[0] - s[1]], guess=straight([1, 1], [0, 0.2], [0, 0]),
                 cost=lambda t, x, u, s, p: u[0]**2 + 4 * x[0] * x[1],
                 sequences=['++ 0+ 00', '++ 00', '++ +0 00'])


def three_relays():
    return Model(start=lambda p: [1, 0.8, 0.9], T=given(3), bounds=[(-0.4, 0.4)],
                 surfaces=lambda t, x, p: [x[0], x[1], x[2]],
                 rate=lambda t, x, u, s, p: [u[0] - s[0] - .2 * s[1], -u[0] - s[1] - .2 * s[2],
                 u[0] / 2 - s[2] - .2 * s[0]],
                 guess=straight([1, .8, .9], [0.2, 0, 0.1], [0, 0, 0]),
                 cost=lambda t, x, u, s, p: ca.sumsqr(x) + u[0]**2,
                 sequences=['+++ +0+ +00 000', '+++ ++0 +00 000', '+++ +00 000', '+++ ++0 0+0 000'])


def both_curves():
    return Model(start=lambda p: [1.5, 1, 0], T=given(3), bounds=[(-4, 4)],
                 surfaces=lambda t, x, p: [x[0] + .3 * x[1]**2, x[1] - .1 * x[0]],
                 rate=lambda t, x, u, s, p: [x[2] - s[0], .5 * x[2] - s[1], u[0]], N=12, scale=1,
                 guess=straight([1.5, 1, 0], [0.3, 0.1, 0], [0, 0, 0]),
                 ends=lambda x, t, p: [(x[0], 0, 0, 0), (x[1], 0, 0, 1)],
                 cost=lambda t, x, u, s, p: x[2]**2 + .05 * u[0]**2 + .3 * x[0]**2,
                 sequences=['++ +0 00', '++ +- +0 00'])


def conveyor():
    """The speed of the conveyor is 0.3 + t/2."""
    def rate(t, x, u, s, p):
        return [x[2], x[3], u[0] - 0.5 * s[0][0], u[1] - 0.5 * s[0][1]]
    return Model(start=lambda p: [0, 0, 0, 0.2], T=given(2), bounds=[(-10, 10)] * 2, cost=square, rate=rate,
                 surfaces=lambda t, x, p: [[x[2] - 0.3 - 0.5 * t, x[3]]], ends=to(1.2, 1, 0, 0),
                 guess=straight([0, 0, 0, 0.2], [0.6, 0.5, 0.8, 0.7], [1.2, 1, 0, 0]),
                 sequences=['+', '0 +', '+ 0 +'])


def ice_patch():
    """Rough for x < 0.5, smooth behind."""
    def rate(t, x, u, s, p):
        grip = pick(s[1], 0.8, 0.1)
        return [x[2], x[3], u[0] - grip * s[0][0], u[1] - grip * s[0][1]]
    return Model(start=lambda p: [0, 0, 0, 1], T=given(2), bounds=[(-10, 10)] * 2, cost=square, rate=rate,
                 surfaces=lambda t, x, p: [[x[2], x[3]], x[0] - 0.5], ends=to(1, 0.5, 0.5, 0),
                 guess=straight([0, 0, 0, 1], [0.5, 0.5, 0.6, 0.3], [1, 0.5, 0.5, 0]),
                 sequences=['+- ++', '+- ++ 0+ ++'])


def dir_drift():
    def rate(t, x, u, s, p):
        return [x[2], x[3], u[0] - .7 * s[0][0], u[1] - .7 * s[0][1]]
    return Model(start=lambda p: [1, 0, 0, 0], T=given(2), bounds=[(-10, 10)] * 2, cost=square, rate=rate, N=16,
                 surfaces=lambda t, x, p: [[x[2] + x[1], x[3] - x[0]]], ends=to(0, 1, 0, 0),
                 guess=straight([1, 0, 0, 0], [.6, .6, -.7, .7], [0, 1, 0, 0]), sequences=['+'])


def dir_ride():
    def rate(t, x, u, s, p):
        return [x[2], x[3], u[0] - .8 * s[0][0], u[1] - .8 * s[0][1]]
    return Model(start=lambda p: [0, 0, .5, 0], T=given(3), bounds=[(-10, 10)] * 2, cost=square, rate=rate, N=16,
                 surfaces=lambda t, x, p: [[x[2] - .5, x[3]]], ends=to(1.4, .4, None, None),
                 guess=straight([0, 0, .5, 0], [1, .2, .5, .1], [1.4, .4, .5, .2]),
                 sequences=['0 +', '0 + 0', '+ 0'])
