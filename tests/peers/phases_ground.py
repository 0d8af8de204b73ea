"""Problems of tests/classics/phases on the ground: masses, vehicles, reactors, chains."""

from math import pi

from casadi import cos, exp, sin
from phases_transcription import INF, Phase, Problem


def cart(t, x, u, p):
    """x'' = u."""
    return [x[1], u[0]]


def effort(t, x, u, p):
    """The square of the control."""
    return u[0]**2


def wagon(t, x, u, p):
    """A mass of 1.59 with a drag of 0.1."""
    return [x[1], (u[0] - 0.1 * x[1]) / 1.59]


def tenth(t, x, u, p):
    """A tenth of the effort."""
    return 0.1 * u[0]**2


def same(x, p):
    """A link that changes nothing."""
    return [x[i] for i in range(x.numel())]


def fixed(begin, end):
    """Times that are numbers."""
    return lambda p: (begin, end)


def on(*durations):
    """The times of a phase after earlier ones: the last index is its own duration, all are indices of unknowns."""
    def times(p):
        begin = sum((p[i] for i in durations[:-1]), 0)
        return begin, begin + p[durations[-1]]
    return times


def chain(count):
    """x' = u with the integral of x^2 + u^2 over [0, 5], cut into equal parts."""
    h = 5 / count
    def part(i):
        return Phase(fixed(i * h, (i + 1) * h), lambda t, x, u, p: [u[0]], lambda s: [0.1], start=None if i else [1],
                     bounds=[(-10, 10)], cost=lambda t, x, u, p: x[0]**2 + u[0]**2, N=3)
    phases = {f's{i}': part(i) for i in range(count)}
    links = {(f's{i}', f's{i + 1}'): same for i in range(count - 1)}
    return Problem(phases, links=links, tell=lambda a, b, p: {'end': b[f's{count - 1}'][0]})


def shared(count=10):
    """From rest to rest over 1 in the time T, cut into equal parts, for the least T + integral of u^2."""
    phases = {f's{i}': Phase(lambda p, i=i: (i * p[0] / count, (i + 1) * p[0] / count), cart,
                             lambda s, i=i: [(i + s) / count, 0.4], start=None if i else [0, 0], bounds=[(-10, 10)],
                             cost=effort, N=1) for i in range(count)}
    last = f's{count - 1}'
    return Problem(phases, {'T': (0.5, 10, 3)}, {(f's{i}', f's{i + 1}'): same for i in range(count - 1)},
                   ends=lambda a, b, p: [(b[last][0], 1, 1), (b[last][1], 0, 0)], mayer=lambda a, b, p: p[0])


def legs(names, links):
    """Links that change nothing between phases that follow upon each other."""
    return {pair: links for pair in zip(names, names[1:])}


def dosed(i):
    """A phase of the medicine."""
    return Phase(fixed(i, i + 1), lambda t, x, u, p: [-x[0]], lambda s: [1], cost=lambda t, x, u, p: (x[0] - 1)**2, N=3)


def water(*durations):
    """A leg through moving water."""
    return Phase(on(*durations), lambda t, x, u, p: [u[0] + cos(t)], lambda s: [0],
                 start=[0] if len(durations) == 1 else None, bounds=[(-10, 10)], cost=effort)


def glass(speed, *durations):
    """A leg with a speed of its own; the heading is taken from the normal."""
    return Phase(on(*durations), lambda t, x, u, p: [speed * sin(u[0]), speed * cos(u[0])], lambda s: [1, 1],
                 start=[0, 0] if len(durations) == 1 else None, bounds=[(-1.5, 1.5)], controls=[0.5], N=4)


ACROSS = 0.3 / 0.91**0.5 + 1.5 + 2


def arm(mass):
    """Reach r, angle, their speeds; the tip has this mass, the hub an inertia of 2."""
    def rate(t, x, u, p):
        r, speed, w = x[0], x[2], x[3]
        return [speed, w, r * w**2 + u[0] / mass, (u[1] - 2 * mass * r * speed * w) / (2 + mass * r**2)]
    return rate


def catch(x, p):
    """The tip of mass 1 catches a mass 1 at rest: momentum and spin go on."""
    return [x[0], x[1], x[2] / 2, x[3] * (2 + x[0]**2) / (2 + 2 * x[0]**2)]


def both(t, x, u, p):
    return u[0]**2 + u[1]**2


def reactor(t, x, u, p):
    """A -> B -> C with the temperature as control."""
    forward, onward = 4000 * exp(-2.5 / u[0]), 620000 * exp(-5 / u[0])
    return [-forward * x[0]**2, forward * x[0]**2 - onward * x[1]]


def walk(t, x, u, p):
    return [x[1], 9.81 * x[0] + u[0]]


def road(k):
    """Place and charge."""
    return lambda t, x, u, p: [u[0], -k * u[0]**3]


GROUND = {
    'periodic_tour': Problem(
        {'out': Phase(fixed(0, 2), cart, lambda s: [1 - 2 * s, -1], start=[1, None], bounds=[(-50, 50)], cost=effort),
         'home': Phase(fixed(2, 6), cart, lambda s: [2 * s - 1, 0.5], bounds=[(-50, 50)], cost=effort)},
        links={('out', 'home'): same, ('home', 'out'): same}, ends=lambda a, b, p: [(b['out'][0], -1, -1)],
        tell=lambda a, b, p: {'v0': a['out'][1], 'v2': b['out'][1]}),
    'walker': Problem(
        {'step': Phase(fixed(0, 0.8), walk, lambda s: [s / 2 - 0.25, 0.6], start=[-0.25, None], bounds=[(-20, 20)],
                       cost=effort)},
        links={('step', 'step'): lambda x, p: [x[0] - 0.5, 0.9 * x[1]]},
        tell=lambda a, b, p: {'v1': b['step'][1]}),
    # at their bounds by the maximum principle
    'meet_soon': Problem(
        {'go': Phase(lambda p: (0, p[0] / 2), lambda t, x, u, p: [x[1], 1, x[3], -2], lambda s: [s, s, 10 - s, -s],
                     start=[0, 0, 10, 0], N=2),
         'brake': Phase(lambda p: (p[0] / 2, p[0]), lambda t, x, u, p: [x[1], -1, x[3], 2], lambda s: [2, 1, 7, -1],
                        N=2)},
        {'T': (0.5, 20, 5)}, {('go', 'brake'): same}, ends=lambda a, b, p: [(b['brake'][0] - b['brake'][2], 0, 0)],
        mayer=lambda a, b, p: p[0], tell=lambda a, b, p: {'x': b['brake'][0]}),
    'ceiling_after_link': Problem(
        {'fill': Phase(fixed(0, 2), lambda t, x, u, p: [u[0]], lambda s: [s / 2], start=[0], bounds=[(-1, 1)],
                       cost=lambda t, x, u, p: -0.1 * u[0]**2),
         'drain': Phase(fixed(2, 3), lambda t, x, u, p: [-x[0]], lambda s: [0.5], state_bounds={0: (-INF, 1)})},
        links={('fill', 'drain'): lambda x, p: [2 * x[0]]}, mayer=lambda a, b, p: b['drain'][0], maximize=True,
        tell=lambda a, b, p: {'x': b['fill'][0]}),
    # slower than the limit where the second phase begins, at it for a while, then at full brakes
    'limit_after_link': Problem(
        {'fast': Phase(on(0), wagon, lambda s: [2.12 + 0.4 * s, 0.7 + 0.3 * s], start=[2.12, 0.7], bounds=[(-1.11, 2.97)],
                       cost=tenth),
         'near': Phase(on(0, 1), wagon, lambda s: [2.52 + 0.2 * s, 0.56 + 0.01 * s], bounds=[(0.057, 1.4)], cost=tenth),
         'limit': Phase(on(0, 1, 2), lambda t, x, u, p: [x[1], 0 * x[1]], lambda s: [2.7 + s, 0.57],
                        cost=lambda t, x, u, p: 0.1 * 0.057**2, N=4),
         'slower': Phase(on(0, 1, 2, 3), wagon, lambda s: [3.6 + 0.2 * s, 0.57 - 0.1 * s], bounds=[(-0.72, 0.057)],
                         cost=tenth),
         'brake': Phase(on(0, 1, 2, 3, 4), lambda t, x, u, p: [x[1], (-0.72 - 0.1 * x[1]) / 1.59],
                        lambda s: [3.8 + 0.2 * s, 0.5 * (1 - s)], cost=lambda t, x, u, p: 0.1 * 0.72**2, N=4)},
        {'T1': (0.1, 3, 0.5), 'T2': (0.01, 3, 0.3), 'T3': (0.1, 5, 1.5), 'T4': (0.01, 3, 0.2), 'T5': (0.1, 3, 1)},
        {('fast', 'near'): lambda x, p: [x[0], 0.58 * x[1]], **legs(['near', 'limit', 'slower', 'brake'], same)},
        ends=lambda a, b, p: [(b['fast'][0], 2.52, 2.52), (b['near'][1], 0.57, 0.57), (b['brake'][0], 3.98, 3.98),
                              (b['brake'][1], 0, 0)],
        mayer=lambda a, b, p: p[0] + p[1] + p[2] + p[3] + p[4]),
    'two_roads': Problem(
        {'rough': Phase(on(0), road(8), lambda s: [s, 3 - 2 * s], start=[0, 3], bounds=[(0.1, 5)], controls=[1]),
         'smooth_road': Phase(on(0, 1), road(1), lambda s: [1 + s, 1 - s], bounds=[(0.1, 5)], controls=[1])},
        {'T1': (0.2, 10, 1.5), 'T2': (0.2, 10, 1.5)}, {('rough', 'smooth_road'): same},
        ends=lambda a, b, p: [(b['rough'][0], 1, 1), (b['smooth_road'][0], 2, 2), (b['smooth_road'][1], 0, INF)],
        mayer=lambda a, b, p: p[0] + p[1]),
    'via_point': Problem(
        {'out': Phase(fixed(0, 1), cart, lambda s: [s, 1], start=[0, 0], bounds=[(-50, 50)], cost=effort),
         'back': Phase(fixed(1, 3), cart, lambda s: [1 - s, 0], bounds=[(-50, 50)], cost=effort)},
        links={('out', 'back'): same}, ends=lambda a, b, p: [(b['out'][0], 1, 1), (b['back'][0], 0, 0)],
        tell=lambda a, b, p: {'v': b['out'][1]}),
    'jump_of_dynamics': Problem(
        {'grow': Phase(fixed(0, 1), lambda t, x, u, p: [x[0] + u[0]], lambda s: [1 - s], start=[1], bounds=[(-10, 10)],
                       cost=lambda t, x, u, p: x[0]**2 + u[0]**2),
         'fade': Phase(fixed(1, 3), lambda t, x, u, p: [-x[0] + 2 * u[0]], lambda s: [0], bounds=[(-10, 10)],
                       cost=lambda t, x, u, p: x[0]**2 + u[0]**2)},
        links={('grow', 'fade'): lambda x, p: [x[0] / 2]}, tell=lambda a, b, p: {'x': b['grow'][0]}),
    'two_limits': Problem(
        {'slow': Phase(on(0), cart, lambda s: [s, s], start=[0, 0], bounds=[(-1, 1)], N=4),
         # at its bounds by the maximum principle, switched once
         'push': Phase(on(0, 1), lambda t, x, u, p: [x[1], 2], lambda s: [1 + s, 2], N=4),
         'brake': Phase(on(0, 1, 2), lambda t, x, u, p: [x[1], -2], lambda s: [2 + s, 1 - s], N=4)},
        {'T1': (0.1, 5, 1), 'T2': (0.1, 5, 1), 'T3': (0.1, 5, 1)}, legs(['slow', 'push', 'brake'], same),
        ends=lambda a, b, p: [(b['slow'][0], 1, 1), (b['brake'][0], 3, 3), (b['brake'][1], 0, 0)],
        mayer=lambda a, b, p: p[0] + p[1] + p[2]),
    'forced_oscillator': Problem(
        {'year': Phase(fixed(0, 2 * pi), lambda t, x, u, p: [x[1], -2 * x[0] - x[1] + cos(t) + u[0]], lambda s: [0, 0],
                       bounds=[(-10, 10)], cost=lambda t, x, u, p: x[0]**2 + 0.5 * u[0]**2)},
        links={('year', 'year'): same}, tell=lambda a, b, p: {'x': a['year'][0], 'v': a['year'][1]}),
    'hopper': Problem(
        {'flight': Phase(fixed(0, 1), lambda t, x, u, p: [x[1], -9.81], lambda s: [1, 4 - 8 * s], start=[0, None], N=2),
         'stance': Phase(lambda p: (1, 1 + p[0]), lambda t, x, u, p: [x[1], u[0] - 9.81], lambda s: [-0.3, 8 * s - 4],
                         bounds=[(-100, 100)], cost=effort, N=4)},
        {'T': (0.1, 3, 0.5)}, {('flight', 'stance'): lambda x, p: [x[0], 0.8 * x[1]], ('stance', 'flight'): same},
        ends=lambda a, b, p: [(b['flight'][0], 0, 0)]),
    'refraction': Problem(
        {'air': glass(1, 0), 'sea': glass(2, 0, 1), 'ice': glass(8 / 3, 0, 1, 2)},
        {'T1': (0.1, 10, 1), 'T2': (0.1, 10, 1), 'T3': (0.1, 10, 1)}, legs(['air', 'sea', 'ice'], same),
        ends=lambda a, b, p: [(b['air'][1], 1, 1), (b['sea'][1], 3, 3), (b['ice'][1], 4.5, 4.5),
                              (b['ice'][0], ACROSS, ACROSS)],
        mayer=lambda a, b, p: p[0] + p[1] + p[2]),
    'gear_shift': Problem(
        {'first': Phase(on(0), lambda t, x, u, p: [u[0] * (4 - x[0])], lambda s: [2 * s], start=[0], bounds=[(0, 1)]),
         'shift': Phase(lambda p: (p[0], p[0] + 0.3), lambda t, x, u, p: [-0.1 * x[0]], lambda s: [2]),
         'second': Phase(lambda p: (p[0] + 0.3, p[0] + 0.3 + p[1]), lambda t, x, u, p: [u[0] * (2 - x[0] / 4)],
                         lambda s: [2 + 4 * s], bounds=[(0, 1)])},
        {'T1': (0.1, 5, 1), 'T2': (0.1, 20, 4)}, legs(['first', 'shift', 'second'], same),
        ends=lambda a, b, p: [(b['second'][0], 6, 6)], mayer=lambda a, b, p: p[0] + 0.3 + p[1]),
    'tidal_legs': Problem(
        {'out': water(0), 'over': water(0, 1), 'home': water(0, 1, 2)},
        {'D1': (0.5, 4, 1.5), 'D2': (0.5, 4, 3), 'D3': (0.5, 4, 1.5)}, legs(['out', 'over', 'home'], same),
        ends=lambda a, b, p: [(b['out'][0], 1, 1), (b['over'][0], -1, -1), (b['home'][0], 0, 0),
                              (p[0] + p[1] + p[2], 6, 6)]),
    'meeting': Problem(
        {'one': Phase(fixed(0, 1), cart, lambda s: [s, 1], start=[0, 0], bounds=[(-50, 50)], cost=effort),
         'two': Phase(fixed(0, 1), cart, lambda s: [1, 0], start=[1, 0.5], bounds=[(-50, 50)],
                      cost=lambda t, x, u, p: 2 * u[0]**2)},
        ends=lambda a, b, p: [(b['one'] - b['two'], 0, 0)], tell=lambda a, b, p: {'x': b['one'][0], 'v': b['one'][1]}),
    'doses': Problem(
        {f'day{i}': dosed(i) for i in range(4)}, {f'd{i}': (0, 5, 0.5) for i in range(1, 5)},
        {(f'day{i}', f'day{i + 1}'): (lambda x, p, i=i: [x[0] + p[i + 1]]) for i in range(3)},
        ends=lambda a, b, p: [(a['day0'][0] - p[0], 0, 0)]),
    'chain_10': chain(10),
    'chain_50': chain(50),
    'chain_shared': shared(),
    'catch_and_carry': Problem(
        {'reach': Phase(on(0), arm(1), lambda s: [1 - 0.2 * s, s, 0, 0.7], start=[1, 0, 0, 0],
                        bounds=[(-50, 50)] * 2, cost=both),
         'carry': Phase(lambda p: (p[0], 3), arm(2), lambda s: [0.8 + 0.4 * s, 1 + 1.5 * s, 0, 0.7],
                        bounds=[(-50, 50)] * 2, cost=both)},
        {'T1': (0.5, 2.5, 1.5)}, {('reach', 'carry'): catch},
        ends=lambda a, b, p: [(b['reach'][0], 0.8, 0.8), (b['reach'][1], 1, 1), (b['carry'][0], 1.2, 1.2),
                              (b['carry'][1], 2.5, 2.5), (b['carry'][2], 0, 0), (b['carry'][3], 0, 0)]),
    'two_batches': Problem(
        {'first': Phase(on(0), reactor, lambda s: [1 - s / 2, 0.1 + s / 2], start=[1, 0.1], bounds=[(0.298, 0.45)],
                        N=50),
         'second': Phase(lambda p: (p[0], 1), reactor, lambda s: [1 - s / 2, 0.1 + s / 2], bounds=[(0.298, 0.45)],
                         N=50)},
        {'T1': (0.05, 0.95, 0.5)}, {('first', 'second'): lambda x, p: [x[0] + 0.5, 0.2 * x[1]]},
        mayer=lambda a, b, p: 0.8 * b['first'][1] + b['second'][1], maximize=True),
}
