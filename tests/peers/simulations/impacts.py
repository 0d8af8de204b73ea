"""tests/simulations/impacts.fdc"""

from filippov import Run, System, mp, mpf

oscillator = System(
    ['x', 'v'],
    lambda t, x, s: [x[1], -x[0] - x[1] / 10 + mp.cos(mpf(28) / 10 * t)],
    {'wall': (lambda t, x: x[0] - mpf(1) / 10, lambda t, x, f: f[0])},
    {('wall', 'rising'): lambda t, x: [x[0], -mpf(8) / 10 * x[1]]},
)
Run(oscillator, [0, 0]).to(15, 0.01).done()
