"""The numbers of the models of tests/simulations/ that are followed by hand: thermostat, bilinear, rocking, backlash, two_balls, corner."""

from mpmath import acos, acosh, asin, cos, cosh, exp, log, mp, mpf, nsum, inf, nstr, pi, sin, sinh, sqrt

mp.dps = 30


def event(t, what):
    print('event', nstr(t, 18), what)


def state(**values):
    for name, value in values.items():
        print(name, '=', nstr(mpf(value), 18))
    print()


def thermostat(last=2):
    """Heated: 30 - (30 - x) exp(-t); not heated: 10 + (x - 10) exp(-t); between 19 and 21."""
    print('== thermostat')
    t, x, heats = mpf(0), mpf(15), True
    event(log(mpf(15) / 11), 'cold crosses_up')
    while True:
        goal, limit = (30, 21) if heats else (10, 19)
        d = log((goal - x) / mpf(goal - limit))
        if t + d > last:
            return state(x=goal + (x - goal) * exp(t - last), heat=1 if heats else 0)
        t, x = t + d, mpf(limit)
        event(t, 'hot jump' if heats else 'cold jump')
        heats = not heats


def bilinear(last=6):
    """x = 2 sin t below 1; x = 8/9 + A cos(3 t) about the top above it, A^2 = 1/81 + 1/3."""
    print('== bilinear')
    amplitude = sqrt(mpf(1) / 81 + mpf(1) / 3)
    inside, above = pi / 6, 2 * acos(1 / (9 * amplitude)) / 3
    below = pi + 2 * inside
    t = inside
    event(t, 'stop crosses_up')
    t += above
    event(t, 'stop crosses_down')
    t += below
    event(t, 'stop crosses_up')
    d = last - t - above / 2
    state(x=mpf(8) / 9 + amplitude * cos(3 * d), v=-3 * amplitude * sin(3 * d))


def rocking(e=mpf(8) / 10, angle=mpf(6) / 10, last=6):
    """angle'' = angle - 1 until the block is upright; it then rocks on with e times the speed."""
    print('== rocking')
    t = acosh(1 / (1 - angle))
    speed = sqrt(2 * angle - angle**2)
    while True:
        event(t, 'upright jump')
        speed *= e
        top = 1 - sqrt(1 - speed**2)
        d = 2 * acosh(1 / (1 - top))
        if t + d > last:
            d = last - t
            return state(angle=1 - cosh(d) + speed * sinh(d), speed=speed * cosh(d) - sinh(d))
        t += d


def rocking_ends(e=mpf(8) / 10, angle=mpf(6) / 10):
    """Impacts pile up: 2 acosh(1/sqrt(1 - w^2)) = 2 atanh(w) for each speed w."""
    first = sqrt(2 * angle - angle**2)
    print('status zeno', nstr(acosh(1 / (1 - angle)) + nsum(lambda k: 2 * mp.atanh(first * e**k), [1, inf]), 18))
    print()


def backlash(e=mpf(6) / 10, last=6):
    """Two wheels with a play of 2: the difference bounces between -1 and 1, the momentum 2 a + b stays."""
    print('== backlash')
    t, d, w = mpf(0), mpf(0), mpf(3)
    while True:
        step = (1 - d) / w if w > 0 else (-1 - d) / w
        if t + step > last:
            d += w * (last - t)
            return state(
                driver=2 * mpf(last) + d / 3,
                driven=2 * mpf(last) - 2 * d / 3,
                driver_speed=2 + w / 3,
                driven_speed=2 - 2 * w / 3,
            )
        t, d = t + step, mpf(1 if w > 0 else -1)
        event(t, 'front jump' if w > 0 else 'back jump')
        w = -e * w


def two_balls(last=mpf(15) / 10):
    """Masses 3 below and 1 above, restitution 9/10 on the floor and 8/10 between them, g = 10."""
    print('== two_balls')
    t, h, v, k, w, g = mpf(0), mpf(1), mpf(0), mpf(13) / 10, mpf(0), mpf(10)
    while True:
        floor = (v + sqrt(v**2 + 2 * g * h)) / g
        meet = (k - h) / (v - w) if v > w and k > h else mpf(10)
        d = min(floor, meet, last - t)
        h, v, k, w = h + v * d - g * d**2 / 2, v - g * d, k + w * d - g * d**2 / 2, w - g * d
        t += d
        if t == last:
            return state(h=h, v=v, k=k, w=w)
        if d == floor:
            event(t, 'floor jump')
            h, v = mpf(0), -mpf(9) / 10 * v
        else:
            event(t, 'touch jump')
            k, common, relative = h, (3 * v + w) / 4, mpf(8) / 10 * (v - w)
            v, w = common - relative / 4, common + 3 * relative / 4


def corner(last=mpf(2)):
    """A ball thrown at a wall: its two coordinates are independent."""
    print('== corner')
    events, h, v, t = [(mpf(6) / 10, 'wall jump')], mpf(1), mpf(1), mpf(0)
    while True:
        d = (v + sqrt(v**2 + 20 * h)) / 10
        if t + d > last:
            break
        t, h, v = t + d, mpf(0), mpf(8) / 10 * (10 * d - v)
        events.append((t, 'floor jump'))
    for at, what in sorted(events):
        event(at, what)
    d = last - t
    state(x=(last - mpf(6) / 10) * mpf(18) / 10, h=h + v * d - 5 * d**2, u=mpf(18) / 10, v=v - 10 * d)


thermostat()
bilinear()
rocking()
rocking_ends()
backlash()
two_balls()
corner()
