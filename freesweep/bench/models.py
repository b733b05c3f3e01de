"""What the models of a tube cost beside each other: the same designs, solved by vectors of designs on one core."""

import numpy as np

from ..solver.physics.wall import BONDED, LOOSE
from ..solver.status import OK

MODELS = {  # whether the wall is thick, and its threads; fibers lie outside of all but the source's
    "membrane, bonded": (False, BONDED),
    "thick, bonded": (True, BONDED),
    "membrane, loose": (False, LOOSE),
    "thick, loose": (True, LOOSE),
}
SOURCE = "membrane, bonded"


def as_model(problems, thick, threads) -> np.ndarray:
    """The source's tubes (n, 11) as those of another model (n, 13), in units of their outer radius, where the fibers lie."""
    rows = np.column_stack([problems, np.zeros(len(problems)), np.full(len(problems), threads)])
    square = 1.0 + problems[:, 2]
    rows[:, 2] /= square
    rows[:, 8] /= np.sqrt(square)
    rows[:, 11] = float(thick) / square
    return rows


def models(chosen, accuracy, clocked) -> list:
    """Seconds for each state of a sample by each model, along the pressures as in a sweep, times the source's, and the share
    of states that vectors solve; ``clocked(run)`` gives seconds and what ``run`` returned.
    """
    from ..solver.batch import walk_by_vectors

    problems, first, pressures = chosen.listed()
    found = []
    for name, (thick, threads) in MODELS.items():
        rows = problems if name == SOURCE else as_model(problems, thick, threads)
        walk_by_vectors(rows[:1], first[:2], pressures[: first[1]], accuracy)  # compiles, or loads what is compiled
        seconds, walks = clocked(lambda rows=rows: walk_by_vectors(rows, first, pressures, accuracy))
        found.append({"model": name, "seconds": seconds / len(pressures), "solved": float(np.mean(walks.status == OK))})
    for row in found:
        row["times_source"] = row["seconds"] / found[0]["seconds"]
    return found
