"""The wall of :mod:`wall` where the energy is linear in I1 and I2 (Mooney and Rivlin, no Yeoh): far fewer operations.

With ``d = rho^2 - 1``, ``g = -1/(2 G^(3/2))`` a layer's q has ``q_y = 2 y, q_G = g d``, so that what depends on the layer is
a power of d times one of ``rho^2/q, rho^2/q^2, rho^2/q^3``. As ``d/q`` is linear in ``1/q``, three sums over the layers make
all first and second derivatives.
"""

from math import sqrt
from typing import NamedTuple

import numpy as np

from ...jit import kernel
from .membrane import excess


class Layers(NamedTuple):
    """A wall as layers: its area, k, and rho_i^2; how many there are, and where their rule begins among the ``places`` and
    ``weights`` of all.
    """

    area: float
    k: float
    inner: float
    count: int
    at: int
    places: np.ndarray
    weights: np.ndarray


@kernel
def weigh(area, inner, count, reciprocal):
    """Sums over the layers of 1, d, and 1/rho^2."""
    if count == 1:
        return area, 0.0 * area, area
    return area, area * (inner + 0.5 * area - 1.0), area * reciprocal


@kernel
def stored(y, G_1, psi, c, layers):
    """W alone."""
    area, k, inner, count, at, places, weights = layers
    G = 1.0 + G_1
    e = 1.0 / G
    root = sqrt(e)
    n = k * psi * psi
    bend = root * G_1 / (1.0 / root + 1.0)
    square, one, W = 1.0 + 0.0 * area, area, 0.0 * area
    for j in range(count):
        if count > 1:
            square, one = inner + area * places[at + j], area * weights[at + j]
        q = y * y + (square - 1.0) * root
        i = 1.0 / square
        x = square / q
        b = ((y - 1.0) * (y + 1.0) - (square - 1.0) * bend) * i  # q/rho^2 - 1
        first = excess(G_1, b, x * e) + q * n
        second = excess(-G_1 * e, -b * x, G * q * i) + square * n * e
        W += one * (first + c * second)
    return W


@kernel
def slopes(y, G_1, psi, c, layers, reciprocal):
    """With the mean of 1/rho^2 over the layers: ``(W_y, W_G, W_psi, W_yy, W_yG, W_ypsi, W_GG, W_Gpsi, W_psipsi)``."""
    area, k, inner, count, at, places, weights = layers
    G = 1.0 + G_1
    e = 1.0 / G
    root = sqrt(e)
    y2, n, g = y * y, k * psi * psi, -0.5 * root * e
    square, one = 1.0 + 0.0 * area, area
    one_q = two_q = three_q = 0.0 * area
    for j in range(count):
        if count > 1:
            square, one = inner + area * places[at + j], area * weights[at + j]
        z = 1.0 / (y2 + (square - 1.0) * root)
        part = one * square * z
        one_q += part
        part = part * z
        two_q += part
        three_q += part * z
    whole, d, i = weigh(area, inner, count, reciprocal)
    per_root = G * root  # 1/root
    d_two = (one_q - y2 * two_q) * per_root
    d_three = (two_q - y2 * three_q) * per_root
    dd_three = (d_two - y2 * d_three) * per_root
    squares = whole + d  # sum of rho^2
    d_i = whole - i
    q, q_i = y2 * whole + root * d, y2 * i + root * d_i
    slope, bend, stiff = e + c, 2.0 * (e + c), 1.0 + c * G
    w_q, d_w_q = stiff * i + n * whole - slope * two_q, stiff * d_i + n * d - slope * d_two
    w_G = whole - e * e * one_q + c * (q_i - e * e * (whole + n * squares))
    w_qG, d_w_qG = e * e * two_q + c * i, e * e * d_two + c * d_i
    w_GG = 2.0 * e * e * e * (one_q + c * (whole + n * squares))
    twist = 2.0 * k * psi
    return (
        2.0 * y * w_q, w_G + g * d_w_q, twist * (q + c * e * squares), 4.0 * y2 * bend * three_q + 2.0 * w_q,
        2.0 * y * (w_qG + g * bend * d_three), 2.0 * y * twist * whole,
        w_GG + 2.0 * g * d_w_qG + g * g * bend * dd_three - 1.5 * g * e * d_w_q,
        twist * (g * d - c * e * e * squares), 2.0 * k * (q + c * e * squares),
    )  # fmt: skip


@kernel
def rises(y, G_1, psi, c, layers, reciprocal):
    """``(W, W_y, W_G, W_psi)``, in one go along the layers."""
    area, k, inner, count, at, places, weights = layers
    G = 1.0 + G_1
    e = 1.0 / G
    root = sqrt(e)
    y2, n = y * y, k * psi * psi
    bend = root * G_1 / (1.0 / root + 1.0)
    square, one, W = 1.0 + 0.0 * area, area, 0.0 * area
    one_q = two_q = 0.0 * area
    for j in range(count):
        if count > 1:
            square, one = inner + area * places[at + j], area * weights[at + j]
        q = y2 + (square - 1.0) * root
        z, i = 1.0 / q, 1.0 / square
        x = square * z
        b = ((y - 1.0) * (y + 1.0) - (square - 1.0) * bend) * i  # q/rho^2 - 1
        first = excess(G_1, b, x * e) + q * n
        W += one * (first + c * (excess(-G_1 * e, -b * x, G * q * i) + square * n * e))
        part = one * x
        one_q += part
        two_q += part * z
    whole, d, i = weigh(area, inner, count, reciprocal)
    d_two = (one_q - y2 * two_q) * G * root
    squares, d_i = whole + d, whole - i  # the first the sum of rho^2
    slope, stiff = e + c, 1.0 + c * G
    w_q, d_w_q = stiff * i + n * whole - slope * two_q, stiff * d_i + n * d - slope * d_two
    w_G = whole - e * e * one_q + c * (y2 * i + root * d_i - e * e * (whole + n * squares))
    return (
        W, 2.0 * y * w_q, w_G - 0.5 * root * e * d_w_q, 2.0 * k * psi * (y2 * whole + root * d + c * e * squares)
    )  # fmt: skip
