"""The course along a tube: splines of the dimensionless numbers that its profiles make.

Between the places where some profile jumps or bends, H, D and a are smooth: cubic splines on equal pieces of each such
segment. They are compared with the profile at many irregular places; where it changes within a few cells of the mesh,
segments are cut, where it cannot be followed it is refused.
"""

from itertools import pairwise

import numpy as np

from .profiles import MOST_SEGMENTS, SHORTEST, TOO_FAST, ProfileError, places_of, shares_in

PIECES = (16, 64, 256, 1024, 4096)  # of a segment, until the splines fit
FINE, FIT = 1e-12, 1e-9  # relative errors of splines that suffice, and that are allowed: they enter the bounds
# of outputs to relative changes of H, D and a all along the tube, each with the worse sign: 45 was the most in 250 random
# states of steep tubes (a rotation of steep fibers, an energy beside its work); close to a limit pressure it is more
SENSITIVITY = 100.0
LEAST = np.array([1e-6, 1e-6, 1e-6, 1.0, 1.0, 1.0])  # of H, D, a, R, R', inner: errors are relative to no less
IN_EACH = 4  # places at least where each piece of a spline is checked
SEEN = 0.05  # relative error of a spline over the cells of a base mesh: they see what is there
CELLS = 240  # of a base mesh, shared by its segments, LEAST_CELLS and MOST_CELLS of each
LEAST_CELLS, MOST_CELLS = 16, 48


def course(tube, fine=FINE):
    """``((course, edges, places), error)`` of a tube that varies: the first as the kernels take them, lengths in radii; the
    largest relative error of its splines, below ``fine`` if that can be. A body's course has an axis more
    (:mod:`freesweep.solver.numerics.properties_along`).

    Raises :class:`ProfileError` where a profile changes too fast to be followed.
    """
    from .revolution import resolved

    parts = resolved(tube)
    profiles, numbers = parts.profiles, parts.numbers

    def splines(low, high, pieces):
        return _splines(numbers, low, high, pieces, shares_in(high - low, *profiles, least=IN_EACH * pieces))

    breaks = places_of(*profiles, middle=0.5)
    if any(profile.function for profile in profiles):
        breaks = _cut(breaks, lambda low, high: splines(low, high, LEAST_CELLS)[1])
    for pieces in PIECES:
        segments, errors = zip(*(splines(low, high, pieces) for low, high in pairwise(breaks)))
        if max(errors) < fine:
            break
    if not max(errors) < FIT:
        raise ProfileError(TOO_FAST.format(places=_span(breaks, int(np.argmax(errors)))))
    each = min(max(2 * round(CELLS / len(segments) / 2), LEAST_CELLS), MOST_CELLS)
    edges = np.arange(len(breaks), dtype=np.int64) * each
    rows = np.stack(segments)
    if rows.shape[2] == 6:
        rows = rows.reshape(*rows.shape[:2], 2, 3, 4)
    return (rows, edges, breaks * tube.length / tube.fiber_surface), max(errors)


def _span(breaks, k):
    return f"{breaks[k]:.6g} and {breaks[k + 1]:.6g}"


def _cut(breaks, missed):
    """``breaks`` with pieces cut in halves until the cells of a base mesh see what is in each of them."""
    found, ahead = [breaks[0]], list(breaks[:0:-1])
    while ahead:
        low, high = found[-1], ahead[-1]
        if missed(low, high) < SEEN:
            found.append(ahead.pop())
        elif high - low < 2.0 * SHORTEST or len(found) + len(ahead) > MOST_SEGMENTS:
            raise ProfileError(TOO_FAST.format(places=_span([low, high], 0)))
        else:
            ahead.append(0.5 * (low + high))
    return np.array(found)


def _splines(numbers, low, high, pieces, between):
    """Coefficients (pieces, n, 4) in rising powers of one segment, and the largest relative error ``between`` the nodes."""
    from scipy.interpolate import CubicSpline

    nodes = np.arange(pieces + 1) / pieces
    spline = CubicSpline(nodes, numbers(low, high, nodes), axis=1)
    exact = numbers(low, high, between)
    scale = np.max(np.abs(exact), axis=1, keepdims=True) + LEAST[: len(exact), None]
    error = float(np.max(np.abs(spline(between) - exact) / scale))
    powers = spline.c[::-1] * (1.0 / pieces) ** np.arange(4).reshape(4, 1, 1)
    return np.ascontiguousarray(powers.transpose(1, 2, 0)), error


def follow(tube, accuracy, fine=FINE):
    """What :func:`course` gives; raises :class:`ProfileError` also where the error is too large for the ``accuracy``."""
    found, error = course(tube, fine)
    if SENSITIVITY * error > 0.5 * accuracy:
        least = 2.0 * SENSITIVITY * error
        raise ProfileError(f"accuracy: found {accuracy:g}; the profiles of this tube can be followed to {least:.1g}")
    return found, error


def widened(values, bounds, error):
    """Bounds of dimensionless ``values`` with what an ``error`` of the course, relative, can add to them."""
    return bounds + SENSITIVITY * error * np.maximum(np.abs(values), 1.0)
