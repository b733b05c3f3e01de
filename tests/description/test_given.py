"""Numbers as people give them: units are converted, masks refused, wherever numbers come in."""

import dataclasses
import inspect
from fractions import Fraction

import numpy as np
import pytest
import xarray as xr
from odd import ODD, Quantity, Wrapped, only_clear_errors

import freesweep as fs
from freesweep import closed_form
from freesweep.description.given import numbers, read_column, read_number
from freesweep.description.loads import read_stations

RUBBER = fs.MooneyRivlin(0.11e6, 0.06e6)
TUBE = fs.Actuator(alpha=30, beta=-30, length=0.192, radius=4.76e-3, wall=1.59e-3, material=RUBBER)


PRESSURES = [10e3, 15e3]


def carriers():
    yield Quantity([10, 15], "kPa")
    yield Wrapped(np.array([10, 15]), "kPa")
    yield [Quantity(10, "kPa"), Wrapped(15, "kPa")]
    yield xr.DataArray([10, 15], dims="pressure", attrs={"units": "kPa"})
    yield xr.DataArray([10, 15], dims="pressure", attrs={"units": "kPa(g)"})
    yield ["10 kPa", "0.15 bar"]
    yield np.array(["10 kPa", "15 kPa"])
    yield np.array([10e3, Fraction(15000)], object)
    yield np.ma.array([10e3, 15e3], mask=[False, False])
    yield xr.DataArray(PRESSURES, dims="pressure", attrs={"units": "Pa"})


@pytest.mark.parametrize("pressure", list(carriers()), ids=lambda value: type(value).__name__)
def test_what_carries_units_is_converted(pressure):
    assert numbers(pressure, "Pa") == pytest.approx(PRESSURES, rel=1e-15)
    assert fs.inflate(TUBE, pressure, x=0.0)["pressure"].values == pytest.approx(PRESSURES, rel=1e-15)


def test_the_real_libraries_are_read_too():
    units = pytest.importorskip("astropy.units")
    registry = pytest.importorskip("pint").UnitRegistry()
    for given in (np.array([10, 15]) * units.kPa, [10 * units.kPa, 15 * units.kPa], np.array([10, 15]) * registry.kPa):
        assert numbers(given, "Pa") == pytest.approx(PRESSURES, rel=1e-15)
    for given in (0.5 * units.rad, registry.Quantity(0.5, "rad")):
        assert numbers(given, "degree") == pytest.approx(np.degrees(0.5), rel=1e-15)
    for given in (2 * units.N * units.m, registry.Quantity(2, "N*m")):
        assert numbers(given, "N m") == 2.0
    for given in (3 * units.m, registry.Quantity(3, "m")):
        with pytest.raises(ValueError, match=r"cannot be converted to \[Pa\]"):
            numbers(given, "Pa")


MASKED = [np.ma.masked, np.ma.array([1.0, 2.0], mask=[False, True]), [1.0, np.ma.masked]]
MASKED.append(Wrapped(np.ma.array([1.0, 2.0], mask=[True, False]), "Pa"))


@pytest.mark.parametrize("masked", MASKED[:3], ids=("constant", "array", "list"))
def test_what_is_masked_is_refused_wherever_numbers_come_in(masked):
    for call in (
        lambda: fs.inflate(TUBE, masked),
        lambda: fs.inflate(TUBE, 1e4, force=masked),
        lambda: fs.blocked_force(TUBE, 1e4, masked),
        lambda: fs.lock(TUBE, x=masked),
        lambda: dataclasses.replace(TUBE, length=masked),
        lambda: dataclasses.replace(TUBE, alpha=[(0, 20), (1, np.ma.masked)]),
        lambda: dataclasses.replace(TUBE, wall=lambda share: np.ma.masked_greater(1e-3 + 0 * share, 0.0)),
        lambda: fs.MooneyRivlin(masked),
        lambda: fs.Measurement(TUBE, pressure=masked, deformed_length=[0.19, 0.18]),
        lambda: fs.Helix(length=masked, height=0.03, turns=1),
        lambda: closed_form.blocked_force(30, -30, 5e-3, masked),
    ):
        with pytest.raises(fs.ActuatorError, match="masked"):
            call()


def test_a_unit_of_another_kind_is_refused_by_its_name():
    for length in ("4.76 psi", Quantity(3, "kPa"), Wrapped(3, "rad"), xr.DataArray(3.0, attrs={"units": "psia"})):
        faults = []
        assert read_number("length", length, "m", faults) is None
        assert len(faults) == 1
        assert faults[0].startswith("length: ")
    with pytest.raises(ValueError, match="an absolute pressure"):
        numbers(xr.DataArray([15.0], dims="pressure", attrs={"units": "psia"}), "Pa")


def test_every_public_description_takes_texts_with_units():
    text = fs.Actuator(
        alpha="30 deg", beta="-30 deg", length="192 mm", radius="4.76 mm", wall="1.59 mm",
        material=fs.MooneyRivlin("0.11 MPa", "0.06 MPa"),
    )  # fmt: skip
    assert text == TUBE
    assert fs.Helix.around("42.8 mm", "192 mm", "3 cm") == fs.Helix.around(0.0428, 0.192, 0.03)
    assert fs.Measurement(TUBE, "100 kPa", deformed_length=["17 cm"]).deformed_length.tolist() == [0.17]
    assert closed_form.blocked_force("30 deg", -30, "5 mm", ["1 bar"]) == closed_form.blocked_force(30, -30, 5e-3, 1e5)
    profile = dataclasses.replace(TUBE, alpha=[(0, "20 deg"), ("50 %", Quantity(0.5, "rad")), (1, 35)])
    assert profile.alpha == ((0.0, 20.0), (0.5, np.degrees(0.5)), (1.0, 35.0))
    turned = dataclasses.replace(TUBE, beta=lambda share: Quantity(-0.5 - 0.1 * share, "rad"))
    assert turned.angles(0.0)[1] == pytest.approx(-np.degrees(0.5))


def test_equal_actuators_have_equal_hashes_whatever_varies():
    pairs = [(0, 20), (0.5, 25), (1, 35)]
    polynomial = np.polynomial.Polynomial([20, 5])  # has no hash of its own
    for one, other in ((pairs, np.array(pairs, float)), (polynomial, np.polynomial.Polynomial([20, 5])), (20, 20.0)):
        first, second = dataclasses.replace(TUBE, alpha=one), dataclasses.replace(TUBE, alpha=other)
        assert first == second
        assert hash(first) == hash(second)
    designs = {dataclasses.replace(TUBE, wall=[(0, 1e-3), (1, 1e-3 + k * 1e-5)]) for k in range(20)}
    assert len(designs) == len({hash(design) for design in designs}) == 20


def test_a_column_names_its_first_entry_outside_the_domain():
    faults = []
    assert read_column("force", [1.0, 2.0, np.nan], "N", faults) is None
    assert read_column("force", [[1.0]], "N", faults) is None
    assert read_column("force", [], "N", faults) is None
    assert read_column("pressure", [1.0, -2.0], "Pa", faults, least=0.0) is None
    assert [fault.split(";")[0] for fault in faults] == [
        "force: entry 3: found nan",
        "force: found an array of shape (1, 1)",
        "force: found an array of shape (0,)",
        "pressure: entry 2: found -2 Pa",
    ]


# --- odd values of any kind, to any public function

FEW = fs.Measurement(TUBE, 1e4, deformed_length=0.0999)  # one value, which tells no parameter
ARGUMENTS = {
    fs.Actuator: {
        "alpha": 30, "beta": -30, "length": 0.2, "radius": 5e-3, "wall": 1e-3, "material": RUBBER, "fiber_extension": 1.0,
        "fiber_radius": None, "energy": "full",
    },
    TUBE.angles: {"share": 0.5},
    TUBE.profile: {"name": "alpha"},
    fs.MooneyRivlin: {"c10": 1e5, "c01": 0.0, "largest_stretch": None, "source": ""},
    fs.Yeoh: {"c1": 1e5, "c2": 0.0, "c3": 0.0},
    fs.NeoHookean: {"c10": 1e5},
    fs.material: {"name": "dragon-skin-30"},
    fs.Goal: {"output": "rotation", "value": 90, "pressure": 1e5, "tolerance": 1.0},
    fs.Limit: {"output": "force", "between": (1, 2), "pressure": 1e5, "deformed_length": 0.19, "torque": 0.0},
    fs.Profile: {"knots": 3, "between": (0, 85)},
    fs.design: {
        "template": TUBE, "free": {"length": (0.1, 0.3)}, "goals": [fs.Goal("length", 0.2)], "limits": (),
        "minimize": None, "count": 1, "seed": 0,
    },
    fs.tolerance: {
        "tube": TUBE, "pressure": 1e5, "force": 0.0, "torque": 0.0, "accuracy": 1e-6, "alpha": 1.0, "wall": 5e-5,
    },
    fs.lock: {"tube": TUBE, "x": 0.0, "accuracy": 1e-6},
    fs.inflate: {"tube": TUBE, "pressure": 1e4, "force": 0.0, "torque": 0.0, "x": 0.0, "accuracy": 1e-6},
    fs.blocked_force: {"tube": TUBE, "pressure": 1e4, "deformed_length": None, "torque": 0.0, "rotation": None, "x": 0.0},
    fs.blocked_torque: {"tube": TUBE, "pressure": 1e4, "rotation": 0.0, "force": 0.0, "buckled": False},
    fs.corrected_torque: {"tube": TUBE, "pressure": 1e4},
    fs.Helix: {"length": 0.2, "height": 0.03, "turns": 1},
    fs.Helix.around: {"radius": 0.04, "length": 0.2, "height": 0.03},
    fs.Helix(length=0.2, height=0.03, turns=1).hoop_load: {"force": 1.0},
    fs.Helix(length=0.2, height=0.03, turns=1).friction_force: {"force": 1.0, "coefficient": 0.1},
    fs.constriction: {"tube": TUBE, "helix": None, "pressure": 1e4, "friction": 0.0},
    fs.Measurement: {
        "tube": TUBE, "pressure": [1e4, 2e4], "deformed_length": [0.19, 0.18], "force": None, "measured": (), "sigma": {},
    },
    FEW.imposed: {"name": "force"},
    fs.calibrate: {"measurements": FEW, "fit": None, "own_extension": False},
    fs.read_measurements: {"paths": [], "measured": (), "material": RUBBER, "energy": "full", "alpha": 30},
    closed_form.locked_stretch: {"alpha": 30, "beta": -30, "fiber_extension": 1.0},
    closed_form.uniform_state: {"alpha": 30, "beta": -30, "stretch": 1.1},
    closed_form.locked_manifold: {"alpha": 30},
    closed_form.held_shares: {"alpha": 30, "beta": -40, "held": "length"},
    closed_form.blocked_force: {"alpha": 30, "beta": -30, "radius": 5e-3, "pressure": 1e5},
    closed_form.blocked_torque: {"alpha": 30, "beta": -40, "radius": 5e-3, "pressure": 1e5},
    closed_form.critical_pressure: {
        "alpha": 0, "beta": 30, "length": 0.1, "radius": 5e-3, "wall": 1e-3, "c10": 1e5, "c01": 0.0, "energy": "full",
    },
    closed_form.region: {"alpha": 30, "beta": -30},
}  # fmt: skip


@pytest.mark.parametrize("call", ARGUMENTS, ids=lambda call: call.__qualname__)
def test_odd_values_give_faults_and_nothing_else(call):
    """One argument odd at a time; solvers are not reached, but where the value is fine after all."""
    for name in ARGUMENTS[call]:
        for odd in ODD:
            if call in SOLVING and not refused_alone(name, odd):
                continue
            only_clear_errors(call, ARGUMENTS[call] | {name: odd})


SOLVING = (fs.lock, fs.inflate, fs.blocked_force, fs.blocked_torque, fs.corrected_torque, fs.constriction)
UNITS = {"pressure": "Pa", "force": "N", "torque": "N m", "deformed_length": "m", "rotation": "degree", "x": "m"}


def refused_alone(name, odd):
    """Whether a value is no load at all: the others would be solved."""
    if name not in UNITS or odd is None:  # None: the default
        return name not in UNITS
    faults = []
    read_column(name, odd, UNITS[name], faults)
    return bool(faults)


@pytest.mark.long
@pytest.mark.parametrize("seed", range(8))
def test_random_odd_calls_give_faults_and_nothing_else(seed):
    draw = np.random.default_rng(seed)
    calls = list(ARGUMENTS)
    for _ in range(1500):
        call = calls[draw.integers(len(calls))]
        given = dict(ARGUMENTS[call])
        for name in given:
            if draw.random() < 0.4:
                given[name] = ODD[draw.integers(len(ODD))]
        only_clear_errors(call, given)


def test_the_end_of_a_tube_is_a_station_however_it_is_rounded():
    """A rounding beyond the length was a place without fiber angles."""
    stations, _ = read_stations(TUBE, [0.0, np.nextafter(TUBE.length, 1.0)], 1e-6, [])
    assert stations[-1] == TUBE.length


def test_every_public_callable_is_tried():
    tried = {call.__name__ for call in ARGUMENTS} | {"around"}
    apart = {
        "materials",
        "ActuatorError",
        "UnsealedWarning",
        "Calibration",
        "run_sweep",
        "sweep",
        "to_dataframe",
        "open_atlas",
        "example_atlas",
        "explore",
        "Atlas",
        "closed_form",
    }
    assert set(fs.__all__) - apart <= tried
    made = (
        one for one in vars(closed_form).values() if inspect.isfunction(one) and one.__module__ == closed_form.__name__
    )
    formulas = {one.__name__ for one in made if one.__name__[0] != "_"}
    assert formulas - {"locked_angles"} <= tried
