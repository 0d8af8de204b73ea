"""Several masses, the plane, jumps, sliding modes, and models without friction but with switches."""

from model import Model, Quantity


def two_masses(draw):
    """A driven mass, and one that is coupled to it by friction, or by a spring and a damper, over the ground."""
    q = draw.write
    mu, ground = draw.number(0.2, 1), draw.number(0.0, 0.6)
    surfaces, bound = {'between': 'v - w'}, mu + ground + draw.number(0.5, 4)
    coupled = f'{q(mu, "L/T^2")}*Sgn(between)'
    if draw.chance(0.5):
        k, d = draw.number(0.5, 5), draw.number(0.1, 1)
        coupled = f'({q(k, "1/T^2")}*(x - y) + {q(d, "1/T")}*(v - w))'
        surfaces = {}
    rates = {'x': 'v', 'v': f'u - {coupled}', 'y': 'w', 'w': coupled}
    if ground > 0.1 or not surfaces:
        surfaces['slip'] = draw.rng.choice(['v', 'w'])
        rates[surfaces['slip']] += f' - {q(max(ground, 0.1), "L/T^2")}*Sgn(slip)'
    goal, span = draw.number(0.1, 1), draw.number(1.5, 4)
    target = draw.rng.choice([('x', 'v'), ('y', 'w'), ('x', 'v', 'w')])
    free_time = draw.chance(0.3)
    running, terminal = 'u^2', f'T*{q(draw.number(0.2, 4), "L^2/T^4")}' if free_time else '0'
    if free_time and draw.chance(0.4):
        running, terminal = '0', 'T'
    return Model('two_masses', [draw.state(n, u) for n, u in (('x', 'L'), ('v', 'L/T'), ('y', 'L'), ('w', 'L/T'))],
                 [draw.control('u', 'L/T^2', None, -bound, bound)], rates, running, terminal,
                 'T' if free_time else span, draw.unit('T'), [draw.last(0.5, span * 5)] if free_time else [], surfaces,
                 ends=[(n, '==', q(goal, 'L') if n in 'xy' else q(0, 'L/T')) for n in target])


def three_masses(draw):
    """A chain with springs, each mass on the ground with its own friction."""
    q = draw.write
    mu = [draw.number(0.05, 0.6) for _ in range(3)]
    k, d, bound = draw.number(1, 6), draw.number(0.1, 1), sum(mu) + draw.number(1, 5)
    link = [f'({q(k, "1/T^2")}*(x{i} - x{i + 1}) + {q(d, "1/T")}*(v{i} - v{i + 1}))' for i in (1, 2)]
    push = ['u - ' + link[0], f'{link[0]} - {link[1]}', link[1]]
    rates, states = {}, []
    for i in (1, 2, 3):
        rates[f'x{i}'], rates[f'v{i}'] = f'v{i}', f'{push[i - 1]} - {q(mu[i - 1], "L/T^2")}*Sgn(slip{i})'
        states += [draw.state(f'x{i}', 'L'), draw.state(f'v{i}', 'L/T')]
    goal = draw.number(0.2, 1)
    return Model('three_masses', states, [draw.control('u', 'L/T^2', None, -bound, bound)], rates, 'u^2', '0',
                 draw.number(2, 4), draw.unit('T'), surfaces={f'slip{i}': f'v{i}' for i in (1, 2, 3)},
                 ends=[(f'x{draw.rng.choice([1, 3])}', '==', q(goal, 'L'))])


def puck(draw):
    """Friction against the motion in the plane, on a table or a belt."""
    q = draw.write
    mu, span, bound = draw.number(0.1, 1), draw.number(1, 3), draw.number(3, 8)
    belt = draw.rng.choice([0.0, 0.0, draw.number(-0.5, 0.5)])
    start = draw.rng.choice([(0.0, 0.0), (belt, 0.0), (draw.number(-1, 1), draw.number(-1, 1))])
    goals = [draw.number(-0.8, 0.8), draw.number(0.1, 0.8)]
    friction = q(mu, 'L/T^2')
    rates = {'x': 'v', 'y': 'w', 'v': f'a - {friction}*Dir(slide)[1]', 'w': f'b - {friction}*Dir(slide)[2]'}
    ends = [('x', '==', q(goals[0], 'L')), ('y', '==', q(goals[1], 'L'))]
    if draw.chance(0.5):
        ends += [('v', '==', q(belt, 'L/T')), ('w', '==', q(0, 'L/T'))]
    free_time = draw.chance(0.3)
    return Model('puck', [draw.state('x', 'L'), draw.state('y', 'L'), draw.state('v', 'L/T', start[0]),
                          draw.state('w', 'L/T', start[1])],
                 [draw.control(c, 'L/T^2', None, -bound, bound) for c in 'ab'], rates, 'a^2 + b^2',
                 f'T*{q(draw.number(0.5, 5), "L^2/T^4")}' if free_time else '0', 'T' if free_time else span,
                 draw.unit('T'), [draw.last(0.4, span * 5)] if free_time else [],
                 directions={'slide': (f'v - {q(belt, "L/T")}', 'w')}, ends=ends)


def impact(draw):
    """A ball with a small thruster that bounces on its way."""
    q = draw.write
    e, g, bound, high = draw.number(0.4, 0.95), draw.number(2, 10), draw.number(0.5, 3), draw.number(0.5, 2)
    count, span = draw.rng.choice([1, 1, 2]), draw.number(1, 3)
    free_time = draw.chance(0.6)
    top = draw.number(0.2, 1) * high * e**2
    kind = draw.rng.choice(['effort', 'time', 'both']) if free_time else 'effort'
    running = '0' if kind == 'time' else 'u^2'
    terminal = {'effort': '0', 'time': 'T', 'both': f'T*{q(draw.number(0.5, 5), "L^2/T^4")}'}[kind]
    ends = [('h', '==', q(float(f'{top:.2g}'), 'L'))] + ([('v', '==', q(0, 'L/T'))] if draw.chance(0.6) else [])
    return Model('impact', [draw.state('h', 'L', high), draw.state('v', 'L/T')],
                 [draw.control('u', 'L/T^2', None, -bound, bound)], {'h': 'v', 'v': f'u - {q(g, "L/T^2")}'}, running,
                 terminal, 'T' if free_time else span, draw.unit('T'),
                 [draw.last(0.2, 3 * span)] if free_time else [], {'ground': 'h'}, ends=ends,
                 paths=[('h', '>=', q(0, 'L'))] if draw.chance(0.5) else [],
                 jumps=[('bounce', 'ground', 'falling', count, {'v': f'-{e}*v'})])


def struck(draw):
    """A sliding block that rebounds from a wall."""
    q = draw.write
    mu, e, wall = draw.number(0.1, 0.8), draw.number(0.2, 0.9), draw.number(0.3, 1)
    bound, span = mu + draw.number(0.5, 4), draw.number(1.5, 4)
    return Model('struck', [draw.state('x', 'L'), draw.state('v', 'L/T')],
                 [draw.control('u', 'L/T^2', None, -bound, bound)],
                 {'x': 'v', 'v': f'u - {q(mu, "L/T^2")}*Sgn(slip)'}, 'u^2', '0', span, draw.unit('T'),
                 surfaces={'slip': 'v', 'wall': f'x - {q(wall, "L")}'},
                 ends=[('x', '==', q(float(f'{wall * draw.number(0.2, 0.9):.2g}'), 'L'))] +
                 ([('v', '==', q(0, 'L/T'))] if draw.chance(0.6) else []),
                 jumps=[('rebound', 'wall', 'rising', 1, {'v': f'-{e}*v'})])


def relay(draw):
    """A heater with two thresholds, and a control that helps."""
    on, off, loss = draw.number(2, 8), draw.number(0.2, 1), draw.number(0.1, 0.6)
    return Model('relay', [Quantity('w', start=draw.number(-0.9, 0.9)), Quantity('on', start=1.0)],
                 [Quantity('u', low=-1.0, high=1.0)], {'w': f'{on}*on - {loss}*(w + {off * 3}) + u', 'on': '0'},
                 'u^2', '0', draw.number(0.5, 2), surfaces={'warm': 'w - 1.0', 'cold': 'w + 1.0'},
                 ends=[('w', '==', str(draw.number(-0.5, 0.5)))] if draw.chance(0.5) else [('w', '<=', '0.2')],
                 jumps=[('off', 'warm', 'rising', 2, {'on': '0'}), ('again', 'cold', 'falling', 2, {'on': '1'})])


def sliding_mode(draw):
    """Two right sides that point at each other over a line, or do so for some controls only."""
    a, b, bound = draw.number(0.2, 2), draw.number(0.2, 2), draw.number(0.3, 2)
    tilt = draw.number(-0.5, 0.5)
    goal = draw.number(-0.5, 0.5)
    rates = {'x': f'1 + {draw.number(-0.5, 0.5)}*u', 'y': f'match line {{ below => {a} + u, above => -{b} + u }}'}
    ends = [('y', '==', str(goal))] if draw.chance(0.6) else []
    running = f'u^2 + {draw.number(0.5, 3)}*(y - {draw.number(-0.5, 0.5)})^2'
    return Model('sliding_mode', [Quantity('x', start=0.0), Quantity('y', start=draw.number(-1, 1))],
                 [Quantity('u', low=-bound, high=bound)], rates, running, '0', draw.number(1, 3),
                 surfaces={'line': f'y - {tilt}*x'}, ends=ends)


def switched(draw):
    """A plane divided by a line, with other linear dynamics on each side: refraction."""
    n = draw.number
    sides = [f'{n(-1, 1)}*x + {n(-1, 1)}*y + {n(-1, 1)}' for _ in range(4)]
    rates = {'x': f'match line {{ below => {sides[0]}, above => {sides[1]} }} + u',
             'y': f'match line {{ below => {sides[2]}, above => {sides[3]} }}' +
                  draw.rng.choice([' + w', ' + 0.3*u'])}
    controls = [Quantity('u', low=-3.0, high=3.0)] + [Quantity('w', low=-2.0, high=2.0)] * rates['y'].endswith('w')
    line = f'{n(0.5, 1)}*x + {n(-1, 1)}*y - {n(0.1, 0.6)}'
    running = ' + '.join(f'{c.name}^2' for c in controls)
    terminal = f'{n(1, 10)}*((x(end) - {n(0.3, 2)})^2 + (y(end) - {n(0.1, 1)})^2)'
    return Model('switched', [Quantity('x', start=0.0), Quantity('y', start=n(-0.5, 0.5))], controls, rates, running,
                 terminal, n(1, 2), surfaces={'line': line})


def coast(draw):
    """A block that friction alone brings to rest: its start is chosen."""
    mu, k, w = draw.number(0.3, 2), draw.number(0, 2), draw.number(0.05, 1)
    running = f'u^2 + {w}*(x - {draw.number(-1, 1)})^2'
    start = draw.rng.choice([None, draw.number(-2, 2)])
    speed = Quantity('v', low=-3.0, high=3.0, start=start) if start is None else Quantity('v', start=start)
    return Model('coast', [Quantity('x', start=0.0), speed],
                 [Quantity('u', low=-0.5, high=0.5)], {'x': 'v', 'v': f'u - {mu}*Sgn(slip) - {k}*x'}, running,
                 f'{draw.number(0, 2)}*v(end)^2', draw.number(1, 4), surfaces={'slip': 'v'})
