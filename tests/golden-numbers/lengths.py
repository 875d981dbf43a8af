#!/usr/bin/env python3
"""Arc lengths of cubics at hard places, to 20 digits.

    python3 tests/golden-numbers/lengths.py
"""
from mpmath import mp, mpf, quad, sqrt, polyroots

mp.dps = 40

CURVES = {
    "cusp": [(0, 0), (1, 1), (0, 1), (1, 0)],
    "line": [(0, 0), (2, 0), (-1, 0), (1, 0)],
    "loop": [(0, 0), (2, 1), (-1, 1), (1, 0)],
    "near cusp": [(0, 0), (1, 1), (1e-3, 1), (1, 0)],
    "nearer cusp": [(0, 0), (1, 1), (1e-6, 1), (1, 0)],
    "leaning cusp": [(0.3, 0.1), (3.3, 2.1), (-0.7, 2.1), (2.3, 0.1)],
}


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


for name, points in CURVES.items():
    print(name, mp.nstr(length(points), 20))
