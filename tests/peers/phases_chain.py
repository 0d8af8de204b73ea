#!/usr/bin/env python3
"""Writes chain_10.fdc, chain_50.fdc, chain_shared.fdc of tests/classics/phases: one problem, cut into equal phases."""

from pathlib import Path

FOLDER = Path(__file__).parent.parent / 'classics' / 'phases'

REGULATOR = '''\
#! A regulator, cut into {count} phases that are all alike: the answer is that of one phase.
#! Closed form: P = tanh(5 - t) solves the Riccati equation (Kalman 1960), so the cost is tanh(5)
#! and x(5) = 1/cosh(5).
#! Written by tests/peers/phases_chain.py.
model chain_{count}
'''

SHARED = '''\
#! A cart from rest to rest over 1 m in ten phases of one length, a tenth of the whole time T, which
#! all of them share, for the least T + integral of u^2.
#! Closed form: the cubic between two states of rest costs 12/T^3, and T + 12/T^3 is least at T^4 = 36.
#! Written by tests/peers/phases_chain.py.
model chain_shared

free T in [0.5, 10] guess 3
'''


def phase(name, times, states, equations, more=()):
    """The text of one phase with a control u."""
    lines = [f'time t in [{times[0]}, {times[1]}]', *(f'state {s}' for s in states), 'control u in [-10, 10]',
             'dynamics {', *(f'  {e}' for e in equations), '}', *more]
    return '\n'.join([f'phase {name} {{', *(f'  {line}' for line in lines), '}'])


def links(count, states):
    """Links that change nothing."""
    same = '  '.join(f'{s} := {s}' for s in states)
    return '\n'.join(f'link s{i} -> s{i + 1} {{ {same} }}' for i in range(1, count))


def chain(count):
    """x' = u with the integral of x^2 + u^2 over [0, 5]."""
    def part(i):
        start = ' start 1' if i == 1 else ''
        return phase(f's{i}', [f'{5 * k / count:g}' for k in (i - 1, i)], [f'x{start}'], ["x' = u"],
                     ['minimize integral(x^2 + u^2)'])
    expect = f'''method {{ grid N = {max(2, 50 // count)} scheme gauss3  controls = polynomial }}
expect {{
  s{count}.x(end) == 1/cosh(5) within 1e-7
  s1.x(end) == cosh({5 - 5 / count:g})/cosh(5) within 1e-7
  s2.x(start) == s1.x(end) within 1e-9
}}
'''
    parts = [part(i) for i in range(1, count + 1)]
    return '\n\n'.join([REGULATOR.format(count=count), *parts, links(count, 'x'), expect])


def shared(count=10):
    """x'' = u from rest to rest."""
    def part(i):
        start = ' start 0' if i == 1 else ''
        end = ['end x == 1', 'end v == 0'] if i == count else []
        guess = 'guess { x = t/T  v = 1/T }'
        return phase(f's{i}', ['0' if i == 1 else f'T*{(i - 1) / count:g}', 'T' if i == count else f'T*{i / count:g}'],
                     [f'x{start}', f'v{start}'], ["x' = v", "v' = u"], [*end, guess])
    effort = '\n         + '.join(f'integral(s{i}.u^2)' for i in range(1, count + 1))
    end = f'''minimize T + {effort}

method {{ grid N = 5 scheme gauss3  controls = polynomial }}
expect {{
  T == sqrt(6) within 1e-5
  s5.x(end) == 1/2 within 1e-5
  s5.v(end) == 1.5/sqrt(6) within 1e-5
}}
'''
    return '\n\n'.join([SHARED, *(part(i) for i in range(1, count + 1)), links(count, 'xv'), end])


if __name__ == '__main__':
    for size in (10, 50):
        (FOLDER / f'chain_{size}.fdc').write_text(chain(size).replace('\n\n\n', '\n\n'))
    (FOLDER / 'chain_shared.fdc').write_text(shared().replace('\n\n\n', '\n\n'))
