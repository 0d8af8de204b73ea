"""tests/simulations/pinched.fdc"""

from filippov import Run, System, mp, mpf


def rate(t, x, s):
    z = x[2]
    return [1 + z**2 / 2 - 2 * s[0] - s[1] / 2, mp.sin(z) + s[0] - 2 * s[1], 1 + s[0] * s[1] - z / 4]


pinched = System(
    ['x', 'y', 'z'],
    rate,
    {'first': (lambda t, x: x[0], lambda t, x, f: f[0]), 'second': (lambda t, x: x[1], lambda t, x, f: f[1])},
)
Run(pinched, [mpf(1) / 2, mpf(-4) / 10, 0]).to(3, 0.02).done()
