#!/usr/bin/env python3
"""Arc lengths of plane cubics at hard places.

    python3 tests/golden-numbers/lengths.py > tests/golden-numbers/lengths.txt

Each line: family, the eight coordinates of four Bezier points, the length as high + low; hexadecimal floats. The integral is
mpmath's at 40 digits, cut at the least speeds and graded towards each cut.
"""
import random

from mpmath import mp, mpf, quad, sqrt, polyroots

mp.dps = 40
random.seed(20240613)

ROWS = [
    ("cusp", [(0, 0), (1, 1), (0, 1), (1, 0)]),
    ("backtrack", [(0, 0), (2, 0), (-1, 0), (1, 0)]),
    ("loop", [(0, 0), (2, 1), (-1, 1), (1, 0)]),
    ("parabola", [(0, 0), (1 / 3, 0), (2 / 3, 1 / 3), (1, 1)]),
    ("near-cusp", [(0, 0), (1, 1), (1e-3, 1), (1, 0)]),
    ("near-cusp", [(0, 0), (1, 1), (1e-6, 1), (1, 0)]),
    ("loop", [(0.3, 0.1), (3.3, 2.1), (-0.7, 2.1), (2.3, 0.1)]),
]


def point(reach):
    return (random.uniform(-reach, reach), random.uniform(-reach, reach))


def short(reach):
    """A multiple of 1/64, so that sums of a few are exact."""
    return round(random.uniform(-reach, reach) * 64) / 64


def own_family():
    for _ in range(8):
        # A cusp under an exact linear map: points 0, x + y, y, x.
        x, y = (short(1), short(1)), (short(1), short(1))
        yield "cusp", [(0, 0), (x[0] + y[0], x[1] + y[1]), y, x]
    for _ in range(12):
        e = 10 ** random.uniform(-9, -1)
        yield "near-cusp", [(0, 0), (1, 1), (e * random.choice((-1, 1)), 1), (1, 0)]
    for _ in range(8):
        d = (short(1), short(1))
        yield "backtrack", [(d[0] * k, d[1] * k) for k in (0, *(random.randint(-3, 4) for _ in range(3)))]
    for _ in range(8):
        # A parabola, raised to a cubic exactly: thirds of sums that are multiples of three.
        a, b, c = ((3 * short(0.3), 3 * short(0.3)) for _ in range(3))
        yield "parabola", [a, *(((p[0] + 2 * q[0]) / 3, (p[1] + 2 * q[1]) / 3) for p, q in ((a, b), (c, b))), c]
    for _ in range(16):
        yield "loop", [point(1) for _ in range(4)]



def monomial(d):
    return [d[0] - 2 * d[1] + d[2], 2 * (d[1] - d[0]), d[0]]


def multiply(a, b):
    out = [mpf(0)] * (len(a) + len(b) - 1)
    for i, x in enumerate(a):
        for j, y in enumerate(b):
            out[i + j] += x * y
    return out


def length(points):
    square = [mpf(0)] * 5
    for axis in range(2):
        p = [mpf(q[axis]) for q in points]
        v = monomial([3 * (p[i + 1] - p[i]) for i in range(3)])
        square = [a + b for a, b in zip(square, multiply(v, v))]
    slope = [c * k for c, k in zip(square, (4, 3, 2, 1))]
    while slope and slope[0] == 0:
        slope.pop(0)
    roots = polyroots(slope, maxsteps=500, extraprec=400) if len(slope) > 1 else []
    cuts = sorted({mpf(0), mpf(1)} | {r.real for r in map(mp.mpc, roots) if abs(r.imag) < 1e-18 and 0 < r.real < 1})
    speed = lambda t: sqrt(abs(sum(c * t**k for c, k in zip(square, (4, 3, 2, 1, 0)))))
    # Graded towards each cut, since a near cusp has its branch points close by.
    total = mpf(0)
    for a, b in zip(cuts, cuts[1:]):
        m = (a + b) / 2
        left = [a] + [a + (m - a) * mpf(2) ** -k for k in range(40, -1, -1)]
        right = [b - (b - m) * mpf(2) ** -k for k in range(0, 41)] + [b]
        total += quad(speed, left) + quad(speed, right)
    return total


for family, points in [*ROWS, *own_family()]:
    flat = [float(x) for p in points for x in p]
    total = length(points)
    high = float(total)
    print(family, *(x.hex() for x in [*flat, high, float(total - mpf(high))]))
