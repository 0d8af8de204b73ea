"""Dry friction, smoothed with a given width: blocks in several units, a belt, a pendulum."""

from draw import number, power, trajectory
from expressions import Expression, call, lift, name, quantity
from problem import Condition, Control, Problem, State

UNITS = {  # length, time: text and factor to SI
    'metres': (('m', 1.0), ('s', 1.0)), 'millimetres': (('mm', 1e-3), ('s', 1.0)),
    'micrometres': (('um', 1e-6), ('ms', 1e-3)), 'kilometres': (('km', 1e3), ('min', 60.0)),
}


def block(rng):
    """A block on a table, in declared units; the target is within reach of the force."""
    length, time = UNITS[rng.choice(list(UNITS))]
    speed_unit = (f'{length[0]}/{time[0]}', length[1] / time[1])
    push_unit = (f'{length[0]}/{time[0]}^2', length[1] / time[1]**2)
    x, v, F, span = name('x'), name('v'), name('F'), number(rng, 1, 4)
    friction, force = number(rng, 0.2, 2), number(rng, 4, 8)
    goal = number(rng, 0.1, 0.4) * (force - friction) * span**2 / 4
    rate = F - quantity(friction * push_unit[1], *push_unit) * Expression('Sgn', v)
    states = [State('x', v, 0.0, unit=length, move=goal * length[1]),
              State('v', rate, 0.0, unit=speed_unit, move=goal / span * speed_unit[1])]
    layer = number(rng, 0.02, 0.2) if rng.random() < 0.6 else power(rng, -4, -2)
    width = quantity(layer * goal / span * speed_unit[1], *speed_unit)
    effort = least_effort(goal, friction, span, force)
    effort = effort * push_unit[1]**2 * time[1] if effort else None
    goal *= length[1]
    floor = 1e-4 * (force * push_unit[1])**2 * span * time[1]
    control = Control('F', -force * push_unit[1], force * push_unit[1], push_unit)
    return Problem('block', states, [control], F**2, None, span * time[1], time_unit=time, N=rng.choice([40, 100, 200]),
                   sigma=width, objective_floor=floor, true_optimum=effort,
                   scheme=rng.choice(['implicit_euler', 'implicit_euler', 'midpoint', 'radau2']),
                   ends=[Condition(x, goal, goal, length), Condition(v, 0.0, 0.0, speed_unit)])


def least_effort(goal, friction, span, force):
    """The least integral of F^2 from rest to rest, None where the bound of F is met.

    It slides for a time tau with F = friction + v', and rests before or after: 12 goal^2/tau^3 + friction^2 tau,
    which is least for tau^4 = 36 (goal/friction)^2.
    """
    tau = min(span, (36 * (goal / friction)**2)**0.25)
    return 12 * goal**2 / tau**3 + friction**2 * tau if friction + 6 * goal / tau**2 < force else None


def stiff_spring(rng):
    """A mass on a spring with friction, without units; ends that are only asked for, not demanded."""
    x, v, u = name('x'), name('v'), name('u')
    k, mu, width = number(rng, 0.5, 3), number(rng, 0.1, 1), number(rng, 1, 5)
    belt = rng.choice([0.0, number(rng, -0.5, 0.5)])
    slip = v - belt if belt else v
    swing = rng.choice([x, call('sin', x)])
    states = [State('x', v, number(rng, -1, 1)), State('v', u - k * swing - mu * Expression('Sgn', slip), 0.0)]
    goal = number(rng, -0.5, 0.5)
    running = number(rng, 0.05, 1) * u**2 + number(rng, 0, 1) * (x - goal)**2
    end = number(rng, 1, 10) * (name('x(end)') - goal)**2
    return Problem('stiff_spring', states, [Control('u', -width, width)], running, end, number(rng, 1, 3),
                   N=rng.choice([40, 100]), scheme=rng.choice(['implicit_euler', 'midpoint', 'trapezoid']),
                   sigma=lift(number(rng, 0.02, 0.2)))


def pendulum(rng):
    """A pendulum with dry friction in its joint goes where a trajectory under some other torque ends."""
    a, w, u = name('a'), name('w'), name('u')
    pull, mu, width = number(rng, 4, 15), number(rng, 0.2, 2), number(rng, 3, 12)
    rate = u - pull * call('sin', a) - number(rng, 0, 0.2) * w - mu * Expression('Sgn', w)
    states = [State('a', w, number(rng, -1, 1)), State('w', rate, 0.0)]
    problem = Problem('pendulum', states, [Control('u', -width, width)], u**2, None, number(rng, 1, 4),
                      N=rng.choice([50, 100]), sigma=lift(number(rng, 0.05, 0.2)),
                      scheme=rng.choice(['implicit_euler', 'midpoint', 'radau2', 'radau3']))
    found = trajectory(problem, rng)
    if found is not None:
        problem.ends = [Condition(x, float(found[0][i, -1]), float(found[0][i, -1])) for i, x in enumerate((a, w))]
    return problem
