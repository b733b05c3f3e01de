"""Sweeps from Python's arguments: the specification, the bits and the atlas of a file that says the same."""

import contextlib
import inspect
import warnings

import numpy as np
import pytest
from grids import FIXED, make
from odd import ODD

import freesweep as fs
from freesweep.sweep.faults import SpecificationError
from freesweep.sweep.spec import parse
from freesweep.sweep.written import sweep_of

TOML = """
title = "Two \\"ways\\" to one sweep, hé"
[actuator]
length = "100 mm"
radius = 4.76e-3
wall = [[0, "1.59 mm"], [1, 1.2e-3]]
material = "natural-latex"
model = "physical"
fiber_radius = "middle"
[load]
force = "0.1 lbf"
[axes]
alpha = {start = 0, stop = "80 deg", step = 20}
beta = [-70.1, 85]
pressure = {start = "0 kPa", stop = "300 kPa", num = 5, spacing = "sqrt"}
[[designs]]
name = "A"
fiber_extension = 1.005
[[designs]]
name = "B"
[solver]
accuracy = 1e-7
blocked = true
budget = 10_000
interpolation_tolerance = 1e-3
"""
GIVEN = {
    "title": 'Two "ways" to one sweep, hé',
    "length": "100 mm",
    "radius": np.float64(4.76e-3),
    "wall": [(0, "1.59 mm"), (1, 1.2e-3)],
    "material": fs.material("natural-latex"),
    "model": "physical",
    "fiber_radius": "middle",
    "force": "0.1 lbf",
    "alpha": (0, "80 deg", 20),
    "beta": np.array([-70.1, 85.0]),
    "pressure": {"start": "0 kPa", "stop": "300 kPa", "num": np.int64(5), "spacing": "sqrt"},
    "designs": [{"name": "A", "fiber_extension": 1.005}, {"name": "B"}],
    "accuracy": 1e-7,
    "blocked": True,
    "budget": 10_000,
    "interpolation_tolerance": 1e-3,
}
PLAIN = {name: value for name, value in FIXED.items() if name != "length"}


def same(one, other):
    """Whether two values of sweeps are equal, arrays in dictionaries included."""
    if isinstance(one, dict):
        return list(one) == list(other) and all(same(one[name], other[name]) for name in one)
    return np.array_equal(one, other) if isinstance(one, np.ndarray) else one == other


def test_arguments_and_a_file_make_one_specification():
    asked, written = sweep_of(GIVEN), parse(TOML)
    for name, value in vars(written).items():
        assert name == "text" or same(value, getattr(asked, name)), name


class Millimetres:
    """What carries units and can be converted, as of other libraries."""

    units = "mm"

    def __init__(self, value):
        self.value = value

    def to(self, unit):
        assert unit == "m"
        found = Millimetres(np.asarray(self.value) * 1e-3)
        found.magnitude = found.value
        return found


def test_arguments_with_units_are_axes_in_metres():
    asked = sweep_of(PLAIN | {"alpha": 20, "beta": [-50], "length": Millimetres([100.0, 250.0]), "pressure": ["1 bar"]})
    assert asked.axes["length"].tolist() == [0.1, 0.25]
    assert asked.axes["pressure"].tolist() == [1e5]
    assert asked.fixed["alpha"] == 20.0


def test_a_sweep_from_python_has_the_bits_of_the_file_that_it_keeps(tmp_path):
    given = PLAIN | {"alpha": [20, 30], "beta": -50, "length": "100 mm", "pressure": (0, 5e4, 5e4)}
    with fs.sweep(**given, out=tmp_path / "python.nc", progress=False, threads=1) as atlas:
        mine = atlas.data.load()
    kept = tmp_path / "kept.toml"
    kept.write_text(mine.attrs["specification"], encoding="utf-8")
    with fs.run_sweep(kept, tmp_path / "kept.nc", progress=False, threads=1) as atlas:
        again = atlas.data.load()
    del mine.attrs["started"], again.attrs["started"]
    assert mine.identical(again)
    lines = ["[actuator]", *(f"{name} = {value}" for name, value in FIXED.items()), "beta = -50"]
    text = "\n".join([*lines, "[axes]", "alpha = [20, 30]", "pressure = {start = 0, stop = 5e4, num = 2}"])
    assert make(tmp_path / "own.nc", parse(text)).equals(mine)


def test_every_fault_of_the_arguments_is_told_at_once():
    odd = {
        "alpha": lambda share: share,
        "beta": (1, 2),
        "length": [1, None],
        "radius": [2, 1],
        "material": 3,
        "pressure": "1 mm",
        "designs": [7],
    }
    with pytest.raises(SpecificationError) as caught:
        sweep_of(odd)
    told = "\n".join(caught.value.faults)
    for part in (
        "alpha: found a function",
        "beta: found a tuple of 2",
        "length: found list",
        "axes.radius: values must increase",
        "material: found int 3",
        "load.pressure: expects a pressure",
        "designs[0]: found int 7",
        "wall: is missing",
    ):
        assert part in told, part
    assert "alpha: is missing" not in told
    assert "c10: is missing" not in told
    assert "wall: is missing; give wall=" in told  # no tables of TOML


def test_odd_arguments_give_faults_and_nothing_else():
    given = PLAIN | {"alpha": 20, "beta": [-50], "length": 0.1, "pressure": [0.0], "designs": [{"name": "A"}]}
    for name in (*given, "material", "title", "energy", "accuracy", "blocked", "budget", "fiber_radius"):
        for odd in ODD:
            with warnings.catch_warnings(), contextlib.suppress(SpecificationError):
                warnings.simplefilter("ignore")
                sweep_of(given | {name: odd})


def test_slips_of_units_are_told_at_the_line_that_made_them(tmp_path):
    given = PLAIN | {"alpha": 0.5, "beta": -0.9, "length": 0.1, "pressure": [0.0, 5e4]}
    with pytest.warns(UserWarning, match="as if they were radians") as caught:
        fs.sweep(**given, out=tmp_path / "atlas.nc", progress=False, threads=1).close()
    assert {warning.filename for warning in caught} == {__file__}


def test_the_function_and_its_room_share_their_name():
    assert inspect.signature(fs.sweep).parameters.keys() >= {"alpha", "out", "pressure", *GIVEN}
    assert fs.sweep.spec.parse is parse
