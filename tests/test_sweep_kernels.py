"""Machine code is at hand before threads need it: of each kind of states, family of rubbers, and of tubes that vary."""

import numba
import pytest
from grids import make, spec

from freesweep.solver import batch, hold_batch
from freesweep.solver.lanes import hold, walk
from freesweep.sweep import kernels, run
from freesweep.sweep.spec import parse

AXES = {"alpha": [30.0, 40.0], "beta": [-50.0, -20.0], "pressure": [5e4, 1e5]}
FREE = spec(AXES)
VECTORS = {"carry_lanes", "solve_lanes"}


@pytest.mark.parametrize(
    ("text", "needed"),
    [
        (FREE, VECTORS),
        (f"{FREE}\n[solver]\nblocked = true", VECTORS | {"seek_lanes"}),
        (spec(AXES, fixed={"c20": 2e4, "c01": 0.0}), VECTORS),
        (spec(AXES | {"c20": [0.0, 2e4]}, fixed={"c01": 0.0}), VECTORS),
        (FREE.replace("wall = 0.00159", "wall = [[0, 1e-3], [1, 2e-3]]"), {"walk_many"}),
    ],
    ids=["free", "held", "Yeoh", "both families", "varying"],
)
def test_kernels_are_loaded_before_the_threads_begin(text, needed, tmp_path, monkeypatch):
    """Whatever a shard calls has been called with numbers of the same types: has been compiled."""
    called = set()

    def noting(kernel):
        def noted(*given):
            called.add((kernel.__name__, *map(numba.typeof, given)))
            return kernel(*given)

        return noted

    def then(function, found):
        def noted(*given):
            called.clear()
            result = function(*given)
            found.update(called)
            return result

        return noted

    entries = [(walk, "carry_lanes"), (walk, "solve_lanes"), (hold, "seek_lanes")]
    for module, name in [*entries, (batch, "walk_many"), (hold_batch, "block_many")]:
        monkeypatch.setattr(module, name, noting(getattr(module, name)))
    early, late = set(), set()
    monkeypatch.setattr(kernels, "load", then(kernels.load, early))
    monkeypatch.setattr(run, "solve_shard", then(run.solve_shard, late))
    make(tmp_path / "atlas.nc", parse(text), threads=1)
    assert {name for name, *_ in late} == needed
    assert late == early
