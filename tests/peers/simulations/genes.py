"""tests/simulations/genes.fdc"""

from filippov import Run, System, mpf

STRENGTH = [mpf(3), mpf(5) / 2, mpf(14) / 5]


def on(s):
    return (1 + s) / 2


def rate(t, x, s):
    a, b, c, d = x
    return [
        STRENGTH[0] * (1 - on(s[2])) - a,
        STRENGTH[1] * (1 - on(s[0])) - b,
        STRENGTH[2] * (1 - on(s[1])) - c,
        3 * on(s[0]) * (1 - on(s[3])) - d,
    ]


def threshold(i):
    return lambda t, x: x[i] - 1, lambda t, x, f: f[i]


genes = System(list('abcd'), rate, {'has_' + name: threshold(i) for i, name in enumerate('abcd')})
Run(genes, [mpf(12) / 10, mpf(3) / 10, mpf(1) / 2, 0]).to(10, 0.05).done()
