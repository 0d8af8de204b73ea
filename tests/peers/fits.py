#!/usr/bin/env python3
"""The fits of tests/classics/fits once more, by scipy: DOP853 or closed forms, and `least_squares`.

It writes the measurements of fits_problems.py (published ones, or made with a fixed seed) as csv beside the models, and
fits.csv beside this file: the least cost, each unknown that is not at its bound with its standard error from the
Jacobian (s^2 = cost/(values - unknowns)), and the published value where there is one. That table is by scipy 1.17.1 and
numpy 2.4.6.
"""

import csv
import sys
from pathlib import Path

import numpy as np
from fits_problems import FITS
from scipy.optimize import least_squares

TABLE = Path(__file__).with_suffix('.csv')
FOLDER = Path(__file__).parent.parent / 'classics' / 'fits'
HEAD = ['problem', 'quantity', 'value', 'standard_error', 'published']


def write(name, columns, rows):
    """A file of measurements."""
    with open(FOLDER / f'{name}.csv', 'w', newline='') as file:
        csv.writer(file, lineterminator='\n').writerows([columns, *([f'{v:.10g}' for v in row] for row in rows)])


def read(name):
    """The columns of a file of measurements that is only read."""
    return {name: np.loadtxt(FOLDER / f'{name}.csv', delimiter=',', skiprows=1).T}


def measured(name):
    """The tables of a fit, written where they are made here."""
    data = FITS[name].data and FITS[name].data()
    for table, (columns, rows) in (data or {}).items():
        write(table, columns, rows)
    return {table: np.array(rows, float).T for table, (_, rows) in data.items()} if data else read(name)


def standard_errors(found, size):
    """Of the unknowns, nothing for those at their bounds."""
    inside = np.abs(found.x) > 1e-12
    jacobian = found.jac[:, inside]
    freedom = np.count_nonzero(found.fun) - np.count_nonzero(inside)
    covariance = np.linalg.inv(jacobian.T @ jacobian) * 2 * found.cost / freedom
    errors = iter(np.sqrt(np.diag(covariance)) * size[inside])
    return [f'{next(errors):.6g}' if is_free else '' for is_free in inside]


def rows_of(name):
    """The rows of one fit."""
    fit = FITS[name]
    tables = measured(name)
    size = np.array([max(abs(g), 1e-12) for g in fit.unknowns.values()])

    def residuals(scaled):
        return fit.residuals(scaled * size, tables)
    found = least_squares(residuals, np.array(list(fit.unknowns.values())) / size, jac='3-point', loss=fit.loss,
                          bounds=(fit.lower, np.inf), xtol=1e-14, ftol=1e-14, gtol=1e-14, max_nfev=1000)
    values = found.x * size
    cost = 2 * found.cost
    errors = standard_errors(found, size) if fit.loss == 'linear' and fit.plain else [''] * len(values)
    yield [name, 'objective', f'{cost:.12g}', '', fit.published.get('objective', '')]
    for quantity, value, error in zip(fit.unknowns, values, errors):
        yield [name, quantity, f'{value:.12g}', error, fit.published.get(quantity, '')]


def main(names):
    """Fits and writes."""
    table = {}
    if TABLE.exists():
        with open(TABLE, newline='') as file:
            for row in list(csv.reader(file))[1:]:
                table.setdefault(row[0], []).append(row)
    for name in names or FITS:
        table[name] = list(rows_of(name))
        for row in table[name]:
            print(*row, flush=True)
    with open(TABLE, 'w', newline='') as file:
        csv.writer(file, lineterminator='\n').writerows([HEAD, *(row for name in sorted(table) for row in table[name])])


if __name__ == '__main__':
    main(sys.argv[1:])
