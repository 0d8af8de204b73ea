#!/usr/bin/env python3
"""models/turbo.fdc"""

import casadi as ca
from transcription import arguments, sgn, solve

options = arguments(sigma=1.0, intervals=200)
solve(
    options,
    # `match` is the mean of its two sides, weighted by (1 -+ Sgn)/2.
    rate=lambda x, u: ca.vertcat(x[1], u * (2 + sgn(x[1] - 10, options.sigma))),
    start=[0, 0],
    end={0: 200, 1: 0},
    bounds=(-5, 5),
    cost=None,
    duration=(1, 60, 15),
    guess=lambda s: [200 * s, 0],
    state_bounds=([-float('inf'), -20], [float('inf'), 20]),
)
