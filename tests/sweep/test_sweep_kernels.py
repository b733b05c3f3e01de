"""Machine code is at hand before threads need it: of each kind of states, family of rubbers, and of tubes that vary."""

import contextlib
import subprocess
import sys
from pathlib import Path

import numba
import numpy as np
import pytest
from grids import CHILD_ENVIRONMENT, make, spec

from freesweep.solver import batch, hold_batch
from freesweep.solver.lanes import free, held
from freesweep.sweep import kernels, run
from freesweep.sweep.spec import parse, read_file

AXES = {"alpha": [30.0, 40.0], "beta": [-50.0, -20.0], "pressure": [5e4, 1e5]}
FREE = spec(AXES)
QUICK = Path(__file__).parents[2] / "sweeps" / "quick.toml"
VECTORS = {"carry_lanes", "solve_lanes"}


@pytest.mark.parametrize(
    ("text", "needed"),
    [
        (FREE, VECTORS),
        (f"{FREE}\n[solver]\nblocked = true", VECTORS | {"start_lanes"}),
        (spec(AXES | {"held_length_ratio": [0.95, 1.0]}), VECTORS | {"start_lanes", "move_lanes"}),
        (spec(AXES, fixed={"c20": 2e4, "c01": 0.0}), VECTORS),
        (spec(AXES | {"c20": [0.0, 2e4]}, fixed={"c01": 0.0}), VECTORS),
        (FREE.replace("wall = 0.00159", "wall = [[0, 1e-3], [1, 2e-3]]"), {"follow_many"}),
        (FREE.replace("[actuator]", '[actuator]\nmodel = "physical"'), {"carry_physical", "solve_physical"}),
    ],
    ids=["free", "held at rest", "held", "Yeoh", "both families", "varying", "physical"],
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

    entries = [(free, f"{does}_{tubes}") for does in ("carry", "solve") for tubes in ("lanes", "physical")]
    entries += [(held, f"{does}_lanes") for does in ("start", "move")]
    for module, name in [*entries, (batch, "follow_many"), (hold_batch, "hold_many")]:
        monkeypatch.setattr(module, name, noting(getattr(module, name)))
    early, late, idle = set(), set(), set()
    monkeypatch.setattr(kernels, "load", then(kernels.load, early))
    monkeypatch.setattr(run, "solve_shard", then(run.solve_shard, late))
    make(tmp_path / "atlas.nc", parse(text), threads=1)
    assert {name for name, *_ in late} == needed
    assert late == early
    families = ["Yeoh"] * ("c20" in text) + ["Mooney-Rivlin"] * ("c20 = 2" not in text)
    then(kernels.compile_idle, idle)([*families, *needed])  # as other processes do
    assert idle == (set() if "follow_many" in needed else late)


def test_a_first_sweep_needs_no_scalar_kernel(tmp_path, monkeypatch):
    """They take the compiler minutes: all of the quick design space, and of its own measurement, is done by vectors."""

    def never(*_):
        raise AssertionError("a scalar kernel is needed")

    monkeypatch.setattr(batch, "follow_many", never)
    monkeypatch.setattr(hold_batch, "hold_many", never)
    found = make(tmp_path / "atlas.nc", QUICK)
    assert set(np.unique(found["status"])) == {0, 1}
    assert "interpolation_measured" in found.attrs


MEASURING = """
import sys
from numba.core.dispatcher import Dispatcher
from freesweep import run_sweep
from freesweep.query.idle import compile_kernels

def compiled():
    modules = [module for name, module in sys.modules.items() if name.startswith("freesweep.query")]
    kernels = [named for module in modules for named in vars(module).items() if isinstance(named[1], Dispatcher)]
    return {(name, types) for name, kernel in kernels for types in kernel.signatures}

compile_kernels()
early = compiled()
run_sweep(sys.argv[1], sys.argv[2], progress=False).close()
print(len(early), compiled() - early)
"""


def test_what_an_atlas_measures_itself_with_is_compiled_before_there_is_one(tmp_path):
    words = [sys.executable, "-c", MEASURING, str(QUICK), str(tmp_path / "atlas.nc")]
    done = subprocess.run(words, capture_output=True, text=True, env=CHILD_ENVIRONMENT)
    count, _, late = done.stdout.partition(" ")
    assert int(count) > 10, done.stderr
    assert late.strip() == "set()"


class Finished(contextlib.nullcontext):
    """A process that has ended."""

    def __enter__(self):
        return self

    def kill(self):
        pass

    def wait(self):
        pass


@pytest.mark.parametrize(
    ("stored", "wanted"),
    [
        ((), [{"solve_lanes"}, {"carry_lanes", "query"}]),
        (("carry_lanes", "interpolate"), [{"solve_lanes"}]),
        (("carry_lanes", "solve_lanes", "interpolate"), []),
    ],
)
def test_two_processes_compile_what_does_not_lie_on_disk(stored, wanted, monkeypatch, capsys):
    """And one line says so, where there is anything to compile."""
    begun = []
    monkeypatch.setattr(kernels, "_stored", lambda room: {*stored})
    monkeypatch.setattr(kernels.subprocess, "Popen", lambda words, **_: begun.append(words[5:]) or Finished())
    kernels.load(["free"], read_file(QUICK), progress=True)
    assert [{*words} for words in begun] == wanted
    assert capsys.readouterr().out.count("compiling the kernels in two processes") == bool(wanted)
