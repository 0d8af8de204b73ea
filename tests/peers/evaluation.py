#!/usr/bin/env python3
"""Time to evaluate the race car's right side with its Jacobian and the Hessian of multipliers times it, by CasADi's C code under gcc.

    python3 tests/peers/evaluation.py            (then: cargo bench -p fdcc-tests --bench evaluation)

The same function, inputs and outputs as tests/benches/evaluation.rs: rates times T, derivatives by states, controls and T, Hessian as its lower triangle, over
1000 points in a row; nanoseconds for each point, the best of 200 passes. Needs casadi and gcc.
"""

import subprocess
import tempfile
from pathlib import Path

import casadi as ca

HARNESS = r'''
#include <stdio.h>
#include <math.h>
#include <time.h>
#include "function.c"
#define POINTS 1000
static double in[POINTS][10], lam[POINTS][5], f[POINTS][5], jac[POINTS][64], hess[POINTS][64];
int main(void) {
  casadi_int iw[1000]; double w[1000], best = 1e9, par[3] = {1.0, 6.0, 0.1};
  for (int k = 0; k < POINTS; k++) {
    for (int i = 0; i < 7; i++) in[k][i] = sin(0.37 * ((i + 1) * POINTS + k));
    for (int i = 0; i < 5; i++) lam[k][i] = 0.7;
  }
  for (int pass = 0; pass < 200; pass++) {
    struct timespec a, b;
    clock_gettime(CLOCK_MONOTONIC, &a);
    for (int k = 0; k < POINTS; k++) {
      const double *arg[8] = {in[k], in[k] + 5, par, lam[k]};
      double *res[8] = {f[k], jac[k], hess[k]};
      function(arg, res, iw, w, 0);
    }
    clock_gettime(CLOCK_MONOTONIC, &b);
    double ns = ((b.tv_sec - a.tv_sec) * 1e9 + (b.tv_nsec - a.tv_nsec)) / POINTS;
    if (ns < best) best = ns;
  }
  printf("%.1f\n", best);
  return f[7][2] + jac[7][3] + hess[7][2] == 12345.678;
}
'''


def step(kernel, slip, sigma):
    """The smooth steps of the benchmark that CasADi can write as one expression."""
    return {'sqrt': slip / ca.sqrt(slip**2 + sigma**2), 'tanh': ca.tanh(slip / sigma)}[kernel]


def function(kernel):
    """f, its Jacobian and the Hessian of lam' f, as one CasADi function."""
    x, u, p, lam = ca.SX.sym('x', 5), ca.SX.sym('u', 2), ca.SX.sym('p', 3), ca.SX.sym('lam', 5)
    vx, vy, th, mu, duration, sigma = x[2], x[3], x[4], p[0], p[1], p[2]
    along, slip = ca.cos(th) * vx + ca.sin(th) * vy, ca.cos(th) * vy - ca.sin(th) * vx
    friction = mu * step(kernel, slip, sigma)
    f = duration * ca.vertcat(vx, vy, u[0] * ca.cos(th) + friction * ca.sin(th), u[0] * ca.sin(th) - friction * ca.cos(th), u[1] * along)
    z = ca.vertcat(x, u, duration)
    return ca.Function('function', [x, u, p, lam], [f, ca.jacobian(f, z), ca.tril(ca.hessian(ca.dot(lam, f), z)[0])], {'cse': True})


def nanoseconds(kernel):
    """Generates, compiles and runs."""
    with tempfile.TemporaryDirectory() as folder:
        generator = ca.CodeGenerator('function.c')
        generator.add(function(kernel))
        generator.generate(folder + '/')
        (Path(folder) / 'main.c').write_text(HARNESS)
        subprocess.run(['gcc', '-O3', '-march=native', 'main.c', '-o', 'main', '-lm'], cwd=folder, check=True)
        return subprocess.run([folder + '/main'], capture_output=True, text=True, check=False).stdout.strip()


if __name__ == '__main__':
    for name in ('sqrt', 'tanh'):
        print(f'{name}: {nanoseconds(name)} ns for each point')
