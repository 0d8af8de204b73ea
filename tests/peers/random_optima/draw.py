"""Random numbers and units for the families."""

from model import Quantity

UNITS = [('', '')] * 6 + [('m', 's'), ('mm', 's'), ('mm', 'ms'), ('km', 'min'), ('km', 'h')]


class Draw:
    """Numbers with few digits, so that models are readable; all in one system of units."""

    def __init__(self, rng, units=None):
        self.rng = rng
        self.length, self.time = units if units is not None else rng.choice(UNITS)

    def number(self, low, high, digits=2):
        return float(f'{self.rng.uniform(low, high):.{digits}g}')

    def chance(self, probability):
        return self.rng.random() < probability

    def unit(self, powers):
        """'L/T^2' in this system, '' in that without units."""
        return powers.replace('L', self.length).replace('T', self.time) if self.length else ''

    def write(self, value, powers):
        """A number with its unit; a negative one in parentheses."""
        unit = self.unit(powers)
        text = f'{abs(float(value))!r}' + (f' [{unit}]' if unit else '')
        return f'(-{text})' if value < 0 else text

    def state(self, name, powers, start=0.0, low=None, high=None):
        bounds = {} if low is None else {'low': low, 'high': high}
        return Quantity(name, self.unit(powers), start=start, **bounds)

    control = state

    def last(self, low, high):
        """A duration as an unknown."""
        return Quantity('T', self.unit('T'), low, high, (low * high)**0.5)
