"""What a problem with surfaces is, and what it comes to where the mode of each surface is given.

A surface is above, below or held in a phase (`+`, `-`, `0`); where it is held its selector s is an unknown with
|s| <= 1 and d psi/dt = 0. Nothing is smoothed, and nothing here is shared with fdcc.
"""

from dataclasses import dataclass, field
from typing import Callable

import casadi as ca

@dataclass
class Model:
    """A problem with surfaces.

    `rate` and `cost` take (t, x, u, s, p): time, states, controls, selectors (one column for each surface) and
    unknowns; `surfaces` and `path` (which is to be positive or 0) take (t, x, p) and (t, x, u, s, p). A surface of two
    or more components is that of `Dir`: it moves (`+`) or rests (`0`). `sequences` are words such as `0 +^ +`: modes,
    then `^` or `_` for each control that is at its upper or lower bound (`~` if free), `!` and the name of a jump that
    begins the phase, `=` and that of a touch point, `&` and that of an arc, `:` and a guess of the duration.
    """

    start: Callable  # p -> first values, None for each that is open
    rate: Callable
    guess: Callable  # s in [0, 1] -> states
    sequences: list
    T: tuple  # (lower, upper, guess); both the same if it is given
    surfaces: Callable = lambda t, x, p: []
    bounds: list = field(default_factory=list)  # of the controls
    controls: Callable = None  # s -> their guess; the middle of the bounds otherwise
    state_bounds: dict = field(default_factory=dict)  # index: (lower, upper)
    cost: Callable = lambda t, x, u, s, p: 0
    mayer: Callable = lambda x, t, p: 0
    ends: Callable = lambda x, t, p: []  # [(expression, lower, upper, surface that implies it when held or None)]
    path: Callable = lambda t, x, u, s, p: []
    jumps: dict = field(default_factory=dict)  # name: (surface, (t, x, p) -> states afterwards)
    arcs: dict = field(default_factory=dict)  # name: (entry of (t, x, p), equation of (t, x, u, s, p))
    touches: dict = field(default_factory=dict)  # name: (t, x, p) -> what is 0 where a path is touched
    unknowns: dict = field(default_factory=dict)  # name: (lower, upper, guess)
    joined: bool = True  # controls are continuous where an arc begins or ends and no mode changes
    scale: float = 1.0
    N: int = 8
    gap: float = 1e-6  # that a replay may have, relative to the states


@dataclass
class Step:
    """One phase of a sequence."""

    modes: str
    pins: str = ''
    jump: str = ''
    touch: str = ''
    arc: str = ''
    duration: float = None


def steps_of(sequence, surfaces):
    """The phases of a word like `0 +^:0.3 +`."""
    def step(word):
        word, _, duration = word.partition(':')
        word, _, arc = word.partition('&')
        word, _, touch = word.partition('=')
        word, _, jump = word.partition('!')
        return Step(word[:surfaces], word[surfaces:], jump, touch, arc, float(duration) if duration else None)
    return [step(word) for word in sequence.split()]


def symbols(model):
    """t, x, p and what `surfaces` gives."""
    t, x = ca.SX.sym('t'), ca.SX.sym('x', len(model.guess(0)))
    p = ca.SX.sym('p', len(model.unknowns))
    surfaces = [ca.vertcat(*psi) if isinstance(psi, list) else ca.SX(psi) for psi in model.surfaces(t, x, p)]
    return t, x, p, surfaces


def functions(model, modes, arc=''):
    """(t, x, u, z, p) -> rate, cost, d psi/dt of held surfaces, what is positive; z the selectors of held ones."""
    t, x, p, surfaces = symbols(model)
    u = ca.SX.sym('u', len(model.bounds))
    selectors, unknown, rows, positive = [], [], [], []
    for psi, mode in zip(surfaces, modes):
        if mode == '0':
            unknown.append(ca.SX.sym('s', psi.numel()))
            selectors.append(unknown[-1])
        else:
            side = ca.SX(1 if mode == '+' else -1)
            selectors.append(psi / ca.sqrt(ca.sumsqr(psi) + 1e-30) if psi.numel() > 1 else side)
    rate = ca.vertcat(*model.rate(t, x, u, selectors, p))
    for psi, mode, s in zip(surfaces, modes, selectors):
        if mode == '0':
            rows.append(ca.jtimes(psi, x, rate) + ca.jacobian(psi, t))
            positive += [1 - ca.sumsqr(s)] if psi.numel() > 1 else []
        elif psi.numel() == 1:
            positive.append(psi if mode == '+' else -psi)
    if arc:
        rows.append(model.arcs[arc][1](t, x, u, selectors, p))
    positive += model.path(t, x, u, selectors, p)
    cost = ca.SX(model.cost(t, x, u, selectors, p))
    return ca.Function('f', [t, x, u, ca.vertcat(ca.SX(0, 1), *unknown), p],
                       [rate, cost, ca.vertcat(ca.SX(0, 1), *rows), ca.vertcat(ca.SX(0, 1), *positive)])
