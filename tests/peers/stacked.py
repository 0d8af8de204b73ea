#!/usr/bin/env python3
"""models/stacked.fdc"""

import casadi as ca
from transcription import arguments, sgn, solve

options = arguments(sigma=0.1, intervals=200)
m1, m2, g = 3.0, 1.0, 9.81
drag, carry = 0.2 * (m1 + m2) * g, 0.4 * m2 * g


def rate(x, u):
    floor, top = sgn(x[2], options.sigma), sgn(x[3] - x[2], options.sigma)
    return ca.vertcat(x[2], x[3], (u - drag * floor + carry * top) / m1, -carry * top / m2)


solve(
    options,
    rate=rate,
    start=[0, 0, 0, 0],
    end={0: 1, 2: 0, 3: 0},
    bounds=(-40, 40),
    cost=lambda x, u: u**2,
    duration=3,
    guess=lambda s: [s, 0, 0, 0],
    path=lambda x, u: x[1] - x[0],
    path_bounds=(-0.1, 0.1),
)
