"""Model number `index` of a seed."""

import random

import families as one
import families_more as more
from draw import Draw

WEIGHTS = {
    one.slide: 8, one.drag: 5, one.belt: 8, one.slope: 7, one.spring: 8, one.zones: 7, one.gears: 7, one.timed: 6,
    one.bumper: 5, one.bounded: 7, one.mixed: 10,
    more.two_masses: 7, more.three_masses: 2, more.puck: 6, more.impact: 6, more.struck: 4, more.relay: 3,
    more.sliding_mode: 6, more.switched: 6, more.coast: 4,
}


def generate(seed, index):
    """The same model for the same numbers, and its random numbers for later."""
    rng = random.Random(f'{seed} {index}')
    family = rng.choices(list(WEIGHTS), weights=list(WEIGHTS.values()))[0]
    return family(Draw(rng)), rng
