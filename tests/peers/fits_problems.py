"""The fits: measurements, unknowns with their guesses, residuals."""

from dataclasses import dataclass, field
from typing import Callable

import numpy as np
from fits_events import ball, block
from scipy.integrate import solve_ivp
from scipy.linalg import expm


@dataclass
class Fit:
    """`data` gives {table: (columns, rows)}, or is None for a file that is only read; `residuals` takes the unknowns
    and {table: columns}."""

    data: Callable
    unknowns: dict
    residuals: Callable
    loss: str = 'linear'
    lower: float = -np.inf  # bound of all unknowns
    plain: bool = True  # a sum of squares of measured values, with standard errors
    published: dict = field(default_factory=dict)


def curve(rate, start, times, end=None):
    """States at some times, from 0."""
    return solve_ivp(rate, (0, end or max(times)), start, 'DOP853', t_eval=times, rtol=1e-12, atol=1e-12).y


def noisy(values, deviation, seed):
    """Values with normal noise, as they are written to the file."""
    values = np.asarray(values, float)
    return np.round(values + deviation * np.random.default_rng(seed).standard_normal(values.shape), 5)


def table(columns, *values):
    """Columns with their names."""
    return columns.split(), list(zip(*values))


# ---- Published measurements ----

MISRA = ([77.6, 114.9, 141.1, 190.8, 239.9, 289.0, 332.8, 378.4, 434.8, 477.3, 536.8, 593.1, 689.1, 760.0],
         [10.07, 14.73, 17.94, 23.93, 29.61, 35.18, 40.02, 44.82, 50.76, 55.05, 61.01, 66.40, 75.47, 81.78])
RATKOWSKY = ([9, 14, 21, 28, 42, 57, 63, 70, 79], [8.93, 10.80, 18.59, 22.33, 39.35, 56.11, 61.73, 64.62, 67.08])
BOXBOD = ([1, 2, 3, 5, 7, 10], [109, 149, 149, 191, 213, 224])
PINENE = np.array([
    [1230, 88.35, 7.3, 2.3, 0.4, 1.75], [3060, 76.4, 15.6, 4.5, 0.7, 2.8], [4920, 65.1, 23.1, 5.3, 1.1, 5.8],
    [7800, 50.4, 32.9, 6.0, 1.5, 9.3], [10680, 37.5, 42.7, 6.0, 1.9, 12.0], [15030, 25.9, 49.1, 5.9, 2.2, 17.0],
    [22620, 14.0, 57.4, 5.1, 2.6, 21.0], [36420, 4.5, 63.1, 3.8, 2.9, 25.7]])
HARES = [30, 47.2, 70.2, 77.4, 36.3, 20.6, 18.1, 21.4, 22, 25.4, 27.1, 40.3, 57, 76.6, 52.3, 19.5, 11.2, 7.6, 14.6,
         16.2, 24.7]
LYNXES = [4, 6.1, 9.8, 35.2, 59.4, 41.7, 19, 13, 8.3, 9.1, 7.4, 8, 12.3, 19.5, 45.7, 51.1, 29.7, 15.8, 9.7, 10.1, 8.6]


def pinene(k, d):
    def rate(t, y):
        return [-(k[0] + k[1]) * y[0], k[0] * y[0], k[1] * y[0] - (k[2] + k[3]) * y[2] + k[4] * y[4], k[2] * y[2],
                k[3] * y[2] - k[4] * y[4]]
    return (curve(rate, [100, 0, 0, 0, 0], d['alpha_pinene'][0]) - d['alpha_pinene'][1:]).ravel()


def hares(p, d):
    def rate(t, y):
        return [p[0] * y[0] - p[1] * y[0] * y[1], -p[2] * y[1] + p[3] * y[0] * y[1]]
    return (curve(rate, p[4:], d['hares'][0]) - d['hares'][1:]).ravel()


def methanol(k, d):
    def rate(t, y):
        q = (k[1] + k[4]) * y[0] + y[1]
        return [-(2 * k[1] - k[0] * y[1] / q + k[2] + k[3]) * y[0],
                k[0] * y[0] * (k[1] * y[0] - y[1]) / q + k[2] * y[0],
                k[0] * y[0] * (y[1] + k[4] * y[0]) / q + k[3] * y[0]]
    return (curve(rate, [1, 0, 0], d['methanol'][0]) - d['methanol'][1:]).ravel()


def marine(p, d):
    """Growth and mortality in eight stages, linear, with the numbers at the start in the last eight unknowns."""
    growth, mortality = np.append(p[:7], 0), p[7:15]
    step = expm(0.5 * (np.diag(-(mortality + growth)) + np.diag(growth[:7], -1)))
    states = [p[15:]]
    for _ in d['marine'][0][1:]:
        states.append(step @ states[-1])
    return (np.array(states).T - d['marine'][1:]).ravel()


# ---- Measurements made here ----

def substrate(p, times):
    """Michaelis and Menten."""
    return curve(lambda t, s: [-p[0] * s[0] / (p[1] + s[0])], [5], times)[0]


def michaelis_data():
    t = np.linspace(0, 10, 21)
    return {'michaelis_menten': table('t s', t, noisy(substrate([1.2, 1.8], t), 0.05, 1))}


def swing(p, times):
    """x'' = -w^2 x - 2 d x' from x0, v0."""
    w, d, x0, v0 = p
    fast = np.sqrt(w**2 - d**2)
    return np.exp(-d * times) * (x0 * np.cos(fast * times) + (v0 + d * x0) / fast * np.sin(fast * times))


def swing_data():
    t = np.linspace(0.25, 10, 40)
    return {'damped_oscillator': table('t x', t, noisy(swing([2, 0.2, 1, -0.5], t), 0.03, 2))}


def outlier_data():
    t = np.linspace(0, 5, 26)
    x = noisy(4 * np.exp(-0.7 * t), 0.05, 3)
    x[[4, 11, 19]] += [1.5, -1.0, 2.0]
    return {'robust_decay': table('t x', t, np.round(x, 5))}


def chain_of_two(p, times):
    """A -> B -> C from A = 1."""
    a = np.exp(-p[0] * times)
    return a, p[0] / (p[1] - p[0]) * (a - np.exp(-p[1] * times))


def missing_data():
    t = np.linspace(0.2, 6, 30)
    a, b = (noisy(c, 0.02, 4 + i) for i, c in enumerate(chain_of_two([0.8, 0.3], t)))
    has_a, has_b = np.arange(30) % 3 != 1, np.arange(30) % 4 != 2
    return {'missing_rows': table('t a has_a b has_b', t, a * has_a, has_a, b * has_b, has_b)}


def missing(p, d):
    t, a, has_a, b, has_b = d['missing_rows']
    found = chain_of_two(p, t)
    return np.concatenate([has_a * (found[0] - a), has_b * (found[1] - b)])


def warmed(p, temperature):
    """A rate by Arrhenius, with that at 350 K and the energy over the gas constant in 1000 K."""
    return p[0] * np.exp(-1000 * p[1] * (1 / temperature - 1 / 350))


RUNS = {'two_runs_cold': (330, 1.0, 11), 'two_runs_hot': (370, 1.5, 12)}


def runs_data():
    t = np.linspace(0, 8, 17)
    return {name: table('t x', t, noisy(x0 * np.exp(-warmed([0.4, 6], temperature) * t), 0.01, seed))
            for name, (temperature, x0, seed) in RUNS.items()}


def runs(p, d):
    return np.concatenate([x0 * np.exp(-warmed(p, temperature) * d[name][0]) - d[name][1]
                           for name, (temperature, x0, _) in RUNS.items()])


# The start of each cup, the last minute that was measured, and the seed of its noise.
CUPS = {1: (85, 20, 31), 2: (70, 30, 32), 10: (92, 12, 33)}


def cooled(rate, room, start, t):
    """By Newton's law."""
    return room + (start - room) * np.exp(-rate * t)


def cups_data():
    def cup(start, last, seed):
        t = np.arange(0, last + 1.0, 2)
        return table('t x', t, noisy(cooled(0.08, 21, start, t), 0.3, seed))
    return {f'cups_{number}': cup(*of) for number, of in CUPS.items()}


def cups(p, d):
    return np.concatenate([(cooled(p[0], p[1], start, d[f'cups_{number}'][0]) - d[f'cups_{number}'][1]) / 0.3
                           for number, start in zip(CUPS, p[2:])])


MASS, PULL = 1.5, (9.0, 2.1)


def slider_data():
    t = np.linspace(0, 4, 41)
    force = np.round(PULL[0] * np.sin(PULL[1] * t), 3)
    return {'slider_friction': table('t x F', t, noisy(block(1.2, 0.25, MASS, t, force), 0.002, 6), force)}


def slider(p, d):
    t, x, force = d['slider_friction']
    return block(p[1], p[0], MASS, t, force) - x


def bounce_data(name):
    t = np.round(np.arange(0, 1.75, 0.05), 2)
    return {name: table('t h', t, noisy(ball(1.5, 0.3, 0.75, t), 0.005, 7))}


# The phases of bounces.fdc: the first fall, and two leaps.
PARTS = {'bounces_fall': (0, 0.5), 'bounces_first': (0.65, 1.3), 'bounces_second': (1.5, 1.9)}


def parts_data():
    data = {}
    for i, (name, (begin, end)) in enumerate(PARTS.items()):
        t = np.round(np.arange(begin, end + 0.01, 0.05), 2)
        data[name] = table('t h', t, noisy(ball(1.5, 0.3, 0.75, t), 0.005, 20 + i))
    return data


def parts(p, d):
    return np.concatenate([ball(1.5, p[1], p[0], d[name][0]) - d[name][1] for name in PARTS])


def drift_data():
    t = np.linspace(0.5, 5, 10)
    return {'random_walk': table('t x', t, noisy(np.sin(t), 0.2, 8))}


def drift(p, d):
    """Between measurements the best path is straight; its effort is the squared step over the time, counted by 0.1."""
    steps = np.diff(p) / 0.5
    return np.concatenate([[(p[0] - 0.2) * 0.5], p[1:] - d['random_walk'][1], np.sqrt(0.1 * 0.5) * steps])


FITS = {
    'misra1a': Fit(
        lambda: {'misra1a': table('t y', *MISRA)}, {'b1': 250, 'b2': 5e-4},
        lambda p, d: p[0] * (1 - np.exp(-p[1] * d['misra1a'][0])) - d['misra1a'][1],
        published={'objective': '1.2455138894E-01', 'b1': '2.3894212918E+02', 'b2': '5.5015643181E-04'}),
    'ratkowsky2': Fit(
        lambda: {'ratkowsky2': table('t y', *RATKOWSKY)}, {'b1': 75, 'b2': 2.5, 'b3': 0.07},
        lambda p, d: p[0] / (1 + np.exp(p[1] - p[2] * d['ratkowsky2'][0])) - d['ratkowsky2'][1],
        published={'objective': '8.0565229338E+00', 'b1': '7.2462237576E+01', 'b2': '2.6180768402E+00',
                   'b3': '6.7359200066E-02'}),
    'boxbod': Fit(
        lambda: {'boxbod': table('t y', *BOXBOD)}, {'b1': 100, 'b2': 0.75},
        lambda p, d: p[0] * (1 - np.exp(-p[1] * d['boxbod'][0])) - d['boxbod'][1],
        published={'objective': '1.1680088766E+03', 'b1': '2.1380940889E+02', 'b2': '5.4723748542E-01'}),
    'alpha_pinene': Fit(
        lambda: {'alpha_pinene': table('t y1 y2 y3 y4 y5', *PINENE.T)},
        {'k1': 5.8e-5, 'k2': 2.6e-5, 'k3': 1.6e-5, 'k4': 27.7e-5, 'k5': 4.6e-5}, pinene,
        published={'objective': '19.8721'}),
    'hares': Fit(
        lambda: {'hares': table('t hares lynxes', range(21), HARES, LYNXES)},
        {'a': 0.5, 'b': 0.025, 'c': 0.9, 'd': 0.027, 'h0': 35, 'l0': 4}, hares),
    'methanol': Fit(None, {f'k{i}': 1 for i in range(1, 6)}, methanol, lower=0, published={'objective': '9.02229E-03'}),
    'marine': Fit(
        None, {**{f'g{i}': 1 for i in range(1, 8)}, **{f'm{i}': 0.1 for i in range(1, 9)},
               **{f's{i}': s for i, s in enumerate([20000, 17000, 10000, 15000, 12000, 9000, 7000, 3000], 1)}},
        marine, lower=0, published={'objective': '1.97465E+07'}),
    'michaelis_menten': Fit(
        michaelis_data, {'vmax': 1, 'km': 1},
        lambda p, d: substrate(p, d['michaelis_menten'][0]) - d['michaelis_menten'][1]),
    'damped_oscillator': Fit(
        swing_data, {'w': 2.1, 'd': 0.1, 'x0': 0.8, 'v0': -0.2},
        lambda p, d: swing(p, d['damped_oscillator'][0]) - d['damped_oscillator'][1]),
    'robust_decay': Fit(
        outlier_data, {'rate': 1, 'x0': 3},
        lambda p, d: (p[1] * np.exp(-p[0] * d['robust_decay'][0]) - d['robust_decay'][1]) / 0.1, loss='soft_l1'),
    'missing_rows': Fit(missing_data, {'k1': 1, 'k2': 0.5}, missing),
    'two_runs': Fit(runs_data, {'k': 0.3, 'energy': 5}, runs),
    'cups': Fit(cups_data, {'rate': 0.1, 'room': 20, **{f'hot{i}': 80 for i in (1, 2, 3)}}, cups),
    'slider_friction': Fit(slider_data, {'mu': 0.3, 'v0': 1}, slider),
    'bouncing_ball': Fit(
        lambda: bounce_data('bouncing_ball'), {'e': 0.7, 'v0': 0.1},
        lambda p, d: ball(1.5, p[1], p[0], d['bouncing_ball'][0]) - d['bouncing_ball'][1]),
    'bounces': Fit(parts_data, {'e': 0.7, 'v0': 0.1}, parts),
    'random_walk': Fit(drift_data, {f'x{i}': 0.1 for i in range(11)}, drift, plain=False),
}
