"""Expressions, written once: printed as `.fdc`, evaluated by CasADi, and measured by the size of their terms."""

import casadi as ca

FUNCTIONS = {
    'sin': ca.sin, 'cos': ca.cos, 'tan': ca.tan, 'exp': ca.exp, 'sqrt': ca.sqrt, 'log': ca.log, 'tanh': ca.tanh,
    'atan': ca.atan,
}


class Expression:
    """A node of a tree: `kind` is 'number', 'name', an operator, 'Sgn' or a name in FUNCTIONS."""

    def __init__(self, kind, *parts, value=None, unit=None):
        self.kind, self.parts, self.value, self.unit = kind, [lift(part) for part in parts], value, unit

    def __add__(self, other):
        if is_zero(other) or is_zero(self):
            return self if is_zero(other) else lift(other)
        return Expression('+', self, other)

    def __radd__(self, other):
        return lift(other) + self

    def __sub__(self, other):
        return Expression('-', self, other)

    def __rsub__(self, other):
        return Expression('-', other, self)

    def __mul__(self, other):
        return Expression('*', self, other)

    def __rmul__(self, other):
        return Expression('*', other, self)

    def __truediv__(self, other):
        return Expression('/', self, other)

    def __rtruediv__(self, other):
        return Expression('/', other, self)

    def __pow__(self, other):
        return Expression('^', self, other)

    def __neg__(self):
        return Expression('*', -1, self)

    def text(self):
        """As `.fdc`; every operation has its own parentheses."""
        if self.kind == 'number':
            written = plain(self.value / (self.unit[1] if self.unit else 1))
            return f'{written} [{self.unit[0]}]' if self.unit else written
        if self.kind == 'name':
            return self.value
        if self.kind in '+-*/^':
            return f'({self.parts[0].text()} {self.kind} {self.parts[1].text()})'
        return f'{self.kind}({self.parts[0].text()})'

    def evaluate(self, names):
        """The CasADi expression; `names` gives each name its symbol, and what `Sgn` is."""
        if self.kind == 'number':
            return self.value
        if self.kind == 'name':
            return names[self.value]
        first, *rest = [part.evaluate(names) for part in self.parts]
        if self.kind == 'Sgn':
            return names['Sgn'](first)
        return FUNCTIONS[self.kind](first) if not rest else OPERATORS[self.kind](first, rest[0])

    def size(self, names):
        """The sum of the absolute values of its terms: the size that rounding and tolerances are relative to."""
        if self.kind in ('number', 'name'):
            return ca.fabs(self.evaluate(names))
        if self.kind in '+-':
            return self.parts[0].size(names) + self.parts[1].size(names)
        if self.kind == '*':
            return self.parts[0].size(names) * self.parts[1].size(names)
        if self.kind == '^':
            return self.parts[0].size(names) ** self.parts[1].value
        if self.kind == '/':
            return self.parts[0].size(names) / ca.fabs(self.parts[1].evaluate(names))
        return ca.fabs(self.evaluate(names))


OPERATORS = {
    '+': lambda a, b: a + b, '-': lambda a, b: a - b, '*': lambda a, b: a * b, '/': lambda a, b: a / b,
    '^': lambda a, b: a**b,
}


def plain(value):
    """A number as `.fdc` reads it; it reads back to the same bits."""
    written = repr(float(value))
    written = written[:-2] if written.endswith('.0') else written
    return f'({written})' if value < 0 else written


def lift(value):
    """A number as an expression."""
    return value if isinstance(value, Expression) else Expression('number', value=float(value))


def is_zero(value):
    return lift(value).kind == 'number' and lift(value).value == 0


def name(text):
    """A name of the model, or a value at an end such as `x(end)`."""
    return Expression('name', value=text)


def quantity(value, text, factor):
    """A number with a unit; `value` is in SI, `factor` is what one `text` is in SI."""
    return Expression('number', value=value, unit=(text, factor))


def call(function, argument):
    """`sin(argument)` and the like."""
    return Expression(function, argument)


def total(terms):
    """The sum of a list, 0 if there is none."""
    first, *rest = [*terms] or [0]
    return sum(rest, start=lift(first))
