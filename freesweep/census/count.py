"""What a census counts: statuses, where failures lie, and bounds that do not hold."""

import numpy as np

from ..scaling import OUTPUTS
from ..status import NOT_CONVERGED, OK, STATUSES, VALUED
from .designs import BLOCK, COLUMNS, PRESSURES, draw, quadrature, with_pressures

FINER = 4  # times as many cells has the mesh of the audit
KINDS = ("free", "locked", "blocked_force", "blocked_torque")
KEPT = 20_000  # states of one kind and status whose designs are kept, for the ranges they lie in
MIDDLE, APART = (0.05, 0.95), 0.15  # of them; and the share of a usual range by which an end has to differ to be told
ROUNDING = 1e-12  # of what an output is measured by: smaller differences are the reference's own rounding
LISTED = 8  # states of each kind without a result for no physical reason, and broken bounds, that are printed in full


class Census:
    """What was counted: ``counts`` maps kind -> status -> states; ``kept`` (kind, status) -> designs with pressures."""

    def __init__(self, designs, seed):
        self.designs, self.seed = designs, seed
        self.counts = {kind: dict.fromkeys(range(len(STATUSES)), 0) for kind in KINDS}
        self.kept = {}
        self.ratios = {name: [] for name in OUTPUTS}  # bound/difference, of each audited output that differs
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
        seen = difference > ROUNDING * measures(designs, finer["values"])
        for k, name in enumerate(OUTPUTS):
            self.ratios[name].append(bounds[seen[:, k], k] / difference[seen[:, k], k])
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
        every = np.concatenate(
            [with_pressures(block.designs, block.pressures).reshape(-1, len(COLUMNS)) for block in blocks]
        )
        return np.quantile(every, MIDDLE, axis=0).T

    def _defects(self):
        """States that failed for no physical reason, some of each kind in full."""
        found = {kind: np.concatenate(kept) for (kind, value), kept in self.kept.items() if value == NOT_CONVERGED}
        total = sum(self.counts[kind][NOT_CONVERGED] for kind in KINDS)
        lines = [f"{total:,} not_converged" if total else "every state is solved, or has a physical reason"]
        return lines + [f"  {kind}: {_words(row)}" for kind, rows in found.items() for row in rows[:LISTED]]

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
        lines.append("  bound/difference, where the difference is more than the finer mesh's own rounding:")
        for name, ratios in self.ratios.items():
            all_of = np.concatenate(ratios)
            left_out = f"{self.audited - len(all_of):,} of {self.audited:,} left out"
            if len(all_of):
                left_out = f"median {np.median(all_of):.3g}, least {np.min(all_of):.3g}; {left_out}"
            lines.append(f"  {name:<16} {left_out}")
        worst = sorted(self.breaches, key=lambda breach: -breach[1])[:LISTED]
        return lines + [f"  {name} off by {ratio:.3g} times its bound: {_words(row)}" for name, ratio, row in worst]


def measures(designs, values):
    """By what a difference of each output of half a tube counts, (n, 5): undeformed length, the volume itself, half a radian
    or the rotation itself, the energy itself, and the undeformed radius.
    """
    length, volume, turn, energy, _ = np.abs(values).T
    half = 0.5 * designs[:, COLUMNS.index("length/radius")]
    return np.column_stack([half, volume, np.maximum(0.5, turn), energy, np.ones(len(length))])


def _words(row):
    """A design in full."""
    return ", ".join(f"{name} {value!r}" for name, value in zip(COLUMNS, row.tolist()))
