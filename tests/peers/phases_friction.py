#!/usr/bin/env python3
"""The reference of tests/classics/switched_phases/caught.fdc: formulas, and SciPy.

A block of mass 1 with friction 1 is pushed over 0.5, joins another one of the same mass, and both, with friction 2, are
pushed over the rest and stopped: the integral of F^2 within 3. While it slides forwards F = m (a + 1), and the integral of
F^2 over a slide of duration h from v0 to v1 is

    m^2 (integral(a^2) + 2 (v1 - v0) + h)

with the least integral of a^2 of a cubic. At rest nothing is spent. Prints the least sum over the speed at the contact and both
durations, whose sum is at most 3.
"""

from scipy.optimize import minimize


def slide(mass, h, way, v0, v1):
    """The least effort of a slide that does not turn round."""
    squares = (12 * way**2 - 12 * way * h * (v0 + v1) + 4 * h**2 * (v0**2 + v0 * v1 + v1**2)) / h**3
    return mass**2 * (squares + 2 * (v1 - v0) + h)


def effort(z):
    """Of the speed at the contact, and the durations of both slides."""
    v, alone, together = z
    return slide(1, alone, 0.5, 0, v) + slide(2, together, 0.5, v / 2, 0)


def main():
    """From several starts."""
    room = {'type': 'ineq', 'fun': lambda z: 3 - z[1] - z[2]}
    starts = [(v, a, b) for v in (0.3, 1, 1.5) for a in (0.5, 1, 1.5) for b in (0.5, 1, 1.5)]
    found = [minimize(effort, start, method='SLSQP', bounds=[(0, 5), (0.1, 2.9), (0.1, 2.9)], constraints=room,
                      options={'ftol': 1e-15, 'maxiter': 1000}) for start in starts]
    best = min((it for it in found if it.success), key=lambda it: it.fun)
    print(f'effort {best.fun:.12g}, contact at {best.x[0]:.9g}, slides of {best.x[1]:.9g} and {best.x[2]:.9g}')


if __name__ == '__main__':
    main()
