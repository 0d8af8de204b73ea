"""The optimum of a quadratic program without inequalities, by one dense linear system."""

import casadi as ca
import numpy as np

LARGEST = 700  # variables


def equality_optimum(discrete):
    """The least objective where only fixed variables and equations constrain; None for any other problem."""
    free = discrete.lower < discrete.upper
    if not discrete.problem.convex or len(free) > LARGEST or np.any(discrete.low != discrete.high):
        return None
    if np.any(np.isfinite(discrete.lower[free])) or np.any(np.isfinite(discrete.upper[free])):
        return None
    z = np.where(free, 0.0, discrete.lower)
    x, f, g = (discrete.program[key] for key in 'xfg')
    hessian, gradient = ca.Function('h', [x], [*ca.hessian(f, x)])(z)
    rows, jacobian = ca.Function('j', [x], [g, ca.jacobian(g, x)])(z)
    hessian, jacobian = hessian.full()[np.ix_(free, free)], jacobian.full()[:, free]
    count = jacobian.shape[0]
    matrix = np.block([[hessian, jacobian.T], [jacobian, np.zeros((count, count))]])
    right = np.concatenate([-gradient.full().ravel()[free], discrete.low - rows.full().ravel()])
    z[free] = np.linalg.lstsq(matrix, right, rcond=None)[0][:hessian.shape[0]]
    return discrete.value(z)[0] if discrete.violation(z) < 1e-9 else None
