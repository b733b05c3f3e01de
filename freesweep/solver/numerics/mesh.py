"""Graded nodes that follow the solution.

The meridian's turning per length says where nodes are needed: end layers, and the quick change of s where the tube leaves
its end almost at right angles. Nodes are spread by three densities: the root of the turning (resolves the layer), its
eighth root (carries the grading on until the layer has died away: a midpoint cell much longer than the layer reflects
what is left of it undamped) and a constant. Finer meshes split the cells of the coarsest through one smooth map x(z), so
that the error on nested meshes has an expansion in even powers of the cell size: the ground for extrapolation.
"""

from math import exp, log, sqrt

from ...jit import kernel
from ..cells import cell_at, level, rise

FIRST_GRADING = 0.2  # first guess: nodes thin out as exp(-0.2 k x) behind an end layer exp(-k x)
SMALLEST_DENSITY = 3e-3  # of that grading; caps the length of the last cell of a long tube
TAIL_SHARE = 0.2  # of the nodes, by the eighth root
EVEN_SHARE = 0.2  # of the nodes, by the constant
SMOOTHINGS = 3  # passes over the cell sizes
EASINGS = 8  # of a slope, whose room depends on it


@kernel
def layer_mesh(length, rate, n, x):
    """First guess: n cells on 0..length, graded by an end layer exp(-rate x)."""
    k = FIRST_GRADING * rate
    eta = max(exp(-k * length), SMALLEST_DENSITY)
    for i in range(n + 1):
        z = i / n
        x[i] = length * z if k * length < 1e-6 else -log(1.0 - z * (1.0 - eta)) / k
    x[n] = length


@kernel
def slants(integrands, x, y, n, cells, load, sine, cosine):
    """Sine and cosine of the meridian's angle in each cell; the first of ``integrands`` is the axial length per length."""
    for j in range(n):
        v = (y[j + 1] - y[j]) / (x[j + 1] - x[j])
        middle, cell = 0.5 * (y[j] + y[j + 1]), cell_at(cells, j)
        s, up = integrands(middle, v, cell, load)[0], rise(middle, v, cell)
        i = 1.0 / sqrt(s * s + up * up)
        sine[j], cosine[j] = up * i, s * i


@kernel
def bends(x, sine, cosine, n, free, out):
    """The meridian's turning |d(angle)/dx| (1 + |tan(angle)|) in each cell; the second factor resolves the cosine."""
    for j in range(n):
        left, right = max(j - 1, 0), min(j + 1, n - 1)
        change = abs(sine[right] - sine[left])
        distance = 0.5 * (x[right + 1] + x[right] - x[left + 1] - x[left])
        if j == n - 1 and free:  # the slope vanishes in the plane of symmetry
            change, distance = abs(sine[left]), x[n] - 0.5 * (x[left] + x[left + 1])
        out[j] = change / distance * (1.0 + abs(sine[j]) / cosine[j]) / cosine[j]


@kernel
def turning(integrands, x, y, n, free, cells, load, work, out):
    """:func:`bends` of a shape."""
    slants(integrands, x, y, n, cells, load, work[0], work[1])
    bends(x, work[0], work[1], n, free, out)


@kernel
def ease(integrands, x, y, n, cosine, cells, load):
    """Let no cell of a guess be steeper than there is room for: ``y`` is followed from its first node on as closely as
    slopes allow that leave half of what ``cosine`` (n,), of the meridian's angle, promises.
    """
    at = y[0]
    for j in range(n):
        h = x[j + 1] - x[j]
        wanted, v, cell = (y[j + 1] - at) / h, 0.0, cell_at(cells, j)
        steepest = sqrt(1.0 - 0.25 * cosine[j] * cosine[j])
        for _ in range(EASINGS):
            here = at + 0.5 * h * v
            flat, radius = level(here, cell)
            most = steepest * integrands(here, flat, cell, load)[0] / radius
            v = min(max(wanted, flat - most), flat + most)
        at += h * v
        y[j + 1] = at


@kernel
def least_between(x, values, n, new_x, out):
    """Least of the ``values`` (n,) of all cells that each cell of another mesh of n cells shares some length with."""
    first = 0
    for i in range(n):
        while first < n - 1 and x[first + 1] <= new_x[i]:
            first += 1
        least, j = values[first], first
        while j < n - 1 and x[j + 1] < new_x[i + 1]:
            j += 1
            least = min(least, values[j])
        out[i] = least


@kernel
def node_density(x, n, rate, out):
    """Nodes per length from the turning ``rate`` of each cell."""
    largest = 1e-300
    for j in range(n):
        largest = max(largest, rate[j])
    layer, tail = 0.0, 0.0
    for j in range(n):
        root = sqrt(rate[j] / largest)
        layer += (x[j + 1] - x[j]) * root
        tail += (x[j + 1] - x[j]) * sqrt(sqrt(root))
    even = EVEN_SHARE / (x[n] - x[0])
    for j in range(n):
        root = sqrt(rate[j] / largest)
        layer_part = (1.0 - TAIL_SHARE - EVEN_SHARE) * root / layer if layer > 0.0 else 0.0
        out[j] = even + layer_part + (TAIL_SHARE * sqrt(sqrt(root)) / tail if tail > 0.0 else 0.0)


@kernel
def regrade(x, y, density, n, count, new_x, new_y, work):
    """Spread ``count`` cells by the ``density`` in each of n, and carry ``y`` over, linearly."""
    total = 0.0
    for j in range(n):
        total += density[j] * (x[j + 1] - x[j])
    j, below = 0, 0.0
    new_x[0], new_y[0] = x[0], y[0]
    for i in range(1, count):
        target = total * i / count
        while j < n - 1 and below + density[j] * (x[j + 1] - x[j]) < target:
            below += density[j] * (x[j + 1] - x[j])
            j += 1
        new_x[i] = x[j] + (target - below) / density[j]
    new_x[count] = x[n]
    even_out(new_x, count, work)
    j = 0
    for i in range(1, count):
        while j < n - 1 and x[j + 1] < new_x[i]:
            j += 1
        new_y[i] = y[j] + (new_x[i] - x[j]) * (y[j + 1] - y[j]) / (x[j + 1] - x[j])
    new_y[count] = y[n]


@kernel
def even_out(x, n, size):
    """Let neighbouring cells differ little: geometric means, so that a jump over decades becomes a slope."""
    length = x[n] - x[0]
    for j in range(n):
        size[j] = x[j + 1] - x[j]
    for _ in range(SMOOTHINGS):
        left = size[0]
        for j in range(n):
            here = size[j]
            size[j] = sqrt(here * sqrt(left * size[min(j + 1, n - 1)]))
            left = here
    total = 0.0
    for j in range(n):
        total += size[j]
    for j in range(n - 1):
        x[j + 1] = x[j] + size[j] * length / total


@kernel
def split(x, n, factor, out):
    """Split each of n cells into ``factor`` through cubics whose slopes dx/dz are harmonic means of the cells beside."""
    for j in range(n):
        h = x[j + 1] - x[j]
        before = x[j] - x[j - 1] if j > 0 else h
        after = x[j + 2] - x[j + 1] if j < n - 1 else h
        left = 2.0 * before * h / (before + h)
        right = 2.0 * h * after / (h + after)
        for i in range(factor):
            t = i / factor
            out[j * factor + i] = x[j] + h * t * t * (3.0 - 2.0 * t) + t * (1.0 - t) * ((1.0 - t) * left - t * right)
    out[n * factor] = x[n]


@kernel
def prolong(x, y, n, fine_x, out):
    """First guess on twice as many cells: the cubic through four neighbours. In x and not by number of node: where cell
    sizes are uneven, that guess would be rough, and Newton's method slow.
    """
    for j in range(n):
        k = min(max(j - 1, 0), n - 3)
        at = fine_x[2 * j + 1]
        a, b, c, d = at - x[k], at - x[k + 1], at - x[k + 2], at - x[k + 3]
        ab, ac, ad = x[k] - x[k + 1], x[k] - x[k + 2], x[k] - x[k + 3]
        bc, bd, cd = x[k + 1] - x[k + 2], x[k + 1] - x[k + 3], x[k + 2] - x[k + 3]
        out[2 * j] = y[j]
        out[2 * j + 1] = (
            y[k] * (b * c * d / (ab * ac * ad))
            - y[k + 1] * (a * c * d / (ab * bc * bd))
            + y[k + 2] * (a * b * d / (ac * bc * cd))
            - y[k + 3] * (a * b * c / (ad * bd * cd))
        )
    out[2 * n] = y[n]
