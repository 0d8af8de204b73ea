#!/usr/bin/env python3
"""Whether the checks see what is false: certified documents of fdcc, changed in every way that they look for.

`check_judge.py FDCC` exits with 1 if a change is not seen, or if the truth is refused.
"""

import copy
import pathlib
import random
import sys
import tempfile

sys.dont_write_bytecode = True

from answer import Answer  # noqa: E402
from model import Model, Quantity  # noqa: E402
from replayed import replayed  # noqa: E402
from run import judged, solved  # noqa: E402


def sled(bound=4.0, friction=1.0, quickly=False, wind=None):
    """A mass with friction from rest to rest over 1: with little effort in 3, or in the shortest time."""
    rate, surfaces = f'u - {friction}*Sgn(slip)', {'slip': 'v'}
    if wind:
        rate, surfaces = rate + f' + match late {{ below => 0.0*u, above => {wind} }}', {**surfaces, 'late': 't - 0.7'}
    return Model('sled', [Quantity('x'), Quantity('v')], [Quantity('u', low=-bound, high=bound)],
                 {'x': 'v', 'v': rate}, '0' if quickly else 'u^2', 'T' if quickly else '0', 'T' if quickly else 3.0,
                 unknowns=[Quantity('T', low=0.3, high=9.0, start=2.0)] if quickly else [], surfaces=surfaces,
                 ends=[('x', '==', '1.0'), ('v', '==', '0.0')])


def bouncing(e=0.8):
    return Model('bouncing', [Quantity('h', start=1.0), Quantity('v')], [Quantity('u', low=-3.0, high=3.0)],
                 {'h': 'v', 'v': 'u - 4.0'}, 'u^2', '0', 1.2, surfaces={'ground': 'h'}, ends=[('h', '==', '0.3')],
                 jumps=[('bounce', 'ground', 'falling', 1, {'v': f'-{e}*v'})])


def certified(fdcc, model):
    """The document of a model."""
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / 'model.fdc'
        path.write_text(model.text())
        document, code, _ = solved(fdcc, path)
    if code != 0:
        sys.exit(f'the models of this test have to be certified: {document if isinstance(document, str) else code}')
    return document


def scaled(document, *keys, by):
    """One number of a document, or a list of them, times a factor."""
    changed = copy.deepcopy(document)
    place = changed
    for key in keys[:-1]:
        place = place[key]
    value = place[keys[-1]]
    place[keys[-1]] = [v * by for v in value] if isinstance(value, list) else value * by
    return changed


def wavy(model, document):
    """Another control that meets the ends, by a wave of no area and no first moment, with its states and its objective."""
    changed = copy.deepcopy(document)
    nodes, moving = changed['control_nodes'], [s for s in document['surfaces']['slip'] if s['mode'] == 'above'][0]
    span, middle = moving['to'] - moving['from'], (moving['to'] + moving['from']) / 2
    for k, t in enumerate(nodes['time']):
        s = 2 * (t - middle) / span
        if abs(s) < 1:
            nodes['values']['u'][k] += 0.2 * (35 * s**4 - 30 * s**2 + 3) / 8  # Legendre: orthogonal to 1 and s
    answer = Answer(model, changed)
    _, simulation = replayed(answer)
    for k, name in enumerate(('x', 'v')):
        changed['states'][name] = [document['states'][name][0], *(x[k] for x in simulation.nodes)]
    changed['objective'] = simulation.x[-1]
    return changed


def cases(fdcc):
    """(what is said, the model, the document, a word of what has to be found or None)."""
    slow, quick, ball = certified(fdcc, sled()), certified(fdcc, sled(quickly=True)), certified(fdcc, bouncing())
    yield 'the truth, effort', sled(), slow, None
    yield 'the truth, time', sled(quickly=True), quick, None
    yield 'the truth, a bounce', bouncing(), ball, None
    yield 'a false objective', sled(), scaled(slow, 'objective', by=1.0001), 'objective'
    yield 'a false control', sled(), scaled(slow, 'control_nodes', 'values', 'u', by=1.001), 'states'
    yield 'false states', sled(), scaled(slow, 'states', 'x', by=1.0001), 'states'
    yield 'a control beyond its bounds', sled(bound=3.9, quickly=True), quick, 'controls'
    yield 'other friction', sled(friction=1.001), slow, 'states'
    yield 'a wind that is not known', sled(wind=0.01), slow, 'states'
    yield 'another rebound', bouncing(0.81), ball, 'states'
    yield 'a worse control', sled(), wavy(sled(), slow), 'better'
    yield 'not the shortest time', sled(quickly=True), certified(fdcc, sled(3.9, quickly=True)), 'better'
    yield 'not the least effort', sled(), certified(fdcc, sled(1.8)), 'better'


def main():
    blind = 0
    for said, model, document, word in cases(sys.argv[1]):
        found, _ = judged(model, random.Random(1), document)
        right = not found if word is None else any(word in why for why in found)
        blind += not right
        print(f'{"ok" if right else "FAILED"}  {said}: {"; ".join(found) or "nothing wrong"}')
    return 1 if blind else 0


if __name__ == '__main__':
    sys.exit(main())
