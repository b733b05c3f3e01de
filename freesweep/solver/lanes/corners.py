"""A base mesh that is finer where loose fibers go slack, for a vector of designs.

Where one family holds in place of the other, the meridian has all but a corner, and the twist rate all but jumps. A mesh
misses the place by the square of its cells there, by a share that hangs on where in a cell it lies: no extrapolation takes
that away. So the number of a node, z, is counted through a density ::

    1 + DENSER/(1 + t^2)^(3/2),   t = (z - place)/WIDE,   of the integral  z + DENSER WIDE t/sqrt(1 + t^2)
"""

from math import sqrt

from ...jit import kernel
from ..along.places import ALPHA, BETA, PLACE
from .slack import see
from .vector import WIDTH, get, put

DENSER, WIDE = 7.0, 0.7  # beside 1, and cells
APART = 1.0  # cells: what lies nearer together is one place
STEPS, CLOSE = 20, 1e-6  # of the search for a node, and how exactly [cells] it is found


@kernel
def ends_at(x, pull, k, last, lane):
    """Share of the way from the place k to k + 1 at which a pull ends or begins: on the line through the two nearest places
    at which it pulls.
    """
    here, there = x[k, lane], x[k + 1, lane]
    near, far = (k, max(k - 1, 0)) if pull[k, lane] >= 0.0 else (k + 1, min(k + 2, last))
    rise = pull[far, lane] - pull[near, lane]
    if not rise > 0.0:
        return 0.5
    at = x[near, lane] - pull[near, lane] / rise * (x[far, lane] - x[near, lane])
    return min(max((at - here) / (there - here), 0.0), 1.0)


@kernel
def look_for(seen, n, lane, places):
    """Write the nodes' numbers at which a family goes slack to ``places``; returns how many there are."""
    count = 0
    for k in range(n + 1):
        total, found = 0.0, 0
        for family in (ALPHA, BETA):
            pull = seen[family]
            if (pull[k, lane] >= 0.0) != (pull[k + 1, lane] >= 0.0):
                total, found = total + ends_at(seen[PLACE], pull, k, n + 1, lane), found + 1
        if found > 0:
            left, right = (0.0 if k == 0 else k - 0.5), (float(n) if k == n else k + 0.5)
            at = left + total / found * (right - left)
            if count > 0 and at - places[count - 1, lane] < APART:
                places[count - 1, lane] = 0.5 * (places[count - 1, lane] + at)
            else:
                places[count, lane] = at
                count += 1
    return count


@kernel
def counted(z, places, count, lane):
    """``(integral of the density up to z, density)``."""
    total, density = z, 1.0
    for k in range(count):
        t = (z - places[k, lane]) / WIDE
        i = 1.0 / sqrt(1.0 + t * t)
        total, density = total + DENSER * WIDE * t * i, density + DENSER * i * i * i
    return total, density


@kernel
def number_at(target, low, high, places, count, lane):
    """The z between ``low`` and ``high`` up to which the density's integral is ``target``."""
    z = low
    for _ in range(STEPS):
        total, density = counted(z, places, count, lane)
        if total < target:
            low = z
        else:
            high = z
        change = (target - total) / density
        z = z + change
        if not low < z < high or abs(change) > 0.5 * (high - low):  # it may go to and fro about a place
            z = 0.5 * (low + high)
        if abs(change) < CLOSE:
            break
    return z


@kernel
def slope_at(values, i, n, lane):
    """By a node's number, so that what rises goes on rising: the harmonic mean of the rises beside."""
    if i == 0:
        return values[1, lane] - values[0, lane]
    if i == n:
        return values[n, lane] - values[n - 1, lane]
    left, right = values[i, lane] - values[i - 1, lane], values[i + 1, lane] - values[i, lane]
    return 2.0 * left * right / (left + right) if left * right > 0.0 else 0.0


@kernel
def value_at(values, z, n, lane):
    """Of what is known at the nodes: a cubic between two."""
    i = min(int(z), n - 1)
    t, rise = z - i, values[i + 1, lane] - values[i, lane]
    bend = t * (1.0 - t) * ((1.0 - t) * slope_at(values, i, n, lane) - t * slope_at(values, i + 1, n, lane))
    return values[i, lane] + t * t * (3.0 - 2.0 * t) * rise + bend


@kernel
def gather(x, y, n, cell, load, seen, places, new_x, new_y):
    """Move nodes of a mesh, with the shape on it, to where families go slack. ``seen`` (ROWS, > n + 1, WIDTH), ``places``,
    ``new_x`` and ``new_y`` (> n, WIDTH) are scratch.
    """
    see(x, y, n, cell, load, seen)
    for i in range(n + 1):
        put(new_x, i, get(x, i))
        put(new_y, i, get(y, i))
    for lane in range(WIDTH):
        count = look_for(seen, n, lane, places)
        if count == 0:
            continue
        first, last, z = counted(0.0, places, count, lane)[0], counted(float(n), places, count, lane)[0], 0.0
        for i in range(1, n):
            z = number_at(first + (last - first) * i / n, z, float(n), places, count, lane)
            x[i, lane], y[i, lane] = value_at(new_x, z, n, lane), value_at(new_y, z, n, lane)
