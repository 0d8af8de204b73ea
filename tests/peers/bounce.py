"""Bouncing balls, computed apart from fdcc: `tests/tests/jumps.rs` compares.

1. models/bounce.fdc: CasADi and IPOPT, one bounce, 200 control intervals before it and 200 after it, each integrated exactly.
2. The throw of docs/reference/jumps.md: its motion is known, so one number is left to choose; scipy does.

    pip install casadi scipy && python3 tests/peers/bounce.py
"""

import math

import casadi as ca
from scipy.optimize import minimize_scalar

G, E = 9.81, 0.8


def controlled(count=200):
    opti = ca.Opti()
    end, bounce, speed = opti.variable(), opti.variable(), opti.variable()
    controls = [opti.variable(count), opti.variable(count)]
    height, velocity, cost = 1.5, 0.0, 0
    for piece, length in enumerate([bounce, end - bounce]):
        step = length / count
        for k in range(count):
            acceleration = controls[piece][k] - G
            height = height + velocity * step + acceleration * step**2 / 2
            velocity = velocity + acceleration * step
            cost = cost + step * controls[piece][k] ** 2
        if piece == 0:
            opti.subject_to(height == 0)
            velocity = -E * velocity
    opti.subject_to(height == 1)
    opti.subject_to(speed * end == 6)
    for values in controls:
        opti.subject_to(opti.bounded(-2, values, 2))
    opti.subject_to(opti.bounded(0.1, end, 5))
    opti.subject_to(opti.bounded(0, speed, 20))
    opti.subject_to(bounce >= 0.01)
    opti.minimize(speed**2 + cost)
    for variable, guess in [(end, 1.4), (bounce, 0.5), (speed, 4)]:
        opti.set_initial(variable, guess)
    opti.solver("ipopt", {"print_time": 0}, {"print_level": 0, "tol": 1e-10})
    found = opti.solve()
    return [found.value(it) for it in (speed**2 + cost, end, bounce, speed)]


def throw(up, bounces):
    """The square of the speed of the throw, and its times: of the bounces, of the hit on the way down or up, whichever is better."""
    time, height, velocity, times = 0.0, 1.5, up, []
    for _ in range(bounces):
        fall = (velocity + math.sqrt(velocity**2 + 2 * G * height)) / G
        time += fall
        height, velocity = 0.0, -E * (velocity - G * fall)
        times.append(time)
    under = velocity**2 - 2 * G * (1 - height)
    if under < 0:
        return 1e9, []
    best = (1e9, [])
    for sign in (-1, 1):
        last = (velocity + sign * math.sqrt(under)) / G
        if last > 0:
            best = min(best, (up**2 + (6 / (time + last)) ** 2, [*times, time + last]))
    return best


if __name__ == "__main__":
    print("models/bounce.fdc: objective, T, time of the bounce, vx:", controlled())
    for bounces in range(3):
        grid = min((throw(up / 1000, bounces)[0], up / 1000) for up in range(-10000, 10001))
        near = minimize_scalar(
            lambda up: throw(up, bounces)[0], bounds=(grid[1] - 0.002, grid[1] + 0.002), method="bounded", options={"xatol": 1e-13}
        )
        print(bounces, "bounces:", near.fun, "vy", near.x, "times", throw(near.x, bounces)[1])
