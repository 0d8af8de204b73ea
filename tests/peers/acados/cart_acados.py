"""The cart of `cart.fdc` as acados solves it: the same discrete problem, by explicit Euler.

Sequential quadratic programming with HPIPM; with its settings for speed, or converged to 1e-8.
"""

import ctypes
import os
import tempfile

import acados
import casadi as ca
import numpy as np

for name, place in (
    ("ACADOS_SOURCE_DIR", acados.DIR),
    ("ACADOS_INSTALL_DIR", acados.DIR),
    ("ACADOS_PYTHON_INTERFACE_PATH", acados.TEMPLATE_DIR),
    ("TERA_PATH", acados.TERA_PATH),
):
    os.environ.setdefault(name, place)
# The wheel has them without the links that their names ask for.
for library in ("blasfeo", "hpipm", "qpOASES_e"):
    ctypes.CDLL(f"{acados.LIB_DIR}/lib{library}.so", mode=ctypes.RTLD_GLOBAL)
from acados.acados_template import AcadosModel, AcadosOcp, AcadosOcpSolver  # noqa: E402

STEP, SIGMA, LARGEST = 0.02, 0.1, 20.0
WEIGHTS = np.diag([10.0, 0.1, 10.0, 0.1, 0.01])


def rates(x, u, mu=0.4, sign=lambda v: ca.tanh(v / SIGMA)):
    """The right side, of numbers or of symbols."""
    _, v, th, w = (x[0], x[1], x[2], x[3])
    mc, mp, length, g = 1.0, 0.2, 0.5, 9.81
    f, s, c = u - mu * mc * g * sign(v), ca.sin(th), ca.cos(th)
    inertia = mc + mp * s**2
    return ca.vertcat(
        v,
        (f + mp * s * (length * w**2 - g * c)) / inertia,
        w,
        (-f * c - mp * length * w**2 * s * c + (mc + mp) * g * s) / (length * inertia),
    )


def solver(intervals, kind, hessian):
    """`kind` is `SQP` or `SQP_RTI`, `hessian` is `EXACT` or `GAUSS_NEWTON`."""
    x, u = ca.SX.sym("x", 4), ca.SX.sym("u")
    model = AcadosModel()
    model.name, model.x, model.u = f"cart_{kind}_{hessian}_{intervals}".lower(), x, u
    model.disc_dyn_expr = x + STEP * rates(x, u)
    ocp = AcadosOcp()
    ocp.model = model
    ocp.dims.N = intervals
    ocp.cost.cost_type, ocp.cost.cost_type_e = "LINEAR_LS", "LINEAR_LS"
    # Each stage is integrated over one step; the objective is no sum over the end.
    ocp.cost.W, ocp.cost.W_e = 2 * WEIGHTS, np.zeros((0, 0))
    ocp.cost.Vx = np.vstack([np.eye(4), np.zeros((1, 4))])
    ocp.cost.Vu = np.array([[0.0], [0.0], [0.0], [0.0], [1.0]])
    ocp.cost.yref = np.zeros(5)
    ocp.cost.Vx_e, ocp.cost.yref_e = np.zeros((0, 4)), np.zeros(0)
    ocp.constraints.lbu, ocp.constraints.ubu = np.array([-LARGEST]), np.array([LARGEST])
    ocp.constraints.idxbu = np.array([0])
    ocp.constraints.x0 = np.zeros(4)
    options = ocp.solver_options
    options.tf, options.integrator_type = intervals * STEP, "DISCRETE"
    options.nlp_solver_type, options.hessian_approx = kind, hessian
    options.qp_solver = "PARTIAL_CONDENSING_HPIPM"
    options.nlp_solver_max_iter = 100
    for name in ("stat", "eq", "ineq", "comp"):
        setattr(options, f"nlp_solver_tol_{name}", 1e-8)
        setattr(options, f"qp_solver_tol_{name}", 1e-9)
    options.qp_solver_warm_start = 1
    if hessian == "EXACT":
        options.regularize_method = "CONVEXIFY"
    folder = tempfile.mkdtemp()
    ocp.code_export_directory = f"{folder}/code"
    return AcadosOcpSolver(ocp, json_file=f"{folder}/ocp.json", verbose=False)
