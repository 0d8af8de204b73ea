"""tests/simulations/clutch.fdc"""

from filippov import Run, System, mp, mpf

ENGINE, LOAD = mpf(2), mpf(3)


def rate(t, x, s):
    torque = 4 * t / (1 + t) * s[0]
    return [(2 + 3 * mp.sin(4 * t) - torque) / ENGINE, (torque - x[1] / 2) / LOAD]


clutch = System(
    ['engine', 'load'],
    rate,
    {'plates': (lambda t, x: x[0] - x[1], lambda t, x, f: f[0] - f[1])},
)
Run(clutch, [4, 0]).to(10, 0.02).done()
