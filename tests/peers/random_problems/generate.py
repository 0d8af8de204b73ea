"""The list of families with their weights, and problem number `index` of a seed."""

import random

import families
import families_friction
import families_hard
import families_large
import families_nonconvex

WEIGHTS = {
    families.linear_quadratic: 14, families.polynomial: 12, families.trigonometric: 10, families.free_time: 10,
    families.bad_units: 10, families.widened: 10,
    families_hard.wide_bounds: 16, families_hard.redundant: 8, families_hard.infeasible: 6, families_hard.unbounded: 6,
    families_nonconvex.far_but_bounded: 4, families_nonconvex.saddle: 12, families_nonconvex.double_well: 4,
    families_nonconvex.conjugate: 6,
    families_large.chain: 7, families_large.friction_chain: 4, families_large.hard_reach: 6, families_large.tank: 4,
    families_large.heat: 4,
    families_friction.block: 6, families_friction.stiff_spring: 6, families_friction.pendulum: 5,
}


def generate(seed, index):
    """The same problem for the same numbers, whatever was generated before; and its random numbers for later."""
    rng = random.Random(f'{seed} {index}')
    problem = rng.choices(list(WEIGHTS), weights=list(WEIGHTS.values()))[0](rng)
    problem.method = rng.choices(['', '  linear = sparse_ldl\n', '  solver = interior_point\n'], weights=[85, 10, 5])[0]
    return problem, rng
