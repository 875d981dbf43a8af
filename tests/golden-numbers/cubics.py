#!/usr/bin/env python3
"""Exact values of cubics at hard places, as hexadecimal floats.

    python3 tests/golden-numbers/cubics.py > tests/golden-numbers/cubics.txt

Each line: family, t, four Bezier points, the value as high + low, and the sum of |P_i B_i(t)| (rounded).
Computed with exact rationals, so nothing is rounded but the numbers printed.
"""
import random
from fractions import Fraction as F

random.seed(20240607)


def bernstein(t):
    t = F(t)
    r = 1 - t
    return [r**3, 3 * r**2 * t, 3 * r * t**2, t**3]


def line(family, p, t):
    terms = [F(a) * b for a, b in zip(p, bernstein(t))]
    value = sum(terms)
    high = float(value)
    low = float(value - F(high))
    size = float(sum(abs(x) for x in terms))
    print(family, *(float(x).hex() for x in [t, *p, high, low, size]))


def main():
    for _ in range(60):
        line("inside", [0, 1, -1, 2], random.random())
        line("inside", [random.uniform(-3, 3) for _ in range(4)], random.random())
    for p in ([0.1, 0.7, 1e17, 0.3], [-1e-7, 3e15, 2.5, 1 / 3], [1e300, 1e-300, 5.0, -0.1]):
        line("ends", p, 0.0)
        line("ends", p, 1.0)
    # (2t - 1)^3 / 8, its scaled copies, and a triple root at 1/4 that is exact in binary.
    for k in range(2, 6):
        for s in (1, -1):
            line("triple", [-0.125, 0.125, -0.125, 0.125], 0.5 + s * 10.0**-k)
            line("triple", [-8.0, 8.0, -8.0, 8.0], 0.5 + s * 3 * 10.0**-k)
            line("triple", [-1.0, 3.0, -9.0, 27.0], 0.25 + s * 2 * 10.0**-k)
    for k in (10, 20, 30):
        for tail in (1e-30, -3e-25, 7e-18):
            line("tail", [1.0, 0.0, 0.0, tail], 1 - 2.0**-k)
            line("tail", [tail, 0.0, 0.0, -5.0], 2.0**-k)
    for offset in (1e8, -3e11, 6.371e6):
        for _ in range(30):
            line("offset", [offset + x for x in (0.1, 1.7, 3.3, 2.9)], random.random())
            line("offset", [offset + x for x in (0, 1, 3, 2)], random.random())
    for _ in range(60):
        line("outside", [random.uniform(-3, 3) for _ in range(4)], random.uniform(-10, 10))


main()
