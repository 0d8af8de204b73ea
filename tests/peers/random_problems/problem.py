"""One random problem: what is generated, and its text as `.fdc`."""

from dataclasses import dataclass, field

from expressions import Expression, lift, name, plain

INF = float('inf')


@dataclass
class State:
    """`start` is None where the optimiser chooses it; `unit` is a text and its factor to SI."""

    name: str
    rate: Expression
    start: float = 0.0
    low: float = -INF
    high: float = INF
    unit: tuple = None
    move: float = 1.0  # a typical size, for floors of relative measures


@dataclass
class Control:
    """Bounds in SI; without bounds -INF and INF."""

    name: str
    low: float = -INF
    high: float = INF
    unit: tuple = None


@dataclass
class Unknown:
    """A number that the optimiser chooses."""

    name: str
    low: float
    high: float
    guess: float
    unit: tuple = None


@dataclass
class Condition:
    """`low <= expression <= high`; equal bounds are an equation. `unit` as in State."""

    expression: Expression
    low: float
    high: float
    unit: tuple = None


@dataclass
class Problem:
    """All numbers in SI. `truth` is what its construction proves: feasible, infeasible, unbounded."""

    family: str
    states: list
    controls: list
    running: Expression = None
    mayer: Expression = None
    span: object = 1.0  # the last time: a number, or the name of an unknown
    time_unit: tuple = None
    unknowns: list = field(default_factory=list)
    ends: list = field(default_factory=list)
    paths: list = field(default_factory=list)
    integrals: list = field(default_factory=list)  # conditions on integrals
    N: int = 30
    scheme: str = 'implicit_euler'
    sigma: tuple = None  # the width as an Expression
    truth: str = 'feasible'
    convex: bool = False
    optimum: float = None  # of the discrete problem, where a closed form is known
    true_optimum: float = None  # of the true system, where a closed form is known
    objective_floor: float = 1e-4  # a smaller size of the objective is measured as this
    method: str = ''  # more settings, as they stand in a method block

    def __post_init__(self):
        self.running, self.mayer = lift(self.running or 0), lift(self.mayer or 0)

    def text(self):
        """The model."""
        lines = [f'model {self.family}']
        lines += [f'free {u.name} in [{inside(u.low, u)}, {inside(u.high, u)}]{unit(u)} guess {inside(u.guess, u)}'
                  for u in self.unknowns]
        last = self.span if isinstance(self.span, str) else plain(self.span / factor(self.time_unit))
        lines.append(f'time t in [0, {last}]{bracket(self.time_unit)}')
        lines += [f'state {s.name}{unit(s)}{bounds(s)} start {"free" if s.start is None else inside(s.start, s)}'
                  for s in self.states]
        lines += [f'control {c.name}{unit(c)}{bounds(c)}' for c in self.controls]
        lines.append('dynamics {')
        lines += [f"  {s.name}' {'in' if 'Sgn' in s.rate.text() else '='} {s.rate.text()}" for s in self.states]
        lines.append('}')
        lines += [f'end {condition(c)}' for c in self.ends]
        lines += [f'path {condition(c)}' for c in self.paths]
        lines += [f'end {condition(c, integral=True)}' for c in self.integrals]
        lines.append(f'minimize {self.objective()}')
        width = f'\n  smooth sigma = {self.sigma.text()}' if self.sigma is not None else ''
        lines.append(f'method {{{width}\n  grid N = {self.N} scheme {self.scheme}\n{self.method}}}')
        return '\n'.join(lines) + '\n'

    def objective(self):
        parts = [self.mayer.text()] if self.mayer.text() != '0' else []
        parts += [f'integral({self.running.text()})'] if self.running.text() != '0' else []
        return ' + '.join(parts) or '0'


def factor(unit):
    return unit[1] if unit else 1.0


def bracket(unit):
    return f' [{unit[0]}]' if unit else ''


def unit(item):
    return bracket(item.unit)


def inside(value, item):
    """A number in the unit of its declaration."""
    return plain(value / factor(item.unit))


def bounds(item):
    """`in [a, b]`, or nothing."""
    if item.low == -INF and item.high == INF:
        return ''
    return f' in [{inside(item.low, item)}, {inside(item.high, item)}]'


def condition(c, integral=False):
    text = f'integral({c.expression.text()})' if integral else c.expression.text()
    low, high = (plain(side / factor(c.unit)) + bracket(c.unit) for side in (c.low, c.high))
    if c.low == c.high:
        return f'{text} == {low}'
    if c.low == -INF:
        return f'{text} <= {high}'
    return f'{text} >= {low}' if c.high == INF else f'{low} <= {text} <= {high}'


def at_end(state):
    """The value of a state at the last time."""
    return name(f'{state}(end)')
