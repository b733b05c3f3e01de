"""Outputs extrapolated from nested meshes, with error bounds.

A midpoint cell errs by even powers of its size, so results A on meshes of n/2, n, 2n, 4n cells extrapolate to fourth
order, ``E = (4 A_2n - A_n)/3``. The difference of two successive E, divided by the 15 that the order allows, or by less
where it has fallen by less (cells longer than a layer), estimates the error of the second; the difference before it,
divided by 225, guards against its passing through zero. So does the largest share that such an estimate has in the last
change of any output, A_2n - A_n: no other has a smaller one. The bound is ``SAFETY`` times the estimate, plus a floor for
rounding and for what Newton's last steps left.

The rows of a ``table`` belong to the meshes, coarsest first; its columns are the outputs: the four integrals, y in the
middle, and the multiplier of a held integral.
"""

from ...jit import kernel

OUTPUTS = 6  # length, volume, twist, energy, middle stretch, multiplier
MIDDLE, MULTIPLIER = 4, 5
SAFETY = 3.3
SLOWEST = 0.75  # share of a difference that the next one is taken to be at most
FAINT = 0.02  # of the outputs' mean change: what counts as change of an output that hardly changes
TINY = 1e-300


@kernel
def fourth_order(a, b, c, d, broken):
    """``(value, estimate of its error)`` from results on meshes of twice the cells each. On ``broken`` ones a cell somewhere
    holds a change of smoothness: it errs now by more, now by less, and no difference is divided by what an order allows.
    """
    first, second, third = (4.0 * b - a) / 3.0, (4.0 * c - b) / 3.0, (4.0 * d - c) / 3.0
    last, before = abs(third - second), abs(second - first)
    if broken:
        return third, max(last, 0.25 * before)
    fallen = min(last / (before + TINY), SLOWEST)
    return third, max(last * max(fallen / (1.0 - fallen), 1.0 / 15.0), before / 225.0)


@kernel
def extrapolate(table, level, scales, floors, broken, values, bounds):
    """Fourth-order values and bounds from the last four rows; returns the largest scaled bound."""
    largest, share, change = 0.0, 0.0, TINY
    for k in range(OUTPUTS):
        change += FAINT / OUTPUTS * abs(table[level, k] - table[level - 1, k]) / scales[k]
    for k in range(OUTPUTS):
        c, d = table[level - 1, k], table[level, k]
        values[k], estimate = fourth_order(table[level - 3, k], table[level - 2, k], c, d, broken)
        bounds[k] = SAFETY * estimate
        share = max(share, estimate / scales[k] / (abs(d - c) / scales[k] + change))
    for k in range(OUTPUTS):
        bounds[k] = max(bounds[k], share * abs(table[level, k] - table[level - 1, k]))
        largest = max(largest, bounds[k] / scales[k])
        bounds[k] += floors[k]
    return largest


@kernel
def measure(scales, direction, held, out):
    """Write scales and floors of outputs, the pair of ``scales``, to ``out``; of a multiplier in units of its direction."""
    for k in range(OUTPUTS):
        out[2, k], out[3, k] = scales[0][k], scales[1][k]
    if held:
        unit = max(abs(direction.p), max(abs(direction.f), abs(direction.m)))
        out[2, MULTIPLIER] /= max(unit, 1.0)
        out[3, MULTIPLIER] /= unit
