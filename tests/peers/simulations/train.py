"""tests/simulations/train.fdc"""

from filippov import Run, System, mpf

FRICTION = [mpf(10) / 10, mpf(13) / 10, mpf(9) / 10, mpf(16) / 10]


def rate(t, x, s):
    place, speed = x[:4], x[4:]
    pull = [0, place[1] - place[0], place[2] - place[1], place[3] - place[2], 3 * (t / 2 - place[3])]
    force = [pull[i + 1] - pull[i] - FRICTION[i] * s[i] for i in range(4)]
    return speed + force


def surface(i):
    return lambda t, x: x[4 + i], lambda t, x, f: f[4 + i]


train = System(
    [f'x{i}' for i in range(1, 5)] + [f'v{i}' for i in range(1, 5)],
    rate,
    {f'slip{i + 1}': surface(i) for i in range(4)},
)
Run(train, [0] * 8).to(25, 0.05).done()
