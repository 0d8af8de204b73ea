"""tests/simulations/belt.fdc"""

from filippov import Run, System, mpf

BELT, FRICTION, DAMPING = mpf(1) / 2, 1, mpf(1) / 5


def belt(damping, weakening):
    friction = lambda v: FRICTION / (1 + weakening * (v - BELT) ** 2)
    return System(
        ['x', 'v'],
        lambda t, x, s: [x[1], -x[0] - damping * x[1] - friction(x[1]) * s[0]],
        {'slip': (lambda t, x: x[1] - BELT, lambda t, x, f: f[1])},
    )


Run(belt(DAMPING, 0), [0, 0]).to(20, 0.05).done()
Run(belt(0, 3), [0, 0]).to(20, 0.02).done()
