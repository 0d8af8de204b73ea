"""tests/simulations/buck.fdc"""

from filippov import Run, System, mp, mpf

FREQUENCY, GAIN, WANTED, SUPPLY, LOAD = mpf(20), mpf(2), mpf(5), mpf(12), mpf(2)


def rate(t, x, s):
    i, v = x
    return [SUPPLY * (1 + s[0]) / 2 - v, i - v / LOAD]


buck = System(
    ['i', 'v'],
    rate,
    {
        'gate': (
            lambda t, x: GAIN * (WANTED - x[1]) - mp.cos(FREQUENCY * t),
            lambda t, x, f: -GAIN * f[1] + FREQUENCY * mp.sin(FREQUENCY * t),
        )
    },
)
Run(buck, [0, 0]).to(5.4, 0.01).done()
