"""From a grid of designs to distinct dimensionless problems, and back.

Length, radius, pressure and material enter only through ratios; swapping the fiber families changes nothing, and negating
both angles mirrors rotation and torque. So a grid holds fewer distinct problems than points: each is solved once.
"""

from dataclasses import dataclass

import numpy as np

from ..actuator import LARGEST_ANGLE, SMALLEST_DIFFERENCE
from ..atlas.schema import PARAMETERS
from ..scaling import problem_rows
from ..status import DEGENERATE, INVALID, OK

DIGITS = 13  # significant digits to which two problems are the same: rounding differs by the way units were given
H, D, TORQUE = 0, 1, 7  # columns of a problem


@dataclass(frozen=True)
class Plan:
    """What has to be solved, and where each result belongs.

    problems (k, 9) and pressures (n,): problem i owns pressures ``first[i]`` to ``first[i + 1]``, ascending, the last
    of them infinite: the locked shape. ``design`` maps names to columns (d,), one entry for each design of the grid.
    """

    dimensions: tuple
    shape: tuple
    coordinates: dict
    design: dict
    pressure: np.ndarray
    problems: np.ndarray
    first: np.ndarray
    pressures: np.ndarray
    status: np.ndarray  # (d,) OK, DEGENERATE or INVALID, known before anything is solved
    problem: np.ndarray  # (d,) row of ``problems``, 0 where there is none
    swapped: np.ndarray  # (d,) the problem's families are this design's, exchanged
    mirrored: np.ndarray  # (d,) the problem rotates the other way
    rank: np.ndarray  # (d, p) place of each pressure among the problem's

    @property
    def equilibria(self) -> int:
        """Number of distinct equilibria, locked shapes among them."""
        return len(self.pressures)

    @property
    def rows(self) -> np.ndarray:
        """Row of the results that holds each point of the grid (d, p)."""
        return self.first[self.problem][:, None] + self.rank

    @property
    def locked_rows(self) -> np.ndarray:
        """Row of the results that holds each design's locked shape (d,)."""
        return self.first[np.minimum(self.problem + 1, len(self.first) - 1)] - 1


def plan(sweep) -> Plan:
    """The plan of a sweep."""
    dimensions, shape, coordinates, design = design_grid(sweep)
    pressure = np.asarray(sweep.axes.get("pressure", [sweep.fixed.get("pressure", 0.0)]), float)
    status = known_status(design)
    rows, swapped, mirrored = canonical(problem_rows(design, sweep.energy))
    good = status == OK
    problem = np.zeros(len(rows), np.int64)
    problems, problem[good] = np.unique(significant(rows[good]), axis=0, return_inverse=True)
    if len(problems) == 0:
        problems = np.zeros((0, rows.shape[1]))
    # one list of reduced pressures for each material
    c10, material = np.unique(design["c10"], return_inverse=True)
    lists = [significant(pressure / value) for value in c10]
    pairs, pair = np.unique(np.column_stack([problem, material])[good], axis=0, return_inverse=True)
    own, first, ranks = [], [0], np.zeros((len(pairs), len(pressure)), np.int64)
    bounds = np.searchsorted(pairs[:, 0], np.arange(len(problems) + 1))
    for k in range(len(problems)):
        mine = range(bounds[k], bounds[k + 1])
        values = np.unique(np.concatenate([lists[pairs[i, 1]] for i in mine]))
        for i in mine:
            ranks[i] = np.searchsorted(values, lists[pairs[i, 1]])
        own += [values, [np.inf]]
        first.append(first[-1] + len(values) + 1)
    rank = np.zeros((len(rows), len(pressure)), np.int64)
    rank[good] = ranks[pair]
    return Plan(
        dimensions, shape, coordinates, design, pressure, problems, np.array(first, np.int64),
        np.concatenate(own) if own else np.zeros(0), status, problem, swapped, mirrored, rank,
    )  # fmt: skip


def design_grid(sweep):
    """Dimensions, shape, coordinates and columns of the designs: the grid without its pressure axis."""
    axes = {name: values for name, values in sweep.axes.items() if name != "pressure"}
    count = len(sweep.designs["names"]) if sweep.designs else 0
    dimensions = tuple(name for name in sweep.dims if name != "pressure")
    shape = ((count,) if sweep.designs else ()) + tuple(len(values) for values in axes.values())
    coordinates = {name: (name, values) for name, values in axes.items()}
    full = {name: np.full(shape, value) for name, value in sweep.fixed.items() if name != "pressure"}
    for position, name in enumerate(axes, start=1 if sweep.designs else 0):
        side = [1] * len(shape)
        side[position] = shape[position]
        full[name] = np.broadcast_to(axes[name].reshape(side), shape)
    if sweep.designs:
        coordinates["design"] = ("design", np.array(sweep.designs["names"]))
        for name, column in sweep.designs["columns"].items():
            coordinates[name] = ("design", column)
            full[name] = np.broadcast_to(column.reshape(-1, *[1] * (len(shape) - 1)), shape)
    coordinates |= {name: value for name, value in sweep.fixed.items() if name not in coordinates}
    design = {name: np.ascontiguousarray(full[name]).ravel() for name in PARAMETERS if name in full}
    design.setdefault("fiber_radius", design["radius"])
    return dimensions, shape, coordinates, design


def known_status(design) -> np.ndarray:
    """DEGENERATE or INVALID where no solution has to be tried, else OK."""
    alpha, beta, fibers = design["alpha"], design["beta"], design["fiber_radius"]
    apart = np.abs(alpha - beta)
    invalid = (apart < SMALLEST_DIFFERENCE) | (np.abs(alpha) >= LARGEST_ANGLE) | (np.abs(beta) >= LARGEST_ANGLE)
    outer = design["radius"] + design["wall"]
    invalid |= (fibers < design["radius"]) | (fibers > outer * (1.0 + 1e-12))
    return np.where(apart == 0.0, DEGENERATE, np.where(invalid, INVALID, OK))


def canonical(rows):
    """Problems with D > 0 and H >= 0, and which designs were exchanged or mirrored to get there."""
    rows = rows.copy()
    mirrored = (rows[:, H] < 0.0) | ((rows[:, H] == 0.0) & (rows[:, TORQUE] < 0.0))
    rows[mirrored, H] *= -1.0
    rows[mirrored, D] *= -1.0
    rows[mirrored, TORQUE] *= -1.0
    swapped = rows[:, D] < 0.0
    rows[swapped, D] *= -1.0
    return rows + 0.0, swapped, mirrored  # + 0.0: no negative zeros


def significant(array):
    """Rounded to DIGITS significant digits."""
    size = np.abs(array)
    decade = np.floor(np.log10(size, out=np.zeros_like(size), where=size > 0.0))
    scale = 10.0 ** (DIGITS - 1 - decade)
    return np.where(size > 0.0, np.round(array * scale) / scale, 0.0)
