"""Closed forms of true optima, each with its derivation; where an equation in one or two unknowns is left, by scipy."""

from math import cos, exp, log, pi, sin, sqrt
from pathlib import Path

import numpy as np
from scipy.integrate import quad
from scipy.linalg import expm
from scipy.optimize import fsolve, least_squares, minimize_scalar

G = 9.81


def effort(c, d, T, m=1.0):
    """Least integral of u^2 of m v' in u - c Dir(v) from rest to rest over d within T, and how long it slides.

    u = m v' + c v/|v| while it moves and 0 else; the integral of 2 m c v'v/|v| vanishes from rest to rest, so the
    least is 12 m^2 d^2/D^3 + c^2 D after sliding for D, which is best at D = sqrt(6 m d/c) if T allows.
    """
    D = min(T, sqrt(6 * m * d / c))
    return 12 * m**2 * d**2 / D**3 + c**2 * D, D


def rest_soon(c, U, d):
    """Least time from rest to rest: U - c until T (U + c)/(2 U), then -U - c."""
    T = 2 * sqrt(d * U / (U**2 - c**2))
    return T, T * (U + c) / (2 * U)


def reverse_soon(c, U, V, d):
    """As before from the speed -V: v = 0 after V/(U + c) at -V^2/(2 (U + c)), then `rest_soon`."""
    back = V / (U + c)
    T, switch = rest_soon(c, U, d + V * back / 2)
    return back + T, [back, back + switch]


def crossing():
    """J(x0) = (x0 + 1)^2/9 - x0^3/9 + (x0 + 6)^3/81 as x crosses at -x0/3 and goes on at the speed 1."""
    x0 = (9 - sqrt(417)) / 8
    return (x0 + 1)**2 / 9 - x0**3 / 9 + (x0 + 6)**3 / 81, x0


def gear(u, low, ratio, top, length):
    """u until `low`, ratio u until `top`, there as long as the length asks, and back likewise."""
    first, second = low / u, (top - low) / (ratio * u)
    way = low * first + (low + top) * second
    on = (length - way) / top
    assert on >= 0
    return 2 * (first + second) + on, list(np.cumsum([first, second, on, second]))


def pension():
    """c = c0 exp(0.01 t), as its costate falls like exp(-0.02 t); c0 spends wealth and income, discounted, by 60."""
    c0 = (1 + 75 * (1 - exp(-0.8))) / (100 * (1 - exp(-0.6)))
    whole = (1 - exp(-0.6)) / 0.01
    drift = 100 * (1 - exp(-0.6)) - 60 * exp(-0.6)  # integral of 0.01 t exp(-0.01 t)
    return log(c0) * whole + drift


def inclined_plane():
    """The push works 4 (weight sin + friction) on every way that never slides back, and more on others."""
    return 4 * 12 * G * (sin(pi / 12) + 0.25 * cos(pi / 12))


def dc_motor(R=1.2, L=2e-3, k=0.05, J=2e-4, dry=0.01, U=24.0, T=0.5, angle=4 * pi):
    """Full voltage while it sticks (i = 20 (1 - exp(-600 t)) until k i = dry) and for t2 on, then a singular arc.

    On that arc the costate of i is 0, so that i = i2 + b t; t2 and b meet the two conditions at the end.
    """
    t1 = -log(1 - dry / k * R / U) * L / R
    a = np.array([[0, 1, 0, 0], [0, 0, k / J, -dry / J], [0, -k / L, -R / L, U / L], [0, 0, 0, 0]])

    def after(t):
        return expm(a * t) @ np.array([0, 0, dry / k, 1])

    def end(q):
        turned, w, i, _ = after(q[0] * 1e-4)
        D, acceleration, jerk = T - t1 - q[0] * 1e-4, (k * i - dry) / J, k * q[1] / J
        return [turned + w * D + acceleration * D**2 / 2 + jerk * D**3 / 6 - angle,
                (w + acceleration * D + jerk * D**2 / 2) / 10]
    scaled, b = fsolve(end, [1.0, -4.8], xtol=1e-12)
    t2 = scaled * 1e-4
    D, i2 = T - t1 - t2, after(t2)[2]
    square = (quad(lambda t: (U / R * (1 - exp(-R / L * t)))**2, 0, t1, epsabs=1e-16)[0]
              + quad(lambda t: after(t)[2]**2, 0, t2, epsabs=1e-16)[0] + i2**2 * D + i2 * b * D**2 + b**2 * D**3 / 3)
    return R * square, [t1, t1 + t2]


def friction_fit():
    """Each stone stops after v^2/(2 mu g): a linear fit of 1/(2 mu g)."""
    v, d = np.array([0.2, 0.3, 0.4]), np.array([0.103, 0.228, 0.41])
    z = sum(v**2 * d) / sum(v**4)
    return sum((v**2 * z - d)**2), 1 / (2 * G * z), list(v * 2 * z)


def throw(e=0.8):
    """By the speed upwards: down to the floor, then to h = 1 with the rest e of the speed; vx from both times."""
    def times(vy):
        w = sqrt(vy**2 + 3 * G)
        return (vy + w) / G, (e * w + sqrt((e * w)**2 - 2 * G)) / G

    def cost(vy):
        return (6 / sum(times(vy)))**2 + vy**2
    vy = minimize_scalar(cost, bounds=(0.1, 9), method='bounded', options={'xatol': 1e-13}).x
    return cost(vy), vy, times(vy)


def slider_fit():
    """x = a t^2/2 - 2.5 t^3/(6 m), a = 10/m - mu g, until v = 0 at t = 0.8 a m, and fixed from there on; errors in
    standard deviations."""
    data = np.genfromtxt(Path(__file__).parents[2] / 'models' / 'slider.csv', delimiter=',', names=True)

    def misfit(q):
        a, stop = 10 / q[1] - q[0] * G, 0.8 * (10 - q[0] * q[1] * G)
        t = np.minimum(data['t'], stop)
        x, v = a * t**2 / 2 - 2.5 * t**3 / (6 * q[1]), a * t - 2.5 * t**2 / (2 * q[1])
        return np.concatenate([(x - data['x']) / 0.01, (v - data['v']) / 0.03])
    q = least_squares(misfit, [0.3, 2.0], xtol=1e-15, ftol=1e-15, gtol=1e-15).x
    return sum(misfit(q)**2), q, 0.8 * (10 - q[0] * q[1] * G)
