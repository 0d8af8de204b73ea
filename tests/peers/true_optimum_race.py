"""The race car of `fdcc new` for true_optimum_transcription.py."""

from math import pi

import casadi as ca
import numpy as np

from true_optimum_model import Model


def car(grip, bounds, w, L, centre, **more):
    """Position, velocity, heading; throttle and steering; a track of the width w about the centre line (times L)."""
    def rate(t, x, u, s, p):
        along, across = (ca.cos(x[4]), ca.sin(x[4])), (-ca.sin(x[4]), ca.cos(x[4]))
        return [x[2], x[3], *(u[0] * a - grip * s[0] * c for a, c in zip(along, across)),
                u[1] * (along[0] * x[2] + along[1] * x[3])]

    def track(t, x, u, s, p):
        off = x[1] - L * centre(x[0] / L)
        return [w / 2 - off, w / 2 + off]

    def touch(side):
        """Off the centre line by w/2, and no further."""
        def rows(t, x, p):
            y = ca.SX.sym('y')
            slope = ca.Function('slope', [y], [ca.jacobian(centre(y), y)])
            return [x[1] - L * centre(x[0] / L) - side * w / 2, x[3] - slope(x[0] / L) * x[2]]
        return rows
    return Model(start=lambda p: [0] * 5, touches={'left': touch(1), 'right': touch(-1)},
                 bounds=[(-b, b) for b in bounds], rate=rate, path=track,
                 surfaces=lambda t, x, p: [-ca.sin(x[4]) * x[2] + ca.cos(x[4]) * x[3]], **more)


def bend(x):
    return ca.if_else(x <= pi, ca.sin(x), pi - x)


TWICE = [[0, 0, 0, 0, 0], [-0.012, 0, -0.048, -0.001, 0.014], [-0.026, 0, -0.006, 0, 0.032],
         [-0.011, 0, 0.078, 0.004, 0.056], [0.023, 0.004, 0.058, 0.008, 0.141], [0.028, 0.005, -0.027, -0.004, 0.15],
         [-0.001, -0.001, -0.099, -0.022, 0.215], [-0.033, -0.009, -0.036, -0.011, 0.296],
         [-0.027, -0.007, 0.086, 0.028, 0.313], [0.043, 0.025, 0.234, 0.14, 0.541],
         [0.179, 0.079, 0.429, -0.005, -0.012], [0.345, -0.005, 0.336, -0.331, -0.778],
         [0.471, -0.157, 0.29, -0.378, -0.92]]
ONCE = [[0, 0, 0, 0, 0], [-0.026, -0.001, -0.018, -0.002, 0.084], [0.037, 0.018, 0.209, 0.119, 0.518],
        [0.131, 0.077, 0.16, 0.082, 0.471], [0.175, 0.097, 0.002, 0.001, 0.389], [0.138, 0.083, -0.127, -0.044, 0.336],
        [0.076, 0.065, -0.095, -0.023, 0.237], [0.068, 0.063, 0.079, 0.018, 0.224],
        [0.164, 0.075, 0.303, -0.009, -0.03], [0.331, 0.005, 0.317, -0.267, -0.7],
        [0.471, -0.157, 0.258, -0.353, -0.94]]


def template(ways, touches):
    """It rolls all the time, back and forth, and the bend is touched on both sides."""
    L, goal = 0.1, (0.15 * pi, -0.05 * pi)
    return car(6, (3, 20), 0.05, L, bend, T=(5, 5, 5), N=8, sequences=[touches],
               guess=lambda s: [float(np.interp(s, np.linspace(0, 1, len(ways)), c)) for c in zip(*ways)],
               cost=lambda t, x, u, s, p: (u[0] / 3)**2 + (u[1] / 20)**2,
               ends=lambda x, t, p: [(x[0], goal[0], goal[0], None), (x[1], goal[1], goal[1], None)])


def twice():
    return template(TWICE, '0:0.87 0=left:1.08 0=right:1.13 0=left:0.92 0=right:0.58 0=left:0.42')


def once():
    return template(ONCE, '0:0.53 0=left:0.71 0=right:2.74 0=right:0.62 0=left:0.4')
