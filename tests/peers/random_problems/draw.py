"""What the families share: random numbers, and trajectories that prove that a problem is feasible."""

import numpy as np

from expressions import name, total
from steps import Advance


def number(rng, low, high, digits=3):
    """Uniform, with few digits, so that models are readable."""
    return float(f'{rng.uniform(low, high):.{digits}g}')


def power(rng, low, high):
    """A power of ten between 10^low and 10^high, times 1 to 9."""
    return float(f'{10 ** rng.uniform(low, high):.1g}')


def names(prefix, count):
    return [name(f'{prefix}{i + 1}') for i in range(count)]


def linear(rng, variables, low=-1, high=1, density=1.0):
    """A random linear form."""
    return total(number(rng, low, high) * v for v in variables if rng.random() < density)


def squares(rng, variables, low=0.1, high=2, goals=False):
    """A sum of squares with random weights, about random goals."""
    return total(number(rng, low, high) * (v - number(rng, -1, 1) if goals else v)**2 for v in variables)


def scheme(rng, implicit=False):
    """Any scheme, the simple ones more often; or any that is implicit."""
    simple = ['implicit_euler', 'midpoint', 'trapezoid'] + ([] if implicit else ['rk4', 'euler'])
    return rng.choice(3 * simple + ['radau2', 'radau3', 'gauss2'])


def trajectory(problem, rng, amplitude=None, duration=None):
    """A discrete trajectory under random smooth controls: states, controls; None if it runs away."""
    controls = np.array([smooth(rng, c, problem.N, amplitude) for c in problem.controls])
    advance, unknowns = Advance(problem), [u.guess for u in problem.unknowns]
    h = (duration or problem.span) / problem.N
    states = [np.array([s.start if s.start is not None else 0.0 for s in problem.states])]
    for k in range(problem.N):
        found = advance(k * h, h, states[-1], controls[:, k], unknowns)
        if found is None or np.abs(found[0]).max() > 1e6:
            return None
        states.append(found[0])
    return np.array(states).T, controls


def smooth(rng, control, count, amplitude):
    """A few cosines inside the middle of the bounds, of size 1 at most."""
    low, high = max(control.low, -1.0), min(control.high, 1.0)
    if low > high:
        low, high = control.low, min(control.high, control.low + 1)
    middle, half = (low + high) / 2, (high - low) / 2 * (amplitude or 0.8)
    s, wave = np.linspace(0, 1, count), np.zeros(count)
    weights = [rng.uniform(-1, 1) for _ in range(3)]
    for i, weight in enumerate(weights):
        wave += weight / 3 * np.cos(np.pi * i * s)
    return middle + half * wave
