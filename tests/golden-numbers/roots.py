#!/usr/bin/env python3
"""Real roots of polynomials of degree two to four with coefficients that are exactly the f64 printed.

    python3 tests/golden-numbers/roots.py > tests/golden-numbers/roots.txt

Each line: family, degree, coefficients of 1, x, x^2, ..., then each distinct real root as high + low.
How many there are is certain (Sturm's theorem in exact rationals); the roots are mpmath's to 60 digits.
Families whose name starts with "touch" come so close to a double root that the count is a matter of one rounding of a
coefficient; programs are judged on them by backward error alone.
"""
import random
from fractions import Fraction as F

from mpmath import mp, mpf

mp.dps = 120
random.seed(20240611)


def divide(a, b):
    """Remainder of a by b, coefficients ascending."""
    a = a[:]
    while len(a) >= len(b):
        q = a[-1] / b[-1]
        for i in range(len(b)):
            a[len(a) - len(b) + i] -= q * b[i]
        a.pop()
        while a and a[-1] == 0:
            a.pop()
    return a


def sturm(c):
    chain = [c, [i * x for i, x in enumerate(c)][1:]]
    while len(chain[-1]) > 1:
        rest = divide(chain[-2], chain[-1])
        if not rest:
            break
        chain.append([-x for x in rest])
    return chain


def value(c, x):
    total = F(0)
    for a in reversed(c):
        total = total * x + a
    return total


def changes(chain, x):
    signs = [s for s in ((v > 0) - (v < 0) for v in (value(c, x) for c in chain)) if s]
    return sum(a != b for a, b in zip(signs, signs[1:]))


def roots(c):
    """Distinct real roots, isolated by Sturm, closed in on by bisection and Newton."""
    c = [F(x) for x in c]
    while c and c[-1] == 0:
        c.pop()
    chain = sturm(c)
    reach = 1 + max(abs(x / c[-1]) for x in c[:-1])
    found = []
    stack = [(-reach, reach)]
    while stack:
        a, b = stack.pop()
        n = changes(chain, a) - changes(chain, b)
        if n == 0:
            continue
        if n == 1:
            found.append(close_in(chain, a, b))
            continue
        m = cut(a, b)
        stack += [(a, m), (m, b)]
    return sorted(found)


def cut(a, b):
    """Between a and b: halfway in magnitude where they are of very different size."""
    if a < 0 < b:
        return F(0) if min(-a, b) > F(1, 10**40) else (a + b) / 2
    small, large = sorted((abs(a), abs(b)))
    if small == 0 and large > F(1, 10**40):
        small = large / 10**8
    if small and large / small > 16:
        g = F(float(mp.sqrt(mpf(small.numerator) / small.denominator * large.numerator / large.denominator)))
        g = g if a + b > 0 else -g
        return g if a < g < b else (a + b) / 2
    return (a + b) / 2


def close_in(chain, a, b):
    """The single root in (a, b], by counting."""
    for _ in range(2000):
        if b != 0 and abs(b - a) <= abs(b) / 2**140 or b - a < F(1, 10**400):
            break
        m = cut(a, b)
        # Rounded to 200 bits, to keep the fractions short.
        if m:
            e = 200 - (m.numerator.bit_length() - m.denominator.bit_length())
            m2 = F(round(m * F(2) ** e)) / F(2) ** e
            m = m2 if a < m2 < b else m
        if changes(chain, a) - changes(chain, m) == 1:
            b = m
        else:
            a = m
    return b


def line(family, c):
    c = [float(x) for x in c]
    out = []
    for r in roots(c):
        high = float(r)
        out += [high, float(r - F(high))]
    print(family, len(c) - 1, *(x.hex() for x in c + out))


def product(rs, pairs=(), lead=1):
    """Coefficients of lead * prod (x - r) * prod ((x - a)^2 + b^2), exact until the caller rounds."""
    c = [F(lead)]
    factors = [[-F(r), F(1)] for r in rs] + [[F(a) ** 2 + F(b) ** 2, -2 * F(a), F(1)] for a, b in pairs]
    for f in factors:
        out = [F(0)] * (len(c) + len(f) - 1)
        for i, x in enumerate(c):
            for j, y in enumerate(f):
                out[i + j] += x * y
        c = out
    return c


def spread(low, high):
    return random.choice((-1, 1)) * 10 ** random.uniform(low, high)


def quadratics():
    for c in ([1, -1e8, 1], [1, -1, 1e-30], [94906268.375, -189812534.0, 94906265.625], [2e200, -3e200, 1e200]):
        line("quadratic-rows", c)
    for _ in range(40):
        line("quadratic-spread", product([spread(-12, 12), spread(-12, 12)], lead=spread(-3, 3)))
    for _ in range(40):
        r = spread(-2, 2)
        line("quadratic-close", product([r, r * (1 + 10 ** random.uniform(-8, -2))], lead=spread(-100, 100)))
    for _ in range(20):
        line("quadratic-tiny-lead", [spread(-3, 3), spread(-3, 3), spread(-30, -10)])
    for _ in range(20):
        line("quadratic-tame", [spread(-5, 5) for _ in range(3)])


def cubics():
    for lead in (1e-14, 1e-20, -1e-14, 1e-17):
        line("cubic-tiny-lead", [0.32, -1.2, 1.0, lead])
    for _ in range(40):
        a, b = sorted(random.random() for _ in range(2))
        c = product([a, b])
        line("cubic-tiny-lead", c + [spread(-25, -8)])
    for _ in range(40):
        line("cubic-tame", product([spread(-2, 1) for _ in range(3)], lead=spread(-2, 2)))
    for _ in range(30):
        r = random.uniform(0.1, 0.9)
        line("cubic-close", product([r, r + spread(-5, -3), r + spread(-3, -1)]))
    for _ in range(20):
        line("cubic-one-real", product([spread(-2, 2)], [(spread(-2, 2), spread(-4, 1))]))
    line("touch-cubic", product([F(3, 10), F(3, 10), F(4, 5)]))
    line("touch-cubic", product([F(1, 2), F(50001, 100000), F(49999, 100000)]))
    for _ in range(40):
        r = random.random()
        line("touch-cubic", product([r, r, random.uniform(-1, 2)], lead=spread(-3, 3)))
    for _ in range(20):
        r = random.random()
        line("touch-cubic", product([r, r + 10 ** random.uniform(-8, -6), random.uniform(-1, 2)]))


# Orellana & De Michele, Algorithm 1010 (ACM TOMS 46, 2020): table 1, and case by case in the program that makes it, accuracytest.c of
# CALGO 1010. Cases 1 to 13, 17, 18 and 22 by their roots: real ones, then real and imaginary parts of pairs. Cases 23 and 24 are given
# by coefficients; 14, 15 and 19 to 21 have roots of several folds, and 16 has a pair that rounding cannot tell from a double root.
ORELLANA = [
    ([1, 1e3, 1e6, 1e9], []),
    ([2, F("2.001"), F("2.002"), F("2.003")], []),
    ([1e47, 1e49, 1e50, 1e53], []),
    ([-1, 1, 2, 1e14], []),
    ([-2e7, -1, 1, 1e7], []),
    ([1e7, -1e6], [(1, 1)]),
    ([-7, -4], [(-1e6, 1e5)]),
    ([1e8, 11], [(1e3, 1)]),
    ([], [(1e7, 1e6), (1, 2)]),
    ([], [(1e4, 3), (-7, 1e3)]),
    ([], [(F("1.001"), F("4.998")), (F("1.000"), F("5.001"))]),
    ([], [(1e3, 3), (1e3, 1)]),
    ([], [(2, 1e4), (1, 1e3)]),
    ([10000, 10001, 10010, 10100], []),
    ([], [(4e5, 3e2), (3e4, 7e3)]),
    ([1, 10, 1e152, 1e154], []),
]


def quartics():
    for reals, pairs in ORELLANA:
        line("quartic-orellana", product(reals, pairs))
    line("quartic-orellana", [1e-3, 3 / 8, 1, 1, 1])
    s = F(10) ** 30
    line("quartic-orellana", [-s, s * s + s, 1 / s - s * s, -(1 + 1 / s), 1])
    for reals in ([1000] * 4, [F(1, 10**15)] + [1000] * 3, [1, 1e30, 1e30, 1e44], [1, 1e7, 1e7, 1e14], [1, 1e7, 1e7, 1e15]):
        line("touch-quartic", product(reals))
    line("touch-quartic", product([], [(1e16, 1e7), (1, F("0.1"))]))
    for _ in range(40):
        line("quartic-tame", product([spread(-2, 1) for _ in range(4)], lead=spread(-2, 2)))
    for _ in range(30):
        line("quartic-spread", product([spread(-6, 6) for _ in range(4)]))
    for _ in range(30):
        line("quartic-two-real", product([spread(-1, 1) for _ in range(2)], [(spread(-1, 1), spread(-3, 1))]))
    for _ in range(20):
        line("quartic-none-real", product([], [(spread(-1, 1), spread(-3, 1)) for _ in range(2)]))
    for _ in range(40):
        r = spread(-1, 1)
        line("touch-quartic", product([r, r, spread(-1, 1), spread(-1, 1)]))
    for _ in range(20):
        a, b = spread(-1, 1), spread(-1, 1)
        line("touch-quartic", product([a, a, b, b]))


quadratics()
cubics()
quartics()
