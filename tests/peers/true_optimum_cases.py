"""What is asked of each model: the program's problem, the closed form, and what is known of uniqueness."""

from dataclasses import dataclass
from typing import Callable

import true_optimum_closed as closed
import true_optimum_models as models

WAIT = 'not unique: the mass may wait before, after or both; how long it slides is unique'
ONE = 'one optimum'
SAME = 'any share of the hold with |s| = 1 is the same motion'
G = 9.81


@dataclass
class Case:
    """One row of the table."""

    problem: Callable = None  # () -> Model
    closed: Callable = None  # () -> (objective, times or None, numbers by name)
    unique: str = ONE
    sense: int = 1  # -1 where the model maximises
    skipped: str = ''


def effort(c, d, T, m=1.0, weight=1.0):
    """A closed form with times: it slides first and waits then."""
    J, D = closed.effort(c, d, T, m)
    return weight * J, [D] if D < T else [], {}


def gear(*numbers):
    """Both times at which the motor changes, and the end."""
    T, times = closed.gear(*numbers)
    return T, [times[0], times[-1]], {'T': T, 'arcs': [*times[1:3]]}


def rest_soon():
    T, switch = closed.rest_soon(0.5, 2, 1)
    return T, [], {'T': T, 'arcs': [switch]}


def reverse_soon():
    T, (turn, switch) = closed.reverse_soon(0.5, 2, 1, 1)
    return T, [turn], {'T': T, 'arcs': [switch]}


def crossing():
    J, x0 = closed.crossing()
    return J, [-x0 / 3], {'x0': x0}


def dc_motor():
    J, (leaves, singular) = closed.dc_motor()
    return J, [leaves], {'arcs': [singular]}


def slider_fit():
    J, (mu, m), stop = closed.slider_fit()
    return J, [stop], {'mu': mu, 'm': m}


def fit():
    J, mu, stops = closed.friction_fit()
    return J, stops, {'mu': mu}


def throw():
    J, vy, times = closed.throw()
    return J, [times[0]], {'T': sum(times), 'vx': 6 / sum(times), 'vy': vy}


SIMULATED = 'nothing is chosen or minimised: for `simulate`'

CASES = {
    'models/block': Case(models.block, lambda: effort(0.6 * G, 1, 4, 2), WAIT),
    'models/bounce': Case(models.bounce, None, 'one bounce; without it 282.58'),
    'models/coulomb_energy': Case(models.coulomb_energy, lambda: effort(0.5, 1, 3, 1, 0.5)),
    'models/coulomb_rest': Case(models.coulomb_rest, rest_soon),
    'models/coulomb_reverse': Case(models.coulomb_reverse, reverse_soon),
    'models/crossing': Case(models.crossing, crossing),
    'models/puck': Case(models.puck, lambda: effort(0.5, 1, 3, 1, 0.5)),
    'models/slider_fit': Case(None, slider_fit),
    'models/stacked': Case(models.stacked, lambda: effort(0.8 * G, 1, 3, 4),
                           WAIT + '; the blocks never slip on each other (those sequences fall back on this one)'),
    'models/turbo': Case(models.turbo, lambda: gear(5, 10, 3, 20, 200)),
    'right/dc_motor': Case(models.dc_motor, dc_motor, 'one optimum; at first it sticks while the current rises'),
    'right/gripper': Case(models.gripper, None,
                          'the finger draws back, runs up and lets go; pushing at once is a local optimum of 3.0'),
    'right/inclined_plane': Case(models.inclined_plane, lambda: (closed.inclined_plane(), None, {}),
                                 'not unique: every way up that never slides back costs the same'),
    'right/pension': Case(models.pension, lambda: (closed.pension(), [40], {}), sense=-1),
    'right/pushed_table': Case(models.pushed_table, lambda: effort(40, (9 + 0.09)**0.5, 4, 20), WAIT),
    'right/sled_on_ice': Case(models.sled_on_ice),
    **{f'right/{name}': Case(skipped=SIMULATED) for name in (
        'bouncing_ball', 'buck_switched', 'gene_switch', 'relay_reset', 'sliding_mode', 'stick_slip', 'thermostat')},
    'templates/bounce': Case(None, throw, 'one bounce is best: two 23.3070, none 54.1590'),
    'templates/fit': Case(None, fit),
    'templates/friction': Case(models.friction, None, 'one optimum; it rests at its place'),
    'templates/switched': Case(models.switched, lambda: gear(0.05, 0.1, 1.25, 0.2, 2)),
}
