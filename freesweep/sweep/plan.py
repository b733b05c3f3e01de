"""From a grid of designs to distinct problems, each solved once, and back.

Designs are read in chunks, so that a plan holds a few whole numbers for each design and no columns of it.
"""

import hashlib
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ..atlas.schema import HELD, VARIABLES
from ..status import OK
from .canonical_problem import BLOCK, COLUMNS, PHYSICAL, TARGET, Reduced, reduced, significant
from .grid import Grid, tubes

FREE = "free"
CHUNK = 1 << 15  # designs read at once
MOST_PRESSURES = 8192  # of one problem, shared by several materials
NONE = -1  # the problem of a design that cannot be solved
ODD_FACTORS = (0x9E3779B97F4A7C15, 0xBF58476D1CE4E5B9)  # of splitmix64


class PlanError(RuntimeError):
    """Two different problems were taken for the same; never seen, never passed over."""


class Job(NamedTuple):
    """Problems of one kind, as :func:`scaling.problem_rows` makes them, what each holds, where each one's pressures begin,
    and the pressures.

    ``courses`` are ((course, edges, places), its error) of tubes that vary, None where a profile cannot be followed;
    ``course`` says which is each problem's.
    """

    kind: str
    problems: np.ndarray
    targets: np.ndarray
    first: np.ndarray
    pressures: np.ndarray
    courses: list
    course: np.ndarray


@dataclass(frozen=True)
class Table:
    """The distinct problems of one kind of state, and which of them each design is.

    Problem k owns results ``first[k]`` to ``first[k + 1]``, one for each of ``lists[pattern[k]]``: reduced pressures,
    ascending; of free states the last is infinite, the locked shape.
    """

    kind: str
    grid: Grid
    pressure: np.ndarray  # (p,) [Pa]
    c10: np.ndarray  # (m,) the materials, ascending
    problem: np.ndarray  # (d,) of each design, NONE where nothing can be solved
    source: np.ndarray  # (k,) the first design of each problem
    pattern: np.ndarray  # (k,)
    lists: tuple
    ranks: dict  # (pattern, material) -> (p,) place of each pressure in the list
    first: np.ndarray  # (k + 1,)
    digest: bytes  # of what is solved

    @property
    def count(self) -> int:
        """Number of distinct problems."""
        return len(self.source)

    @property
    def equilibria(self) -> int:
        """Number of distinct equilibria, locked shapes among them."""
        return int(self.first[-1])

    def reduced(self, at) -> Reduced:
        """Designs ``at`` (n,) reduced to their problems."""
        return _reduced(self.grid, at, self.kind, self.c10, len(self.pressure))

    def job(self, a, b) -> Job:
        """What a solver has to know of problems a to b."""
        rows = significant(self.reduced(self.source[a:b]).rows)
        size = TARGET if self.grid.sweep.is_physical else PHYSICAL
        lists = [self.lists[k] for k in self.pattern[a:b]]
        return Job(
            self.kind, rows[:, :size].copy(), rows[:, TARGET].copy(), self.first[a : b + 1] - self.first[a],
            np.concatenate(lists) if lists else np.zeros(0), *tubes(self.grid, self.source[a:b]),
        )  # fmt: skip

    def rows(self, at):
        """Results that hold the pressures of designs ``at``: (n, p); any where there is no problem."""
        solved = self.problem[at] != NONE
        rows = np.zeros((len(at), len(self.pressure)), np.int64)
        problem = self.problem[at[solved]]
        material = np.searchsorted(self.c10, self.grid.columns(at[solved])["c10"])
        pairs, which = np.unique(self.pattern[problem] * len(self.c10) + material, return_inverse=True)
        ranks = [self.ranks[divmod(pair, len(self.c10))] for pair in pairs.tolist()]
        if ranks:
            rows[solved] = self.first[problem][:, None] + np.array(ranks)[which]
        return rows

    def locked_rows(self, at):
        """Results that hold the locked shapes of designs ``at``: (n, 1)."""
        return self.first[np.minimum(np.maximum(self.problem[at], 0) + 1, self.count)][:, None] - 1


def plan(sweep) -> dict:
    """The tables of a sweep by kind of state."""
    return {kind: _table(sweep, kind, without) for kind, without in kinds(sweep).items()}


def kinds(sweep) -> dict:
    """Kinds of states that a sweep solves, and the parameters that each does not vary in."""
    return {FREE: HELD} | {kind: VARIABLES[kind].without for kind in sweep.blocked}


def _reduced(grid, at, kind, c10, pressures):
    columns = grid.columns(at)
    found = reduced(columns, grid.sweep, kind)
    together = max(1, MOST_PRESSURES // pressures)
    found.rows[:, BLOCK] = np.searchsorted(c10, columns["c10"]) // together
    return found


def _table(sweep, kind, without):
    grid = Grid(sweep, without)
    pressure = np.asarray(sweep.axes.get("pressure", [sweep.fixed.get("pressure", 0.0)]), float)
    c10 = np.unique(sweep.fixed["c10"] if "c10" in sweep.fixed else _given(sweep, "c10"))
    digest = hashlib.sha256(kind.encode())
    keys, solvable = np.empty(grid.size, np.uint64), np.empty(grid.size, bool)
    for at in _chunks(grid.size):
        found = _reduced(grid, at, kind, c10, len(pressure))
        rows = significant(found.rows)
        keys[at], solvable[at] = _hashed(rows), found.status == OK
        digest.update(rows.tobytes())
    problem, source = _distinct(keys, solvable)
    del keys
    _verify(grid, kind, c10, len(pressure), problem, source)
    pattern, sets = _patterns(grid, problem, len(source), c10)
    lists, ranks = [], {}
    for k, materials in enumerate(sets):
        own = [significant(pressure / c10[m]) for m in materials]
        values = np.unique(np.concatenate(own))
        ranks |= {(k, int(m)): np.searchsorted(values, mine) for m, mine in zip(materials, own)}
        lists.append(np.append(values, np.inf) if kind == FREE else values)
        digest.update(lists[-1].tobytes())
    first = np.zeros(len(source) + 1, np.int64)
    np.cumsum(np.array([len(values) for values in lists], np.int64)[pattern], out=first[1:])
    return Table(kind, grid, pressure, c10, problem, source, pattern, tuple(lists), ranks, first, digest.digest())


def _given(sweep, name):
    return sweep.axes[name] if name in sweep.axes else sweep.designs["columns"][name]


def _chunks(size):
    for a, b in pairwise([*range(0, size, CHUNK), size]):
        yield np.arange(a, b)


def _hashed(rows):
    """A 64-bit number for each row (n, COLUMNS)."""
    bits = rows.view(np.uint64)
    key = np.zeros(len(rows), np.uint64)
    for column in range(COLUMNS):
        key ^= bits[:, column]
        for factor in ODD_FACTORS:
            key *= np.uint64(factor)
            key ^= key >> np.uint64(29)
    return key


def _distinct(keys, solvable):
    """``(problem of each design, first design of each problem)``, problems counted in the order of their first designs."""
    problem = np.full(len(keys), NONE, np.int64)
    at = np.flatnonzero(solvable)
    order = np.argsort(keys[at], kind="stable")
    ordered = keys[at][order]
    new = np.ones(len(at), bool)
    new[1:] = ordered[1:] != ordered[:-1]
    del ordered
    begin = order[new]  # stable: the first design of each group
    number = np.empty(len(begin), np.int64)
    number[np.argsort(begin)] = np.arange(len(begin))
    group = np.cumsum(new)
    group -= 1
    problem[at[order]] = number[group]
    return problem, at[np.sort(begin)]


def _verify(grid, kind, c10, pressures, problem, source):
    """Every design has the very row of its problem: no two rows met in one hash."""
    for at in _chunks(grid.size):
        at = at[problem[at] != NONE]
        at = at[source[problem[at]] != at]
        if len(at) == 0:
            continue
        own, others = (
            significant(_reduced(grid, some, kind, c10, pressures).rows) for some in (at, source[problem[at]])
        )
        if not np.array_equal(own, others):
            raise PlanError("two different problems have one hash: change one axis by a little")


def _patterns(grid, problem, count, c10):
    """Sets of materials that share a problem: ``(number of each problem's set (k,), the sets)``."""
    if len(c10) == 1:
        return np.broadcast_to(np.int64(0), count), [np.zeros(1, np.int64)]
    pairs = []
    for at in _chunks(grid.size):
        at = at[problem[at] != NONE]
        material = np.searchsorted(c10, grid.columns(at)["c10"])
        pairs.append(np.unique(problem[at] * len(c10) + material))
    owner, material = np.divmod(np.unique(np.concatenate(pairs)), len(c10))
    if count == 0:
        return np.zeros(0, np.int64), []
    begin, size = np.searchsorted(owner, np.arange(count)), np.bincount(owner, minlength=count)
    marks = np.random.default_rng(0).integers(1 << 63, size=len(c10))  # of a material; a set's is their sum
    _, typical, pattern = np.unique(np.add.reduceat(marks[material], begin), return_index=True, return_inverse=True)
    other = typical[pattern[owner]]
    if not np.array_equal(size[owner], size[other]) or not np.array_equal(
        material, material[begin[other] + np.arange(len(owner)) - begin[owner]]
    ):
        raise PlanError("two different sets of materials have one sum: change one value of c10 by a little")
    return pattern, [material[begin[k] : begin[k] + size[k]] for k in typical]
