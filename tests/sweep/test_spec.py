"""Sweep specifications: what a file means, every fault at once, and hostile text refused at once."""

import os
import pickle
import random
import time
from pathlib import Path

import numpy as np
import pytest

from freesweep.atlas.schema import HELD, PARAMETERS, SHAPE, YEOH
from freesweep.description.tube_model import MODELS
from freesweep.description.units import quantity
from freesweep.sweep import toml_guard
from freesweep.sweep.spec import MAX_POINTS, SpecificationError, parse, read_file

SWEEPS = Path(__file__).parents[2] / "sweeps"

VALID = """
title = "A sweep"
[actuator]
radius = "4.76 mm"
wall = 1.59e-3
c10 = "0.11 MPa"
[axes]
pressure = {start = "0 kPa", stop = "200 kPa", num = 41}
beta = {start = -85, stop = 85, num = 35}
alpha = {start = "0 deg", stop = "85 deg", step = "2.5 deg"}
length = ["100 mm", 0.2]
"""
HEAD = VALID.split("[axes]")[0]  # title and [actuator]


def replaced(old, new):
    assert VALID.count(old) == 1
    return VALID.replace(old, new)


def faults_of(text):
    with pytest.raises(SpecificationError) as caught:
        parse(text)
    assert all(fault in str(caught.value) for fault in caught.value.faults)
    return caught.value.faults


def test_a_specification_becomes_fixed_values_and_axes_in_canonical_order():
    sweep = parse(VALID)
    assert sweep.title == "A sweep"
    assert sweep.energy == "full"
    assert sweep.accuracy == 1e-6
    assert sweep.designs is None
    assert sweep.dims == tuple(sweep.axes) == ("alpha", "beta", "length", "pressure")
    assert sweep.shape == (35, 35, 2, 41)
    assert sweep.points == 35 * 35 * 2 * 41
    assert type(sweep.points) is int
    assert sweep.fixed == {
        **{"radius": 0.00476, "wall": 0.00159, "c10": 110000.0},
        **{"c01": 0.0, "fiber_extension": 1.0, "force": 0.0, "torque": 0.0},
    }
    assert list(sweep.fixed) == [name for name in PARAMETERS if name in sweep.fixed]
    assert sweep.axes["alpha"].tolist() == [2.5 * i for i in range(35)]
    assert sweep.axes["beta"].tolist() == [5.0 * i for i in range(-17, 18)]
    assert sweep.axes["length"].tolist() == [0.1, 0.2]
    assert sweep.axes["pressure"].tolist() == [5000.0 * i for i in range(41)]
    for array in sweep.axes.values():
        assert array.dtype == np.float64
        assert not array.flags.writeable


def test_loads_solver_and_energy_are_read():
    sweep = parse(
        replaced(
            "[axes]", 'energy = "principal"\n[load]\nforce = "2 N"\n[solver]\naccuracy = "1e-8"\n[axes]\ntorque=[0,1]'
        )
    )
    assert sweep.energy == "principal"
    assert sweep.fixed["force"] == 2.0
    assert sweep.axes["torque"].tolist() == [0.0, 1.0]
    assert "torque" not in sweep.fixed
    assert sweep.accuracy == 1e-8


def test_the_hash_is_that_of_the_text():
    assert parse(VALID).text == VALID
    assert parse(VALID).sha256 == parse(VALID).sha256
    assert parse(VALID).sha256 != parse(VALID + "\n# a comment").sha256
    assert len(parse(VALID).sha256) == 64


@pytest.mark.parametrize(
    ("spacing", "expected"),
    [("linear", [1e3, 34e3, 67e3, 100e3]), ("sqrt", None), ("log", None)],
)
def test_spacing_takes_equal_steps_of_value_root_or_logarithm(spacing, expected):
    axis = parse(
        replaced(
            'pressure = {start = "0 kPa", stop = "200 kPa", num = 41}',
            f'pressure = {{start = "1 kPa", stop = "100 kPa", num = 4, spacing = "{spacing}"}}',
        )
    ).axes["pressure"]
    assert axis[0] == 1e3
    assert axis[-1] == 1e5
    even = {"linear": axis, "sqrt": np.sqrt(axis), "log": np.log(axis)}[spacing]
    np.testing.assert_allclose(np.diff(even), np.diff(even)[0], rtol=1e-12)
    if expected:
        assert axis.tolist() == expected


def test_ranges_hold_the_numbers_a_person_would_write():
    axis = parse(replaced('["100 mm", 0.2]', '{start = "0.1 m", stop = "1 m", step = "100 mm"}')).axes["length"]
    assert axis.tolist() == [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0]


def test_a_range_ends_exactly_where_it_says():
    axis = parse(replaced("start = -85, stop = 85", 'start = "-0.5 rad", stop = "1.1 rad"')).axes["beta"]
    assert axis[0] == quantity("-0.5 rad", "degree")
    assert axis[-1] == quantity("1.1 rad", "degree")


def test_one_value_makes_an_axis_of_length_one():
    sweep = parse(replaced('["100 mm", 0.2]', "{start = 0.1, stop = 0.1, num = 1}"))
    assert sweep.shape == (35, 35, 1, 41)


DESIGNS = """
[axes]
pressure = [0, 1e5]
[[designs]]
name = "P"
alpha = 30
beta = "-30 deg"
length = 0.19
c10 = "0.2 MPa"
fiber_extension = 1.005
[[designs]]
name = "Q"
alpha = 0
beta = 60
length = 0.14
"""


def test_designs_are_one_dimension_with_their_parameters_as_columns():
    sweep = parse(HEAD + DESIGNS)
    assert sweep.dims == ("design", "pressure")
    assert sweep.shape == (2, 2)
    assert sweep.designs["names"] == ("P", "Q")
    columns = sweep.designs["columns"]
    assert list(columns) == ["alpha", "beta", "length", "fiber_extension", "c10"]
    assert columns["beta"].tolist() == [-30.0, 60.0]
    assert columns["c10"].tolist() == [200000.0, 110000.0]  # what a design leaves out is taken from [actuator]
    assert columns["fiber_extension"].tolist() == [1.005, 1.0]  # or is the default
    assert not {"c10", "fiber_extension", "pressure"} & set(sweep.fixed)
    assert not columns["c10"].flags.writeable


def test_every_parameter_stands_in_exactly_one_place():
    for text in (VALID, HEAD + DESIGNS):
        sweep = parse(text)
        columns = sweep.designs["columns"] if sweep.designs else {}
        places = [*sweep.fixed, *sweep.axes, *columns]
        assert sorted(places) == sorted(set(PARAMETERS) - {"fiber_radius", *HELD, *YEOH, *SHAPE})


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (HEAD + DESIGNS.replace('name = "Q"\n', ""), "designs[1].name: is missing"),
        (HEAD + DESIGNS.replace('"Q"', '"P"'), "also the name of designs[0]"),
        (HEAD + DESIGNS.replace('"Q"', '"a\\u001bb"'), "designs[1].name: found"),
        (HEAD + DESIGNS.replace("length = 0.14", ""), "designs[1].length: is missing"),
        (
            HEAD + DESIGNS.replace("length = 0.14", "lenght = 0.14"),
            "designs[1].lenght: unknown key; did you mean 'length'",
        ),
        (HEAD + DESIGNS + "c10 = 2e5", "designs.c10: every design gives it, so actuator.c10 is never used"),
        (HEAD + DESIGNS + "pressure = 2e5", "designs[1].pressure: unknown key; all designs share the pressures"),
        (
            HEAD + DESIGNS.replace("[0, 1e5]", "[0, 1e5]\nforce = [0, 1]") + "force = 2",
            "given twice, also as axes.force",
        ),
        (HEAD + DESIGNS + "fiber_radius = 5e-3", "designs[0].fiber_radius: is missing, but other designs"),
        (HEAD + DESIGNS + 'energy = "full"', "cannot differ between designs"),
        (HEAD + DESIGNS.replace("beta = 60", "beta = 90"), "designs[1].beta: found 90"),
        (HEAD + "[designs]\nname = 'x'", "designs: found a table, must be tables"),
        ("designs = []\n" + VALID, "designs: found a list, must be tables"),
        (HEAD + "[[design]]\nname = 'x'", "design: unknown key; designs are written [[designs]]"),
    ],
)
def test_faults_of_designs_are_named(text, says):
    assert any(says in fault for fault in faults_of(text)), faults_of(text)


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ('"4.76 mm"', '"4.76 kPa"', "actuator.radius: expects a length such as '4.76 mm', got '4.76 kPa', a pressure"),
        ('"4.76 mm"', "0", "actuator.radius: found 0, allowed is 1e-12 to 1e+12 [m]; must be positive"),
        ('"4.76 mm"', '"-1 mm"', "actuator.radius: found '-1 mm'"),
        ('"4.76 mm"', "nan", "must be finite"),
        ('"4.76 mm"', "1" + "0" * 400, "more than 38 digits"),
        ('"4.76 mm"', "true", "found true or false"),
        ('"4.76 mm"', "1979-05-27", "type date"),
        ('"4.76 mm"', '["3 mm", "4 mm"]', "several values belong in [axes]"),
        ("1.59e-3", "0.0", "actuator.wall: found 0.0"),
        ('"0.11 MPa"', '"0 MPa"', "actuator.c10: found '0 MPa'"),
        ("[axes]", "c01 = -1\n[axes]", "actuator.c01: found -1"),
        ("[axes]", 'fiber_extension = "0.5 %"\n[axes]', "it is a stretch: fibers 0.5 % longer have 1.005"),
        ("[axes]", "fiber_radius = 0.004\n[axes]", "fiber_radius: found 0.004 to 0.004 m; must lie within the wall"),
        ("[axes]", 'energy = "half"\n[axes]', "actuator.energy: found 'half', allowed: full, principal"),
        ("[axes]", "raduis = 1\n[axes]", "actuator.raduis: unknown key; did you mean 'radius'"),
        ("[axes]", "pressure = 1\n[axes]", "actuator.pressure: unknown key; it belongs in [load]"),
        ("[axes]", "beta = 3\n[axes]", "axes.beta: given twice, also as actuator.beta; remove one"),
        ("[axes]", "[load]\npressure = 3\n[axes]", "axes.pressure: given twice, also as load.pressure"),
        ("[axes]", "[load]\nalpha = 3\n[axes]", "load.alpha: unknown key; it belongs in [actuator]"),
        ("[axes]", "[axis]\n[axes]", "axis: unknown key; did you mean 'axes'"),
        ("[axes]", '["\\u001b[31m"]\n[axes]', "'\\x1b[31m': unknown key"),
        ("title =", "alpha = 3\ntitle =", "alpha: unknown key; it belongs in [actuator] or [axes]"),
        ("title =", "load = 3\ntitle =", "load: found 3, must be a table"),
        ('"A sweep"', '"""two\nlines"""', "title: found 'two\\nlines', allowed is one line"),
        ("[axes]", "[solver]\naccuracy = 1e-13\n[axes]", "solver.accuracy: found 1e-13, allowed is 1e-10 to 0.01"),
        ("[axes]", "[solver]\naccuracy = [1]\n[axes]", "solver.accuracy: expects"),
        ("[axes]", "[solver]\nsteps = 1\n[axes]", "solver.steps: unknown key"),
        ('radius = "4.76 mm"', "", "radius: is missing; give it in [actuator] or [axes]"),
        ('["100 mm", 0.2]', '"100 mm"', "axes.length: found '100 mm'; an axis is a list, or"),
        ('["100 mm", 0.2]', "[]", "axes.length: found an empty list"),
        (
            '["100 mm", 0.2]',
            '["200 mm", "100 mm"]',
            "values must increase, but '100 mm' follows '200 mm' (entries 1 and 2)",
        ),
        ('["100 mm", 0.2]', '["100 mm", 0.1]', "but 0.1 follows '100 mm'"),
        ('["100 mm", 0.2]', '["100 mm", "20 N"]', "axes.length[1]: expects a length"),
        ('["100 mm", 0.2]', "[[0.1]]", "axes.length[0]: several values found"),
        ('stop = "85 deg"', 'stop = "90 deg"', "axes.alpha.stop: found '90 deg', allowed is between -90 and 90"),
        ("start = -85", "start = -90", "axes.beta.start: found -90"),
        (
            '"2.5 deg"',
            '"2 deg"',
            "axes.alpha.step: steps of '2 deg' do not meet stop '85 deg': the last value would be 84",
        ),
        ('"2.5 deg"', '"2.50001 deg"', "the last value would be 82.50033 degree"),
        ('"2.5 deg"', '"0 deg"', "axes.alpha.step: found '0 deg', must be positive"),
        ('"2.5 deg"', "-2.5", "axes.alpha.step: found -2.5, must be positive"),
        ('"2.5 deg"', "5e-324", "more than 1e+18 values"),
        ('"2.5 deg"', '"2.5 mm"', "axes.alpha.step: expects an angle"),
        ('step = "2.5 deg"', 'step = 2.5, spacing = "log"', "axes.alpha.spacing: 'log' needs num, not step"),
        (', step = "2.5 deg"', "", "axes.alpha: a range needs either step or num"),
        ('step = "2.5 deg"', "step = 2.5, num = 3", "a range needs either step or num, not both"),
        ('start = "0 deg", ', "", "axes.alpha: a range needs start"),
        ("num = 35", "num = 35, n = 35", "axes.beta.n: unknown key; write num"),
        ("stop = 85", "stop = 85, end = 85", "axes.beta.end: unknown key; write stop"),
        ("num = 35", "num = 0", "axes.beta.num: found 0, allowed is a whole number from 1"),
        ("num = 35", "num = 35.0", "axes.beta.num: found 35.0"),
        ("num = 35", "num = true", "axes.beta.num: found True"),
        ("num = 35", "num = 1", "axes.beta: found 1 value from -85 to 85; one value needs start = stop"),
        ("start = -85", "start = 86", "axes.beta: start 86 lies above stop 85; swap them"),
        ("num = 35", 'num = 35, spacing = "cubic"', "found 'cubic', allowed: linear, sqrt, log"),
        ("num = 35", 'num = 35, spacing = "sqrt"', "axes.beta.start: found -85, but 'sqrt' needs start >= 0"),
        ("num = 41", 'num = 41, spacing = "log"', "axes.pressure.start: found '0 kPa', but 'log' needs start"),
        ("num = 35", "num = 35, spaces = 1", "axes.beta.spaces: unknown key; did you mean 'spacing'"),
        (
            'start = "0 kPa"',
            'start = "-1 kPa"',
            "axes.pressure.start: found '-1 kPa', allowed is 0 to 1e+12 [Pa]; vacuum",
        ),
        ("start = -85, stop = 85", "start = 1, stop = 1.000000000000002", "too narrow for 35 different values"),
        (
            "num = 35",
            "num = 1_000_000_000_000_000",
            "1,000,000,000,000,000 values (8,000,000,000,000,000 bytes), at most",
        ),
        ("num = 35", "num = 0x" + "f" * 20_000, "more than 1e+18 values"),
        ("1.59e-3", "1.59 mm", "quantities with units stand in quotes"),
        ("1.59e-3", '"1.59 mm', "line 5: not valid TOML"),
        ("[axes]", 'wall = "2 mm"\n[axes]', "line 7: not valid TOML: Cannot overwrite a value"),
        ("1.59e-3", "1" * 5000, "a number or date cannot be read"),
    ],
)
def test_a_fault_is_named_with_its_key_what_was_found_and_what_is_allowed(old, new, says):
    faults = faults_of(replaced(old, new))
    assert len(faults) == 1, faults
    assert says in faults[0]
    assert faults[0].isprintable()
    assert len(faults[0]) < 500


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("1.59e-3", '"10 mm"'),  # wall > radius: thick, but a tube
        ("[axes]", "fiber_radius = '5 mm'\n[axes]"),
        ('["100 mm", 0.2]', "[0.1]"),
        ("start = -85, stop = 85, num = 35", "start = -89.999, stop = 89.999, num = 3"),
        ("[axes]", "# [[[[[[[[[[[[[[[[[[ a.b.c.d.e.f.g.h.i.j.k.l\n[axes]"),
        ('"A sweep"', '"[[[[[[[[[[[[[[[[ a.b.c.d.e.f.g.h.i.j.k.l \\" {{{{{{{{{{{{"'),
        ('"A sweep"', "'''[[[[[[[[[[[[[[ a.b.c.d.e.f.g.h.i.j.k.l'''"),
        ('"A sweep"', '""'),
    ],
)
def test_what_is_unusual_but_meaningful_is_not_refused(old, new):
    assert parse(replaced(old, new)).points > 0


def test_all_faults_come_in_one_error():
    text = (
        VALID.replace('"4.76 mm"', '"4.76 kPa"')
        .replace("num = 35", "num = 0")
        .replace("[actuator]", "[actuator]\nraduis = 1")
        .replace('c10 = "0.11 MPa"', "")
        .replace('["100 mm", 0.2]', "[2, 1]")
    )
    assert [fault.split(":")[0] for fault in faults_of(text)] == [
        *("actuator.raduis", "actuator.radius", "axes.beta.num", "axes.length", "c10")
    ]


def test_an_empty_specification_lists_every_required_parameter():
    assert [fault.split(":")[0] for fault in faults_of("")] == [
        *("alpha", "beta", "length", "radius", "wall", "c10", "pressure")
    ]


def test_the_list_of_faults_is_bounded():
    faults = faults_of("\n".join(f"key{i} = 1" for i in range(5000)))
    assert len(faults) == 51
    assert faults[-1] == "the list stops at 50 faults"


def test_the_error_survives_pickling_and_names_the_specification():
    with pytest.raises(SpecificationError, match=r"^mine\.toml: 7 faults\n") as caught:
        parse("", "mine.toml")
    copy = pickle.loads(pickle.dumps(caught.value))
    assert str(copy) == str(caught.value)
    assert copy.faults == caught.value.faults


def test_a_grid_beyond_the_limit_is_refused_with_count_and_bytes_before_it_is_made():
    text = VALID.replace("num = 35", "num = 10000").replace("num = 41", "num = 10000")
    points = 35 * 10000 * 2 * 10000
    began = time.process_time()
    (fault,) = faults_of(text)
    assert f"{points:,} points ({8 * points:,} bytes a variable), at most {MAX_POINTS:,}" in fault
    assert time.process_time() - began < 1.0


HOSTILE = {
    "open arrays": "a = " + "[" * 100_000,
    "open tables": "a = " + "{a=" * 60_000,
    "closed arrays": "a = " + "[" * 100_000 + "]" * 100_000,
    "dotted key": "a" + ".a" * 20_000 + " = 1",
    "dotted key with spaces": "a" + " . 'a'" * 20_000 + " = 1",
    "dotted header": "[a" + ".a" * 100_000 + "]",
    "many faults in a list": "[axes]\nalpha = [" + "'x'," * 60_000 + "]",
    "many designs": "[[designs]]\n" * 20_000,
    "many keys": "".join(f"a{i}=1\n" for i in range(25_000)),
    "long number": "a = 1" + "0" * 250_000,
    "long fraction": "a = 0." + "1" * 250_000,
    "long key": "a" * 250_000 + " = 1",
    "quotes": '"""' + '\\"' * 100_000,
    "many quotes": '"' * 250_000,
    "alternating quotes": "\"'" * 125_000,
    "backslashes": '"""' + "\\" * 250_000,
    "too large": "#" * 10_000_000,
    "lone surrogate": "# \ud800",
    "null": "\x00" * 1000,
}


@pytest.mark.parametrize("kind", HOSTILE)
def test_hostile_text_is_refused_at_once(kind):
    began = time.process_time()
    faults = faults_of(HOSTILE[kind])
    assert time.process_time() - began < 2.0  # a tenth of it on a quick machine
    assert sum(map(len, faults)) < 50_000


def test_the_caps_on_depth_name_the_line():
    assert "line 3: nested too deeply" in faults_of("\n\na = [[[[[[[[[1]]]]]]]]]")[0]
    assert "line 2: nested too deeply" in faults_of("\na.b.c.d.e.f.g.h.i.j = 1")[0]


PIECES = [
    *"[]{}=,.\"'#\\-015ä",
    *('"""', '"4 mm"', "1e400", "nan", "true", "0x", "1979-01-01", "[axes]", "[[designs]]"),
    *("num", "start", "stop", "step", "name", "alpha", "pressure"),
]


@pytest.mark.parametrize("seed", range(3))
def test_junk_gives_a_sweep_or_a_specification_error_at_once(seed):
    junk = random.Random(seed)
    began = time.process_time()
    sweeps = 0
    for _ in range(700):
        text = VALID + junk.choice(["", '\n[[designs]]\nname = "A"\n'])
        for _ in range(junk.randrange(1, 4)):
            where = junk.randrange(len(text))
            text = text[:where] + junk.choice([*PIECES, "\n", " "]) + text[where + junk.choice([0, 0, 1, 1, 5, 40]) :]
        sweeps += is_a_sweep(text)
    assert 3 < sweeps < 600  # both ends are met
    assert time.process_time() - began < 10.0


VALUES = [
    *("0", "-0.0", "1", "1e300", "1e-300", "5e-324", "-inf", "nan", "true", "99999999999", "1979-05-27"),
    *('"1 mm"', '"2 kPa"', '"3 deg"', '""', "[]", "[1, 2]", "{}", "[{}]"),
    "{start = 0, stop = 1, num = 3}",
    '{start = "0 deg", stop = "80 deg", step = 1}',
    "{start = -1e12, stop = 1e12, num = 9}",
    "{start = 1e-12, stop = 1e12, step = 1e-12}",
    '{start = 1e-12, stop = 1e12, num = 99, spacing = "log"}',
]


def test_junk_values_of_right_syntax_give_a_sweep_or_a_specification_error():
    junk = random.Random(5)
    for _ in range(2000):
        lines = [f"{key} = {junk.choice(VALUES)}" for key in PARAMETERS if junk.random() < 0.8]
        junk.shuffle(lines)
        cut = junk.randrange(len(lines) + 1)
        is_a_sweep("\n".join(["[actuator]", *lines[:cut], "[axes]", *lines[cut:]]))


def is_a_sweep(text):
    """Whether the text is a sweep; anything but a sweep or a SpecificationError with faults fails the test."""
    try:
        sweep = parse(text)
    except SpecificationError as error:
        if not error.faults:
            raise
        return False
    assert 0 < sweep.points <= MAX_POINTS
    assert all(np.all(np.isfinite(array)) and np.all(np.diff(array) > 0) for array in sweep.axes.values())
    return True


# --- files


@pytest.mark.parametrize("path", sorted(SWEEPS.glob("*.toml")), ids=lambda path: path.name)
def test_the_shipped_sweeps_are_read(path):
    sweep = read_file(path)
    assert sweep.title
    assert sweep.text == path.read_text(encoding="utf-8")


def test_the_shipped_sweeps_have_the_size_they_say():
    assert sorted(path.stem for path in SWEEPS.glob("*.toml")) == [
        "blocked",
        "curves",
        "design-space",
        "physical",
        "physical-map",
        "prototypes",
        "quick",
        "tapered",
        "validity-full",
        "validity-principal",
    ]
    quick, space, prototypes = (read_file(SWEEPS / f"{name}.toml") for name in ("quick", "design-space", "prototypes"))
    assert quick.points == 25_092
    assert "25 092" in quick.text
    assert space.points == 3_781_890
    assert "3 781 890" in space.text
    physical = read_file(SWEEPS / "physical.toml")
    assert all(np.array_equal(physical.axes[name], values) for name, values in space.axes.items())
    assert (physical.fixed, physical.model, space.model) == (space.fixed, MODELS["physical"], MODELS["source"])
    assert prototypes.shape == (6, 41)
    assert prototypes.designs["names"] == ("McKibben 30", "McKibben 35", "McKibben 40", "A", "B", "C")
    assert prototypes.designs["columns"]["c01"].tolist() == [60e3, 120e3, 100e3, 80e3, 80e3, 80e3]
    assert prototypes.axes["pressure"][-1] == 200e3
    for energy in ("full", "principal"):
        validity = read_file(SWEEPS / f"validity-{energy}.toml")
        assert validity.energy == energy
        assert validity.points == 15_750
        assert "15 750" in validity.text
    tapered = read_file(SWEEPS / "tapered.toml")
    assert (tapered.points, tapered.rules) == (5_096, {"alpha": "geodesic", "beta": "geodesic"})
    assert "5 096" in tapered.text


def test_a_file_with_a_byte_order_mark_and_windows_line_ends_is_read(tmp_path):
    path = tmp_path / "windows.toml"
    path.write_bytes(b"\xef\xbb\xbf" + VALID.replace("\n", "\r\n").encode())
    assert read_file(path).shape == parse(VALID).shape


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(FileNotFoundError, match=r"there is no specification .*absent"):
        read_file(tmp_path / "absent.toml")


def test_a_folder_or_a_device_is_refused(tmp_path):
    with pytest.raises(SpecificationError, match="is not a file"):
        read_file(tmp_path)
    pipe = tmp_path / "pipe"
    if hasattr(os, "mkfifo"):
        os.mkfifo(pipe)
        with pytest.raises(SpecificationError, match="is not a file"):
            read_file(pipe)


@pytest.mark.parametrize(
    ("data", "says"),
    [
        (VALID.encode("utf-16"), "line 1: byte 0xff is not UTF-8"),
        (b"title = 'a'\n# \xe9\n", "line 2: byte 0xe9 is not UTF-8"),
        (b"#" * (toml_guard.MAX_BYTES + 1), "more than"),
        (b"\x00\x01", "not valid TOML"),
    ],
)
def test_a_file_that_is_no_text_is_refused(tmp_path, data, says):
    path = tmp_path / "spec.toml"
    path.write_bytes(data)
    with pytest.raises(SpecificationError, match=says) as caught:
        read_file(path)
    assert str(path) in str(caught.value)
