"""tests/simulations/overflow.fdc. The upper tank stops to spill where sin t = -1/3."""

from filippov import Run, System, mp, mpf

overflow = System(
    ['upper', 'lower'],
    lambda t, x, s: [1 + 3 * mp.sin(t) / 2 - x[0] / 2 - 5 * (1 + s[0]), 5 * (1 + s[0]) - x[1]],
    {'full': (lambda t, x: x[0] - 1, lambda t, x, f: f[0])},
)
Run(overflow, [mpf(1) / 5, 0]).to(12, 0.02).done()
