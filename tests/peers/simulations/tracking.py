"""tests/simulations/tracking.fdc"""

from filippov import Run, System, mp, mpf

SLOPE, STRENGTH = mpf(3) / 2, mpf(3)


def surface(t, x):
    return SLOPE * (x[0] - mp.sin(t)) + x[1] - mp.cos(t)


tracking = System(
    ['x', 'v'],
    lambda t, x, s: [x[1], -mp.sin(x[0]) + mp.sin(5 * t) / 2 - STRENGTH * s[0]],
    {'line': (surface, lambda t, x, f: SLOPE * (f[0] - mp.cos(t)) + f[1] + mp.sin(t))},
)
Run(tracking, [1, 0]).to(6, 0.02).done()
