"""The census: random designs over the whole domain, every one solved or explained, and the error bounds audited.

Designs are drawn in blocks, each from its own seed, so that a larger census begins with the designs of a smaller one and
no number depends on the threads. A sample is solved again on a mesh four times finer, to an accuracy a hundred times
better, and the difference held against the bounds.
"""

from concurrent.futures import ThreadPoolExecutor
from typing import NamedTuple

import numpy as np

from .scaling import OUTPUTS
from .status import NOT_CONVERGED, OK, STATUSES, VALUED

BLOCK = 256  # designs that are drawn, solved and counted together
PRESSURES = 4  # of each design, beside its locked shape
HELD_EVERY = 16  # one design in that many is also held at its length and at its rotation
ACCURACY, AUDIT_ACCURACY = 1e-6, 1e-8
FINER = 4
KEPT = 20_000  # states of one kind and status whose designs are kept, for the ranges they lie in
MIDDLE, APART = (0.05, 0.95), 0.15  # of them; and the share of a usual range by which an end has to differ to be told
LISTED = 10  # states without a result for no physical reason that are printed in full
KINDS = ("free", "locked", "blocked_force", "blocked_torque")
COLUMNS = (
    "alpha",
    "beta",
    "length/radius",
    "wall/radius",
    "fiber_extension",
    "c01/c10",
    "force",
    "torque",
    "pressure",
    "full",
)


class Drawn(NamedTuple):
    """Designs (n, 10): COLUMNS but pressure, angles in degrees, loads in pi r^2 C10 and pi r^3 C10; ``pressures`` (n, m)."""

    designs: np.ndarray
    pressures: np.ndarray

    def problems(self):
        """As the kernels take them (n, 9)."""
        alpha, beta, length, wall, gamma, ratio, force, torque, full = self.designs.T
        ta, tb = np.tan(np.radians(alpha)), np.tan(np.radians(beta))
        columns = (0.5 * (ta + tb), 0.5 * (ta - tb), wall * (2.0 + wall), gamma, ratio, full, force, torque, length)
        return np.column_stack(columns)


def draw(count, seed, block) -> Drawn:
    """Random designs of one block: angles 2..85 degrees of both signs and half a degree apart, length/radius 2..200,
    wall/radius 0.03..1, fiber extension 1 (half of them) to 1.02, C01/C10 0..2, force -1..3, torque -1.5..1.5 (each 0 in two
    of five), both strain energies, P/C10 0.003..10.
    """
    rng = np.random.default_rng([seed, block])
    signs = rng.choice([-1.0, 1.0], (2, BLOCK))
    alpha, beta = signs * rng.uniform(2.0, 85.0, (2, BLOCK))
    beta = np.where(np.abs(alpha - beta) < 0.5, -beta, beta)
    columns = [
        alpha, beta, _spread(rng, 2.0, 200.0), _spread(rng, 0.03, 1.0),
        np.where(rng.random(BLOCK) < 0.5, 1.0, rng.uniform(1.0, 1.02, BLOCK)),
        np.where(rng.random(BLOCK) < 0.25, 0.0, rng.uniform(0.0, 2.0, BLOCK)),
        np.where(rng.random(BLOCK) < 0.4, 0.0, rng.uniform(-1.0, 3.0, BLOCK)),
        np.where(rng.random(BLOCK) < 0.4, 0.0, rng.uniform(-1.5, 1.5, BLOCK)),
        np.where(rng.random(BLOCK) < 0.5, 1.0, 0.0),
    ]  # fmt: skip
    pressures = np.sort(_spread(rng, 0.003, 10.0, (BLOCK, PRESSURES)), axis=1)
    return Drawn(np.column_stack(columns)[:count], pressures[:count])


def _spread(rng, low, high, shape=BLOCK):
    """Numbers of evenly spread size."""
    return np.exp(rng.uniform(np.log(low), np.log(high), shape))


class Census:
    """What was counted: ``counts`` maps kind -> status -> states; ``kept`` (kind, status) -> designs with pressures."""

    def __init__(self, designs, seed):
        self.designs, self.seed = designs, seed
        self.counts = {kind: dict.fromkeys(range(len(STATUSES)), 0) for kind in KINDS}
        self.kept = {}
        self.ratios = {name: [] for name in OUTPUTS}  # bound/difference, of each audited output
        self.audited, self.differing, self.acquitted = 0, 0, 0
        self.breaches = []  # (output, difference/bound, design) of every broken bound

    def add(self, kind, designs, status):
        """Count states (n,) and keep their designs (n, 10) where there is no plain result."""
        for value in np.unique(status).tolist():
            self.counts[kind][value] += int(np.count_nonzero(status == value))
            if value != OK:
                kept = self.kept.setdefault((kind, value), [])
                if sum(map(len, kept)) < KEPT:
                    kept.append(designs[status == value])

    @property
    def broken(self) -> int:
        """Number of bounds that do not hold."""
        return len(self.breaches)

    def audit(self, designs, states, finer):
        """Hold records of states of ``designs`` (n, 10) against those of a finer mesh; where the two contradict each
        other, quadrature of the first integral decides.
        """
        valued = np.isin(states["status"], VALUED), np.isin(finer["status"], VALUED)
        self.differing += int(np.count_nonzero(valued[0] != valued[1]))
        both = valued[0] & valued[1]
        designs, states, finer = designs[both], states[both], finer[both]
        self.audited += len(states)
        bounds, difference = states["bounds"].astype(float), np.abs(states["values"] - finer["values"])
        for name, ratios in zip(OUTPUTS, (bounds / np.maximum(difference, 1e-300)).T):
            self.ratios[name].append(ratios)
        apart = difference > bounds + finer["bounds"]
        if (rows := np.flatnonzero(apart.any(axis=1))).size:
            exact, own = quadrature(designs[rows], states["values"][rows, 4])
            missed = np.abs(states["values"][rows] - exact)
            missed = np.where(np.isnan(missed), difference[rows], missed)
            for row, k in np.argwhere(apart[rows]).tolist():
                if missed[row, k] <= bounds[rows[row], k] + np.nan_to_num(own[row, k]):
                    self.acquitted += 1
                else:
                    ratio = missed[row, k] / bounds[rows[row], k]
                    self.breaches.append((OUTPUTS[k], ratio, designs[rows[row]]))

    def report(self) -> str:
        """Counts, the ranges in which failures lie, and the audit, in words."""
        lines = [f"{self.designs:,} random designs, seed {self.seed}, {PRESSURES} pressures each, both strain energies"]
        for kind in KINDS:
            total = sum(self.counts[kind].values())
            lines += ["", f"{kind}: {total:,} states"]
            for value, number in self.counts[kind].items():
                if number:
                    lines.append(f"  {number:>12,}  {STATUSES[value].meaning}{self._ranges(kind, value)}")
        lines += ["", *self._defects(), *self._audit()]
        return "\n".join(lines)

    def _ranges(self, kind, value):
        """Where the states of one status lie: the middle nine tenths of the parameters that set them apart."""
        if (kind, value) not in self.kept:
            return ""
        designs, usual = np.concatenate(self.kept[kind, value]), self._usual()
        words = []
        for name, column, (least, most) in zip(COLUMNS, designs.T, usual):
            low, high = np.quantile(column, MIDDLE)
            if np.isfinite(high) and (low > least + APART * (most - least) or high < most - APART * (most - least)):
                words.append(f"{name} {low:.3g}..{high:.3g}" if low < high else f"{name} {low:.3g}")
        return f": {', '.join(words)}" if words else ""

    def _usual(self):
        """The same of all designs, from a few blocks."""
        blocks = [draw(BLOCK, self.seed, block) for block in range(4)]
        every = np.concatenate([_rows(block.designs, block.pressures).reshape(-1, len(COLUMNS)) for block in blocks])
        return np.quantile(every, MIDDLE, axis=0).T

    def _defects(self):
        """States that failed for no physical reason, in full."""
        found = [
            (kind, row)
            for (kind, value), kept in self.kept.items()
            if value == NOT_CONVERGED
            for row in np.concatenate(kept)
        ]
        lines = [f"{len(found):,} not_converged"] if found else ["every state is solved, or has a physical reason"]
        return lines + [f"  {kind}: {_words(row)}" for kind, row in found[:LISTED]]

    def _audit(self):
        if not self.audited:
            return []
        every = len(OUTPUTS) * self.audited
        lines = [
            "",
            f"bounds held against a mesh {FINER} times finer: {self.audited:,} states, {every:,} bounds, {self.broken:,}"
            f" broken ({100.0 * self.broken / every:.3g} %); {self.differing:,} states with a result on one mesh only",
        ]
        if self.acquitted:
            lines.append(
                f"  {self.acquitted:,} more seemed broken, but quadrature of the first integral confirms them: the finer"
                " mesh is off"
            )
        for name, ratios in self.ratios.items():
            all_of = np.concatenate(ratios)
            lines.append(f"  {name:<16} median bound/difference {np.median(all_of):>9.3g}, least {np.min(all_of):.3g}")
        worst = sorted(self.breaches, key=lambda breach: -breach[1])[:LISTED]
        return lines + [f"  {name} off by {ratio:.3g} times its bound: {_words(row)}" for name, ratio, row in worst]


def quadrature(designs, mid_radius):
    """Values and errors (n, 5) of ``designs`` (n, 10) by the second method, as the kernels give them; NaN: not judged."""
    from .first_integral.folded import solve_near
    from .first_integral.tube import SOLVED, solve
    from .first_integral.uniform import Tubes

    alpha, beta, length, wall, gamma, ratio, force, torque, pressure, full = designs.T
    ta, tb = np.tan(np.radians(alpha)), np.tan(np.radians(beta))
    loaded = np.isfinite(pressure)
    loads = np.where(loaded, pressure, 1.0), np.where(loaded, force, 0.0), np.where(loaded, torque, 0.0)
    area, half = wall * (2.0 + wall), 0.5 * length
    tubes = Tubes(0.5 * (ta + tb), 0.5 * (ta - tb), area, gamma, ratio, full, *loads, loaded.astype(float), half)
    found = solve(tubes, loads[0])
    if (lost := np.flatnonzero(found.reason != SOLVED)).size:
        again = solve_near(tubes.at(lost), mid_radius[lost])
        found.values[lost], found.errors[lost] = again.values, again.errors
    of_half = np.array([0.5, 0.5, 0.5, 0.5, 1.0])
    return found.values * of_half, found.errors * of_half


def _words(row):
    """A design in full."""
    return ", ".join(f"{name} {value!r}" for name, value in zip(COLUMNS, row.tolist()))


def census(count, seed=0, *, audit=1000, threads=None, progress=True) -> Census:
    """Draw ``count`` designs, solve them, count their statuses, and audit the bounds of about ``audit`` states.

    Raises ValueError for numbers below what makes sense. No result depends on ``threads`` (default: one for each core).
    """
    from .sweep.estimate import cores

    faults = [f"{name}: found {n}; give 1 or more" for name, n in (("N", count), ("threads", threads or 1)) if n < 1]
    faults += [f"audit: found {audit}; give 0 or more"] if audit < 0 else []
    faults += [f"seed: found {seed}; give 0 or more"] if seed < 0 else []
    if faults:
        raise ValueError("\n".join(faults))
    blocks = -(-count // BLOCK)
    audited = -(-audit // (blocks * (PRESSURES + 1)))  # designs of each block
    found = Census(count, seed)

    def run(block):
        size = min(BLOCK, count - block * BLOCK)
        return size, *_solve(draw(size, seed, block), min(size, audited))

    _solve(draw(1, seed, 0), 0)  # compiles, or loads what is compiled
    with ThreadPoolExecutor(threads or cores()) as pool, _bar(count, progress) as bar:
        for first in range(0, blocks, 64):  # a few at a time: what is done is counted and let go
            for size, counted, compared in pool.map(run, range(first, min(first + 64, blocks))):
                for kind, designs, status in counted:
                    found.add(kind, designs, status)
                if compared:
                    found.audit(*compared)
                bar.update(size)
    return found


def _solve(drawn, audited):
    """``(kind, designs with pressures, status)`` of all states of a block, and its audited records beside finer ones."""
    from .sweep.plan import FREE, Job
    from .sweep.solve import solve_shard

    problems, count = drawn.problems(), len(drawn.designs)
    nothing = np.zeros(count)
    pressures = np.column_stack([drawn.pressures, np.full(count, np.inf)])
    first = np.arange(count + 1, dtype=np.int64) * pressures.shape[1]
    states, _ = solve_shard(Job(FREE, problems, nothing, first, pressures.ravel(), [], nothing), ACCURACY)
    counted = []
    grid = states["status"].reshape(count, -1)
    rows = _rows(drawn.designs, drawn.pressures)
    counted.append(("free", rows.reshape(-1, len(COLUMNS)), grid[:, :-1].ravel()))
    counted.append(("locked", rows[:, -1], grid[:, -1]))
    for kind, load, target in (("blocked_force", 6, problems[:, 8]), ("blocked_torque", 7, nothing)):
        some = slice(0, count, HELD_EVERY)
        held, unloaded = problems[some].copy(), drawn.designs[some].copy()
        held[:, load], unloaded[:, load] = 0.0, 0.0
        each = np.arange(len(held) + 1, dtype=np.int64)
        job = Job(kind, held, target[some], each, drawn.pressures[some, -1].copy(), [], nothing[some])
        counted.append(
            (kind, _rows(unloaded, drawn.pressures[some, -1:])[:, 0], solve_shard(job, ACCURACY)[0]["status"])
        )
    if not audited:
        return counted, None
    part = first[audited]
    job = Job(
        FREE, problems[:audited], nothing[:audited], first[: audited + 1], pressures[:audited].ravel(), [], nothing
    )
    locked = np.full((count, 1), np.inf)
    every = _rows(drawn.designs, np.column_stack([drawn.pressures, locked])).reshape(-1, len(COLUMNS))
    return counted, (every[:part], states[:part], _finer(job))


def _finer(job):
    """Records of a job on a finer mesh."""
    from .sweep import solve

    edges = np.array([0, FINER * solve.BASE_CELLS])
    tube = (solve.UNIFORM[0], edges, solve.UNIFORM[2])
    return solve._solve_free(job.kind, job.problems, job.targets, job.first, job.pressures, tube, AUDIT_ACCURACY)[0]


def _rows(designs, pressures):
    """Designs with each of their pressures (n, m, 10), in the order of COLUMNS."""
    repeated = np.broadcast_to(designs[:, None, :], (*pressures.shape, designs.shape[1]))
    return np.concatenate([repeated[..., :8], pressures[..., None], repeated[..., 8:]], axis=2)


def _bar(total, progress):
    from tqdm import tqdm

    return tqdm(total=total, unit=" designs", unit_scale=True, disable=not progress, dynamic_ncols=True)
