"""Batches of random tubes, what vectors tell of their derivatives, and differences of the solver beside them."""

from itertools import pairwise

import numpy as np

from freesweep.derivative.attach import BOUNDS, SAME
from freesweep.derivative.dual import Dual
from freesweep.derivative.physics import OWN
from freesweep.derivative.request import SHAPE
from freesweep.derivative.vectors import differentiated
from freesweep.scaling import OUTPUTS, output_scales, problem_rows, wall_volume_inside
from freesweep.solver.batch import walk_by_vectors
from freesweep.solver.status import OK

# thick, threads, share of the wall inside the fibers
KINDS = {
    "source": (False, 0.0, 0.0),
    "physical": (True, 1.0, 1.0), "thick": (True, 0.0, 0.5), "bonded outside": (True, 0.0, 1.0),
    "loose membrane": (False, 1.0, 0.0), "loose inside": (True, 1.0, 0.0),
}  # fmt: skip
PARAMETERS = (
    "alpha", "beta", "length", "radius", "wall", "fiber_extension", "c10", "c01", "pressure", "force", "torque"
)  # fmt: skip
STEPS, LITTLE = (4e-3, 8e-4, 1.6e-4), (3e-5, 1e-5)  # of sizes; on one side only there is less to tell corners by
CAUTION, ONE_SIDED = 10.0, 1e-5  # times those estimates, and relative: corners may hide in them
SCATTER = 2e-9  # what differences of two states scatter, of these


def batch(count, seed, loaded=0.6):
    """Random designs and loads, name -> (n,), in SI units and degrees; so many of them ``loaded``."""
    rng = np.random.default_rng(seed)
    alpha, beta = rng.uniform(0, 85, count), rng.uniform(-85, 85, count)
    beta = np.where(np.abs(alpha - beta) < 3.0, beta - 10.0, beta)
    r, p = rng.uniform(3e-3, 12e-3, count), 10 ** rng.uniform(3.5, 5.3, count)

    def some(share, values):
        return np.where(rng.random(count) < share, values, 0.0)

    return {
        "alpha": alpha, "beta": beta, "length": r * rng.uniform(5, 60, count), "radius": r,
        "wall": r * rng.uniform(0.05, 0.5, count), "fiber_extension": 1.0 + some(0.3, rng.uniform(0.005, 0.03, count)),
        "c10": 0.11e6 * rng.uniform(0.5, 2, count), "c01": 0.11e6 * rng.uniform(0.1, 1, count), "pressure": p,
        "force": some(loaded, p * np.pi * r**2 * rng.uniform(-0.3, 0.8, count)),
        "torque": some(loaded, p * np.pi * r**3 * rng.uniform(-0.3, 0.3, count)),
    }  # fmt: skip


def sizes(design):
    """What steps of each parameter are parts of."""
    r, p = design["radius"], design["pressure"]
    own = {"alpha": 25.0, "beta": 25.0, "fiber_extension": 1.0, "c01": design["c10"]}
    return {name: own.get(name, design[name]) for name in PARAMETERS} | {
        "force": p * np.pi * r**2, "torque": p * np.pi * r**3
    }  # fmt: skip


def problems_of(design, kind):
    """Dimensionless problems, pressures, and the design with its fiber radius."""
    thick, threads, share = KINDS[kind]
    design = design | {"fiber_radius": design["radius"] + share * design["wall"]}
    rows = problem_rows(design, "full", thick, threads)
    return np.ascontiguousarray(rows), design["pressure"] / design["c10"], design


def solved(design, kind, accuracy=1e-10):
    """Outputs (5, n) in the order of SHAPE, NaN where vectors have none."""
    rows, pressures, design = problems_of(design, kind)
    found = walk_by_vectors(rows, np.arange(len(rows) + 1), pressures, accuracy)
    scales = output_scales(design)
    values = np.array([found.values[:, OUTPUTS.index(name)] * scales[name] for name in SHAPE])
    values[SHAPE.index("volume")] -= wall_volume_inside(design)
    return np.where(found.status == OK, values, np.nan)


def told(design, kind, accuracy=1e-6):
    """Rows and bounds (5, 1 + parameters, n) of :func:`.derivative.vectors.differentiated`."""
    thick, threads, share = KINDS[kind]
    seeded, count = {}, len(PARAMETERS)
    for k, name in enumerate(PARAMETERS):
        parts = np.zeros((OWN + count, 1))
        parts[OWN + k] = 1.0
        seeded[name] = Dual(design[name], parts)
    seeded["fiber_radius"] = seeded["radius"] + share * seeded["wall"]
    own = sizes(design)
    measured = np.array([np.broadcast_to(own[name], design["radius"].shape) for name in PARAMETERS])
    return differentiated(seeded, "full", measured, SHAPE, accuracy, thick, threads)


def difference(design, kind, name, middle):
    """Differences (5, n) of the solver along one parameter about what it gives in the ``middle``, and by how much they may
    err: of several steps, and extrapolated, those that their own estimate calls best. On either side they tell the same
    unless a family begins to go slack within the step.
    """
    best, doubt = np.full(middle.shape, np.nan), np.full(middle.shape, np.inf)
    for step in STEPS if name != "fiber_extension" else (*STEPS, *LITTLE):
        h = step * sizes(design)[name] * np.ones(middle.shape[1])
        at_one = (name == "fiber_extension") & (design[name] == 1.0)  # the least; below it is another slope
        if name == "fiber_extension":
            h = np.where(at_one, 0.25 * h, np.minimum(h, 0.9 * (design[name] - 1.0)))
        sides = []
        for side in (1.0, -1.0):
            ends = [solved(design | {name: design[name] + side * part * h}, kind) for part in (0.25, 0.5, 1.0)]
            slopes = [side * (end - middle) / (part * h) for end, part in zip(ends, (0.25, 0.5, 1.0))]
            sides.append((slopes, [2.0 * near - far for near, far in pairwise(slopes)]))
        (above, first), (below, second) = sides
        even = [(4.0 * (a + b) - (c + d)) / 6.0 for (a, c), (b, d) in zip(pairwise(above), pairwise(below))]
        ahead, behind = ((4.0 * near - far) / 3.0 for near, far in (first, second))
        found = np.where(at_one, ahead, even[0])
        one_sided = CAUTION * (np.abs(ahead - first[0]) + np.abs(first[0] - first[1]))
        one_sided = one_sided + ONE_SIDED * np.abs(ahead)
        error = np.where(at_one, one_sided, np.abs(even[0] - even[1]) + np.abs(ahead - behind))
        error = error + SCATTER * measured(middle) / h
        better = np.isfinite(found) & (error < doubt)
        best, doubt = np.where(better, found, best), np.where(better, error, doubt)
    return best, doubt


def measured(values):
    """What outputs scatter by is a part of."""
    return np.abs(values) + (np.arange(len(SHAPE)) == SHAPE.index("rotation"))[:, None]


def compared(count, seed, kind):
    """``(how many derivatives were compared, how many of them are told by differences to 1e-5, what is wrong, states,
    states without derivatives)``.
    """
    design = batch(count, seed)
    values, (rows, bounds) = solved(design, kind), told(design, kind)
    same = np.abs(rows[:, 0] - values) <= BOUNDS * bounds[:, 0] + SAME * measured(values)
    there, found = np.isfinite(values[0]), np.all(same, axis=0)  # another state's are not taken
    number = sharp = 0
    wrong = []
    for k, name in enumerate(PARAMETERS):
        other, doubt = difference(design, kind, name, values)
        exact, bound = rows[:, 1 + k], bounds[:, 1 + k]
        size = np.maximum(np.abs(exact), 1e-3 * measured(values) / sizes(design)[name])
        judged = there & found & np.isfinite(other)
        number += np.count_nonzero(judged)
        sharp += np.count_nonzero(judged & (doubt <= 1e-5 * size))
        missed = judged & ~(np.abs(exact - other) <= np.maximum(1e-6 * size, bound) + doubt)
        wrong += [
            (name, SHAPE[i], int(j), exact[i, j], other[i, j], bound[i, j], doubt[i, j]) for i, j in np.argwhere(missed)
        ]
    return number, sharp, wrong, np.count_nonzero(there), np.count_nonzero(there & ~found)
