"""Problems of tests/classics/phases in the air and above it."""

from math import pi, radians
from math import cos as c_, sin as s_

from casadi import cos, exp, sin, sqrt
from phases_transcription import INF, Phase, Problem


def same(x, p):
    """A link that changes nothing."""
    return [x[i] for i in range(x.numel())]


def after(index):
    """The times of a phase whose duration is an unknown, after those of the unknowns before it."""
    def times(p):
        begin = sum((p[i] for i in range(index)), 0)
        return begin, begin + p[index]
    return times


def climb(push, exhaust=2500):
    """A rocket without drag in 100 km, km/s, t; `push` is its thrust in kN, or None for a control."""
    def rate(t, x, u, p):
        thrust = u[0] if push is None else push
        return [x[1] / 100, (thrust / x[2] - 9.81) / 1000, -thrust / exhaust]
    return rate


def drop(x, p):
    """The empty stage of 0.3 t goes."""
    return [x[0], x[1], x[2] - 0.3]


def goddard(push):
    """COPS: height, speed, mass; the thrust is fixed or a control."""
    def rate(t, x, u, p):
        h, v, m = x[0], x[1], x[2]
        thrust = u[0] if push is None else push
        drag = 310 * v**2 * exp(-500 * (h - 1))
        return [v, (thrust - drag) / m - 1 / h**2, -thrust / 0.5]
    return rate


def singular(t, x, u, p):
    """Where the switching function of the thrust stays 0: (1 + v/c) drag = weight."""
    return [(1 + x[1] / 0.5) * 310 * x[1]**2 * exp(-500 * (x[0] - 1)) - x[2] / x[0]**2]


def orbit(push):
    """Radius, speeds outwards and along, mass; thrust 0.1 with a speed of the exhaust of 0.5, headed by the control."""
    def rate(t, x, u, p):
        r, out, along, m = x[0], x[1], x[2], x[3]
        a = push / m
        angle = u[0] if push else 0
        return [out, along**2 / r - 1 / r**2 + a * sin(angle), -out * along / r + a * cos(angle), -push / 0.5]
    return rate


def coast(t, x, u, p):
    """The same without a thrust and a mass."""
    return [x[1], x[2]**2 / x[0] - 1 / x[0]**2, -x[1] * x[2] / x[0]]


def ball(t, x, u, p):
    """Place, height, speed upwards; the speed along the ground is an unknown."""
    return [p[0], x[2], -9.81]


# The units of the launch: the radius of the Earth, its orbital time, the mass at the start.
MU, EARTH, MASS = 3.986012e14, 6378145.0, 301454.0
TIME = (EARTH**3 / MU)**0.5
SPIN = 7.29211585e-5 * TIME
PUSH = TIME**2 / EARTH / MASS
DRAG = 0.5 * 0.5 * 4 * pi * 1.225 * EARTH / MASS
SOLID, FIRST, SECOND = (TIME / MASS * flow for flow in (17010 / 75.2, 95550 / 261, 16820 / 700))


def stage(solids, first, second):
    """A phase of the launch with so many solid boosters and engines that burn."""
    push = PUSH * (solids * 628500 + first * 1083100 + second * 110094)
    flow = solids * SOLID + first * FIRST + second * SECOND

    def rate(t, x, u, p):
        r, v, m = x[0:3], x[3:6], x[6]
        size = sqrt(r[0]**2 + r[1]**2 + r[2]**2)
        wind = [v[0] + SPIN * r[1], v[1] - SPIN * r[0], v[2]]
        drag = DRAG * exp(-(size - 1) * EARTH / 7200) * sqrt(wind[0]**2 + wind[1]**2 + wind[2]**2)
        return [v[0], v[1], v[2], *(-r[i] / size**3 + (push * u[i] - drag * wind[i]) / m for i in range(3)), -flow]
    return rate


def lose(mass):
    """A link of the launch: a mass in kg is dropped."""
    return lambda x, p: [*(x[i] for i in range(6)), x[6] - mass / MASS]


def rough(i, t):
    """The guess of a phase of the launch, that of delta_launch.fdc."""
    return [
        lambda: [0.879 * 1.003, 0.13 * t * 1.003, 0.477 * 1.003, 0.9 * t, 0.05 + t, 0.3 * t, 1 - 4.6 * t],
        lambda: [0.885, 0.2 * (t - 0.03), 0.48, 0.08, 0.15 + 2 * (t - 0.09), 0.03, 0.54 - 2.8 * (t - 0.09)],
        lambda: [0.89, 0.03 + 0.6 * (t - 0.19), 0.482, 0.08 - 0.5 * (t - 0.19), 0.35 + 2.9 * (t - 0.19), 0.02,
                 0.26 - (t - 0.19)],
        lambda: [0.92 - 0.25 * (t - 0.32), 0.11 + 0.67 * (t - 0.32), 0.5 - 0.15 * (t - 0.32), -0.9 * (t - 0.32),
                 0.75 + 0.3 * (t - 0.32), -0.5 * (t - 0.32), 0.078 - 0.06 * (t - 0.32)]][i]()


def flown(i, begin, end):
    """A phase of the launch between two times; the last one ends at the unknown."""
    return Phase(
        lambda p: (begin / TIME, p[0] if i == 3 else end / TIME), STAGES[i],
        lambda s: rough(i, (begin + s * (end - begin)) / TIME),
        start=[c_(radians(28.5)), 0, s_(radians(28.5)), 0, SPIN * c_(radians(28.5)), 0, 1] if i == 0 else None,
        bounds=[(-1.1, 1.1)] * 3, controls=[0, 0.9, -0.4] if i == 3 else [0.6, 0.8, 0.1] if i else [0.9, 0.1, 0.4],
        state_bounds={**{k: (-2, 2) for k in range(6)}, 6: (0.01, 1)},
        path=lambda t, x, u, p: [u[0]**2 + u[1]**2 + u[2]**2, x[0]**2 + x[1]**2 + x[2]**2],
        path_bounds=[(1, 1), (1, INF)], N=5)


STAGES = [stage(6, 1, 0), stage(3, 1, 0), stage(0, 1, 0), stage(0, 0, 1)]


def target():
    """Angular momentum and eccentricity vector of the orbit, from its elements."""
    a, e, i, node, pericentre = 24361140 / EARTH, 0.7308, *(radians(v) for v in (28.5, 269.8, 130.5))
    h = (a * (1 - e**2))**0.5
    n = (c_(node), s_(node), 0)
    m = (-c_(i) * s_(node), c_(i) * c_(node), s_(i))
    return [h * v for v in (s_(i) * s_(node), -s_(i) * c_(node), c_(i))], [
        e * (c_(pericentre) * n[k] + s_(pericentre) * m[k]) for k in range(3)]


def reached(a, b, p):
    """The orbit is that of the target: five conditions, because the two vectors are at right angles."""
    x = b['second']
    r, v = [x[i] for i in range(3)], [x[i] for i in range(3, 6)]
    h = [r[1] * v[2] - r[2] * v[1], r[2] * v[0] - r[0] * v[2], r[0] * v[1] - r[1] * v[0]]
    size = sqrt(r[0]**2 + r[1]**2 + r[2]**2)
    e = [v[1] * h[2] - v[2] * h[1] - r[0] / size, v[2] * h[0] - v[0] * h[2] - r[1] / size]
    momentum, eccentricity = target()
    return [(g - w, 0, 0) for g, w in zip([*h, *e], [*momentum, *eccentricity])]


FLIGHT = {
    # at full thrust by the maximum principle
    'two_stages': Problem(
        {'boost': Phase(after(0), climb(40), lambda s: [0.4 * s, 1.4 * s, 1.5 - 0.8 * s], start=[0, 0, 1.5],
                        state_bounds={2: (0.7, 1.5)}),
         'sustain': Phase(after(1), climb(8), lambda s: [0.4 + 2 * s, 1.4 + 2 * s, 0.4 - 0.28 * s],
                          state_bounds={2: (0.12, 0.4)}),
         'coast': Phase(after(2), climb(0), lambda s: [2 + 7 * s, 3.5 * (1 - s), 0.12])},
        {'T1': (10, 80, 45), 'T2': (10, 150, 80), 'T3': (10, 600, 350)},
        {('boost', 'sustain'): drop, ('sustain', 'coast'): same}, mayer=lambda a, b, p: 1e5 * b['coast'][0],
        maximize=True, scale=1e-5),
    # as hard as it can until its fuel is gone, by the maximum principle
    'sounding_rocket': Problem(
        {'first': Phase(after(0), climb(200, 2800), lambda s: [0.3 * s, 1.2 * s, 10 - 4 * s], start=[0, 0, 10], N=4),
         'second': Phase(after(1), climb(60, 2800), lambda s: [0.3 + 0.2 * s, 1.2, 5 - 0.5 * s], N=4),
         'third': Phase(after(2), climb(15, 2800), lambda s: [0.5, 1.1, 4.2 - 0.2 * s], N=4),
         'coast': Phase(after(3), climb(0), lambda s: [0.5 + 0.6 * s, 1 - s, 4], N=4)},
        {'T1': (1, 200, 60), 'T2': (1, 200, 20), 'T3': (1, 200, 20), 'Tc': (1, 2000, 100)},
        {('first', 'second'): lambda x, p: [x[0], x[1], x[2] - 0.8],
         ('second', 'third'): lambda x, p: [x[0], x[1], x[2] - 0.3], ('third', 'coast'): same},
        ends=lambda a, b, p: [(b['third'][2], 4, 4), (b['coast'][1], 0, 0)],
        mayer=lambda a, b, p: 1e5 * b['coast'][0], maximize=True, scale=1e-5),
    # models/twostage.fdc; its phases are cut where the thrust is switched off
    'twostage': Problem(
        {'boost': Phase(after(0), climb(40), lambda s: [0.4 * s, 1.4 * s, 1.5 - 0.8 * s], start=[0, 0, 1.5]),
         'wait': Phase(after(1), climb(0), lambda s: [0.4 + 0.6 * s, 1.4 - 0.6 * s, 0.7]),
         'sustain': Phase(after(2), climb(8), lambda s: [1 + s, 0.8 + s, 0.4 - 0.2 * s]),
         'coast': Phase(after(3), climb(0), lambda s: [2 + 2 * s, 1.8 * (1 - s), 0.2])},
        {'burn1': (1, 50, 50), 'wait': (0, 119, 30), 'burn2': (1, 87.5, 50), 'fall': (1, 199, 150)},
        {('boost', 'wait'): same, ('wait', 'sustain'): drop, ('sustain', 'coast'): same},
        ends=lambda a, b, p: [(b['coast'][1], 0, 0), (p[0] + p[1], 5, 120), (p[2] + p[3], 5, 200)],
        mayer=lambda a, b, p: 1e5 * b['coast'][0], maximize=True, scale=1e-5),
    'goddard_arcs': Problem(
        {'full': Phase(after(0), goddard(3.5), lambda s: [1 + 0.001 * s, 0.1 * s, 1 - 0.15 * s], start=[1, 0, 1]),
         'sustain': Phase(after(1), goddard(None), lambda s: [1 + 0.005 * s, 0.12, 0.85 - 0.25 * s], bounds=[(0, 3.5)],
                          controls=[1.5], path=singular, path_bounds=[(0, 0)]),
         'coast': Phase(after(2), goddard(0), lambda s: [1.006 + 0.006 * s, 0.1 - 0.1 * s, 0.6])},
        {'T1': (0.005, 0.1, 0.02), 'T2': (0.01, 0.2, 0.05), 'T3': (0.02, 0.3, 0.12)},
        {('full', 'sustain'): same, ('sustain', 'coast'): same},
        ends=lambda a, b, p: [(b['coast'][2], 0.6, 0.6), (*singular(0, b['full'], None, p), 0, 0)],
        mayer=lambda a, b, p: b['coast'][0], maximize=True),
    'low_thrust_coast': Problem(
        {'leave': Phase(after(0), orbit(0.1), lambda s: [1, 0, 1, 1 - 0.2 * s], start=[1, 0, 1, 1], bounds=[(-2, 2)]),
         'coast': Phase(after(1), orbit(0), lambda s: [1 + 0.5 * s, 0.1, 1 - 0.2 * s, 0.8]),
         'arrive': Phase(after(2), orbit(0.1), lambda s: [1.5, 0, 0.82, 0.8 - 0.2 * s], bounds=[(-2, 2)])},
        {'T1': (0.1, 4, 1), 'T2': (0.1, 8, 3), 'T3': (0.1, 4, 1)},
        {('leave', 'coast'): same, ('coast', 'arrive'): same},
        ends=lambda a, b, p: [(b['arrive'][0], 1.5, 1.5), (b['arrive'][1], 0, 0),
                              (b['arrive'][2], 1.5**-0.5, 1.5**-0.5), (p[0] + p[1] + p[2], -INF, 5)],
        mayer=lambda a, b, p: b['arrive'][3], maximize=True),
    'hohmann': Problem(
        {'park': Phase(lambda p: (0, 1), coast, lambda s: [1, 0, 1], start=[1, 0, 1], N=4),
         'transfer': Phase(lambda p: (1, 1 + p[4]), coast, lambda s: [1 + s, 0.1, 1.15 - 0.6 * s], N=20),
         'stay': Phase(lambda p: (1 + p[4], 2 + p[4]), coast, lambda s: [2, 0, 0.7], N=4)},
        {'away1': (-1, 1, 0.05), 'along1': (-1, 1, 0.2), 'away2': (-1, 1, 0.05), 'along2': (-1, 1, 0.2),
         'T': (2, 9, 5)},
        {('park', 'transfer'): lambda x, p: [x[0], x[1] + p[0], x[2] + p[1]],
         ('transfer', 'stay'): lambda x, p: [x[0], x[1] + p[2], x[2] + p[3]]},
        ends=lambda a, b, p: [(a['stay'][0], 2, 2), (a['stay'][1], 0, 0), (a['stay'][2], 0.5**0.5, 0.5**0.5)],
        mayer=lambda a, b, p: sqrt(p[0]**2 + p[1]**2) + sqrt(p[2]**2 + p[3]**2)),
    'throw': Problem(
        {'fly': Phase(lambda p: (0, p[2]), ball, lambda s: [4 * s, 1.5 * (1 - s), 1 - 8 * s], start=[0, 1.5, None],
                      N=2),
         'leap': Phase(lambda p: (p[2], p[2] + p[3]), ball, lambda s: [4 + 2 * s, s, 4 - 8 * s], N=2)},
        {'vx': (0, 20, 4), 'vy': (-10, 10, 2), 'T1': (0.1, 3, 0.8), 'T2': (0.1, 3, 0.9)},
        {('fly', 'leap'): lambda x, p: [x[0], x[1], -0.8 * x[2]]},
        ends=lambda a, b, p: [(a['fly'][2] - p[1], 0, 0), (b['fly'][1], 0, 0), (b['leap'][0], 6, 6),
                              (b['leap'][1], 1, 1)],
        mayer=lambda a, b, p: p[0]**2 + p[1]**2),
    'delta_launch': Problem(
        {'six': flown(0, 0, 75.2), 'three': flown(1, 75.2, 150.4), 'first': flown(2, 150.4, 261),
         'second': flown(3, 261, 920)},
        {'T': (850 / TIME, 961 / TIME, 920 / TIME)},
        {('six', 'three'): lose(13680), ('three', 'first'): lose(6840), ('first', 'second'): lose(8830)},
        ends=reached, mayer=lambda a, b, p: b['second'][6], maximize=True,
        tell=lambda a, b, p: {'kilograms': MASS * b['second'][6], 'seconds': TIME * p[0]}),
}
