"""A model with switches: its text as `.fdc`, and the same formulas as Python functions in SI units.

Formulas are written once, in the language of fdcc. `Sgn(s)`, `match s {...}` and `Dir(d)[i]` become names of
selectors.
"""

import cmath
import re
from dataclasses import dataclass, field

INF = float('inf')
SYMBOLS = {'m': 1.0, 'mm': 1e-3, 'um': 1e-6, 'km': 1e3, 's': 1.0, 'ms': 1e-3, 'min': 60.0, 'h': 3600.0}


@dataclass
class Quantity:
    """A state, control or unknown: bounds, start and guess are in its unit; a start of None is free."""

    name: str
    unit: str = ''
    low: float = -INF
    high: float = INF
    start: object = 0.0

    @property
    def si(self):
        return factor(self.unit)

    def declared(self):
        unit = f' [{self.unit}]' if self.unit else ''
        return f'{self.name}{unit}' + (f' in [{plain(self.low)}, {plain(self.high)}]' if self.low > -INF else '')


@dataclass
class Model:
    """`rates` by state; `ends` are (formula, sense, formula), `jumps` (name, surface, sense, count, {state: formula})."""

    family: str
    states: list
    controls: list
    rates: dict
    running: str
    terminal: str = '0'
    duration: object = 1.0  # a number in `time_unit`, or the name of an unknown
    time_unit: str = ''
    unknowns: list = field(default_factory=list)
    surfaces: dict = field(default_factory=dict)
    directions: dict = field(default_factory=dict)  # name -> (formula, formula)
    ends: list = field(default_factory=list)
    paths: list = field(default_factory=list)  # (formula, '<=' or '>=', formula)
    jumps: list = field(default_factory=list)
    guess: str = ''

    def text(self):
        """The model."""
        unit = f' [{self.time_unit}]' if self.time_unit else ''
        lines = [f'model {self.family}']
        lines += [f'free {u.declared()} guess {plain(u.start)}' for u in self.unknowns]
        lines += [f'time t in [0, {self.duration if isinstance(self.duration, str) else plain(self.duration)}]{unit}']
        lines += [f'state {s.declared()} start {start(s)}' for s in self.states]
        lines += [f'control {c.declared()}' for c in self.controls]
        lines += [f'surface {name} = {psi}' for name, psi in self.surfaces.items()]
        lines += [f'let {name} = ({", ".join(parts)})' for name, parts in self.directions.items()]
        lines += ['dynamics {']
        lines += [f"  {s}' {'in' if is_set(rate) else '='} {rate}" for s, rate in self.rates.items()]
        lines += ['}']
        for name, surface, sense, count, resets in self.jumps:
            body = '  '.join(f'{s} := {value}' for s, value in resets.items())
            lines.append(f'jump {name} on {surface} {sense} at most {count} {{ {body} }}')
        lines += [f'path {a} {sense} {b}' for a, sense, b in self.paths]
        lines += [f'end {a} {sense} {b}' for a, sense, b in self.ends]
        parts = [f'integral({self.running})'] * (self.running != '0') + [self.terminal] * (self.terminal != '0')
        lines.append('minimize ' + ' + '.join(parts))
        return '\n'.join(lines + ([self.guess] if self.guess else [])) + '\n'

    def selectors(self):
        """Names of the selectors: one for each surface that is not only jumped from, two for each direction."""
        jumped = {surface for _, surface, *_ in self.jumps}
        used = ' '.join(self.rates.values())
        scalar = [f's_{name}' for name in self.surfaces if name not in jumped or re.search(rf'\b{name}\b', used)]
        return scalar + [f'd_{name}_{i}' for name in self.directions for i in (1, 2)]

    def function(self, texts, functions=None):
        """(t, x, u, p, s) -> values of the texts, in SI."""
        body = ', '.join(translated(text) for text in texts)
        code = 'def f(t, x, u, p, s):\n'
        for letter, names in (('x', [s.name for s in self.states]), ('u', [c.name for c in self.controls]),
                              ('p', [q.name for q in self.unknowns]), ('s', self.selectors())):
            code += f' {", ".join(names)}, = {letter}\n' if names else ''
        scope = {name: getattr(functions or cmath, name) for name in ('sin', 'cos', 'exp', 'sqrt', 'tanh')}
        exec(code + f' return [{body}]', scope)
        return scope['f']


def is_set(rate):
    return any(word in rate for word in ('Sgn(', 'match ', 'Dir('))


def start(state):
    return 'free' if state.start is None else state.start if isinstance(state.start, str) else plain(state.start)


def plain(value):
    """A number as `.fdc` reads it."""
    return repr(float(value))


def factor(unit):
    """What one `unit` is in SI."""
    value, sign = 1.0, 1
    for mark, symbol, power in re.findall(r'([ /]?)([a-z]+)(?:\^(-?\d))?', unit):
        sign = -1 if mark == '/' else 1
        value *= SYMBOLS[symbol] ** (sign * int(power or 1))
    return value


def translated(text):
    """A formula of fdcc as one of Python, quantities in SI."""
    text = re.sub(r'match (\w+) \{ below => (.+?), above => (.+?) \}',
                  r'(((\2) + (\3))/2 + s_\1*((\3) - (\2))/2)', text)
    text = re.sub(r'Dir\((\w+)\)\[(\d)\]', r'd_\1_\2', re.sub(r'Sgn\((\w+)\)', r's_\1', text))
    text = re.sub(r'([\d.]+(?:e-?\d+)?) \[([^\]]+)\]', lambda m: f'({m[1]}*{factor(m[2])!r})', text)
    return text.replace('^', '**').replace('(end)', '')
