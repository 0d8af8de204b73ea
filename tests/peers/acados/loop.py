"""A cart with friction in closed loop, 50 steps in a second: `fdcc` and acados by turns.

    python/test -k controller                             # the package fdcc, in target/python
    target/python/bin/pip install comma-deps-acados casadi
    cargo build --release --package fdcc-c
    target/python/bin/python tests/peers/acados/loop.py

Both solve the same discrete problem (`cart.fdc`): from the state that the loop has reached, and from
the plan before. The cart has less friction than they believe, exact and not smoothed, and its goal
jumps. The medians and the 99th percentiles of the wall-clock time of a step are printed as a table.
"""

import ctypes
import itertools
import pathlib
import time

import numpy as np

import fdcc
from cart_acados import STEP, rates, solver

HERE = pathlib.Path(__file__).parent
STEPS, TURNS, SUBSTEPS = 400, 5, 40
GOALS = [0.0, 0.5, -0.3, 0.2]


def goal(step):
    return GOALS[step * len(GOALS) // STEPS]


def plant(x, u):
    """One step of the true cart: friction holds it where it can."""
    h = STEP / SUBSTEPS
    for _ in range(SUBSTEPS):
        free = np.array(rates(x, u, sign=lambda v: 0.0)).ravel()
        full = 0.3 * 9.81 * h
        speed = x[1] + h * free[1]
        sign = np.sign(speed) if abs(speed) > full else speed / full
        x = x + h * np.array(rates(x, u, mu=0.3, sign=lambda v: sign)).ravel()
    return x


class Python:
    """`fdcc` as its package calls it."""

    def __init__(self, intervals):
        self.controller = fdcc.Model(str(HERE / "cart.fdc")).controller(N=intervals)

    def goal(self, value):
        self.controller.set(goal=value)

    def step(self, x):
        begin = time.perf_counter()
        found = self.controller.step(x)
        return time.perf_counter() - begin, found["F"], found.iterations, found.is_solved


class C:
    """`fdcc` as a program in C calls it."""

    def __init__(self, intervals):
        library = ctypes.CDLL(str(HERE / "../../../target/release/libfdcc_c.so"))
        library.fdcc_new.restype = ctypes.c_void_p
        text, why = (HERE / "cart.fdc").read_bytes(), ctypes.create_string_buffer(1000)
        self.own = ctypes.c_void_p(library.fdcc_new(text, intervals, why, len(why)))
        assert self.own, why.value
        self.library, self.x, self.u = library, (ctypes.c_double * 4)(), (ctypes.c_double * 1)()

    def goal(self, value):
        self.library.fdcc_set(self.own, b"goal", ctypes.c_double(value))

    def step(self, x):
        self.x[:] = list(x)
        begin = time.perf_counter()
        status = self.library.fdcc_step(self.own, self.x, self.u)
        return time.perf_counter() - begin, self.u[0], self.library.fdcc_iterations(self.own), status == 0


class Acados:
    def __init__(self, intervals, kind, hessian):
        self.own, self.intervals = solver(intervals, kind, hessian), intervals

    def goal(self, value):
        for k in range(self.intervals):
            self.own.set(k, "yref", np.array([value, 0.0, 0.0, 0.0, 0.0]))

    def step(self, x):
        self.own.set(0, "lbx", x)
        self.own.set(0, "ubx", x)
        begin = time.perf_counter()
        status = self.own.solve()
        seconds = time.perf_counter() - begin
        return seconds, self.own.get(0, "u")[0], int(self.own.get_stats("sqp_iter")[0]), status == 0


KINDS = {
    "fdcc from C": C,
    "fdcc from Python": Python,
    "acados, converged, exact Hessian": lambda n: Acados(n, "SQP", "EXACT"),
    "acados, converged, Gauss-Newton": lambda n: Acados(n, "SQP", "GAUSS_NEWTON"),
    "acados, one iteration": lambda n: Acados(n, "SQP_RTI", "GAUSS_NEWTON"),
}


def run(controller):
    """Seconds and iterations of each step but the first, the cost of the loop, and what failed."""
    x, cost, all_seconds, all_iterations, failures = np.zeros(4), 0.0, [], [], 0
    for step in range(STEPS):
        if step == 0 or goal(step) != goal(step - 1):
            controller.goal(goal(step))
        seconds, u, iterations, is_solved = controller.step(x)
        cost += STEP * (10 * (x[0] - goal(step)) ** 2 + 10 * x[2] ** 2 + 0.01 * u**2)
        x = plant(x, u)
        if step:
            all_seconds.append(seconds)
            all_iterations.append(iterations)
            failures += not is_solved
    return all_seconds, all_iterations, cost, failures


def main():
    print("| | N | median, us | 99th percentile | iterations | not solved | cost of the loop |")
    print("|---|---|---|---|---|---|---|")
    for intervals in (40, 100):
        controllers = {name: make(intervals) for name, make in KINDS.items()}
        runs = {name: [] for name in KINDS}
        for _, name in itertools.product(range(TURNS), KINDS):
            runs[name].append(run(controllers[name]))
        for name, own in runs.items():
            # Other work of the machine makes single steps slower: the best of the turns for each.
            seconds = np.min([it[0] for it in own[1:]], axis=0)
            _, iterations, cost, failures = own[-1]
            median, late = 1e6 * np.percentile(seconds, [50, 99])
            print(
                f"| {name} | {intervals} | {median:.0f} | {late:.0f} | {np.mean(iterations):.1f} "
                f"| {failures} | {cost:.4f} |"
            )


if __name__ == "__main__":
    main()
