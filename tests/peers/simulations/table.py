"""tests/simulations/table.fdc: between bounces the ball is a parabola, so each bounce is one root."""

from mpmath import cos, findroot, mp, mpf, nstr, sin

mp.dps = 30
HEIGHT, FREQUENCY, RESTITUTION, GRAVITY = mpf(1) / 10, mpf(7), mpf(7) / 10, mpf(981) / 100


def table(t):
    return HEIGHT * sin(FREQUENCY * t)


def lift(t):
    return HEIGHT * FREQUENCY * cos(FREQUENCY * t)


def bounces(h, v, count):
    """Times, with the state after each."""
    t = mpf(0)
    for _ in range(count):
        gap = lambda d: h + v * d - GRAVITY * d**2 / 2 - table(t + d)
        guess = (v - lift(t)) * 2 / (GRAVITY - HEIGHT * FREQUENCY**2 * sin(FREQUENCY * t)) if t else mpf(45) / 100
        step = guess / 50
        d = step
        while gap(d) > 0:
            d += step
        d = findroot(gap, (d - step, d), solver='anderson', tol=mpf(10) ** -50)
        t, h, v = t + d, table(t + d), v - GRAVITY * d
        v = -RESTITUTION * v + (1 + RESTITUTION) * lift(t)
        yield t, h, v


few = [bounce for bounce in bounces(mpf(1), mpf(0), 7)]
for t, _, _ in few:
    print('event', nstr(t, 18), 'table jump')
t, h, v = few[-1]
d = 2 - t
print('h =', nstr(h + v * d - GRAVITY * d**2 / 2, 18))
print('v =', nstr(v - GRAVITY * d, 18))
print()
many = [t for t, _, _ in bounces(mpf(1), mpf(0), 80)]
print('status zeno', nstr(many[-1] + (many[-1] - many[-2]) * RESTITUTION / (1 - RESTITUTION), 18))
