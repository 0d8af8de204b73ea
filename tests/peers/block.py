#!/usr/bin/env python3
"""models/block.fdc"""

import casadi as ca
from transcription import arguments, sgn, solve

options = arguments(sigma=0.1, intervals=200)
mass, mu, g = 2.0, 0.3, 9.81
solve(
    options,
    rate=lambda x, u: ca.vertcat(x[1], (-mu * mass * g * sgn(x[1], options.sigma) + u) / mass),
    start=[0, 0],
    end={0: 1, 1: 0},
    bounds=(-12, 12),
    cost=lambda x, u: u**2,
    duration=4,
    guess=lambda s: [s, 0],
)
