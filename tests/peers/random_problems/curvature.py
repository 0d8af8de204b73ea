"""The second-order condition at a point: the least eigenvalue of the Hessian on the active constraints, densely."""

import casadi as ca
import numpy as np

LARGEST = 700  # variables
ACTIVE = 1e-4  # of the size of a variable or row: what is nearer to a bound counts as fixed
STEP = 1e-2


def gain_along_curvature(discrete, z):
    """How much the objective falls to second order in a step of 1 % along the direction of least curvature."""
    if len(z) > LARGEST:
        return 0.0
    sizes = np.maximum(discrete.sizes(z), 0.1 * np.minimum(1.0, discrete.upper - discrete.lower))
    free = np.minimum(z - discrete.lower, discrete.upper - z) > ACTIVE * sizes
    gradient, jacobian, g, row_sizes = derivatives(discrete, z)
    rows = np.minimum(g - discrete.low, discrete.high - g) <= ACTIVE * row_sizes
    scaled = jacobian[np.ix_(rows, free)] * sizes[free] / row_sizes[rows, None]
    multipliers = np.zeros(len(g))
    fit = np.linalg.lstsq(scaled.T, -gradient[free] * sizes[free], rcond=1e-12)[0]
    multipliers[rows] = fit / row_sizes[rows]
    hessian = lagrangian(discrete)(z, multipliers)
    hessian = np.array(hessian)[np.ix_(free, free)] * np.outer(sizes[free], sizes[free])
    directions = null_space(scaled)
    if directions.shape[1] == 0:
        return 0.0
    least = np.linalg.eigvalsh(directions.T @ hessian @ directions)[0]
    return max(0.0, -least) * STEP**2 / 2


def derivatives(discrete, z):
    """Gradient, Jacobian, rows and their sizes as arrays."""
    if not hasattr(discrete, 'first'):
        x, f, g = (discrete.program[key] for key in 'xfg')
        discrete.first = ca.Function('first', [x], [ca.gradient(f, x), ca.jacobian(g, x)])
    gradient, jacobian = discrete.first(z)
    _, _, g, sizes = discrete.measures(z)
    return np.array(gradient).ravel(), np.array(ca.DM(jacobian).full()), np.array(g).ravel(), np.array(sizes).ravel()


def lagrangian(discrete):
    """The Hessian of the Lagrangian as a function of variables and multipliers."""
    if not hasattr(discrete, 'second'):
        x, f, g = (discrete.program[key] for key in 'xfg')
        multipliers = ca.SX.sym('l', g.numel())
        hessian = ca.hessian(f + ca.dot(multipliers, g), x)[0]
        discrete.second = ca.Function('second', [x, multipliers], [hessian])
    return lambda z, l: ca.DM(discrete.second(z, l)).full()


def null_space(matrix):
    """An orthonormal basis, by the singular value decomposition."""
    if matrix.shape[0] == 0:
        return np.eye(matrix.shape[1])
    _, values, rows = np.linalg.svd(matrix, full_matrices=True)
    rank = int((values > 1e-10 * max(values.max(initial=0.0), 1e-300)).sum())
    return rows[rank:].T
