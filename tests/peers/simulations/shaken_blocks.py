"""tests/simulations/shaken_blocks.fdc"""

from filippov import Run, System, mpf, mp

BELOW, ABOVE, FLOOR, TOP = mpf(3), mpf(1), mpf(8), mpf(3)


def rate(t, x, s):
    force = 20 * mp.sin(2 * t)
    return [x[2], x[3], (force - FLOOR * s[0] + TOP * s[1]) / BELOW, -TOP * s[1] / ABOVE]


blocks = System(
    ['x1', 'x2', 'v1', 'v2'],
    rate,
    {
        'floor': (lambda t, x: x[2], lambda t, x, f: f[2]),
        'top': (lambda t, x: x[3] - x[2], lambda t, x, f: f[3] - f[2]),
    },
)
Run(blocks, [0, 0, 0, 0]).to(6, 0.02).done()
