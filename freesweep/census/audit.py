"""Error bounds of a census held against a finer mesh, and where the two contradict each other, against quadrature."""

import numpy as np

from ..description.tube_model import MODELS
from ..scaling import ALONG, OUTPUTS
from ..status import VALUED
from .designs import COLUMNS, quadrature, quadrature_held, words

FINER = 4  # times as many cells has the finer mesh
HELD = ("blocked_force", "blocked_torque")
ROUNDING = 1e-12  # of what an output is measured by: smaller differences are the reference's own rounding
LISTED = 8  # broken bounds that are printed in full


class Audit:
    """Bounds that hold and others: ``ratios`` maps output -> bound/difference, arrays; ``breaches`` are broken bounds."""

    def __init__(self, model=MODELS["source"]):
        self.model, self.outputs = model, (*OUTPUTS, *(ALONG if model.is_physical else ()))
        self.states, self.bounds, self.differing, self.acquitted = 0, 0, 0, 0
        self.ratios = {name: [] for name in (*self.outputs, *HELD)}  # where the two differ by more than rounding
        self.compared = dict.fromkeys(self.ratios, 0)
        self.breaches = []  # (output, difference/bound, design)

    def free(self, designs, states, finer):
        """Records of free or locked states of ``designs`` (n, 10), and those of a finer mesh."""
        designs, states, finer = self._with_both(designs, states, finer)
        values, others = states["values"], finer["values"]

        def judge(rows):
            if self.model.is_physical:
                return np.full(
                    (2, len(rows), len(self.outputs)), np.nan
                )  # the second method knows the source's tubes only
            return quadrature(designs[rows], values[rows, -1])

        self._compare(
            self.outputs, designs, values, others, states["bounds"], finer["bounds"], _measures(designs, others), judge
        )

    def held(self, kind, designs, states, finer):
        """The same for states that hold the undeformed length or rotation."""
        designs, states, finer = self._with_both(designs, states, finer)
        one = slice(None), np.newaxis
        values, others = states["value"][one], finer["value"][one]
        loads = np.abs(designs[:, [COLUMNS.index(name) for name in ("pressure", "force", "torque")]])

        def judge(rows):
            if self.model.is_physical:
                return np.full((2, len(rows), 1), np.nan)
            exact, own = quadrature_held(kind, designs[rows], values[rows, 0])
            return exact[one], own[one]

        measure = np.maximum(np.max(loads, axis=1)[one], np.abs(others))
        self._compare((kind,), designs, values, others, states["bound"][one], finer["bound"][one], measure, judge)

    def _with_both(self, designs, states, finer):
        """What has a result on both meshes."""
        valued = np.isin(states["status"], VALUED), np.isin(finer["status"], VALUED)
        self.differing += int(np.count_nonzero(valued[0] != valued[1]))
        both = valued[0] & valued[1]
        self.states += int(np.count_nonzero(both))
        return designs[both], states[both], finer[both]

    def _compare(self, names, designs, values, others, bounds, other_bounds, measure, judge):
        """Values (n, k) with those of the finer mesh; ``judge`` gives values and errors of rows by the second method."""
        bounds, difference = bounds.astype(float), np.abs(values - others)
        self.bounds += values.size
        seen = difference > np.maximum(ROUNDING * measure, other_bounds)  # else it may be the reference's own error
        for k, name in enumerate(names):
            self.compared[name] += len(values)
            self.ratios[name].append(bounds[seen[:, k], k] / difference[seen[:, k], k])
        apart = difference > bounds + other_bounds
        if (rows := np.flatnonzero(apart.any(axis=1))).size:
            exact, own = judge(rows)
            missed = np.abs(values[rows] - exact)
            missed = np.where(np.isnan(missed), difference[rows], missed)
            for row, k in np.argwhere(apart[rows]).tolist():
                if missed[row, k] <= bounds[rows[row], k] + np.nan_to_num(own[row, k]):
                    self.acquitted += 1
                else:
                    self.breaches.append((names[k], missed[row, k] / bounds[rows[row], k], designs[rows[row]]))

    def figures(self) -> dict:
        """All this in numbers, as JSON takes them."""
        ratios = {}
        for name, compared in self.compared.items():
            every = np.concatenate(self.ratios[name]) if self.ratios[name] else np.empty(0)
            told = {"median": float(np.median(every)), "least": float(np.min(every))} if len(every) else {}
            ratios[name] = {"compared": compared, "differing": len(every), **told}
        broken = [
            {"output": name, "ratio": float(ratio), "design": dict(zip(COLUMNS, row.tolist()))}
            for name, ratio, row in self.breaches
        ]
        return {
            "finer": FINER, "states": self.states, "bounds": self.bounds, "broken": broken, "acquitted": self.acquitted,
            "on_one_mesh_only": self.differing, "bound_over_difference": ratios,
        }  # fmt: skip

    def report(self) -> list[str]:
        """All this in words, line by line."""
        if not self.states:
            return []
        broken = len(self.breaches)
        lines = [
            "",
            f"bounds held against a mesh {FINER} times finer: {self.states:,} states, {self.bounds:,} bounds, {broken:,}"
            f" broken ({100.0 * broken / self.bounds:.3g} %); {self.differing:,} states with a result on one mesh only",
        ]
        if self.acquitted:
            lines.append(
                f"  {self.acquitted:,} more seemed broken, but quadrature of the first integral confirms them: the finer"
                " mesh is off"
            )
        lines.append("  bound/difference, where the difference is more than the finer mesh's own rounding:")
        for name, ratios in self.ratios.items():
            if not self.compared[name]:
                continue
            all_of = np.concatenate(ratios)
            left_out = f"{self.compared[name] - len(all_of):,} of {self.compared[name]:,} left out"
            if len(all_of):
                left_out = f"median {np.median(all_of):.3g}, least {np.min(all_of):.3g}; {left_out}"
            lines.append(f"  {name:<16} {left_out}")
        worst = sorted(self.breaches, key=lambda breach: -breach[1])[:LISTED]
        return lines + [f"  {name} off by {ratio:.3g} times its bound: {words(row)}" for name, ratio, row in worst]


def _measures(designs, values):
    """By what a difference of each output of half a tube counts, (n, k): undeformed length, the volume itself, half a radian
    or the rotation itself, the energy itself, and the undeformed radius; shares of the length by all of it.
    """
    _, volume, turn, energy, *rest = np.abs(values).T
    half = 0.5 * designs[:, COLUMNS.index("length/radius")]
    return np.column_stack([half, volume, np.maximum(0.5, turn), energy, *(np.ones(len(half)) for _ in rest)])
