"""Held tubes with a neck: between the clamped end and the middle the meridian turns back, on the other side of the end's
radius.

What turns one way in the body turns back in the neck, so nearly straight fibers hold a rotation under any pressure. The
walls between them stand ever more upright, and no mesh holds them for long; the first integral does (:mod:`meridian`).
Five numbers tell a shape: the stretches y_m and y_n of middle and neck, the logarithms q of the drives there, which tell how
long the tube stays close to them, to any length, and the multiplier mu. With x and C of the ways to the end's radius, and a
body wider than the end::

    U'(y_m) = e^q_m,    -U'(y_n) = e^q_n,    U(y_n) = U(y_m),    x_m + 2 x_n = half,    C_m + 2 C_n = C

The first two are solved at once, for y where the tube stands still close to it, else for mu or q; Newton's method does the
others. Such a tube is unstable: y' is a Jacobi field that vanishes in the middle and in the neck.
"""

from math import exp, log, sqrt
from typing import NamedTuple

import numpy as np

from ...jit import kernel
from ..numerics import error_bounds, held
from ..physics import lagrangian
from . import meridian, quadrature

LEAST_NECK, ROUNDED_OFF = 1e-3, 1e-9  # |y_n - 1| that is traced; that may be rounding
SHALLOWEST = 1e-6  # (y_n - 1)/(y_m - 1) that is no rounding either
FLAT = 0.01  # of |y_n - 1|: within it a mesh's neck counts as flat
CROWDING = 0.1  # of an e-fold: distances at the end's radius
DEEP = 25.0  # e-folds of a drive below its bend: beyond them the tube is uniform, to the last digits
STANDING = 0.02  # share of bend times y, below which a drive tells its stretch
ITERATIONS, LARGEST_CHANGE, ROOT = 20, 0.1, 1e-14  # of the search for that, relative
MIDDLE, FOLDS, NECK, NECK_FOLDS, MU = 0, 1, 2, 3, 4  # y_m, q_m, y_n, q_n, mu


class Asked(NamedTuple):
    """A held tube: the numbers of its fibers and its section; its load but for what holds it, and the load ``direction``
    that does; the ``target`` of its integral, and how long ``half`` of it is.
    """

    cell: tuple
    load: tuple
    direction: tuple
    target: float
    half: float


class Traced(NamedTuple):
    """Room for what is traced: nodes and shape of body and neck, ``curve`` (2, ...), and their integrals, a ``row`` each."""

    curve: np.ndarray
    row: np.ndarray
    other: np.ndarray


@kernel
def neck_of(y):
    """The node of the extreme stretch on the other side of the end's radius than the middle."""
    return np.argmin(y) if y[len(y) - 1] > 1.0 else np.argmax(y)


@kernel
def depth_of(y):
    """By how much of the body's height a tube has a neck; 0 where there is none."""
    neck, middle = y[neck_of(y)], y[len(y) - 1]
    depth = (1.0 - neck) / (middle - 1.0) if middle != 1.0 else 0.0
    return depth if depth > SHALLOWEST and abs(neck - 1.0) > ROUNDED_OFF else 0.0


@kernel
def guess_of(cell, load, x, y, now):
    """First guess ``now`` from a mesh's necked shape; whether there is one."""
    k = neck_of(y)
    middle, neck = y[len(y) - 1], y[k]
    if not depth_of(y) > 0.0 or abs(neck - 1.0) < LEAST_NECK:
        return False
    outward = 1.0 if middle > 1.0 else -1.0
    drive = outward * lagrangian.density(middle, 0.0, cell, load)[1]
    _, L_y, _, L_yy, _, L_vv = lagrangian.density(neck, 0.0, cell, load)
    at_neck = -outward * L_y
    if L_yy < 0.0:  # a flat neck is driven by what is left of U' behind so many e-folds
        first, last, near = k, k, FLAT * abs(neck - 1.0)  # neither end is as near
        while abs(y[first - 1] - neck) < near:
            first -= 1
        while abs(y[last + 1] - neck) < near:
            last += 1
        folds = 0.5 * np.sqrt(L_yy / L_vv) * (x[last] - x[first])
        at_neck = max(at_neck, -L_yy * near * exp(-folds))
    now[MIDDLE], now[NECK] = middle, neck
    if drive > 0.0 and at_neck > 0.0:
        now[FOLDS], now[NECK_FOLDS] = log(drive), log(at_neck)
        return True
    return False


@kernel
def part(cell, load, top, folds, nodes, curve, row):
    """Integrals from the extreme stretch ``top``, whose drive is exp(``folds``), to the end's radius, into ``row``; x of it,
    NaN if there is no such way. What lies deeper than DEEP e-folds is uniform.
    """
    _, _, _, L_yy, _, L_vv = lagrangian.density(top, 0.0, cell, load)
    reach, size = abs(top - 1.0), log(abs(L_yy))
    beyond = size - DEEP - folds if L_yy < 0.0 else 0.0
    drive = exp(max(folds, folds + beyond))
    if not drive > 0.0:
        return np.nan
    total = meridian.trace(cell, load, top, drive, 0.0, min(drive / abs(L_yy), reach), nodes, CROWDING, curve)
    if total > 0.0:
        quadrature.integrate(cell, load, top, 0.0, total, total, nodes, curve, row)
        if beyond > 0.0:
            rest = beyond / sqrt(L_yy / L_vv)
            length, volume, twist, energy, _ = lagrangian.integrands(top, 0.0, cell, load)
            row[0], row[1], row[2], row[3] = (
                row[0] + rest * length, row[1] + rest * volume, row[2] + rest * twist, row[3] + rest * energy
            )  # fmt: skip
            curve[0, nodes] += rest
            total += rest
    return total


@kernel
def stretch_of(cell, load, pull, near):
    """The stretch close to ``near`` at which U' is ``pull``; NaN if there is none where U bends down."""
    y = near
    for _ in range(ITERATIONS):
        _, L_y, _, L_yy, _, _ = lagrangian.density(y, 0.0, cell, load)
        if not L_yy < 0.0:
            break
        change = (pull - L_y) / L_yy
        y += min(max(change, -LARGEST_CHANGE * y), LARGEST_CHANGE * y)
        if abs(change) < ROOT * y:
            return y
    return np.nan


@kernel
def stands(cell, load, y, folds):
    """Whether a stretch follows from its drive: U bends down there, and the drive is small."""
    bend = -lagrangian.density(y, 0.0, cell, load)[3]
    return exp(folds) < STANDING * bend * y


@kernel
def unknowns(asked, now):
    """Those three of the numbers ``now`` that the others follow from, most smoothly, while the load changes."""
    cell, loaded = asked.cell, held.loaded(asked.load, asked.direction, now[MU])
    body = MU if stands(cell, loaded, now[MIDDLE], now[FOLDS]) else MIDDLE
    neck = NECK_FOLDS if stands(cell, loaded, now[NECK], now[NECK_FOLDS]) else NECK
    return body, FOLDS, neck


@kernel
def misses(asked, now, free, nodes, traced, out):
    """What a tube of the numbers ``now``, of which three are ``free`` and the others made to follow, misses in three
    equations, into ``out``. Half its integrals go to the row. Half the ``nodes`` are the body's, a quarter the neck's.
    """
    (cell, load, direction, target, half), (curve, row, other) = asked, traced
    body, drive, outward = nodes // 2, exp(now[FOLDS]), 1.0 if now[MIDDLE] > 1.0 else -1.0
    if free[0] == MU:
        now[MIDDLE] = stretch_of(cell, held.loaded(load, direction, now[MU]), outward * drive, now[MIDDLE])
    else:
        slope = lagrangian.conjugate(now[MIDDLE], 0.0, cell, load, direction)[1]
        now[MU] = (outward * drive - lagrangian.density(now[MIDDLE], 0.0, cell, load)[1]) / slope
    loaded = held.loaded(load, direction, now[MU])
    if free[2] == NECK_FOLDS:
        now[NECK] = stretch_of(cell, loaded, -outward * exp(now[NECK_FOLDS]), now[NECK])
    else:
        at_neck = -outward * lagrangian.density(now[NECK], 0.0, cell, loaded)[1]
        now[NECK_FOLDS] = log(at_neck) if at_neck > 0.0 else np.nan
    x = part(cell, loaded, now[MIDDLE], now[FOLDS], body, curve[:, : body + 1], row)
    x += 2.0 * part(cell, loaded, now[NECK], now[NECK_FOLDS], nodes // 4, curve[:, body + 1 :], other)
    for k in range(4):
        row[k] += 2.0 * other[k]
    row[error_bounds.MULTIPLIER] = now[MU]
    _, pull, at_middle = lagrangian.uniform_tube(now[MIDDLE], cell, loaded)
    out[0] = x / half - 1.0
    out[1] = (row[0] * direction.f + row[2] * direction.m - target) / (half * max(abs(direction.f), abs(direction.m)))
    out[2] = (lagrangian.uniform_tube(now[NECK], cell, loaded)[2] - at_middle) / pull
