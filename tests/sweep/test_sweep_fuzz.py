"""Random specifications through parser and planner, random kills of real sweeps, races for one output."""

import os
import random
import re
import subprocess
import sys
import time

import numpy as np
import pytest
from grids import CHILD_ENVIRONMENT, spec
from shards import same_bits

from freesweep import open_atlas
from freesweep.atlas.schema import PARAMETERS
from freesweep.atlas.seal import seal_fault
from freesweep.cli import BAD_INPUT, DONE
from freesweep.sweep import estimate
from freesweep.sweep.plan import NONE, plan
from freesweep.sweep.spec import SpecificationError, parse

USUAL = {
    **{"alpha": (-89, 89), "beta": (-89, 89), "length": (20, 400), "radius": (2, 10), "wall": (0.5, 3)},
    **{"fiber_radius": (2, 12), "fiber_extension": (1, 1.02), "c10": (50, 500)},
    **{"c01": (0, 200), "c20": (-5, 50), "c30": (-0.1, 5)},
    **{"force": (-5, 20), "torque": (-20, 20), "held_length": (20, 400), "held_length_ratio": (0.7, 1.2)},
    **{"held_rotation": (-90, 90), "pressure": (0, 400)},
}
UNITS = {"m": "mm", "Pa": "kPa", "N": "N", "N m": "mN m", "degree": "deg"}
RARE = [*USUAL][5:7] + [*USUAL][8:16]
LOADS = [*USUAL][11:]
ODD = ["nan", "-1", "true", '"x"', "[]", "{}", '"4 furlong"', '"1e3 Pa"', "[[0, 1], [1, 2]]", "1e400"]


class Author:
    """Writes specifications that are nearly right."""

    def __init__(self, seed):
        self.random = random.Random(seed)

    def chance(self, share):
        return self.random.random() < share

    def number(self, name):
        if name in ("alpha", "beta") and self.chance(0.1):
            return self.random.choice([0.0, 30.0, -30.0, 1e-9, 89.9999])
        return round(self.random.uniform(*USUAL[name]), self.random.choice([0, 1, 6]))

    def value(self, name, number=None):
        if self.chance(0.002):
            return self.random.choice(ODD)
        unit = UNITS.get(PARAMETERS[name].units)
        number = self.number(name) if number is None else number
        return f'"{number} {unit}"' if unit else str(number)

    def axis(self, name):
        numbers = sorted({self.number(name) for _ in range(self.random.randint(1, 4))})
        if self.chance(0.5):
            return f"[{', '.join(self.value(name, number) for number in numbers)}]"
        low, high = self.value(name, numbers[0]), self.value(name, numbers[-1])
        count = self.random.choice([2, 3, 10, 100]) if len(numbers) > 1 else 1
        return f"{{start = {low}, stop = {high}, num = {count}}}"

    def profile(self, name):
        shares = [self.random.random() for _ in range(self.random.randint(0, 3))] + [0.5, 0.5] * self.chance(0.3)
        return f"[{', '.join(f'[{share}, {self.value(name)}]' for share in sorted([0, 1, *shares]))}]"

    def text(self):
        tables = {"actuator": [], "load": [], "axes": []}
        for name in USUAL:
            if self.chance(0.7 if name in RARE else 0.002):
                continue
            home = "load" if name in LOADS else "actuator"
            if name in ("alpha", "beta", "wall") and self.chance(0.15):
                tables["actuator"].append(f"{name} = {self.profile(name)}")
            elif self.chance(0.6):
                tables[home].append(f"{name} = {self.value(name)}")
            else:
                tables["axes"].append(f"{name} = {self.axis(name)}")
        text = "\n".join(f"[{name}]\n" + "\n".join(lines) for name, lines in tables.items())
        if self.chance(0.2):
            text += f"\n[solver]\nblocked = {self.random.choice(['true', 'true', 'false', '1'])}"
        if self.chance(0.03):
            cut = self.random.randrange(len(text))
            text = text[:cut] + self.random.choice('[]"{=#\x00é') + text[cut + 1 :]
        return text


def planned(text):
    """Whether a text was planned, or was refused as it should be; how long that took [s of the processor]."""
    begun = time.process_time()
    try:
        sweep = parse(text)
    except SpecificationError as error:
        if not error.faults:
            raise
        return False, time.process_time() - begun
    if sum(estimate.grids(sweep).values()) <= estimate.MOST_PLANNED:
        for table in plan(sweep).values():
            job = table.job(0, min(2, table.count))
            assert np.all(np.isfinite(job.problems))
            at = np.arange(min(100, table.grid.size))
            solved = table.problem[at] != NONE
            assert np.all(table.rows(at)[solved] < table.equilibria)
    assert estimate.disk(sweep, estimate.grids(sweep))[1] > 0
    return True, time.process_time() - begun


def plans(seed, count):
    author = Author(seed)
    made = [planned(author.text()) for _ in range(count)]
    assert max(took for _, took in made) < 1.0
    return sum(good for good, _ in made)


def test_random_specifications_are_planned_or_refused():
    assert 10 < plans(1, 300) < 290  # both ends are met


@pytest.mark.long
def test_a_hundred_thousand_specifications_are_planned_or_refused():
    assert plans(2, 100_000) > 1000


@pytest.mark.long
def test_two_hundred_specifications_through_the_command(tmp_path):
    """Each in a process of its own: planned, or refused in one message; a second of the processor at most, start and all."""
    author, path, planned_ones = Author(4), tmp_path / "spec.toml", 0
    for _ in range(200):
        path.write_text(text := author.text())
        with open(tmp_path / "out", "w+") as out, open(tmp_path / "err", "w+") as err:
            child = subprocess.Popen(
                [sys.executable, "-P", "-m", "freesweep", "sweep", str(path), "--dry-run"],
                env=CHILD_ENVIRONMENT, cwd=tmp_path, stdout=out, stderr=err,
            )  # fmt: skip
            _, child.returncode, used = os.wait4(child.pid, 0)
            out.seek(0), err.seek(0)
            said, complained = out.read(), err.read()
        assert used.ru_utime + used.ru_stime < 1.0, text
        if child.returncode == DONE:
            planned_ones += 1
            assert "grid points, " in said, text
            assert re.search(r"^time: .* on \d+ threads?", said, re.M), text
            assert all(line.startswith("freesweep: warning: ") for line in complained.splitlines()), (text, complained)
        else:
            assert os.waitstatus_to_exitcode(child.returncode) == BAD_INPUT, (text, complained)
            assert said == "", text
            first, *faults = complained.splitlines()
            assert first.startswith(f"freesweep: {path}: "), (text, complained)
            assert all(line.startswith("  ") for line in faults), (text, complained)
        assert sorted(found.name for found in tmp_path.iterdir()) == ["err", "out", "spec.toml"]
    assert 10 < planned_ones < 190  # both ends are met


CHILD = """
import sys
from freesweep.cli import main
from freesweep.sweep import run
run.SHARD_EQUILIBRIA = 64
sys.exit(main(sys.argv[1:]))
"""
AXES = {
    **{"alpha": [-20.0, 5.0, 40.0, 50.0], "beta": [-50.0, -30.0, 20.0, 70.0], "length": [0.05, 0.07, 0.1]},
    **{"held_rotation": [0.0, 3.0], "pressure": np.linspace(0.0, 1e5, 20).tolist()},
}


@pytest.fixture(scope="module")
def begin(tmp_path_factory):
    """Starts the sweep of AXES in a process of its own."""
    text = tmp_path_factory.mktemp("spec") / "spec.toml"
    text.write_text(spec(AXES))
    words = [sys.executable, "-P", "-c", CHILD, "sweep", str(text), "--quiet", "-o"]
    return lambda out: subprocess.Popen([*words, str(out)], env=CHILD_ENVIRONMENT, stderr=subprocess.PIPE, text=True)


@pytest.fixture(scope="module")
def whole(begin, tmp_path_factory):
    """The atlas of an undisturbed sweep, and how long that took [s] once the kernels were compiled."""
    folder = tmp_path_factory.mktemp("whole")
    assert begin(folder / "first.nc").communicate()[1] == ""
    out, begun = folder / "atlas.nc", time.perf_counter()
    assert begin(out).communicate()[1] == ""
    with open_atlas(out) as atlas:
        return atlas.data.load(), time.perf_counter() - begun


@pytest.mark.long
def test_a_hundred_random_kills_cost_time_and_no_bit(begin, whole, tmp_path):
    data, took = whole
    draw, kills, out = random.Random(3), 0, tmp_path / "atlas.nc"
    while kills < 100:
        child = begin(out)
        try:
            child.wait(timeout=draw.uniform(0.1, 1.1) * took)
        except subprocess.TimeoutExpired:
            child.kill()
            kills += 1
        error = child.communicate()[1]
        assert error == ""
        if out.exists():
            assert seal_fault(out) is None
        if child.returncode == DONE:
            with open_atlas(out) as atlas:
                same_bits(data, atlas.data.load())
            assert [path.name for path in tmp_path.iterdir()] == ["atlas.nc"]
            out.unlink()


@pytest.mark.long
@pytest.mark.parametrize("count", [2, 5, 8])
def test_sweeps_that_race_for_one_output_make_it_once(count, begin, whole, tmp_path):
    out = tmp_path / "atlas.nc"
    children = [begin(out) for _ in range(count)]
    errors = [child.communicate()[1] for child in children]
    assert {child.returncode for child in children} <= {DONE, BAD_INPUT}
    assert DONE in {child.returncode for child in children}
    assert all("another process is sweeping into" in error for error in errors if error)
    with open_atlas(out) as atlas:
        same_bits(whole[0], atlas.data.load())
    assert [path.name for path in tmp_path.iterdir()] == ["atlas.nc"]
