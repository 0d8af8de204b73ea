"""One mass with friction on which more and more acts, in random units."""

from model import Model

EFFORT = 'L^2/T^4'


def moved(draw, family, force, friction, start=0.0, ends=True, force_bound=None, **more):
    """A mass of 1 from rest to rest: `force` is what acts beside the control, with its sign; `friction` is its size."""
    free_time = draw.chance(0.4)
    bound = force_bound or (friction + draw.number(0.3, 4))
    span = draw.number(1, 4)
    goal = draw.number(0.1, 0.8) * min((bound - friction) * span**2 / 4, 4.0)
    goal = float(f'{goal:.2g}') * draw.rng.choice([1, 1, -1])
    q = draw.write
    conditions = [('x', '==', q(goal, 'L')), ('v', '==', q(draw.rng.choice([0, 0, 0, 0.3]), 'L/T'))]
    running, terminal = 'u^2', '0'
    if free_time:
        weight = draw.number(0.2, 5)
        running, terminal = ('0', 'T') if draw.chance(0.5) else ('u^2', f'T*{q(weight, EFFORT)}')
    elif draw.chance(0.3):
        conditions = conditions[draw.rng.choice([1, 2]):]
        sign = '-' if goal > 0 else ''
        terminal = f'{sign}x(end)*{q(draw.number(0.2, 3), "L/T^3")}' if draw.chance(0.5) else \
            f'(x(end) - {q(goal, "L")})^2*{q(draw.number(1, 10), "1/T^3")}'
        conditions = [c for c in conditions if c[0] != 'x']
    elif draw.chance(0.3):
        running = f'u^2*{draw.number(0.1, 1)} + (x - {q(goal, "L")})^2*{q(draw.number(0.5, 4), "1/T^4")}'
    model = Model(family, [draw.state('x', 'L'), draw.state('v', 'L/T', start)],
                  [draw.control('u', 'L/T^2', None, -bound, bound)], {'x': 'v', 'v': f'u{force}'}, running, terminal,
                  'T' if free_time else span, draw.unit('T'),
                  [draw.last(span / 4, span * 6)] if free_time else [], ends=conditions, **more)
    return model


def slide(draw):
    mu = draw.number(0.1, 2)
    return moved(draw, 'slide', f' - {draw.write(mu, "L/T^2")}*Sgn(slip)', mu, surfaces={'slip': 'v'})


def drag(draw):
    """Friction with linear or cubic drag."""
    mu, d = draw.number(0.1, 1.5), draw.number(0.1, 1)
    term = draw.rng.choice([f'{draw.write(d, "1/T")}*v', f'{draw.write(d, "T/L^2")}*v^3'])
    return moved(draw, 'drag', f' - {term} - {draw.write(mu, "L/T^2")}*Sgn(slip)', mu, surfaces={'slip': 'v'})


def belt(draw):
    mu, w = draw.number(0.2, 1.5), draw.number(0.1, 1) * draw.rng.choice([1, -1])
    begin = draw.rng.choice([0.0, w])
    return moved(draw, 'belt', f' - {draw.write(mu, "L/T^2")}*Sgn(slip)', mu, begin,
                 surfaces={'slip': f'v - {draw.write(w, "L/T")}'})


def slope(draw):
    mu = draw.number(0.2, 1.5)
    pull = draw.number(0.2, 1.5) * draw.rng.choice([1, -1])
    force = f' + {draw.write(pull, "L/T^2")} - {draw.write(mu, "L/T^2")}*Sgn(slip)'
    return moved(draw, 'slope', force, mu + abs(pull), surfaces={'slip': 'v'})


def spring(draw):
    mu, k = draw.number(0.1, 1), draw.number(0.3, 4)
    bound = mu + draw.number(1, 6)
    return moved(draw, 'spring', f' - {draw.write(k, "1/T^2")}*x - {draw.write(mu, "L/T^2")}*Sgn(slip)', mu,
                 force_bound=bound + (k if bound < k else 0), surfaces={'slip': 'v'})


def zones(draw):
    """Friction that changes at a place; rarely at the start itself."""
    a, b = draw.number(0.1, 1), draw.number(0.1, 1.5)
    place = 0.0 if draw.chance(0.1) else draw.number(0.05, 0.8)
    force = f'match zone {{ below => {draw.write(a, "L/T^2")}, above => {draw.write(b, "L/T^2")} }}*Sgn(slip)'
    surfaces = {'slip': 'v', 'zone': f'x - {draw.write(place, "L")}'}
    return moved(draw, 'zones', f' - {force}', max(a, b), surfaces=surfaces)


def gears(draw):
    """What the control does changes with the speed."""
    mu, switch = draw.number(0.0, 0.4), draw.number(0.2, 1.5)
    ratio = draw.number(0.3, 3)
    model = moved(draw, 'gears', '', mu, surfaces={'gear': f'v - {draw.write(switch, "L/T")}'})
    friction = ''
    if mu and draw.chance(0.6):
        model.surfaces['slip'] = 'v'
        friction = f' - {draw.write(mu, "L/T^2")}*Sgn(slip)'
    model.rates['v'] = f'match gear {{ below => u, above => u*{ratio} }}{friction}'
    return model


def timed(draw):
    """A wind that blows from or until a time."""
    mu, wind, at = draw.number(0.1, 1), draw.number(0.1, 1.5) * draw.rng.choice([1, -1]), draw.number(0.3, 1.5)
    w = draw.write(wind, 'L/T^2')
    sides = ('0.0*u', w) if draw.chance(0.5) else (w, '0.0*u')
    force = f' + match wind {{ below => {sides[0]}, above => {sides[1]} }} - {draw.write(mu, "L/T^2")}*Sgn(slip)'
    return moved(draw, 'timed', force, mu + abs(wind), surfaces={'slip': 'v', 'wind': f't - {draw.write(at, "T")}'})


def bumper(draw):
    """A spring behind a gap: the force is continuous, its slope is not."""
    mu, k, gap = draw.number(0.1, 1), draw.number(1, 10), draw.number(0.05, 0.5)
    push = f'{draw.write(k, "1/T^2")}*({draw.write(gap, "L")} - x)'
    force = f' - {draw.write(mu, "L/T^2")}*Sgn(slip) + match wall {{ below => 0.0*u, above => {push} }}'
    return moved(draw, 'bumper', force, mu, force_bound=mu + draw.number(2, 8),
                 surfaces={'slip': 'v', 'wall': f'x - {draw.write(gap, "L")}'})


def bounded(draw):
    """Friction and a bound of the speed or of the place."""
    model = draw.rng.choice([slide, slope, spring])(draw)
    model.family = 'bounded'
    goal = 0.5
    for a, _, b in model.ends:
        if a == 'x':
            goal = abs(float(b.strip('(-)').split(' ')[0]))
    if draw.chance(0.6):
        state, size = model.states[1], goal / (1.0 if model.unknowns else model.duration) * draw.number(1.05, 1.6)
    else:
        state, size = model.states[0], goal * draw.number(1.02, 1.3)
    ends = [abs(float(b.strip('(-)').split(' ')[0])) for a, _, b in model.ends if a == state.name]
    size = max([size, *(1.05 * it for it in ends)])  # an end beyond its bound is refused
    state.low, state.high = -float(f'{size:.3g}'), float(f'{size:.3g}')
    return model


def mixed(draw):
    """Several of all that at once."""
    mu, force, surfaces = draw.number(0.1, 1), '', {'slip': 'v'}
    force += f' - {draw.write(mu, "L/T^2")}*Sgn(slip)'
    size = mu
    if draw.chance(0.5):
        k = draw.number(0.2, 2)
        force += f' - {draw.write(k, "1/T^2")}*x'
        size += k
    if draw.chance(0.5):
        a, place = draw.number(-1, 1), draw.number(-0.2, 0.8)
        force += f' + match step {{ below => 0.0*u, above => {draw.write(a, "L/T^2")} }}'
        surfaces['step'] = f'x - {draw.write(place, "L")}'
        size += abs(a)
    if draw.chance(0.4):
        a, speed = draw.number(0.1, 1), draw.number(0.1, 1)
        force += f' - {draw.write(a, "L/T^2")}*Sgn(lip)'
        surfaces['lip'] = f'v - {draw.write(speed, "L/T")}'
        size += a
    if draw.chance(0.4):
        a, at = draw.number(-1, 1), draw.number(0.2, 2)
        force += f' + match late {{ below => 0.0*u, above => {draw.write(a, "L/T^2")} }}'
        surfaces['late'] = f't - {draw.write(at, "T")}'
        size += abs(a)
    return moved(draw, 'mixed', force, size, force_bound=size + draw.number(0.5, 4), surfaces=surfaces)
