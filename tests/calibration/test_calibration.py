"""Calibration: constants recovered from curves that the model made, with noise, within the uncertainty that is stated."""

import html
import re
from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import chi2

from freesweep import (
    Actuator,
    ActuatorError,
    Measurement,
    MooneyRivlin,
    NeoHookean,
    blocked_force,
    blocked_torque,
    calibrate,
    inflate,
    read_measurements,
)  # fmt: skip
from freesweep.calibration.page import page

TRUTH = {"c10": 0.15e6, "c01": 0.08e6, "fiber_extension": 1.006}
PRESSURE = np.array([0.1, 0.2, 0.3, 0.5, 0.8, 1.1, 1.5, 2.0]) * 1e5
NOISE = {"deformed_length": 3e-4, "rotation": 0.5, "force": 0.2, "torque": 2e-4}


def tube(alpha=30, beta=-30, length=0.192, **changes):
    constants = TRUTH | changes
    material = MooneyRivlin(constants["c10"], constants["c01"])
    return Actuator(
        alpha=alpha, beta=beta, length=length, radius=4.76e-3, wall=1.59e-3, material=material,
        fiber_extension=constants["fiber_extension"],
    )  # fmt: skip


def guessed(of):
    """The actuator as one would describe it before any calibration."""
    return tube(of.alpha, of.beta, of.length, c10=0.4e6, c01=0.05e6, fiber_extension=1.0)


def freely(of, names, rng=None, noise=1.0, given=False, pressure=PRESSURE):
    """A free actuator's curves, measured with noise."""
    exact = inflate(of, pressure, x=0.0)
    columns = {
        n: exact[n].values + noise * NOISE[n] * (rng.standard_normal(len(pressure)) if rng else 0.0) for n in names
    }
    sigma = {n: noise * NOISE[n] for n in names} if given else {}
    return Measurement(guessed(of), pressure, **columns, sigma=sigma)


def blocked(of, rng=None, noise=1.0, pressure=PRESSURE):
    """A blocked force curve, measured with noise where there is a force."""
    force = blocked_force(of, pressure, x=0.0)["force"].values
    taut = np.isfinite(force)
    scatter = noise * NOISE["force"] * rng.standard_normal(taut.sum()) if rng else 0.0
    return Measurement(guessed(of), pressure[taut], force=force[taut] + scatter)


def mahalanobis(found, names=("c10", "c01", "fiber_extension")):
    """Squared distance of what was found from the truth, in standard uncertainties: chi square with as many freedoms."""
    off = found.values - [TRUTH[name] for name in names]
    return off @ np.linalg.solve(found.covariance, off)


def test_exact_curves_give_exact_constants():
    found = calibrate([freely(tube(), ["deformed_length"]), blocked(tube())])
    assert found.names == ("c10", "c01", "fiber_extension")
    assert found.values == pytest.approx(list(TRUTH.values()), rel=2e-5)
    assert found.material == MooneyRivlin(found.values[0], found.values[1])
    assert found.tubes[1].fiber_extension == found.values[2]
    for measurement, predicted in zip(found.measurements, found.predicted):
        (name,) = measurement.measured
        assert predicted[:, 0] == pytest.approx(getattr(measurement, name), rel=1e-6)


def test_noisy_curves_give_constants_within_the_uncertainty_stated():
    """Length and rotation of a rotator, uncertainties given: six benches, chi square of all misses together."""
    total = 0.0
    for seed in range(6):
        rng = np.random.default_rng(seed)
        found = calibrate(freely(tube(0, 30, 0.131), ["deformed_length", "rotation"], rng, given=True))
        total += mahalanobis(found)
        assert 0.2 < found.chi_square < 2.5
        assert np.all(
            (found.intervals[:, 1] - found.values) == pytest.approx(2.16 * found.standard_errors, rel=2e-3)
        )  # t, 13
    assert chi2.ppf(0.001, 18) < total < chi2.ppf(0.999, 18)


def test_scatter_of_mixed_curves_tells_their_uncertainty():
    """Two actuators, two quantities, no uncertainty given: each quantity's own is found."""
    rng = np.random.default_rng(11)
    pressure = np.linspace(1e4, 2e5, 16)
    found = calibrate(
        [freely(tube(), ["deformed_length"], rng, pressure=pressure), blocked(tube(40, -40), rng, pressure=pressure)]
    )
    assert found.sigma["deformed_length"] == pytest.approx(NOISE["deformed_length"], rel=0.4)
    assert found.sigma["force"] == pytest.approx(NOISE["force"], rel=0.4)
    assert found.chi_square == pytest.approx(1.0, abs=0.1)
    assert mahalanobis(found) < chi2.ppf(0.999, 3)


def test_uncertainty_falls_with_the_noise():
    loud, quiet = (
        calibrate(
            freely(tube(), ["deformed_length"], np.random.default_rng(4), noise, given=True), ["c10", "fiber_extension"]
        )
        for noise in (1.0, 0.1)
    )
    assert loud.standard_errors == pytest.approx(10 * quiet.standard_errors, rel=0.1)
    assert abs(quiet.values - loud.values)[0] > 3 * quiet.standard_errors[0]


def test_an_extension_of_each_actuator():
    """As in section 2.3.4: the muscles were wound with different slack."""
    loose = tube(40, -40, fiber_extension=1.01)
    curves = [freely(tube(), ["deformed_length"]), blocked(loose), freely(loose, ["deformed_length"])]
    found = calibrate(curves, own_extension=True)
    assert found.names == ("c10", "c01", "fiber_extension_1", "fiber_extension_2")
    assert found.values == pytest.approx([0.15e6, 0.08e6, 1.006, 1.01], rel=1e-4)
    assert [t.fiber_extension for t in found.tubes] == [found.values[2], found.values[3], found.values[3]]


def test_c10_and_c01_are_hardly_separable_from_one_curve():
    exact = inflate(tube(), PRESSURE, x=0.0)["deformed_length"].values
    length = exact + NOISE["deformed_length"] * np.random.default_rng(2).standard_normal(len(PRESSURE))
    found = calibrate(Measurement(tube(c10=0.4e6), PRESSURE, deformed_length=length), ["c10", "c01"])
    assert found.correlation[0, 1] < -0.95
    assert found.condition > 20
    verdict, note = found.notes
    assert verdict.startswith("the model fits: what is left looks like noise. Typically deformed_length is missed by ")
    assert note.startswith("c10 and c01 are hardly separable from these data (correlation -0.9")
    # what is told: a sum, far better known than either constant
    share = -found.covariance[0, 1] / found.covariance[1, 1]
    told = found.values[0] + share * found.values[1]
    assert f"c10 + {share:.3g} c01 = {told * 1e-6:.4g} MPa" in note
    error = np.sqrt(np.array([1, share]) @ found.covariance @ np.array([1, share]))
    assert abs(told - (0.15e6 + share * 0.08e6)) < 3.5 * error
    assert error < 0.1 * found.standard_errors[0]


def test_ideal_blocked_forces_do_not_depend_on_the_wall():
    """Eq. 2.16: with inextensible fibers only radius and angles count."""
    ideal = tube(fiber_extension=1.0)
    force = blocked_force(ideal, PRESSURE, x=0.0)["force"].values
    found = calibrate(Measurement(ideal, PRESSURE, force=force), "c10")
    assert found.standard_errors.tolist() == [np.inf]
    assert found.values.tolist() == [0.15e6]  # stays where it was
    assert "the data do not tell c10" in found.notes[1]


def test_states_that_the_model_does_not_have_are_left_out():
    """Below about 8 kPa no wall reaches the taut fibers of this muscle when its length is held."""
    low = np.array([2e3, 5e3])
    taut = blocked(tube(), pressure=PRESSURE[1:])
    with_low = Measurement(guessed(tube()), np.append(low, taut.pressure), force=np.append([0.1, 0.3], taut.force))
    found = calibrate([with_low, freely(tube(), ["deformed_length"])])
    assert np.isnan(found.predicted[0][:, 0]).tolist() == [True] * 2 + [False] * 7
    assert found.values == pytest.approx(list(TRUTH.values()), rel=1e-4)
    assert any(note.startswith("2 measured values did not count") for note in found.notes)


def test_a_constant_that_would_fall_below_zero_stays_there():
    """A muscle that softens more than any neo-Hookean one."""
    soft = inflate(tube(c10=0.2e6, c01=0.0), PRESSURE, x=0.0)["deformed_length"].values
    bent = soft - np.linspace(0, 1.0e-3, len(PRESSURE))
    found = calibrate(Measurement(tube(c10=0.4e6), PRESSURE, deformed_length=bent), ["c10", "c01"])
    assert found.values[1] == 0.0
    assert any("c01 ended at its smallest value" in note for note in found.notes)


def test_force_stroke_and_torque_rotation_curves():
    """Held lengths and rotations, and the loads that a bench imposed meanwhile."""
    length = np.array([0.192, 0.186, 0.18])
    force = blocked_force(tube(), 1e5, length, x=0.0)["force"].values
    rotator = tube(0, 45, 0.1)
    rotation = np.array([0.0, -20.0, -40.0])
    torque = blocked_torque(rotator, 0.5e5, rotation, 1.5, x=0.0)["torque"].values
    found = calibrate(
        [
            Measurement(guessed(tube()), 1e5, deformed_length=length, force=force, measured="force"),
            Measurement(guessed(rotator), 0.5e5, rotation=rotation, torque=torque, force=1.5, measured="torque"),
        ],
        ["c10", "fiber_extension"],
    )
    # c01 was not fitted, and the guess of it is wrong: so is the answer
    assert abs(found.values[0] - 0.15e6) > 1e4
    right = [Measurement(tube(c10=0.3e6), m.pressure, deformed_length=m.deformed_length, rotation=m.rotation, force=m.force,
                         torque=m.torque, measured=m.measured) for m in found.measurements[:1]]  # fmt: skip
    assert calibrate(right, ["c10", "fiber_extension"]).values == pytest.approx([0.15e6, 1.006], rel=1e-4)


def test_the_second_constant_alone_and_actuators_that_vary():
    """A first guess of 0, and two muscles whose wall is a profile, told apart."""
    walls = [np.array([[0, 1.5e-3], [1, w]]) for w in (1.6e-3, 1.8e-3)]
    muscles = [
        Actuator(alpha=30, beta=-30, length=0.1, radius=4.76e-3, wall=w, material=MooneyRivlin(0.15e6, 0.08e6))
        for w in walls
    ]
    curves = []
    for muscle, extension in zip(muscles, (1.003, 1.009)):
        wound = replace(muscle, fiber_extension=extension)
        length = inflate(wound, PRESSURE[1::3], x=0.0)["deformed_length"].values
        tube = replace(muscle, material=MooneyRivlin(0.15e6))
        curves.append(Measurement(tube, PRESSURE[1::3], deformed_length=length))
    found = calibrate(curves, ["fiber_extension", "c01"], own_extension=True)
    assert found.names == ("c01", "fiber_extension_1", "fiber_extension_2")
    assert found.values == pytest.approx([0.08e6, 1.003, 1.009], rel=1e-4)


def test_a_muscle_that_carries_a_weight():
    length = inflate(tube(), PRESSURE, 5.0, x=0.0)["deformed_length"].values
    found = calibrate(
        Measurement(tube(c10=0.3e6), PRESSURE, deformed_length=length, force=5.0, measured="deformed_length"), "c10"
    )
    assert found.values == pytest.approx([0.15e6], rel=1e-5)


def test_neo_hookean_has_one_constant():
    exact = inflate(tube(c01=0.0), PRESSURE, x=0.0)["deformed_length"].values
    rubber = Actuator(alpha=30, beta=-30, length=0.192, radius=4.76e-3, wall=1.59e-3, material=NeoHookean(1e5))
    found = calibrate(Measurement(rubber, PRESSURE, deformed_length=exact))
    assert found.names == ("c10", "fiber_extension")
    assert found.values == pytest.approx([0.15e6, 1.006], rel=1e-5)
    assert isinstance(found.material, NeoHookean)


def test_a_wrong_model_is_said_to_miss():
    wrong = freely(tube(), ["deformed_length"]).deformed_length + 2e-3
    found = calibrate(Measurement(tube(), PRESSURE, deformed_length=wrong, sigma={"deformed_length": 1e-4}), "c10")
    assert found.chi_square > 4
    assert any("the model misses the data by" in note for note in found.notes)


@pytest.mark.parametrize(
    ("columns", "faults"),
    [
        ({"pressure": [1e5]}, ["measured: nothing was"]),
        ({"pressure": -1.0, "force": ["x"]}, ["pressure: found -1", "force: expects a force such as '12 N', found 'x'"]),
        ({"pressure": [1e5, 2e5], "force": [1.0, 2.0, 3.0]}, ["columns differ in length: pressure 2, force 3"]),
        ({"pressure": 1e5, "force": 1.0, "deformed_length": 0.1}, ["measured: deformed_length and force are given; say"]),
        ({"pressure": 1e5, "force": 1.0, "torque": 1.0, "measured": ["force", "torque"]}, ["measured: torque beside force"]),
        ({"pressure": 1e5, "force": 1.0, "rotation": 1.0, "measured": "force"}, ["rotation: given and not measured"]),
        ({"pressure": 1e5, "force": [1.0, np.nan]}, ["force: entry 2: found nan; give a finite number"]),
        ({"pressure": 1e5, "force": 1.0, "sigma": {"force": 0.0, "torque": 1.0}},
         ["sigma of force: found 0", "sigma: 'torque' is not measured"]),
        ({"pressure": 1e5, "deformed_length": 0.0}, ["deformed_length: found 0 m; it has to be above 0"]),
        ({"pressure": 1e5, "force": 1.0, "sigma": 5e-4},
         ["sigma: found float 0.0005; give standard uncertainties by name, such as {'force': 5e-4}"]),
        ({"pressure": 1e5, "force": 1.0, "measured": 5}, ["measured: found int 5; give a name or a list of names"]),
        ({"pressure": 1e5, "force": 1.0, "measured": "weight"}, ["measured: 'weight' is not among the columns given"]),
    ],
)  # fmt: skip
def test_every_fault_of_a_measurement_is_named(columns, faults):
    with pytest.raises(ActuatorError) as error:
        Measurement(tube(), **columns)
    assert [found.startswith(fault) for found, fault in zip(error.value.faults, faults, strict=True)] == [True] * len(
        faults
    )


@pytest.mark.parametrize(
    ("arguments", "faults"),
    [
        (([],), ["measurements: found none"]),
        (([1, 2],), ["measurements: found int"] * 2),
        (
            (Measurement(tube(), 1e5, force=3.0), ["c1", "c10"]),
            ["fit: found 'c1'; choose among c10, c01, fiber_extension"],
        ),
        ((Measurement(tube(), 1e5, force=3.0), []), ["fit: nothing to fit"]),
        ((Measurement(tube(), [1e5, 2e5, 3e5], force=3.0),), ["measurements: 3 values cannot tell 3 parameters"]),
    ],
)
def test_every_fault_of_a_calibration_is_named(arguments, faults):
    with pytest.raises(ActuatorError) as error:
        calibrate(*arguments)
    assert [found.startswith(fault) for found, fault in zip(error.value.faults, faults, strict=True)] == [True] * len(
        faults
    )


@pytest.mark.parametrize(
    ("text", "says", "never"),
    [
        ("pressure [kPa],,force [N]\n10,,1\n20,,2\n", "column 2: has no name; name it or remove it", "did you mean"),
        ("pressure [kPa],force [N],\n10,1,7\n", "line 2: 3 cells under 2 names; a separator too many", "missing"),
        (
            "pressure [kPa],force [N]\n1,0,1\n",
            "a separator too many, or a decimal comma where a point belongs",
            "missing",
        ),
    ],
)
def test_a_bench_file_is_refused_for_what_is_wrong_with_it(text, says, never, tmp_path):
    (tmp_path / "bench.csv").write_text(text)
    with pytest.raises(ActuatorError) as caught:
        read_measurements(
            tmp_path / "bench.csv", measured="force", alpha=30, beta=-30, length=0.2, radius=5e-3, wall="1 mm"
        )
    assert any(says in fault for fault in caught.value.faults)
    assert never not in str(caught.value)


@pytest.mark.parametrize(
    ("curves", "given", "begins", "ends"),
    [
        (1, False, "nothing speaks against the model, but too few values tell what of the misfit is noise", "range"),
        (1, True, "the model fits: what is left looks like noise", "range (given as 3 %)"),
        (8, False, "the model fits: what is left looks like noise", "range (replicates scatter by"),
    ],
)
def test_a_verdict_tells_the_size_of_the_misfit_beside_what_tells_the_noise(curves, given, begins, ends):
    pressure = np.tile([0.5e5, 1e5, 1.5e5], curves)
    length = inflate(tube(), pressure, x=0.0)["deformed_length"].values
    length = length + 0.03 * np.ptp(length) * np.random.default_rng(4).standard_normal(len(pressure))
    sigma = {"deformed_length": 0.03 * np.ptp(length)} if given else {}
    found = calibrate(Measurement(tube(c10=0.4e6), pressure, deformed_length=length, sigma=sigma), "c10")
    assert found.fits
    missed = np.sqrt(np.mean((found.predicted[0][:, 0] - length) ** 2)) / np.ptp(length)
    assert 0.01 < missed < 0.04
    verdict = found.notes[0]
    assert verdict.startswith(f"{begins}. Typically deformed_length is missed by {100 * missed:.2g} % of its {ends}")
    assert html_verdict(page(found)) == verdict[0].upper() + verdict[1:] + "."


def html_verdict(text):
    """The words in bold of a page."""
    return html.unescape(re.search("<strong>(.*?)</strong>", text).group(1))
