"""tests/simulations/sphere.fdc"""

from filippov import Run, System, mpf


def rate(t, x, s):
    x, y, z = x
    inside = [-y / 2, x / 2, 1 + z / 2]
    outside = [2 - x, -y / 2, -1 - z / 4]
    above = (1 + s[0]) / 2
    return [a * (1 - above) + b * above for a, b in zip(inside, outside)]


sphere = System(
    ['x', 'y', 'z'],
    rate,
    {
        'shell': (
            lambda t, x: sum(c * c for c in x) - 1,
            lambda t, x, f: 2 * sum(c * d for c, d in zip(x, f)),
        )
    },
)
Run(sphere, [mpf(-4) / 10, mpf(2) / 10, 0]).to(5, 0.02).done()
