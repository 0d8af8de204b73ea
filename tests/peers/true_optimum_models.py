"""The models of models/, tests/right and of `fdcc new` that have surfaces, for true_optimum_transcription.py.

The sequences are what was tried: the modes of the smoothed answer, and holds, crossings and arcs more or less.
"""

from math import pi

import casadi as ca
import numpy as np

from phases_transcription import INF
from true_optimum_model import Model

G = 9.81


def slide(s, d=1.0, T=1.0):
    """From rest to rest over d in T."""
    return [d * s * s * (3 - 2 * s), 6 * d * s * (1 - s) / T]


def rest(d):
    """x == d and v == 0, the latter implied by a hold."""
    return lambda x, t, p: [(x[0], d, d, None), (x[1], 0, 0, 0)]


def mass(c, m, d, T, bound, sequences, cost=lambda t, x, u, s, p: u[0]**2, push=lambda x: 0, **more):
    """A mass m with the friction c and the force u, from rest to rest."""
    return Model(start=lambda p: [0, 0], guess=lambda s: slide(s, d, T[2]), T=T, bounds=[bound],
                 rate=lambda t, x, u, s, p: [x[1], (u[0] + push(x) - c * s[0]) / m],
                 surfaces=lambda t, x, p: [x[1]], ends=rest(d), cost=cost, sequences=sequences, **more)


def block():
    return mass(0.3 * 2 * G, 2, 1, (4, 4, 4), (-12, 12), ['+', '0 +', '+ 0', '0 + 0', '+ 0 +'])


def coulomb_energy():
    return mass(0.5, 1, 1, (3, 3, 3), (-10, 10), ['+', '0 +', '0 + 0', '+ 0 +'],
                lambda t, x, u, s, p: u[0]**2 / 2)


def coulomb_rest():
    return mass(0.5, 1, 1, (0.1, 10, 2), (-2, 2), ['+', '+^ +_', '+^ +_ 0', '+_ +^ +_'],
                lambda t, x, u, s, p: 0, mayer=lambda x, t, p: t)


def coulomb_reverse():
    return Model(start=lambda p: [0, -1], guess=lambda s: [s, 2 * s - 1], T=(0.1, 10, 3), bounds=[(-2, 2)],
                 rate=lambda t, x, u, s, p: [x[1], u[0] - 0.5 * s[0]], surfaces=lambda t, x, p: [x[1]],
                 ends=rest(1), mayer=lambda x, t, p: t,
                 sequences=['-^ +^ +_', '- +', '-^ 0 +^ +_', '-_ -^ +^ +_'])


def crossing():
    return Model(start=lambda p: [p[0]], guess=lambda s: [-1 + 2 * s], T=(2, 2, 2),
                 rate=lambda t, x, u, s, p: [2 - s[0]], surfaces=lambda t, x, p: [x[0]],
                 cost=lambda t, x, u, s, p: x[0]**2, mayer=lambda x, t, p: (x[0] - 5 / 3)**2,
                 unknowns={'x0': (-1.5, -0.5, -1)}, sequences=['- +', '-', '- +:0.1'])


def disc(c, m, goal, T, bound, weight=1.0, **more):
    """A puck of the mass m on a table with the friction c, from rest to rest."""
    return Model(start=lambda p: [0] * 4, T=(T, T, T), bounds=[(-bound, bound)] * 2,
                 guess=lambda s: [slide(s, g, T)[i] for i in (0, 1) for g in goal],
                 rate=lambda t, x, u, s, p: [x[2], x[3], (u[0] - c * s[0][0]) / m, (u[1] - c * s[0][1]) / m],
                 surfaces=lambda t, x, p: [[x[2], x[3]]], cost=lambda t, x, u, s, p: weight * ca.sumsqr(u),
                 ends=lambda x, t, p: [(x[0], goal[0], goal[0], None), (x[1], goal[1], goal[1], None),
                                       (x[2], 0, 0, 0), (x[3], 0, 0, 0)],
                 sequences=['+', '+ 0', '0 +', '0 + 0'], **more)


def puck():
    return disc(0.5, 1, (0.6, 0.8), 3, 10, 0.5)


def pushed_table():
    return disc(40, 20, (3, 0.3), 4, 100, scale=1e-3)


def stacked():
    floor, top = 0.2 * 4 * G, 0.4 * G
    return Model(start=lambda p: [0] * 4, T=(3, 3, 3), bounds=[(-40, 40)], scale=1e-2,
                 guess=lambda s: [slide(s, 1, 3)[i] for i in (0, 0, 1, 1)],
                 rate=lambda t, x, u, s, p: [x[2], x[3], (u[0] - floor * s[0] + top * s[1]) / 3, -top * s[1]],
                 surfaces=lambda t, x, p: [x[2], x[3] - x[2]], cost=lambda t, x, u, s, p: u[0]**2,
                 path=lambda t, x, u, s, p: [0.1 - (x[1] - x[0]), 0.1 + x[1] - x[0]],
                 ends=lambda x, t, p: [(x[0], 1, 1, None), (x[2], 0, 0, 0), (x[3] - x[2], 0, 0, 1)],
                 sequences=['+0', '+0 00', '00 +0', '00 +0 00', '+- +0 00', '+- +0 ++ 0+ 00', '+0 ++ 0+ 00',
                            '+- +0 +- +0 00', '+0 00 +0 00'])


def turbo(low=10.0, ratio=3.0, length=200.0, u=5.0, top=20.0, guess=15.0):
    """The motor of `turbo`, and of the template `switched`."""
    return Model(start=lambda p: [0, 0], T=(1, 60, guess), bounds=[(-u, u)], N=4, joined=False,
                 guess=lambda s: [length * s, 4 * top * s * (1 - s)],
                 rate=lambda t, x, u, s, p: [x[1], u[0] * ((1 + s[0]) / 2 * ratio + (1 - s[0]) / 2)],
                 surfaces=lambda t, x, p: [x[1] - low], mayer=lambda x, t, p: t,
                 path=lambda t, x, u, s, p: [top - x[1]], arcs={'top': (lambda t, x, p: [x[1] - top], accelerate)},
                 ends=lambda x, t, p: [(x[0], length, length, None), (x[1], 0, 0, None)],
                 sequences=['-^ +^ +_ -_', '-^ +^ +~&top +_ -_', '-^ -_', '-^ 0^ -_', '-^ +^ +~&top +_ 0 -_'])


def accelerate(t, x, u, s, p):
    """The control is off where the speed is at its bound."""
    return u[0]


def switched():
    return turbo(0.1, 1.25, 2.0, 0.05, 0.2, 15.0)


def bounce():
    return Model(start=lambda p: [0, 1.5, 0], T=(0.1, 5, 1.4), bounds=[(-2, 2)],
                 guess=lambda s: [6 * s, abs(1.5 * (1 - 2 * s)), -5 if s < 0.4 else 3],
                 rate=lambda t, x, u, s, p: [p[0], x[2], u[0] - G], surfaces=lambda t, x, p: [x[1]],
                 jumps={'hit': (0, lambda t, x, p: [x[0], x[1], -0.8 * x[2]])}, cost=lambda t, x, u, s, p: u[0]**2,
                 mayer=lambda x, t, p: p[0]**2, unknowns={'vx': (0, 20, 4)},
                 ends=lambda x, t, p: [(x[0], 6, 6, None), (x[1], 1, 1, None)],
                 sequences=['+', '+ +!hit', '+:0.4 +_:0.13 +^!hit:0.43 +:0.44', '+ +_ +^!hit', '+ +_ +!hit'])


def sled_on_ice():
    return mass(0.05 * 30 * G, 30, 10, (8, 8, 8), (0, 150), ['+', '+ 0', '+ +_', '+ +_ 0', '0 + +_ 0', '+^ + +_ 0'],
                push=lambda x: -4 * x[1], scale=1e-3)


def friction():
    """In units of metres."""
    return mass(0.1 * 2 * G, 2, 0.02, (0.4, 0.4, 0.4), (-12, 12), ['+', '+ 0', '0 +', '0 + 0', '+^ + 0', '+^ + +_ 0',
                                                                  '+^ + +_ + 0'],
                lambda t, x, u, s, p: u[0]**2 + (200 * (x[0] - 0.02))**2)


def inclined_plane():
    weight = 12 * G
    fall, grip = weight * ca.sin(pi / 12), 0.25 * weight * ca.cos(pi / 12)
    return mass(grip, 12, 4, (5, 5, 5), (0, 120), ['+', '+ 0', '0 +', '0 + 0', '+ 0 +'],
                lambda t, x, u, s, p: u[0] * x[1], push=lambda x: -fall, scale=1e-2)


def pension():
    return Model(start=lambda p: [1], T=(60, 60, 60), bounds=[(0.1, 5)], guess=lambda s: [1 + 40 * s * (1 - s)],
                 rate=lambda t, x, u, s, p: [0.02 * x[0] - u[0] + 1.5 * (1 - s[0]) / 2], controls=lambda s: [1.0],
                 surfaces=lambda t, x, p: [t - 40], cost=lambda t, x, u, s, p: -ca.exp(-0.01 * t) * ca.log(u[0]),
                 ends=lambda x, t, p: [(x[0], 0, INF, None)], sequences=['- +', '-_ - +', '- + +^'])


def dc_motor():
    """J/k and L make the fast phases: stick and slip at full voltage."""
    R, L, k, J, dry = 1.2, 2e-3, 0.05, 2e-4, 0.01
    return Model(start=lambda p: [0, 0, 0], T=(0.5, 0.5, 0.5), bounds=[(-24, 24)],
                 guess=lambda s: [*slide(s, 4 * pi, 0.5), 1.4 - 2.4 * s],
                 rate=lambda t, x, u, s, p: [x[1], (k * x[2] - dry * s[0]) / J, (u[0] - R * x[2] - k * x[1]) / L],
                 surfaces=lambda t, x, p: [x[1]], state_bounds={2: (-10, 10)}, joined=False, gap=1e-5, scale=1e3, N=16,
                 cost=lambda t, x, u, s, p: R * x[2]**2, controls=lambda s: [2.0],
                 ends=lambda x, t, p: [(x[0], 4 * pi, 4 * pi, None), (x[1], 0, 0, 0)],
                 sequences=['0^:2e-5 +^:1e-4 +:0.5', '0:2e-5 +:0.5', '0^:2e-5 +^:1e-4 +:0.49 0:0.01'])


def gripper():
    """The finger draws back, runs up, pushes and lets go; the last surface is that of the friction."""
    def rate(t, x, u, s, p):
        press = 200 * (x[0] - x[1] + 0.05)**2 * (1 + s[0]) / 2
        return [x[2], x[3], u[0] - press, press - 2 * s[1]]

    def guess(s):
        at = [0, 0.35, 0.65, 0.75, 0.85, 1]
        points = [0, 0, 0.15, 0.21, 0.21, 0.21], [0.05, 0.05, 0.06, 0.11, 0.25, 0.3], \
            [0, 0.2, 0.6, 0.3, 0, 0], [0, 0, 0.1, 0.5, 0.5, 0]
        return [float(np.interp(s, at, values)) for values in points]
    lost = '-0:1.2 +0:0.15 ++:0.35 -+:0.3'
    return Model(start=lambda p: [0, 0.05, 0, 0], T=(2, 2, 2), bounds=[(-20, 20)], rate=rate, guess=guess,
                 cost=lambda t, x, u, s, p: u[0]**2, surfaces=lambda t, x, p: [x[0] - x[1] + 0.05, x[3]],
                 ends=lambda x, t, p: [(x[1], 0.3, INF, None), (x[3], 0, 0, 1)],
                 sequences=[lost, lost + ' -0:0.1', '-0:1.2 +0:0.15 ++:0.6', '+0 ++ -+', lost + ' ++ -+'])
