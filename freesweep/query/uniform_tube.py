"""The uniform tube: what an actuator does far from its ends, in closed form but for one root.

Every stored state is close to it; what is left is the effect of the clamped ends, which is small and smooth. Dimensionless:
lengths by the fiber surface's radius, pressure by C10. With q = y^2, y the circumferential stretch::

    G(q) = gamma^2 (1 + H^2 + D^2) - D^2 q - gamma^4 H^2/q,   psi(q) = H (gamma^2/q - 1)
    L(q) = (p q + f) sqrt(G) - a w(q) + m psi                  (Eqs. 2.2, 2.11), stationary in q

and w the energy of a rubber (C01, C20, C30)/C10, over C10 (Eq. 2.5, Yeoh's terms; with the shear of twisting if ``shear``
is 1).
"""

import math

from ..jit import kernel

STEPS = 60  # Newton inside a bracket: 5 to 8 are usual, bisection alone would take 52
MARCH = 48  # steps in search of a bracket, each a fifth of the way that is left to where the fibers end
REMAINS, UNIQUE = 0.8, 0.5  # half of it where theory knows of one root only: full energy, no loads but the pressure
LAST_STEP = 1e-9  # of q: Newton doubles the digits, so what comes after it is rounding


@kernel
def kinematics(q, h, d, gamma):
    """``(G, G', G'', psi, psi', psi'')`` at q; primes are derivatives by q."""
    g2 = gamma * gamma
    b = g2 * g2 * h * h / q
    G = g2 * (1.0 + h * h + d * d) - d * d * q - b
    turn = h * g2 / q
    return G, -d * d + b / q, -2.0 * b / (q * q), turn - h, -turn / q, 2.0 * turn / (q * q)


@kernel
def energy(q, state, rubber, shear):
    """``(w, w', w'')`` of the wall over C10; ``state`` as :func:`kinematics` gives it."""
    G, G1, G2, psi, psi1, psi2 = state
    B, B1, B2 = 1.0 + shear * psi * psi, 2.0 * shear * psi * psi1, 2.0 * shear * (psi1 * psi1 + psi * psi2)
    thin = 1.0 / (G * q)  # squared stretch of the thickness
    rate = G1 / G + 1.0 / q
    rate1 = G2 / G - G1 * G1 / (G * G) - 1.0 / (q * q)
    i1, i1_1 = G + q * B + thin - 3.0, G1 + B + q * B1 - thin * rate
    i1_2 = G2 + 2.0 * B1 + q * B2 + thin * (rate * rate - rate1)
    i2, i2_1 = G * q + 1.0 / q + B / G - 3.0, G1 * q + G - 1.0 / (q * q) + (B1 - B * G1 / G) / G
    i2_2 = G2 * q + 2.0 * G1 + 2.0 / (q * q * q)
    i2_2 += (B2 - (2.0 * B1 * G1 + B * G2) / G + 2.0 * B * G1 * G1 / (G * G)) / G
    c, c2, c3 = rubber
    slope, bend = 1.0 + i1 * (2.0 * c2 + 3.0 * c3 * i1), 2.0 * c2 + 6.0 * c3 * i1  # of Yeoh's energy, along I1
    w = i1 * (1.0 + i1 * (c2 + c3 * i1)) + c * i2
    return w, slope * i1_1 + c * i2_1, slope * i1_2 + bend * i1_1 * i1_1 + c * i2_2


@kernel
def balance(q, problem, p):
    """dL/dq and its derivative; NaN where the fibers cannot reach. ``problem``: (H, D, a, gamma, rubber, shear, f, m)."""
    h, d, area, gamma, rubber, shear, f, m = problem
    state = kinematics(q, h, d, gamma)
    _, w1, w2 = energy(q, state, rubber, shear)
    G, G1, G2, _, psi1, psi2 = state
    if not G > 0.0:
        return math.nan, math.nan
    s = math.sqrt(G)
    s1 = 0.5 * G1 / s
    s2 = 0.5 * G2 / s - s1 * s1 / s
    load = p * q + f
    return p * s + load * s1 - area * w1 + m * psi1, 2.0 * p * s1 + load * s2 - area * w2 + m * psi2


@kernel
def squared_stretch(problem, p):
    """q of the uniform tube at pressure p: the first stationary point met from q = 1; NaN if there is none."""
    h, d, gamma = problem[0], problem[1], problem[3]
    _, c2, c3 = problem[4]
    unique = gamma == 1.0 and problem[5] == 1.0 and problem[6] == 0.0 and problem[7] == 0.0 and c2 == 0.0 and c3 == 0.0
    start, _ = balance(1.0, problem, p)
    if start == 0.0:
        return 1.0
    if not abs(start) > 0.0:
        return math.nan
    # G = 0 at both ends of what the fibers allow
    g2 = gamma * gamma
    total = g2 * (1.0 + h * h + d * d)
    root = math.sqrt(max(total * total - 4.0 * g2 * g2 * d * d * h * h, 0.0))
    end = 0.5 * (total + root) / (d * d) if start > 0.0 else 2.0 * g2 * g2 * h * h / (total + root)
    inner, outer, share, found = 1.0, 1.0, 1.0, False
    before, value = start, start
    for _ in range(MARCH):
        share *= UNIQUE if unique else REMAINS
        outer = end + (1.0 - end) * share
        value, _ = balance(outer, problem, p)
        if not value * start > 0.0:
            found = value * start <= 0.0
            break
        inner, before = outer, value
    if not found:
        return math.nan
    q = inner + (outer - inner) * before / (before - value)
    for _ in range(STEPS):
        value, slope = balance(q, problem, p)
        if value == 0.0:
            break
        if value * start > 0.0:
            inner = q
        else:
            outer = q
        step = value / slope
        if abs(step) <= LAST_STEP * q:
            q -= step
            break
        q -= step
        if not min(inner, outer) < q < max(inner, outer):
            q = 0.5 * (inner + outer)
    return q


@kernel
def locked_squared_stretch(h, d, gamma):
    """q of the locked uniform tube (Eq. 2.12)."""
    g2 = gamma * gamma
    a = g2 * (1.0 + h * h + d * d)
    return (a + math.sqrt(max(a * a - 3.0 * (g2 * d * h) ** 2, 0.0))) / (3.0 * d * d)
