"""tests/simulations/chua.fdc"""

from filippov import Run, System, mpf

ALPHA, BETA, INNER, OUTER = mpf(156) / 10, mpf(28), mpf(-8) / 7, mpf(-5) / 7


def rate(t, x, s):
    x, y, z = x
    right, left = (1 + s[0]) / 2, (1 - s[1]) / 2
    diode = INNER * x + (OUTER - INNER) * ((x - 1) * right + (x + 1) * left)
    return [ALPHA * (y - x - diode), x - y + z, -BETA * y]


chua = System(
    ['x', 'y', 'z'],
    rate,
    {
        'right': (lambda t, x: x[0] - 1, lambda t, x, f: f[0]),
        'left': (lambda t, x: x[0] + 1, lambda t, x, f: f[0]),
    },
)
Run(chua, [mpf(7) / 10, 0, 0]).to(4, 0.01).done()
