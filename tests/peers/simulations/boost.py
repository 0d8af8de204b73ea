"""tests/simulations/boost.fdc: the diode is a mode of its own here, `i = 0` once the current has died out."""

from filippov import Run, System, mp, mpf

FREQUENCY, SUPPLY, LOAD, DUTY = mpf(6), mpf(2), mpf(8), mpf(8) / 10


def rate(t, x, s):
    i, v = x
    is_on, conducts = (1 + s[0]) / 2, (1 + s[1]) / 2
    off = (SUPPLY - v) * conducts + SUPPLY * (1 - conducts)
    return [SUPPLY * is_on + off * (1 - is_on), i * (1 - is_on) - v / LOAD]


boost = System(
    ['i', 'v'],
    rate,
    {
        'gate': (
            lambda t, x: mp.cos(FREQUENCY * t) - DUTY,
            lambda t, x, f: -FREQUENCY * mp.sin(FREQUENCY * t),
        ),
        'diode': (lambda t, x: x[0], lambda t, x, f: f[0]),
    },
)
Run(boost, [0, 3]).to(6, 0.01).done()
