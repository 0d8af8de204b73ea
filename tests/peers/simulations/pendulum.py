"""tests/simulations/pendulum.fdc. The angles of rest follow from `cos b - mu b = cos a + mu a` also without integration."""

from filippov import Run, System, mp, mpf

pendulum = System(
    ['angle', 'speed'],
    lambda t, x, s: [x[1], -mp.sin(x[0]) - s[0] / 5],
    {'joint': (lambda t, x: x[1], lambda t, x, f: f[1])},
)
Run(pendulum, [mpf(5) / 2, 0]).to(20, 0.05).done()
