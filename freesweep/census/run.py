"""Solves the designs of a census on threads, and counts what became of them."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np

from ..description.tube_model import DEFAULT, MODELS, word_faults
from .audit import FINER, HELD
from .count import Census
from .designs import BLOCK, COLUMNS, PRESSURES, draw, together, with_pressures

HELD_EVERY = 16  # one design in that many is also held at its length and at its rotation
BLOCKS = 8  # solved together: where branches have to be followed, many are as quick as few
ACCURACY, AUDIT_ACCURACY = 1e-6, 1e-10


def census(count, seed=0, *, audit=1000, threads=None, progress=True, model=DEFAULT) -> Census:
    """Draw ``count`` designs of tubes of a ``model``, solve them, count their statuses, and audit the bounds of about
    ``audit`` states.

    Raises ValueError for numbers below what makes sense. No result depends on ``threads`` (default: one for each core).
    """
    from ..sweep.estimate import cores

    faults = [f"{name}: found {n}; give 1 or more" for name, n in (("N", count), ("threads", threads or 1)) if n < 1]
    faults += [f"audit: found {audit}; give 0 or more"] if audit < 0 else []
    faults += [f"seed: found {seed}; give 0 or more"] if seed < 0 else []
    faults += word_faults(model, None, None, "full", ("full",))
    if faults:
        raise ValueError("\n".join(faults))
    blocks = -(-count // BLOCK)
    audited = -(-audit // (blocks * (PRESSURES + 1)))  # designs of each block
    model = MODELS[model]
    found = Census(count, seed, model)

    def run(first):
        sizes = [min(BLOCK, count - block * BLOCK) for block in range(first, min(first + BLOCKS, blocks))]
        drawn = together([draw(size, seed, first + k, model) for k, size in enumerate(sizes)])
        return sum(sizes), *_solve(drawn, np.concatenate([np.arange(size) < audited for size in sizes]), model)

    _solve(draw(1, seed, 0, model), np.zeros(1, bool), model)  # compiles, or loads what is compiled
    with ThreadPoolExecutor(threads or cores()) as pool, _bar(count, progress) as bar:
        for first in range(0, blocks, 16 * BLOCKS):  # a few at a time: what is done is counted and let go
            for size, counted, compared in pool.map(run, range(first, min(first + 16 * BLOCKS, blocks), BLOCKS)):
                for kind, designs, status in counted:
                    found.add(kind, designs, status)
                for kind, *pair in compared:
                    found.audit.held(kind, *pair) if kind in HELD else found.audit.free(*pair)
                bar.update(size)
    return found


def _solve(drawn, audited, model):
    """Of all states of blocks ``(kind, designs with pressures, status)``, and of those of the ``audited`` designs (n,)
    ``(kind, designs with pressures, records, those of a finer mesh)``.
    """
    from ..sweep.plan import FREE, Job
    from ..sweep.solve import solve_shard

    problems, count = drawn.problems(model), len(drawn.designs)
    nothing = np.zeros(count)
    pressures = np.column_stack([drawn.pressures, np.full(count, np.inf)])
    first = np.arange(count + 1, dtype=np.int64) * pressures.shape[1]
    job = Job(FREE, problems, nothing, first, pressures.ravel(), [], nothing)
    states, _ = solve_shard(job, ACCURACY)
    counted, compared = [], []
    grid = states["status"].reshape(count, -1)
    rows = with_pressures(drawn.designs, drawn.pressures)
    counted.append(("free", rows.reshape(-1, len(COLUMNS)), grid[:, :-1].ravel()))
    counted.append(("locked", rows[:, -1], grid[:, -1]))
    if np.any(audited):
        every = with_pressures(drawn.designs[audited], pressures[audited]).reshape(-1, len(COLUMNS))
        compared.append((FREE, every, states.reshape(count, -1)[audited].ravel(), _finer(job, audited)))
    some = slice(0, count, HELD_EVERY)
    for kind, load, target in zip(HELD, (6, 7), (problems[:, 8], nothing)):
        held, unloaded = problems[some].copy(), drawn.designs[some].copy()
        held[:, load], unloaded[:, load] = 0.0, 0.0
        each = np.arange(len(held) + 1, dtype=np.int64)
        job = Job(kind, held, target[some], each, drawn.pressures[some, -1].copy(), [], nothing[some])
        designs = with_pressures(unloaded, drawn.pressures[some, -1:])[:, 0]
        states, _ = solve_shard(job, ACCURACY)
        counted.append((kind, designs, states["status"]))
        if np.any(audited[some]):
            compared.append((kind, designs[audited[some]], states[audited[some]], _finer(job, audited[some])))
    return counted, compared


def _finer(job, audited):
    """Records of the ``audited`` of a job's problems (n,), by meshes, and those finer ones."""
    from ..sweep import solve
    from ..sweep.plan import FREE

    each = np.diff(job.first)
    first = np.concatenate([[0], np.cumsum(each[audited])])
    edges = np.array([0, FINER * solve.BASE_CELLS])
    exact = (solve.UNIFORM[0], edges, solve.UNIFORM[2]), 0.0  # no profile, no error of one
    of_kind = solve._solve_free if job.kind == FREE else solve._solve_held
    problems, targets, pressures = job.problems[audited], job.targets[audited], job.pressures[np.repeat(audited, each)]
    return of_kind(job.kind, problems, targets, first, pressures, exact, AUDIT_ACCURACY, lanes=False)[0]


def _bar(total, progress):
    from tqdm.auto import tqdm

    return tqdm(total=total, unit=" designs", unit_scale=True, disable=not progress, dynamic_ncols=True)
