"""What a shape looks like along the tube: values at stations and their error bounds, from the three finest meshes.

Their node values extrapolate twice to fourth order, and bounds follow as in :mod:`..numerics.nested`. What nodes carry
loses no digit where the meridian stands upright (:mod:`axial`).
"""

from math import atan, sqrt
from typing import NamedTuple

import numpy as np

from ...jit import kernel
from ..cells import cell_at, of_length
from ..load import Load, under
from ..numerics.error_bounds import SAFETY, TINY
from ..numerics.finest import LEFT, MESHES, load_of, mesh_of
from ..numerics.properties_along import at_point, fill
from ..physics import lagrangian
from ..physics.lagrangian import LAST_STEP, ROUNDING
from .axial import axial_stretch, flux_at, is_told_by_stretch

VALUES = 7  # stretch, axial position, twist, angles after deformation, fiber multipliers
FIELDS = 2 * VALUES  # and a bound for each
STENCIL = 6  # nodes of the interpolating polynomial: its error is of sixth order, the node values' of fourth
SPREAD = 0.5  # of a node's difference that its neighbours have at least: differences pass through zero
UNEVEN = 30.0  # times the cell beside: what is that long, of a tube that is uniform there, is interpolated linearly


class Nodes(NamedTuple):
    """What meshes tell of their nodes, ``at`` (5, ...), as :func:`extrapolate_nodes` leaves it, of ``n`` cells; by what the
    ``order`` divides differences; in what ``unit`` (5,) they count; and what ``rounding`` leaves.
    """

    at: np.ndarray
    n: int
    order: float
    unit: np.ndarray
    rounding: float


class Told(NamedTuple):
    """What is told at a station: weights of nodes and of every second one, (STENCIL,); numbers, their bounds, and what share
    of these is no rounding, (5,).
    """

    weights: np.ndarray
    coarse: np.ndarray
    number: np.ndarray
    bound: np.ndarray
    share: np.ndarray


class Loads(NamedTuple):
    """The ``load``, and one as far from it as its error may be; of a tube that is ``alike`` all along, whose stretch tells
    all of a place (:func:`.axial.is_told_by_stretch`), the constant of its first integral, by how much that may be missed,
    and that under the other load.
    """

    load: Load
    other: Load
    alike: bool
    constant: float
    missed: float
    other_constant: float


@kernel
def add(nodes, at, mesh, share, numbers):
    """Add a share of a node's numbers to a column of ``nodes``; the finer ``mesh`` (0) of an extrapolation comes first."""
    for i in range(len(numbers)):
        nodes[i, at] = share * numbers[i] + (nodes[i, at] if mesh > 0 else 0.0)


@kernel
def extrapolate_nodes(base, n, tube, load, fine, nodes):
    """x, y, axial position, twist and flux at the nodes of the mesh of n cells, to fourth order, in rows of ``nodes``; from
    column n + 1 on, at every second node, by how much those from coarser meshes differ, or spread from beside. Whether the
    kind of cell changes along the tube.
    """
    course, edges, cells, _, _, _ = tube
    alike, behind, broken = is_told_by_stretch(course, load.wall), n + 1, False
    for which in range(MESHES):
        x, y = mesh_of(which, n, fine)
        now, count = load_of(which, load, fine), len(x) - 1
        own = fill(course, edges, x, count, base, cells)
        constant = lagrangian.uniform_tube(y[count], cell_at(own, 0), now)[2] if alike else 0.0
        z, twist, before = 0.0, 0.0, -1.0
        for j in range(count + 1):
            numbers = (x[j], y[j], z, twist, 0.0 if alike else flux_at(x, y, j, count, own, now))
            half = j >> 1
            if which < MESHES - 1 and j == half << 1:
                add(nodes, half + (0 if which == 0 else behind), 0, 4.0 / 3.0, numbers)
            if which > 0:
                add(nodes, j + (0 if which == 1 else behind), 1, -1.0 / 3.0, numbers)
            if j < count:
                cell = cell_at(own, j)
                h, middle = x[j + 1] - x[j], 0.5 * (y[j] + y[j + 1])
                s, _, turn, _, kind = lagrangian.integrands(middle, (y[j + 1] - y[j]) / h, of_length(cell, h), now)
                broken = broken or (kind != before and j > 0)
                before = kind
                z += h * (axial_stretch(middle, constant, cell, now) if alike else s)
                twist += h * turn
    for k in range(n // 2 + 1):
        left, right, at = max(2 * k - 2, 0), min(2 * k + 2, n), behind + k
        moved = (nodes[0, 2 * k] - nodes[0, at]) / (nodes[0, right] - nodes[0, left])
        for i in range(1, 5):  # at the same x
            nodes[i, at] = abs(nodes[i, 2 * k] - nodes[i, at] - moved * (nodes[i, right] - nodes[i, left]))
    for k in range(1, n // 2 + 1):
        for i in range(1, 5):
            nodes[i, behind + k] = max(nodes[i, behind + k], SPREAD * nodes[i, behind + k - 1])
    for k in range(n // 2 - 1, -1, -1):
        for i in range(1, 5):
            nodes[i, behind + k] = max(nodes[i, behind + k], SPREAD * nodes[i, behind + k + 1])
    return broken


@kernel
def weights(x, first, stride, at, out):
    """Lagrange weights of STENCIL nodes, every ``stride``-th from ``first`` on."""
    for i in range(STENCIL):
        out[i] = 1.0
        for k in range(STENCIL):
            if k != i:
                there = x[first + k * stride]
                out[i] *= (at - there) / (x[first + i * stride] - there)


@kernel
def local(y, flux, constant, alike, cell, load):
    """Angles after deformation [rad], and multipliers of both families with their extension, at one place."""
    if alike:
        psi, _, _, G_1, _, _ = lagrangian.kinematics(y, cell, load)
        alpha, beta = lagrangian.fiber_multipliers(y, axial_stretch(y, constant, cell, load), cell, load)
    else:
        psi, G_1, alpha, beta = lagrangian.at_flux(y, flux, cell, load)
    meridional = sqrt(1.0 + G_1)
    return (
        atan(y * (cell[0] + cell[1] + psi) / meridional), atan(y * (cell[0] - cell[1] + psi) / meridional),
        load.gamma * alpha, load.gamma * beta,
    )  # fmt: skip


@kernel
def extrapolated_loads(load, fine):
    """The load to fourth order, and one as far from it as its error may be."""
    a, b, c = load_of(0, load, fine), load_of(1, load, fine), load_of(2, load, fine)
    p, f, m = (4.0 * a.p - b.p) / 3.0, (4.0 * a.f - b.f) / 3.0, (4.0 * a.m - b.m) / 3.0
    fourth = SAFETY / 15.0
    other_p = p + fourth * (p - (4.0 * b.p - c.p) / 3.0)
    other_f = f + fourth * (f - (4.0 * b.f - c.f) / 3.0)
    other_m = m + fourth * (m - (4.0 * b.m - c.m) / 3.0)
    return under(load, p, f, m), under(load, other_p, other_f, other_m)


@kernel
def units(nodes, n):
    """In what differences count, (5,): stretch, axial position, twist, flux behind x."""
    unit = np.empty(5)
    unit[1], unit[2], unit[3], unit[4] = 1.0, nodes[0, n], max(1.0, abs(nodes[3, n])), 0.0
    for k in range(n + 1):
        unit[4] = max(unit[4], abs(nodes[4, k]))
    return unit


@kernel
def loads_of(known, course, load, fine):
    """The :class:`Loads` of a profile."""
    load, other = extrapolated_loads(load, fine)
    if not is_told_by_stretch(course, load.wall):
        return Loads(load, other, False, 0.0, 0.0, 0.0)
    cell, middle, n = at_point(course, 0, 1.0), known.at[1, known.n], known.n
    off = SAFETY / known.order * known.at[1, n + 1 + n // 2]
    constant = lagrangian.uniform_tube(middle, cell, load)[2]
    missed = lagrangian.uniform_tube(middle + off, cell, load)[2] - constant
    return Loads(load, other, True, constant, missed, lagrangian.uniform_tube(middle, cell, other)[2])


@kernel
def interpolate(at, j, low, high, known, told):
    """What is told at a station in cell j of the segment from node ``low`` to ``high``; returns the largest bound, scaled,
    rounding left out, of stretch, axial position and twist.
    """
    x, nodes, behind, worst = known.at[0], known.at, known.n + 1, 0.0
    weight, coarse, number, bound, share = told
    h, before, after = x[j + 1] - x[j], max(j, low + 1), min(j, high - 2)
    linear = h > UNEVEN * min(x[before] - x[before - 1], x[after + 2] - x[after + 1])
    first = min(max(j - STENCIL // 2 + 1, low), high + 1 - STENCIL)
    weights(x, first, 1, at, weight)
    half = min(max(j // 2 - STENCIL // 2 + 1, low // 2), high // 2 + 1 - STENCIL)
    weights(x, 2 * half, 2, at, coarse)
    for r in range(1, 5):
        number[r], bound[r] = 0.0, 0.0
        for k in range(STENCIL):
            number[r] += weight[k] * nodes[r, first + k]
            bound[r] += coarse[k] * nodes[r, 2 * half + k * 2]
        bound[r] = abs(bound[r] - number[r]) / known.order
        if linear:
            number[r] = nodes[r, j] + (at - x[j]) / h * (nodes[r, j + 1] - nodes[r, j])
            bound[r] = abs(nodes[r, j + 1] - nodes[r, j]) if r == 1 or r == 4 else 0.0
        bound[r] += SAFETY / known.order * max(nodes[r, behind + j // 2], nodes[r, behind + (j + 1) // 2])
        worst = max(worst, bound[r] / known.unit[r] if r < 4 else 0.0)
        share[r] = bound[r]
        bound[r] += known.rounding * (number[1] if r == 1 else known.unit[r])
        share[r] /= max(bound[r], TINY)
    return worst


@kernel
def write(cell, loads, told, rounding, i, profile):
    """Write the FIELDS of station i to the ``profile``; returns the largest bounds, rounding left out, of angles and of
    multipliers, and the largest of these.
    """
    (_, _, number, bound, share), (load, other, alike, constant, missed, other_constant) = told, loads
    y, flux, angle, loose, tension = number[1], number[4], 0.0, 0.0, 0.0
    here = local(y, flux, constant, alike, cell, load)
    by_y = local(y + bound[1], flux, constant, alike, cell, load)
    by_flux = local(y, flux + bound[4], constant + missed, alike, cell, load)
    by_load = local(y, flux, other_constant, alike, cell, other)
    for r in range(3):
        profile[r, i], profile[VALUES + r, i] = number[1 + r], bound[1 + r]
    for r in range(4):
        one, two, three = abs(by_y[r] - here[r]), abs(by_flux[r] - here[r]), abs(by_load[r] - here[r])
        profile[3 + r, i], profile[VALUES + 3 + r, i] = here[r], one + two + three + rounding * abs(here[r])
        known = share[1] * one + (1.0 if alike else share[4]) * two + three
        if r < 2:
            angle = max(angle, known)
        else:
            loose, tension = max(loose, known), max(tension, abs(here[r]))
    return angle, loose, tension


@kernel
def at_stations(stations, base, doublings, tube, load, fine, nodes, profile):
    """Write the FIELDS at each of ``stations`` (distance from the end in radii, ascending) into ``profile`` (FIELDS, m):
    stretch, axial position [radius], twist [rad], angles of both families [rad], multipliers of both; then their bounds.

    Returns the largest bound, scaled, rounding left out: stretch as it is, positions by the length, twist by itself or a
    radian, angles by a radian, multipliers by the largest along the tube.
    """
    course, edges, n, x = tube.course, tube.edges, base << (doublings - 1), nodes[0]
    order = 1.0 if extrapolate_nodes(base, n, tube, load, fine, nodes) else 15.0  # as in error_bounds.extrapolate
    known = Nodes(nodes, n, order, units(nodes, n), ROUNDING + LAST_STEP * max(fine[3, LEFT], 0.0))
    loads = loads_of(known, course, load, fine)
    told = Told(np.empty(STENCIL), np.empty(STENCIL), np.empty(5), np.empty(5), np.empty(5))
    segment, j, worst, loose, tension = 0, 0, 0.0, 0.0, 0.0
    for i in range(len(stations)):
        # a station on a jump belongs to the segment before it
        while segment < len(edges) - 2 and x[edges[segment + 1] * n // base] < stations[i]:
            segment += 1
        low, high = edges[segment] * n // base, edges[segment + 1] * n // base
        j = max(j, low)
        while j < high - 1 and x[j + 1] < stations[i]:
            j += 1
        position = interpolate(stations[i], j, low, high, known, told)
        cell = at_point(course, segment, (stations[i] - x[low]) / (x[high] - x[low]))
        angle, pull, most = write(cell, loads, told, known.rounding, i, profile)
        worst, loose, tension = max(worst, max(position, angle)), max(loose, pull), max(tension, most)
    return max(worst, loose / tension if tension > 0.0 else 0.0)
