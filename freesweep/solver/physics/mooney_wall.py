"""The wall of :mod:`wall` where the energy is linear in I1 and I2 (Mooney and Rivlin, no Yeoh): exactly, without layers.

With ``d = rho^2 - 1``, ``g = -1/(2 G^(3/2))`` a layer's q has ``q_y = 2 y, q_G = g d``. As q is linear in d, all that
depends on the layer is a power of d times one of ``1/q, rho^2/q^2, rho^2/q^3``, and as ``d/q`` is linear in ``1/q``, the
sums of ``1/q, 1/q^2, 1/q^3`` make W and all first and second derivatives. Means of powers over a range from a to b are ::

    mean of 1/q = 1/(logarithmic mean of a and b),   mean of 1/q^2 = 1/(a b),   mean of 1/q^3 = (a + b)/(2 a^2 b^2)

With the arithmetic mean m and the geometric one g, n = m + g and h = (b - a)/2, the first is ``2/h atanh(h/n)``, and with
``i = h/(n + sqrt(n^2 - h^2))`` ``atanh(h/n) = 2 atanh(i)``. Roots and divisions are what this costs: there are no more. W is
a sum of terms of the size of the strain, each of which is known to all digits.
"""

from math import sqrt
from typing import NamedTuple

import numpy as np

from ...jit import kernel
from ..either import some

TERMS = 10  # of a Gauss rule, whose mean of 1/(1 + i x) stands for atanh(i)/i: 1e-11 off at i = 1/2, where b = 81 a
_PLACES, _WEIGHTS = (row[TERMS // 2 :] for row in np.polynomial.legendre.leggauss(TERMS))
_FACTORS = [np.polynomial.Polynomial([1.0, -x * x]) for x in _PLACES]  # two places together
_BELOW = np.prod(_FACTORS)
_ABOVE = sum(w * np.prod([*_FACTORS[:j], *_FACTORS[j + 1 :]]) for j, w in enumerate(_WEIGHTS))
BELOW, ABOVE = _BELOW.coef[::-1].copy(), np.append(_ABOVE.coef[:0:-1], 1.0)  # what has no range is exact
NO_ROOM = 1e-30  # stands for a b where the innermost layer would reach the axis


class Section(NamedTuple):
    """A wall: its area, k, mean of d and half the range of rho^2, none of a membrane; mean of 1/rho^2."""

    area: float
    k: float
    d: float
    half: float
    reciprocal: float


class Known(NamedTuple):
    """``1/G, 1/sqrt(G), sqrt(G)``, means of q, 1/q and 1/q^2."""

    e: float
    root: float
    per_root: float
    q: float
    one: float
    two: float


@kernel
def polynomial(coefficients, v):
    """By Horner's rule, the highest power first."""
    total = coefficients[0] + 0.0 * v
    for k in range(1, len(coefficients)):
        total = total * v + coefficients[k]
    return total


@kernel
def mean_reciprocals(middle, half, product):
    """Means of 1/q and 1/q^2 where q goes from ``middle - half`` to ``middle + half``, whose ``product`` is given."""
    if not some(half > 0.0):  # all lanes of a vector are membranes, or none is
        one = 1.0 / middle
        return one, one * one
    both = middle + sqrt(product)
    per = 1.0 / (both + sqrt((both - half) * (both + half)))
    v = half * per
    v = v * v
    below = polynomial(BELOW, v)
    rest = 1.0 / (below * product)
    return 4.0 * per * polynomial(ABOVE, v) * (rest * product), rest * below


@kernel
def known(y, G_1, section):
    """What is :class:`Known` of the layers."""
    per_root = sqrt(1.0 + G_1)
    root = 1.0 / per_root
    q, half = y * y + section.d * root, section.half * root
    one, two = mean_reciprocals(q, half, max((q - half) * (q + half), NO_ROOM))
    return Known(root * root, root, per_root, q, one, two)


@kernel
def energy(y, G_1, psi, c, section, own):
    """W where what is :class:`Known` is ``own``."""
    area, k, d, _, reciprocal = section
    e, root, per_root, q, one, _ = own
    n, hoop, both = k * psi * psi, (y - 1.0) * (y + 1.0), G_1 * y * y + (y - 1.0) * (y + 1.0)
    wide = G_1 / (per_root + 1.0)  # 1/root - 1, with all its digits
    bend, away = root * wide, (1.0 - y * y * one) * per_root  # 1 - root; mean of d/q
    # means of q/rho^2 - 1, rho^2/(G q) - 1; of G q/rho^2 - 1, rho^2/q - 1
    first = (hoop + bend) * reciprocal - bend - e * (both * one + wide * away)
    second = (both - wide) * reciprocal + wide + bend * away - hoop * one
    return area * (G_1 + first + n * q + c * (second - G_1 * e + n * e * (1.0 + d)))


@kernel
def rising(y, G_1, psi, c, section, own):
    """``(W_y, W_G, W_psi)`` over the area, and of these the means that W_yy, W_yG and W_GG know, too: ``rho^2/q^2``,
    ``d rho^2/q^2``, and d times W_q.
    """
    _, k, d, _, i = section
    e, root, per_root, q, one, two = own
    y2, n, G = y * y, k * psi * psi, 1.0 + G_1
    one_q = one + (1.0 - y2 * one) * per_root  # mean of rho^2/q
    two_q = two + (one - y2 * two) * per_root
    d_two = (one_q - y2 * two_q) * per_root
    d_i, squares, slope, stiff = 1.0 - i, 1.0 + d, e + c, 1.0 + c * G
    w_q, d_w_q = stiff * i + n - slope * two_q, stiff * d_i + n * d - slope * d_two
    w_G = 1.0 - e * e * one_q + c * (y2 * i + root * d_i - e * e * (1.0 + n * squares))
    first = 2.0 * y * w_q, w_G - 0.5 * root * e * d_w_q, 2.0 * k * psi * (q + c * e * squares)
    return first, (one_q, two_q, d_two, w_q, d_w_q)


@kernel
def stored(y, G_1, psi, c, section):
    """W alone."""
    return energy(y, G_1, psi, c, section, known(y, G_1, section))


@kernel
def rises(y, G_1, psi, c, section):
    """``(W, W_y, W_G, W_psi)``."""
    own = known(y, G_1, section)
    (W_y, W_G, W_p), _ = rising(y, G_1, psi, c, section, own)
    area = section.area
    return energy(y, G_1, psi, c, section, own), area * W_y, area * W_G, area * W_p


@kernel
def slopes(y, G_1, psi, c, section):
    """``(W_y, W_G, W_psi, W_yy, W_yG, W_ypsi, W_GG, W_Gpsi, W_psipsi)``."""
    return slopes_of(y, G_1, psi, c, section, known(y, G_1, section))


@kernel
def slopes_of(y, G_1, psi, c, section, own):
    """:func:`slopes` where what is :class:`Known` is ``own``."""
    area, k, d, _, i = section
    e, root, per_root, q, _, two = own
    (W_y, W_G, W_p), (one_q, two_q, d_two, w_q, d_w_q) = rising(y, G_1, psi, c, section, own)
    y2, n, g = y * y, k * psi * psi, -0.5 * root * e
    three = q * two * two
    three_q = three + (two - y2 * three) * per_root
    d_three = (two_q - y2 * three_q) * per_root
    dd_three = (d_two - y2 * d_three) * per_root
    bend, squares, twist = 2.0 * (e + c), 1.0 + d, 2.0 * k * psi
    w_qG, d_w_qG = e * e * two_q + c * i, e * e * d_two + c * (1.0 - i)
    w_GG = 2.0 * e * e * e * (one_q + c * (1.0 + n * squares))
    return (
        area * W_y, area * W_G, area * W_p, area * (4.0 * y2 * bend * three_q + 2.0 * w_q),
        area * 2.0 * y * (w_qG + g * bend * d_three), area * 2.0 * y * twist,
        area * (w_GG + 2.0 * g * d_w_qG + g * g * bend * dd_three - 1.5 * g * e * d_w_q),
        area * twist * (g * d - c * e * e * squares), area * 2.0 * k * (q + c * e * squares),
    )  # fmt: skip
