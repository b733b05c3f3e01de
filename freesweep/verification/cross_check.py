"""Stored points of an atlas, solved anew by quadrature of the first integral and held against their bounds."""

from typing import NamedTuple

import numpy as np

from ..atlas.schema import SHAPE, VARIABLES, YEOH
from ..description.families import FAMILIES, families_of
from ..description.local import Bodies, rules_of
from ..description.tube_model import fiber_surface, model_of
from ..first_integral import folded, held
from ..first_integral.tube import NO_GUIDE, OUTPUTS, SOLVED, cylinders, solve
from ..first_integral.uniform import Tubes, follow, to_corner
from ..status import VALUED

DESIGN = ("alpha", "beta", "length", "radius", "wall", "fiber_extension", "c10", "c01", "force", "torque")
NEXT_TO_NOTHING = 1e-14  # of the torque: a pressure for none
MANY = 1 << 25  # numbers of one variable read at once


class Compared(NamedTuple):
    """One variable at the points drawn: arrays (judged,), in the units of the atlas."""

    name: str
    difference: np.ndarray
    bound: np.ndarray  # as stored
    own: np.ndarray  # estimate of the second method's own error
    unjudged: int  # points with a stored number that the second method could not solve

    @property
    def broken(self) -> np.ndarray:
        """Where the difference exceeds both errors together."""
        return self.difference > self.bound + self.own


def draw(data, count, seed=0):
    """``count`` points with results from an atlas' Dataset; raises ValueError where its tubes have profiles: no numbers
    describe them.
    """
    none = set(FAMILIES) - set(families_of(data.attrs))
    if missing := [name for name in DESIGN if name not in data.coords and name not in none]:
        raise ValueError(
            f"--resolve: {', '.join(missing)} {'is' if len(missing) == 1 else 'are'} no number in this atlas; only tubes"
            " that numbers describe are solved anew"
        )
    return Points(data, count, seed)


def resolve(points):
    """Solve ``points`` of an atlas anew; ``(comparisons, notes)``, sentences on what could not be judged without help."""
    if not points.count:
        return [], ["no point of this atlas has a result"]
    notes = []
    found = [*_shapes(points, "", *_free(points, notes)), *_shapes(points, "locked_", *_locked(points))]
    found += [_limits(points), *_blocked(points), *ideal(points)]
    found = [compared for compared in found if compared is not None]
    if any(compared.unjudged for compared in found):
        notes.append(
            "not judged: shapes that turn back between end and middle, as held states do that wave about the cylinder, and"
            " limit pressures at which the second method finds no longest tube"
        )
    return found, notes


class Points:
    """Points of the grid drawn among those with results, and what is stored there."""

    def __init__(self, data, count, seed):
        self.data, self.shape, self.dims = data, data["status"].shape, data["status"].dims
        status = data["status"].values
        good = np.flatnonzero(np.isin(status, VALUED))
        rng = np.random.default_rng(seed)
        drawn = rng.choice(good, size=min(count, len(good)), replace=False, shuffle=False)
        self.index = dict(zip(self.dims, np.unravel_index(np.sort(drawn), self.shape) if self.shape else ()))
        held = {name: size for name, size in data.sizes.items() if name not in self.dims}  # axes of held states only
        self.index |= {name: rng.integers(size, size=len(drawn)) for name, size in held.items()}
        self.count = len(drawn)
        there = [name for name in (*DESIGN, "pressure") if name in data.coords]
        self.column = dict.fromkeys(FAMILIES, np.zeros(self.count)) | {name: self.stored(name) for name in there}
        self.column |= {name: self.stored(name) if name in data else np.zeros(self.count) for name in YEOH}
        self.model = model_of(data.attrs)
        families, of_bodies = families_of(data.attrs), set(SHAPE) & set(data.coords)
        bodies = Bodies(self.model, rules_of(data.attrs), families) if of_bodies else None
        self.of = {"bodies": bodies, "families": families}  # as the solver is told
        given = {"fiber_radius": self.stored("fiber_radius")} if "fiber_radius" in data else {}
        self.radius = fiber_surface(self.column | given, self.model)

    @property
    def has_first_integral(self) -> bool:
        """Whether the second method knows them: membranes with bonded fibers that are the same all along."""
        return not self.model.is_physical and self.of["bodies"] is None and len(self.of["families"]) == 2

    def stored(self, name):
        """Numbers of a variable at the points (n,)."""
        variable = self.data[name]
        at = tuple(self.index[dim] for dim in variable.dims)
        if variable.size <= MANY:
            return np.broadcast_to(np.asarray(variable.values[at], float), self.count)
        numbers = np.empty(self.count)
        for row in np.unique(at[0]):
            mine = at[0] == row
            numbers[mine] = variable[int(row)].values[tuple(index[mine] for index in at[1:])]
        return numbers

    def target(self, kind):
        """What is held: deformed length in radii (``kind`` 0), or rotation in radians (1)."""
        if kind == 1:
            return np.radians(self.stored("held_rotation")) if "held_rotation" in self.data else 0.0 * self.radius
        if "held_length" in self.data:
            return self.stored("held_length") / self.radius
        ratio = self.stored("held_length_ratio") if "held_length_ratio" in self.data else 1.0
        return ratio * self.column["length"] / self.radius

    def tubes(self, locked=False, **changes):
        """The points' dimensionless problems."""
        c = self.column
        ta, tb = np.tan(np.radians(c["alpha"])), np.tan(np.radians(c["beta"]))
        r, ones = self.radius, np.ones(self.count)
        area = (2.0 * c["radius"] + c["wall"]) * c["wall"] / r**2
        loads = {
            "pressure": c["pressure"] / c["c10"],
            "force": c["force"] / (np.pi * r**2 * c["c10"]),
            "torque": c["torque"] / (np.pi * r**3 * c["c10"]),
        }
        if locked:
            loads = {"pressure": ones, "force": 0.0 * ones, "torque": 0.0 * ones}
        shear = ones * (self.data.attrs["energy"] == "full")
        return Tubes(
            0.5 * (ta + tb), 0.5 * (ta - tb), area, c["fiber_extension"], c["c01"] / c["c10"], shear, **loads,
            weight=ones * (not locked), half=0.5 * c["length"] / r, second=c["c20"] / c["c10"], third=c["c30"] / c["c10"],
        )._replace(**changes)  # fmt: skip


def _free(points, notes):
    """Equilibria under the points' loads; of those past the uniform tube's turn, beginning at the stored middle."""
    tubes = points.tubes()
    rest = (tubes.pressure == 0.0) & (tubes.force == 0.0) & (tubes.torque == 0.0)
    limp = (tubes.pressure == 0.0) & (tubes.force == 0.0)  # torque alone: the limit of falling pressures
    tubes = tubes._replace(pressure=np.where(limp, NEXT_TO_NOTHING * np.abs(tubes.torque), tubes.pressure))
    judged = solve(tubes)
    values, errors, reason = judged
    values[rest], errors[rest], reason[rest] = (
        cylinders(tubes.at(rest)._replace(gamma=np.ones(rest.sum()))),
        0.0,
        SOLVED,
    )
    if (lost := np.flatnonzero((reason == NO_GUIDE) & ~rest)).size:
        again = folded.solve_near(tubes.at(lost), points.stored("mid_radius")[lost] / points.radius[lost])
        values[lost], errors[lost], reason[lost] = again
        notes.append(
            f"{lost.size:,} points lie where the uniform tube has turned back: solved from their stored middle radius, so"
            " that it is an equilibrium is judged, on which branch is not"
        )
    return values, errors


def _locked(points):
    return solve(points.tubes(locked=True))[:2]


def _shapes(points, prefix, values, errors):
    """Comparisons of the five outputs of equilibria."""
    r, c10 = points.radius, points.column["c10"]
    units = (r, np.pi * r**3, np.degrees(1.0), np.pi * r**3 * c10, r)
    for k, (name, unit) in enumerate(zip(OUTPUTS, units)):
        value = values[:, k] * unit
        if name == "volume":  # the wall inside the fibers keeps its volume
            value = value - np.pi * (r**2 - points.column["radius"] ** 2) * points.column["length"]
        yield compare(points, prefix + name, value, errors[:, k] * unit)


def _limits(points):
    """Limit pressures of the points' designs; those met before the loads are on are none."""
    near = points.stored("limit_pressure") / points.column["c10"]
    value = np.full(points.count, np.nan)
    tubes = points.tubes()
    if (some := np.flatnonzero(np.isfinite(near))).size:
        tubes = tubes.at(some)
        corner, u, _ = to_corner(tubes)
        beyond = tubes._replace(pressure=1.5 * near[some])
        turning, t = follow(u, corner, beyond)
        value[some] = folded.limit_pressures(tubes, turning, corner.toward(beyond, t).pressure, near[some])
    own = 1e-9 * np.abs(value) * points.column["c10"]
    return compare(points, "limit_pressure", value * points.column["c10"], own)


def _blocked(points):
    """Blocked force and torque."""
    tubes, r, c10 = points.tubes(), points.radius, points.column["c10"]
    for kind, name in enumerate(("blocked_force", "blocked_torque")):
        if name not in points.data:
            continue
        unit = np.pi * r ** (2 + kind) * c10
        near = points.stored(name) / unit
        nothing = (tubes.pressure == 0.0) & (points.column[held.LOADS[1 - kind]] == 0.0)
        good = np.flatnonzero(np.isfinite(near) & ~nothing)
        mine = tubes._replace(**{held.LOADS[kind]: 0.0 * r}).at(good)
        value, own = np.full((2, points.count), np.nan)
        value[good], own[good] = held.blocked(mine, kind, points.target(kind)[good], near[good])
        value[nothing], own[nothing] = 0.0, 0.0
        yield compare(points, name, value * unit, own * unit)


def ideal(points):
    """The closed forms of inextensible fibers: the load that makes a straight cylinder of no wall stationary."""
    ones, r = np.ones(points.count), points.radius
    tubes = points.tubes(gamma=ones, weight=0.0 * ones, force=0.0 * ones, torque=0.0 * ones)
    for kind, name in enumerate(("ideal_blocked_force", "ideal_blocked_torque")):
        unit = np.pi * r ** (2 + kind) * points.column["c10"]
        with np.errstate(all="ignore"):
            value = held.cylinder_load(tubes, kind, ones) * unit
        yield compare(points, name, value, 1e-13 * np.abs(value))


def compare(points, name, value, own):
    """A variable's stored numbers against ``value`` with its ``own`` error; None where nothing is stored."""
    if name not in points.data or name not in VARIABLES:
        return None
    stored, bound = points.stored(name), points.stored(f"{name}_error")
    there = np.isfinite(stored)
    judged = there & np.isfinite(value)
    if not there.any():
        return None
    difference = np.abs(stored - value)[judged]
    return Compared(name, difference, bound[judged], own[judged], int(np.count_nonzero(there & ~judged)))


def table(comparisons) -> str:
    """The comparisons as text: one line for each variable."""
    rows = [
        ("variable", "judged", "not judged", "largest difference", "its bound", "largest difference/bound", "exceeding")
    ]
    for c in comparisons:
        if len(c.difference):
            worst = int(np.argmax(c.difference))
            ratio = np.max(c.difference / np.maximum(c.bound + c.own, 1e-300))
            figures = (f"{c.difference[worst]:.2g} {VARIABLES[c.name].units}", f"{c.bound[worst]:.2g}", f"{ratio:.2g}")
        else:
            figures = ("-", "-", "-")
        rows.append((c.name, f"{len(c.difference):,}", f"{c.unjudged:,}", *figures, f"{np.count_nonzero(c.broken):,}"))
    widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
    return "\n".join(
        "  ".join([row[0].ljust(widths[0]), *(cell.rjust(width) for cell, width in zip(row[1:], widths[1:]))])
        for row in rows
    )
