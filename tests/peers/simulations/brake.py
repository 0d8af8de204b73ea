"""tests/simulations/brake.fdc"""

from filippov import Run, System, mpf

MASS, INERTIA, LOW, HIGH, LOAD = mpf(4), mpf(1) / 2, mpf(1) / 10, mpf(3) / 10, mpf(39)


def grip(speed, wheel):
    slip = 1 - wheel / speed
    return LOAD * 2 * slip / (1 + 25 * slip**2) * 4


def rate(t, x, s):
    speed, wheel, pressure = x
    force = grip(speed, wheel)
    return [-force / MASS, (force - 120 * pressure) / INERTIA, 0]


def slips(limit):
    return lambda t, x: x[0] * (1 - limit) - x[1], lambda t, x, f: f[0] * (1 - limit) - f[1]


brake = System(
    ['speed', 'wheel', 'pressure'],
    rate,
    {'high': slips(HIGH), 'low': slips(LOW)},
    {('high', 'rising'): lambda t, x: [x[0], x[1], mpf(1) / 5], ('low', 'falling'): lambda t, x: [x[0], x[1], 1]},
)
Run(brake, [30, 30, 1]).to(2, 0.01).done()
