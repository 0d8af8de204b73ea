"""Exact trajectories with events, for fits: a block with dry friction, a ball that bounces."""

import numpy as np

GRAVITY = 9.81


def ball(h, v, kept, times):
    """Heights of a ball that begins at h with the speed v and keeps a part of its speed at each bounce."""
    out, begin = [], 0.0
    for t in times:
        while True:
            landing = (v + np.sqrt(v**2 + 2 * GRAVITY * h)) / GRAVITY
            if t - begin <= landing:
                break
            begin, h, v = begin + landing, 0.0, -kept * (v - GRAVITY * landing)
        s = t - begin
        out.append(h + v * s - GRAVITY * s**2 / 2)
    return np.array(out)


def block(speed, friction, mass, times, force):
    """Positions at `times` of a block under a force that is linear between these, events found exactly."""
    x, v, out = 0.0, speed, [0.0]
    limit = friction * mass * GRAVITY
    for t0, t1, f0, f1 in zip(times, times[1:], force, force[1:]):
        slope, now = (f1 - f0) / (t1 - t0), t0
        while now < t1:
            pull = f0 + slope * (now - t0)
            if v == 0 and abs(pull) <= limit and not breaks(pull, slope, limit):
                now = release(pull, slope, limit, now, t1)
                continue
            way = np.sign(v) if v != 0 else np.sign(pull)
            a, jerk = (pull - way * limit) / mass, slope / mass
            step = min([s for s in halts(v, a, jerk) if s > 1e-12] + [t1 - now])
            x += v * step + a * step**2 / 2 + jerk * step**3 / 6
            stopped = step < t1 - now
            v = 0.0 if stopped else v + a * step + jerk * step**2 / 2
            now = now + step if stopped else t1
        out.append(x)
    return np.array(out)


def breaks(pull, slope, limit):
    """Whether a force at its limit grows beyond it."""
    return abs(abs(pull) - limit) < 1e-12 and pull * slope > 0


def release(pull, slope, limit, now, end):
    """When a block at rest begins to slide, or the end."""
    if slope == 0:
        return end
    s = (np.sign(slope) * limit - pull) / slope
    return min(now + s, end)


def halts(v, a, jerk):
    """Times at which v + a s + jerk s^2/2 is 0."""
    roots = np.roots([jerk / 2, a, v]) if jerk != 0 else np.roots([a, v]) if a != 0 else []
    return [float(r.real) for r in np.atleast_1d(roots) if abs(r.imag) < 1e-12]
