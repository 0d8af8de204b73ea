"""Models of tests/classics/switched that were written as somebody would who does not know how they are solved."""

from math import hypot, pi

from true_optimum_formulas_kept import least
from true_optimum_model import Model
from true_optimum_models import slide
from true_optimum_switched import given, square, straight, to


def springs():
    """Two masses with friction, and a spring between them."""
    def rate(t, x, u, s, p):
        return [x[2], x[3], u[0] + 5 * (x[1] - x[0]) - 0.4 * s[0], 5 * (x[0] - x[1]) - 0.6 * s[1]]

    def ends(x, t, p):
        return [(x[1], 1, 1, None), (x[2], 0, 0, 0), (x[3], 0, 0, 1)]
    return Model(start=lambda p: [0] * 4, T=given(3), bounds=[(-20, 20)], cost=square, rate=rate, ends=ends,
                 guess=lambda s: [slide(s, 1, 3)[k] for k in (0, 0, 1, 1)], surfaces=lambda t, x, p: [x[2], x[3]],
                 sequences=['+0:0.3 ++', '00:0.2 +0:0.3 ++', '+0:0.3 ++ -+:0.4', '+0:0.3 ++ 0+:0.2',
                            '00:0.2 +0:0.3 ++ -+:0.4', '+0:0.3 ++ -+:0.4 00:0.1'])


def corner():
    """Into the corner of two relays, to rest there, and out of it."""
    def rate(t, x, u, s, p):
        return [u[0] - s[0] + 0.3 * s[1], u[1] - 0.2 * s[0] - 0.8 * s[1]]
    return Model(start=lambda p: [0.5, -0.4], T=given(3), bounds=[(-2, 2)] * 2, cost=square, rate=rate,
                 ends=to(0.3, 0.4), guess=straight([0.5, -0.4], [0, 0], [0, 0], [0.3, 0.4]),
                 surfaces=lambda t, x, p: [x[0], x[1]],
                 sequences=['+- 0- 00 0+ ++', '+- 0- 00 +0 ++', '+- 0- 00 ++', '+- +0 00 0+ ++', '+- +0 00 ++',
                            '+- +0 ++', '+- ++', '+- 0- 0+ ++', '+- ++ 0+ ++'])


def eclipse():
    """What the sun gives while it is seen, less the effort of a turn: a cubic takes it to its end."""
    return 0.5 + 0.3 * pi - 12 * 9 / 6**3, [pi], {}


def sand_and_road():
    """Sand, a road, grass: where the ways meet, from a straight line in each."""
    T, places = least(lambda z: hypot(1, z[0]) + hypot(1, z[1]) / 3 + hypot(1, 8 - z[0] - z[1]) / 2, [0.3, 6])
    first = hypot(1, places[0])
    return T, [first, first + hypot(1, places[1]) / 3], {'T': T}
