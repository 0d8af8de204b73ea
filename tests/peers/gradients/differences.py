"""The derivatives of tests/gradients/ without a closed form: central differences of runs with many digits.

    f' = (f(h) - f(-h))/(2 h),    f'' = (f(h, h) - f(h, -h) - f(-h, h) + f(-h, -h))/(4 h^2)

both with Richardson's extrapolation (h and 2 h). Prints the cases of the file that is named; some take minutes.
"""

import sys
from contextlib import redirect_stdout
from functools import cache
from io import StringIO
from pathlib import Path

from mpmath import cos, findroot, mp, mpf, nstr, sin, sqrt

sys.path.append(str(Path(__file__).parent.parent / 'simulations'))
from filippov import Run, System
GRAVITY = mpf(981) / 100

mp.dps = 30
H = mpf(10) ** -5


def richardson(difference):
    return (4 * difference(H) - difference(2 * H)) / 3


class Differences:
    """Of `run(**values) -> {output: number}`."""

    def __init__(self, run, **values):
        self.values = {name: mpf(value) for name, value in values.items()}
        self.run = cache(lambda *values: run(**dict(zip(self.values, values))))

    def at(self, output, **moves):
        return self.run(*(value + moves.get(name, 0) for name, value in self.values.items()))[output]

    def first(self, output, a):
        return richardson(lambda h: (self.at(output, **{a: h}) - self.at(output, **{a: -h})) / (2 * h))

    def second(self, output, a, b):
        if a == b:
            middle = 2 * self.at(output)
            return richardson(lambda h: (self.at(output, **{a: h}) - middle + self.at(output, **{a: -h})) / h**2)
        at = lambda i, j: self.at(output, **{a: i, b: j})
        return richardson(lambda h: (at(h, h) - at(h, -h) - at(-h, h) + at(-h, -h)) / (4 * h**2))

    def case(self, title, output, seconds='all', given=()):
        """Prints a case; `output` as it is written in the model, nothing for the objective."""
        print('case', title)
        for line in given:
            print(line)
        if output:
            print('of', output)
        names = list(self.values)
        spoken = lambda name: name[:-6] + '(start)' if name.endswith('_start') else name
        for name in names:
            print('by', spoken(name), '=', nstr(self.first(output, name), 15))
        if seconds == 'all':
            seconds = [(a, b) for i, a in enumerate(names) for b in names[i:]]
        for a, b in seconds:
            print('second', spoken(a), spoken(b), '=', nstr(self.second(output, a, b), 12))
        print(flush=True)


def quiet(run):
    with redirect_stdout(StringIO()):
        return run()


def curved():
    """Example (c)."""
    fields = System(
        ['x', 'y'],
        lambda t, x, s: [
            ((1 - s[0]) * (1 + x[1] / 4) + (1 + s[0]) * (mpf(1) / 2 - x[1] ** 2 / 4)) / 2,
            ((1 - s[0]) * (mpf(1) / 2 - x[0] * x[1]) + (1 + s[0]) * (x[1] / 2 - x[0])) / 2,
        ],
        {'edge': (lambda t, x: x[0] + x[1] ** 2 / 2 - 1, lambda t, x, f: f[0] + x[1] * f[1])},
    )

    def run(x_start, y_start):
        end = quiet(lambda: Run(fields, [x_start, y_start]).to(2, 0.1)).x
        return {'x(end)': end[0], 'y(end)': end[1]}

    differences = Differences(run, x_start=0, y_start='0.2')
    for output in ('x(end)', 'y(end)'):
        differences.case(f'(c), {output}, Taylor series with 30 digits', output)


def moving():
    """Enters and leaves a line that moves; the integral is one more state."""

    def run(slope, strength, mass, gravity, T):
        load = mass * gravity
        line = System(
            ['x', 'v', 'cost'],
            lambda t, x, s: [
                x[1],
                (-sin(x[0]) + mass * sin(3 * t) - strength * s[0]) / mass,
                x[1] ** 2 + x[0] * s[0],
            ],
            {
                'line': (
                    lambda t, x: slope * (x[0] - sin(t)) + x[1] - load * cos(t),
                    lambda t, x, f: slope * (f[0] - cos(t)) + f[1] + load * sin(t),
                )
            },
        )
        x, v, cost = quiet(lambda: Run(line, [load, 0, 0]).to(T, 0.1)).x
        return {None: x**2 * v + mass * cost}

    differences = Differences(run, slope='1.5', strength='0.9', mass='0.8', gravity='1.2', T=4)
    some = [('slope', 'slope'), ('slope', 'mass'), ('strength', 'T'), ('mass', 'mass'), ('gravity', 'T'), ('strength', 'gravity')]
    differences.case('Taylor series with 30 digits', None, some)


def table():
    """A ball on a table that moves: parabolas between bounces, each bounce one root."""

    def run(height, frequency, restitution, T):
        t, h, v = mpf(0), mpf(1), mpf(0)
        for guess in ('0.452', '0.856'):
            gap = lambda s: h + v * (s - t) - GRAVITY * (s - t) ** 2 / 2 - height * sin(frequency * s)
            s = findroot(gap, mpf(guess))
            lift = height * frequency * cos(frequency * s)
            t, h, v = s, height * sin(frequency * s), -restitution * (v - GRAVITY * (s - t)) + (1 + restitution) * lift
        s = T - t
        return {'h(end)': h + v * s - GRAVITY * s**2 / 2, 'v(end)': v - GRAVITY * s}

    differences = Differences(run, height='0.1', frequency=7, restitution='0.7', T='1.2')
    for output in ('h(end)', 'v(end)'):
        differences.case(f'{output} after two bounces, parabolas with 30 digits', output, 'all', ['set T = 1.2'])


def block():
    """Example (b1): slips and sticks; each phase in closed form, each event one root."""

    def run(m, F, A, w, v0):
        slope = lambda t, s: (A * sin(w * t) - s * F) / m
        t, x, v, side = mpf(0), mpf(0), v0, 1
        # Reference (b): ends of the phases, with the direction of the next.
        phases = [('3.306', -1), ('4.103', 0), ('4.639', 1), ('6.488', 0), ('6.733', -1), ('8.583', 0), ('8.828', 1)]
        for guess, next_side in phases + [(9, None)]:
            t0, x0, v0 = t, x, v
            speed = lambda s: v0 - side * F / m * (s - t0) - A / (m * w) * (cos(w * s) - cos(w * t0))
            place = lambda s: (
                x0 + (v0 + A / (m * w) * cos(w * t0)) * (s - t0) - side * F / m * (s - t0) ** 2 / 2
                - A / (m * w**2) * (sin(w * s) - sin(w * t0))
            )
            if side == 0:
                t = findroot(lambda s: A * sin(w * s) - next_side * F, mpf(guess))
            elif next_side is None:
                t = mpf(guess)
                x, v = place(t), speed(t)
            else:
                t = findroot(speed, mpf(guess))
                x, v = place(t), mpf(0)
            side = next_side
        return {'x(end)': x, 'v(end)': v}

    differences = Differences(run, m=1, F=1, A='1.6', w='1.5', v0='2.5')
    for output in ('x(end)', 'v(end)'):
        differences.case(f'(b1), {output}, closed forms between roots with 30 digits', output)


if __name__ == '__main__':
    globals()[sys.argv[1]]()
