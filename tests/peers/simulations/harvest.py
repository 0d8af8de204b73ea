"""tests/simulations/harvest.fdc"""

from filippov import Run, System, mpf


def rate(t, x, s):
    prey, predator = x
    caught = (1 + s[0]) / 2
    return [prey * (1 - predator) - caught * prey / 4, predator * (prey - 1) - caught * predator * 3 / 5]


harvest = System(
    ['prey', 'predator'],
    rate,
    {'allowed': (lambda t, x: x[0] + x[1] / 2 - 2, lambda t, x, f: f[0] + f[1] / 2)},
)
Run(harvest, [mpf(1) / 2, mpf(6) / 10]).to(15, 0.02).done()
