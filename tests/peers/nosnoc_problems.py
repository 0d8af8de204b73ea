"""Published examples of nosnoc, with their settings, for tests/peers/nosnoc_examples.py.

Each function returns the arguments of the model, those of the optimal control problem, the settings, and where the
states have to be at the end (NaN where nothing is demanded). The sources are named in the models of fdcc beside it.
"""

import casadi as ca
import nosnoc
import numpy as np

INF = float('inf')
RELAXED = nosnoc.StepEquilibrationMode.L2_RELAXED_SCALED
BOTH_SIDES = [np.array([[1], [-1]])]  # the first column of F where c > 0


def names(text):
    return [ca.SX.sym(it) for it in text.split()]


def two_signs(x, u, start, above, below, c):
    return dict(x=x, u=u, x0=np.array(start, float), F=[ca.horzcat(above, below)], c=[c], S=BOTH_SIDES)


def turbo():
    """The last time is a factor of the right side; nosnoc for Python has no `time_optimal_problem`."""
    q, v, u, T = names('q v u T')
    model = two_signs(ca.vertcat(q, v), u, [0, 0], T*ca.vertcat(v, 3*u), T*ca.vertcat(v, u), v - 10)
    bounds = dict(lbu=np.array([-5]), ubu=np.array([5]), lbx=np.array([-INF, -20]), ubx=np.array([INF, 20]),
                  lbv_global=np.array([1]), ubv_global=np.array([60]), v_global_guess=np.array([15]))
    settings = dict(terminal_time=1, N_stages=10, N_finite_elements=3, n_s=2)
    return model | dict(v_global=T), bounds | dict(f_terminal=T), settings, [200, 0]


def two_pedals():
    q, v, a, b = names('q v a b')
    u = ca.vertcat(a, b)
    model = two_signs(ca.vertcat(q, v), u, [0, 0], ca.vertcat(v, 3*a - 5*b), ca.vertcat(v, 5*a - 5*b), v - 15)
    ocp = dict(lbu=np.zeros(2), ubu=np.ones(2), f_q=a**2 + b**2, g_path_comp=ca.horzcat(a, b))
    return model, ocp, motor_settings(30), [500, 0]


def motor_settings(duration):
    return dict(terminal_time=duration, N_stages=30, N_finite_elements=2, n_s=2, comp_tol=1e-6,
                homotopy_update_slope=0.1, step_equilibration=RELAXED)


def motor_with_friction():
    x1, v1, x2, v2, i, u = names('x1 v1 x2 v2 i u')
    m1, m2, k, R, L, K, dry = 1.03, 0.56, 2.4e3, 2, 2e-3, 12, 2.1
    rate = lambda friction: ca.vertcat(
        v1, (k*(x2 - x1) + K*i - friction)/m1, v2, k*(x1 - x2)/m2, (u - R*i - K*v1)/L)
    model = two_signs(ca.vertcat(x1, v1, x2, v2, i), u, [0]*5, rate(dry), rate(-dry), v1)
    ocp = dict(lbu=np.array([-5]), ubu=np.array([5]), f_q=u**2)
    return model, ocp, motor_settings(0.08), [0.01, 0, 0.01, 0, 0]


def sliding_mode():
    x1, x2, v1, v2, u1, u2 = names('x1 x2 v1 v2 u1 u2')
    sides = [ca.horzcat(ca.vertcat(-1 + v1, 0, u1, u2), ca.vertcat(1 + v1, 0, u1, u2)),
             ca.horzcat(ca.vertcat(0, -1 + v2, u1, u2), ca.vertcat(0, 1 + v2, u1, u2))]
    model = dict(x=ca.vertcat(x1, x2, v1, v2), u=ca.vertcat(u1, u2), x0=np.array([2*np.pi/3, np.pi/3, 0, 0]),
                 F=sides, c=[x1 + 0.15*x2**2, x2 - 0.05*x1**3], S=BOTH_SIDES*2)
    ocp = dict(lbu=np.full(2, -10.0), ubu=np.full(2, 10.0), f_q=v1**2 + v2**2)
    settings = dict(terminal_time=4, N_stages=6, N_finite_elements=6, n_s=2, comp_tol=1e-9, rho_h=10.0,
                    homotopy_update_slope=0.1, irk_representation=nosnoc.IrkRepresentation.DIFFERENTIAL,
                    step_equilibration=nosnoc.StepEquilibrationMode.HEURISTIC_MEAN)
    return model, ocp, settings, [-np.pi/6, -np.pi/4, np.nan, np.nan]


def cart_pole():
    p, th, v, w, u = names('p th v w u')
    m1, m2, l, g, dry = 1, 0.1, 1, 9.81, 2
    inertia = ca.vertcat(ca.horzcat(m1 + m2, m2*l*ca.cos(th)), ca.horzcat(m2*l*ca.cos(th), m2*l**2))
    rate = lambda friction: ca.vertcat(v, w, ca.inv(inertia) @ ca.vertcat(
        u - friction + m2*l*w**2*ca.sin(th), -m2*g*l*ca.sin(th)))
    x = ca.vertcat(p, th, v, w)
    off = x - ca.vertcat(0, np.pi, 0, 0)
    weigh = lambda weights: off.T @ ca.diag(ca.DM(weights)) @ off
    model = two_signs(x, u, [1, 0, 0, 0], rate(dry), rate(-dry), v)
    limit = np.array([5, INF, INF, INF])
    ocp = dict(lbu=np.array([-30]), ubu=np.array([30]), lbx=-limit, ubx=limit,
               f_q=weigh([10, 100, 1, 1]) + u**2, f_terminal=weigh([500, 100, 10, 10]))
    return model, ocp, dict(terminal_time=5, N_stages=20, N_finite_elements=2, n_s=2), [np.nan]*4


def solve(problem, times):
    """The objective, the last time if that is free, the controls by time, and whether nosnoc calls it solved."""
    model, ocp, settings, end = problem()
    options = nosnoc.NosnocOpts()
    options.print_level = 0
    for name, value in settings.items():
        setattr(options, name, value*times if name == 'N_stages' else value)
    fixed = [k for k, value in enumerate(end) if not np.isnan(value)]
    if fixed:
        ocp['g_terminal'] = model['x'][fixed] - ca.DM([end[k] for k in fixed])
    answer = nosnoc.NosnocSolver(options, nosnoc.NosnocModel(**model), nosnoc.NosnocOcp(**ocp)).solve()
    duration = float(np.ravel(answer['v_global'])[0]) if 'v_global' in model else 1.0
    controls = np.column_stack([np.array(answer['t_grid_u'])[:-1]*duration, np.array(answer['u_traj'])])
    return float(answer['cost_val']), duration, controls, answer['status'] == nosnoc.Status.SUCCESS
