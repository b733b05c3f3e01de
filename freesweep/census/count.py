"""What a census counts: statuses, and where failures lie."""

import numpy as np

from ..description.tube_model import MODELS
from ..status import NOT_CONVERGED, OK, STATUSES
from .audit import HELD, Audit
from .designs import BLOCK, COLUMNS, PRESSURES, draw, with_pressures, words

KINDS = ("free", "locked", *HELD)
KEPT = 20_000  # states of one kind and status whose designs are kept, for the ranges they lie in
MIDDLE, APART = (0.05, 0.95), 0.15  # of them; and the share of a usual range by which an end has to differ to be told
LISTED = 8  # states of each kind without a result for no physical reason that are printed in full


class Census:
    """What was counted: ``counts`` maps kind -> status -> states; ``kept`` (kind, status) -> designs with pressures."""

    def __init__(self, designs, seed, model=MODELS["source"]):
        self.designs, self.seed = designs, seed
        self.counts = {kind: dict.fromkeys(range(len(STATUSES)), 0) for kind in KINDS}
        self.kept = {}
        self.audit = Audit(model)

    def add(self, kind, designs, status):
        """Count states (n,) and keep their designs (n, 10) where there is no plain result."""
        for value in np.unique(status).tolist():
            self.counts[kind][value] += int(np.count_nonzero(status == value))
            if value != OK:
                kept = self.kept.setdefault((kind, value), [])
                if sum(map(len, kept)) < KEPT:
                    kept.append(designs[status == value])

    def figures(self) -> dict:
        """What was counted and audited, as JSON takes it; of each kind the designs that failed for no physical reason."""
        counts = {
            kind: {STATUSES[value].meaning: number for value, number in own.items()}
            for kind, own in self.counts.items()
        }
        failed = {kind: [dict(zip(COLUMNS, row)) for row in rows.tolist()] for kind, rows in self._failed().items()}
        return {
            "designs": self.designs, "seed": self.seed, "pressures": PRESSURES, "model": self.audit.model._asdict(),
            "counts": counts, "not_converged": failed, "audit": self.audit.figures(),
        }  # fmt: skip

    def report(self) -> str:
        """Counts, the ranges in which failures lie, and the audit, in words."""
        model = self.audit.model
        head = f"{self.designs:,} random designs, seed {self.seed}, {PRESSURES} pressures each"
        tubes = f"{model.wall_model} walls, {model.fibers} fibers at the {model.fiber_radius} radius"
        lines = [
            head + ("" if model.is_loose else ", both strain energies") + (f", {tubes}" if model.is_physical else "")
        ]
        for kind in KINDS:
            total = sum(self.counts[kind].values())
            lines += ["", f"{kind}: {total:,} states"]
            for value, number in self.counts[kind].items():
                if number:
                    lines.append(f"  {number:>12,}  {STATUSES[value].meaning}{self._ranges(kind, value)}")
        lines += ["", *self._defects(), *self.audit.report()]
        return "\n".join(lines)

    def _ranges(self, kind, value):
        """Where the states of one status lie: the middle nine tenths of the parameters that set them apart."""
        if (kind, value) not in self.kept:
            return ""
        designs, usual = np.concatenate(self.kept[kind, value]), self._usual()
        apart = []
        for name, column, (least, most) in zip(COLUMNS, designs.T, usual):
            low, high = np.quantile(column, MIDDLE)
            if np.isfinite(high) and (low > least + APART * (most - least) or high < most - APART * (most - least)):
                apart.append(f"{name} {low:.3g}..{high:.3g}" if low < high else f"{name} {low:.3g}")
        return f": {', '.join(apart)}" if apart else ""

    def _usual(self):
        """The same of all designs, from a few blocks."""
        blocks = [draw(BLOCK, self.seed, block, self.audit.model) for block in range(4)]
        every = np.concatenate(
            [with_pressures(block.designs, block.pressures).reshape(-1, len(COLUMNS)) for block in blocks]
        )
        return np.quantile(every, MIDDLE, axis=0).T

    def _failed(self):
        """Designs (n, 10) of the states that failed for no physical reason, by kind."""
        return {kind: np.concatenate(kept) for (kind, value), kept in self.kept.items() if value == NOT_CONVERGED}

    def _defects(self):
        """States that failed for no physical reason, some of each kind in full."""
        found = self._failed()
        total = sum(self.counts[kind][NOT_CONVERGED] for kind in KINDS)
        lines = [f"{total:,} not_converged" if total else "every state is solved, or has a physical reason"]
        return lines + [f"  {kind}: {words(row)}" for kind, rows in found.items() for row in rows[:LISTED]]
