"""Any scalar is fitted: angles, sizes, dead length, threshold; with priors, bounds, ties; from the shell and from TOML."""

import html
import json
import re
from dataclasses import replace

import numpy as np
import pytest
from benches import FIT, TIES, bench, exact, muscle, values
from commands import refused, run

import freesweep
from freesweep import Actuator, ActuatorError, Measurement, MooneyRivlin, blocked_force, calibrate, inflate
from freesweep.calibration.parameters import Setup
from freesweep.calibration.picture import axis, between, picture, words_of
from freesweep.calibration.predicted import Asked, Predictor, scalar
from freesweep.calibration.report import shown_as, table
from freesweep.cli import DONE
from freesweep.plot import style

TRUTH = Actuator(
    alpha=25, beta=-25, length=0.3, radius=8e-3, wall=1.5e-3, material=MooneyRivlin(0.2e6, 0.1e6), fiber_extension=1.004
)
GUESS = replace(TRUTH, alpha=26.0, beta=-26.0, material=MooneyRivlin(0.15e6, 0.075e6), fiber_extension=1.0)
PRESSURE = np.linspace(0.3e5, 3e5, 8)


def lengths(truth, guess, **how):
    """A free curve as the model has it."""
    made = Measurement(guess, PRESSURE, stroke=np.full(8, 1e-3))
    (length,) = exact([made], truth)
    return Measurement(guess, PRESSURE, deformed_length=length, **how)


def forces(truth, guess, pressure=(1e5, 3e5)):
    """Force over contraction, slack where there is none."""
    p, c = np.repeat(pressure, 6), np.tile(np.linspace(0.0, 0.25, 6), len(pressure))
    made = Measurement(guess, p, contraction=c, force=np.ones(len(p)), measured="force")
    (force,) = exact([made], truth)
    return Measurement(guess, p, contraction=c, force=force, measured="force")


def by_vectors(tube, held):
    """Forces at which vectors hold shares of the length; and what was asked."""
    asked = Measurement(tube, 2e5, deformed_length=held * tube.length, force=[30.0, 10.0], measured="force")
    predictor, setup = Predictor([asked]), Setup(tube, tube.length, 0.0, 0.0)
    predictor.predict([[setup]])
    predictor.refresh([setup])
    predictor.refresh([setup])
    (((quick,)),) = predictor.predict([[setup]])
    return quick[:, 0], asked, setup


# of a long tube and of a short one, whose ends feel each other; physical held ones are compiled for a minute
@pytest.mark.parametrize("model", ["source", pytest.param("physical", marks=pytest.mark.long)])
@pytest.mark.parametrize("length", [0.4, 0.12])
def test_vectors_say_what_the_public_functions_say(model, length):
    quick, asked, setup = by_vectors(replace(TRUTH, length=length, model=model), np.array([1.0, 0.9]))
    state = Asked(setup, asked.pressure, {"deformed_length": asked.deformed_length, "torque": np.zeros(2)})
    assert quick == pytest.approx(scalar(asked, state)[:, 0], rel=1e-5)


@pytest.mark.parametrize("length", [0.4, 0.12])
def test_under_the_force_that_holds_a_physical_tube_it_has_that_length(length):
    tube, held = replace(TRUTH, length=length, model="physical"), np.array([1.0, 0.9])
    force, *_ = by_vectors(tube, held)
    free = [inflate(tube, 2e5, float(one), x=0.0)["deformed_length"].item() for one in force]
    assert free == pytest.approx(held * length, rel=1e-6)


def test_angle_rubber_and_extension_of_a_muscle():
    """The mirror family follows; slack zeros do not pull the fit."""
    found = calibrate([lengths(TRUTH, GUESS), forces(TRUTH, GUESS)], FIT, ties=TIES)
    assert found.names == ("c10", "fiber_extension", "alpha")
    assert found.values == pytest.approx([0.2e6, 1.004, 25.0], rel=1e-4)
    assert found.tubes[0].beta == -found.tubes[0].alpha
    assert found.material.c01 == pytest.approx(0.1e6, rel=1e-4)
    assert found.fits


def test_a_dead_length_and_a_threshold():
    """Clamps hide 12 mm of 300, the bladder reaches the braid at 10 kPa."""
    working = replace(TRUTH, length=0.288)
    nominal = replace(GUESS, alpha=25.0, beta=-25.0)
    made = [Measurement(nominal, PRESSURE, stroke=np.full(8, 1e-3)), forces(TRUTH, nominal)]
    setup = Setup(working, 0.3, 0.012, 1e4)
    free, held = (each[:, 0] for each in Predictor(made).predict([[setup, setup]])[0])
    curves = [Measurement(nominal, PRESSURE, stroke=0.3 - free), made[1]]
    held = np.nan_to_num(held).clip(min=0.0)
    curves[1] = Measurement(
        nominal, made[1].pressure, deformed_length=made[1].deformed_length, force=held, measured="force"
    )
    found = calibrate(curves, ["c10", "fiber_extension", "dead_length", "threshold_pressure"], ties=TIES)
    assert found.values == pytest.approx([0.2e6, 1.004, 0.012, 1e4], rel=2e-3)
    assert found.tubes[0].length == pytest.approx(0.288, abs=1e-4)
    assert (found.dead_length, found.threshold_pressure) == (found.values[2], found.values[3])
    again = found.band("force", 3e5, contraction=0.1, actuator=1)
    assert again.force_low < again.force < again.force_high


def test_a_band_of_a_short_tube_and_of_one_that_pushes():
    """Their ends feel each other; at a tenth of contraction under 1 bar it pushes."""
    tube = Actuator(alpha=25, beta=-25, length=0.03, radius=5e-3, wall=1e-3, material=TRUTH.material)
    force = blocked_force(tube, PRESSURE, x=0.0)["force"].values
    found = calibrate(Measurement(tube, PRESSURE, contraction=np.zeros(8), force=force, measured="force"), ["c10"])
    for contraction in (0.02, 0.1):
        band = found.band("force", [1e5, 2e5], contraction=contraction)
        own = blocked_force(found.tubes[0], [1e5, 2e5], (1.0 - contraction) * 0.03, x=0.0)["force"]
        assert band["force"].values == pytest.approx(own.values, rel=1e-5)
    assert band["force"].values[0] < 0.0 < band["force"].values[1]


def test_priors_bounds_and_ties():
    """Length and radius hardly move apart in a curve of lengths: what is known of one tells the other."""
    curve = lengths(TRUTH, replace(GUESS, alpha=25.0, beta=-25.0))
    known = calibrate(curve, ["c10", "fiber_extension"], alpha=("24.5 deg", "0.001 deg"), ties=TIES)
    assert known.values[2] == pytest.approx(24.5, abs=0.01)  # the data would have 25: a prior that sharp is obeyed
    assert known.names == ("c10", "fiber_extension", "alpha")
    loose = calibrate(curve, ["c10", "fiber_extension"], priors={"alpha": (25.5, 1)}, ties=TIES)
    assert loose.values[2] == pytest.approx(25.0, abs=0.1)
    bounded = calibrate(curve, ["c10", "alpha"], bounds={"alpha": (25.5, 27)}, ties=TIES)
    assert bounded.values[1] == pytest.approx(25.5, abs=1e-6)
    assert any("alpha ended at its smallest value" in note for note in bounded.notes)


def test_rubbers_are_tied_where_data_do_not_tell_both():
    """Three percent of noise on forces alone: no constant ends at nothing."""
    rng = np.random.default_rng(5)
    curve = forces(TRUTH, replace(TRUTH, material=GUESS.material))
    force = np.where(curve.force > 0.0, curve.force + 0.03 * curve.force.max() * rng.standard_normal(12), 0.0)
    noisy = Measurement(
        curve.tube, curve.pressure, contraction=1 - curve.deformed_length / 0.3, force=force, measured="force"
    )
    found = calibrate(noisy)
    assert found.names == ("c10", "fiber_extension")
    assert found.material.c01 == pytest.approx(0.5 * found.material.c10)
    assert any("c01 = 0.5 c10, as in the first guess: the data do not tell both" in note for note in found.notes)
    assert found.intervals[0, 0] < 0.2e6 < found.intervals[0, 1]


def test_no_rubber_vanishes():
    """The other constant was given as four times all there is: alone, the first would end at nothing."""
    guess = replace(TRUTH, material=MooneyRivlin(0.15e6, 0.6e6))
    found = calibrate(lengths(TRUTH, guess), "c10")
    assert found.values[0] > 0.02e6
    assert any("c01 = 4 c10, as in the first guess" in note for note in found.notes)


def test_a_curve_without_pressure_counts():
    """At P = 0 a stretched muscle is a rubber tube: it tells the rubber."""
    tube = replace(TRUTH, fiber_extension=1.0)
    guess = replace(tube, material=MooneyRivlin(0.12e6, 0.06e6))
    made = Measurement(guess, 0.0, stroke=[-4e-3, -3e-3, -2e-3, -1e-3, 0.0, 3e-3], force=np.ones(6), measured="force")
    (force,) = exact([made], tube)
    assert (force[:4] > 1.0).all()
    assert force[4:].tolist() == [0.0, 0.0]
    found = calibrate(
        replace(made, stroke=0.3 - made.deformed_length, deformed_length=None, force=force), "c10", ties=TIES
    )
    assert found.values == pytest.approx([0.2e6], rel=1e-4)


def test_three_forces_that_are_met_exactly_do_not_count_as_exact():
    """As many as parameters: their scatter tells nothing, intervals were a ninth of what they had to be."""
    rng = np.random.default_rng(33)
    truth, guess = muscle(rng)
    curves = bench(truth, guess, rng, states=(10, 2))
    assert np.count_nonzero(curves[1].force) == 3
    found = calibrate(curves, FIT, ties=TIES)
    assert found.sigma["force"] > 1e-3 * curves[1].force.max()
    off = np.abs(found.values - values(truth)) / (0.5 * np.ptp(found.intervals, axis=1))
    assert np.all(off < 1.5)


def test_pictures_show_lengths_as_they_were_given_and_what_was_found():
    found = calibrate([lengths(TRUTH, GUESS), forces(TRUTH, GUESS)], FIT, ties=TIES)
    free, pulled = found.measurements
    title, shown = axis(pulled, "deformed_length")
    assert title == "contraction [%]"
    assert shown(pulled.deformed_length) == pytest.approx(np.tile(np.linspace(0.0, 25.0, 6), 2), abs=1e-12)
    title, shown = axis(replace(free, deformed_length=None, stroke=0.3 - free.deformed_length), "deformed_length")
    assert title == "stroke [mm]"
    assert shown(np.array([0.3, 0.29])) == pytest.approx([0.0, 10.0])
    assert axis(free, "deformed_length")[0] == "deformed length [mm]"
    assert words_of(found, 0) == []  # one actuator only
    thicker = replace(found, tubes=(found.tubes[0], replace(found.tubes[1], wall=2.54e-3, alpha=30.0)))
    assert words_of(thicker, 0, shown_as([("1 in", "m")])) == ["alpha 25 deg", "wall 0.05906 in"]  # 26 was the guess


def test_the_picture_is_drawn_in_the_style_of_the_house():
    """Its type and colours, axes open at the top, units of the data, a key that tells marks, curves told at their ends."""
    found = calibrate([lengths(TRUTH, GUESS), forces(TRUTH, GUESS)], FIT, ties=TIES)
    figure = picture(found, shown_as([("1 psi", "Pa"), ("1 lbf", "N")]))
    top, other, bottom, _ = figure.axes
    assert top.xaxis.label.get_fontfamily() == style.SETTINGS["font.family"]
    assert [line.get_color() for line in top.lines[:1]] == style.ramp(1)
    assert not any(ax.spines[side].get_visible() for ax in figure.axes for side in ("top", "right"))
    assert (bottom.get_xlabel(), other.get_ylabel()) == ("pressure [psi]", "force [lbf]")
    assert [text.get_text() for text in other.texts if text.get_gid() == "end"] == ["14.5 psi", "43.51 psi"]
    assert [len(ax.lines) for ax in found.picture().axes] == [len(ax.lines) for ax in figure.axes]
    (key,) = figure.legends
    assert [text.get_text() for text in key.get_texts()][-1] == "slack muscle"


def test_a_model_is_drawn_between_what_was_measured_and_goes_through_what_it_says_there():
    """Chords between few states had corners that no muscle has."""
    found = calibrate([lengths(TRUTH, GUESS), forces(TRUTH, GUESS)], FIT, ties=TIES)
    for k, measurement in enumerate(found.measurements):
        joined = [(states, predicted[:, 0]) for states, predicted in between(found, k)]
        assert sum(len(states) for states, _ in joined) > 2 * len(measurement)
        said = {}
        for states, model in joined:
            said |= dict(zip(zip(states.pressure, states.imposed("deformed_length")), model))
        for row, value in enumerate(found.predicted[k][:, 0]):
            drawn = said[measurement.pressure[row], measurement.imposed("deformed_length")[row]]
            if value >= 0.0:
                assert drawn == pytest.approx(value, rel=1e-6)
            else:
                assert np.isnan(drawn)  # a push that was not measured


def test_intervals_that_only_rounding_parts_are_called_the_same():
    found = calibrate([lengths(TRUTH, GUESS), forces(TRUTH, GUESS)], FIT, ties=TIES)
    assert repr(found) == table(found)  # as the shell prints it
    rounded = replace(found, profile_intervals=found.intervals * (1.0 + 1e-12))
    assert "by profile likelihood" not in table(rounded)
    farther = replace(found, profile_intervals=np.add(found.intervals, [[1e4, 0.0], [0.0, 0.0], [0.0, 0.0]]))
    rows = table(farther).splitlines()
    assert "by profile likelihood" in rows[0]
    assert [row.endswith("the same") for row in rows[1:4]] == [False, True, True]


def part(whole, seen):
    """Some points of a force-length bench."""
    return Measurement(
        whole.tube, whole.pressure[seen], contraction=1 - whole.deformed_length[seen] / whole.tube.length,
        force=whole.force[seen], measured="force",
    )  # fmt: skip


def test_a_wrong_angle_is_called_wrong_and_halves_agree():
    """The angle is not fitted: intervals of both halves of the data still meet, as they are widened."""
    rng = np.random.default_rng(1)
    truth, guess = muscle(rng)
    data = bench(truth, guess, rng, noise=3e-3)
    found = calibrate(data[1], ["c10", "fiber_extension"], ties=TIES)
    assert not found.fits
    assert found.notes[0].startswith("the model does not fit: ")
    assert found.widening.max() > 1.5
    order = np.arange(len(data[1].pressure))
    one, other = (calibrate(part(data[1], order % 2 == k), ["c10", "fiber_extension"], ties=TIES) for k in range(2))
    assert np.all(np.abs(one.values - other.values) < 2.0 * np.hypot(one.standard_errors, other.standard_errors))
    right = calibrate(data[1], FIT, ties=TIES)
    assert right.fits
    assert right.leave_one_out["force"] < 0.5 * found.leave_one_out["force"]
    assert np.all(np.abs(right.values - values(truth)) < 4.0 * right.standard_errors)


def three_forces(by):
    """Of a muscle held at its length, with the share by which each is off."""
    pressure = np.array([1e5, 2e5, 3e5])
    made = Measurement(GUESS, pressure, contraction=np.zeros(3), force=np.ones(3), measured="force")
    (force,) = exact([made], replace(TRUTH, alpha=GUESS.alpha, beta=GUESS.beta))
    return Measurement(GUESS, pressure, contraction=np.zeros(3), force=force * (1.0 + by), measured="force")


def test_three_forces_that_are_missed_by_much_are_not_called_met():
    """They are too few for any test of noise: what is a tenth off was said to fit."""
    wrong, right = (
        calibrate(three_forces(share * np.array([1.0, -1.0, 1.0])), ["c10", "fiber_extension"], ties=TIES)
        for share in (0.2, 0.01)
    )
    assert not wrong.fits
    assert "too few values tell of any noise" in wrong.notes[0]
    assert right.fits


def test_no_interval_reaches_beyond_what_can_be():
    """Three forces hardly tell a rubber from extended fibers: the formula alone would go below nothing."""
    found = calibrate(three_forces(np.array([0.03, -0.03, 0.02])), ["c10", "fiber_extension"], ties=TIES)
    assert found.intervals[:, 0].tolist() == [0.0, 1.0]
    assert np.all(found.profile_intervals[:, 0] >= [0.0, 1.0])
    assert np.all(np.minimum(found.intervals[:, 1], found.profile_intervals[:, 1]) > found.values)


def test_leaving_out_a_curve_foretells_a_fit_without_it():
    rng = np.random.default_rng(8)
    truth, guess = muscle(rng)
    whole = bench(truth, guess, rng)[1]
    found = calibrate(whole, FIT, ties=TIES)
    missed = []
    for pressure in np.unique(whole.pressure):
        seen = whole.pressure != pressure
        refit = calibrate(part(whole, seen), FIT, ties=TIES)
        own = ~seen & (whole.force > 0.0)
        unseen = refit.band("force", whole.pressure[own], deformed_length=whole.deformed_length[own])
        missed.append(unseen.force.values - whole.force[own])
    assert found.leave_one_out["force"] == pytest.approx(np.sqrt(np.mean(np.concatenate(missed) ** 2)), rel=0.25)


def test_faults_of_what_is_known():
    curve = lengths(TRUTH, GUESS)
    with pytest.raises(ActuatorError) as caught:
        calibrate(
            curve, ["alpha", "colour"], bounds={"wall": (2, 1)}, priors={"alpha": (30, -1), "beta": 3},
            ties={"beta": "alpha+1"}, gamma=(1, 1),
        )  # fmt: skip
    starts = [
        "fit: found 'colour'",
        "bounds of wall",
        "priors of alpha",
        "priors of beta",
        "priors: found str 'gamma'",
        "ties",
    ]
    assert [any(fault.startswith(start) for fault in caught.value.faults) for start in starts] == [True] * 6


def test_the_shell_and_toml_say_the_same(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    curve = lengths(TRUTH, GUESS)
    rows = "".join(f"{p / 1e3:.6f};{300 - 1e3 * v:.6f};x\n" for p, v in zip(curve.pressure, curve.deformed_length))
    (tmp_path / "free.csv").write_text(f"pressure [kPa(g)];stroke [mm];remark\n{rows}")
    (tmp_path / "case.toml").write_text(
        '[data]\nfiles = ["free.csv"]\n[actuator]\nalpha = "26 deg"\nlength = "300 mm"\nradius = "8 mm"\nwall = "1.5 mm"\n'
        'c10 = "0.15 MPa"\nc01 = "75 kPa"\n[fit]\nparameters = ["c10", "fiber_extension"]\n[priors]\nalpha = [25, "1 deg"]\n'
        '[ties]\nc01 = "0.5*c10"\n'
    )
    words = [
        "--alpha",
        "26",
        "--beta",
        "-26",
        "--length",
        "300 mm",
        "--radius",
        "8 mm",
        "--wall",
        "1.5 mm",
        "--c10",
        "0.15 MPa",
    ]
    known = ["--c01", "75 kPa", "--fit", "c10", "fiber_extension", "--prior", "alpha=25,1 deg", "--tie", "c01=0.5*c10"]
    assert run("calibrate", "free.csv", *words, *known) == DONE
    shell = capsys.readouterr().out
    assert run("calibrate", "case.toml", "--report", "page.html") == DONE
    toml = capsys.readouterr().out
    assert toml == shell + "page.html\n"
    assert "1 column not needed and passed over: 'remark' (column 3)" in shell
    page = (tmp_path / "page.html").read_text()
    assert "data:image/png;base64," in page
    assert "[actuator]" in page
    assert "://" not in page  # nothing is fetched
    (line,) = re.findall(r"<pre>(fs.Actuator.*?)</pre>", html.unescape(page))
    assert "None" not in line  # nor what is as usual
    assert eval(line, {"fs": freesweep}).alpha == pytest.approx(25.0, abs=0.1)
    assert run("calibrate", "case.toml", "--json", "--report", "page.PDF", "--out", "kept.nc") == DONE
    told = capsys.readouterr()
    assert json.loads(told.out)["fits"]  # and nothing behind it
    assert told.err == "kept.nc\npage.PDF\n"
    assert (tmp_path / "page.PDF").read_bytes().startswith(b"%PDF")
    assert "--report: found" in refused(capsys, "calibrate", "case.toml", "--report", "page.docx")
    (tmp_path / "case.toml").write_text("[data]\nfile = 1\n")
    assert "data.file: unknown; it has files, measured" in refused(capsys, "calibrate", "case.toml")


@pytest.fixture(scope="module")
def muscle_read():
    """Free lengths of a muscle whose families differ from what its actuator says of the second."""
    truth = Actuator(alpha=30, beta=-30, length=0.2, radius=6e-3, wall=1e-3, material=MooneyRivlin(1.2e5, 6e4))
    pressure = np.linspace(2e4, 2e5, 8)
    noise = 1e-4 * np.random.default_rng(1).standard_normal(8)
    read = inflate(truth, pressure, x=0.0)["deformed_length"].values + noise
    guess = replace(truth, beta=-50, material=MooneyRivlin(1.5e5, 6e4))
    return Measurement(guess, pressure, deformed_length=read)


@pytest.mark.parametrize(
    ("asked", "words"),
    [
        ({"bounds": {"alpha": (0, 95), "wall": (-1e-3, 2e-3)}}, ["bounds of alpha: found 95", "wall: found -0.001"]),
        ({"bounds": {"fiber_extension": (0.5, 2)}}, ["bounds of fiber_extension: found 0.5, allowed is 1 to 10"]),
        ({"bounds": {"radius": (1e-3, 2e-3)}}, ["bounds of radius: it is not fitted"]),
        ({"priors": {"alpha": (95, 1)}}, ["priors of alpha: found 95"]),
        ({"priors": {"alpha": (30, 1)}, "alpha": (31, 1)}, ["priors: found alpha twice"]),
        ({"fit": ["alpha", "beta"], "ties": {"beta": "-alpha"}}, ["fit: beta is tied"]),
        (
            {"ties": {"beta": "-alpha", "alpha": "2*beta"}},
            ["'beta': tied to 'alpha', which", "'alpha': tied to 'beta'"],
        ),
        ({"ties": {"wall": "c10"}}, ["what is in [m] cannot follow what is in [Pa]"]),
        ({"ties": {"wall": "1.2.3*radius"}}, ["tie a parameter to a number times another"]),
    ],
)
def test_what_no_calibration_can_follow_is_refused(muscle_read, asked, words):
    with pytest.raises(ActuatorError) as fault:
        calibrate(muscle_read, **{"fit": ["c10", "alpha", "wall", "fiber_extension"]} | asked)
    said = fault.value.faults
    assert all(any(word in one for one in said) for word in words)
    assert len(said) == len(words)


def test_a_tie_holds_where_what_it_follows_is_not_fitted(muscle_read):
    """The second family mirrors the first, whatever the actuator says of it."""
    found = calibrate(muscle_read, "c10", ties={"beta": "-alpha"})
    assert found.tubes[0].beta == -30.0
    assert found.values.item() == pytest.approx(1.2e5, rel=0.02)


@pytest.mark.parametrize(
    ("alpha", "beta", "c10", "wall", "top", "off"),
    [
        (36.22046965, -56.71108998, 165786.717, 9.566276e-4, 73645.511, 1.98),
        (40.68839407, -51.91293947, 146661.940, 1.35789568e-3, 86344.645, -0.52),
    ],
)
def test_a_muscle_that_hardly_pushes_misleads_no_fit(alpha, beta, c10, wall, top, off):
    """What it pushes where the bench read next to nothing is told from a slope at no force: that of the tube, not of a far
    stiffer one that the first look passed. All else is exact, so the fit is the truth.
    """
    truth = Actuator(alpha=alpha, beta=beta, length=0.15, radius=5e-3, wall=wall, material=MooneyRivlin(c10, 0.5 * c10))
    guess = replace(truth, alpha=alpha + off, material=MooneyRivlin(1.5e5, 0.75e5))
    pressure = np.linspace(0.1, 1.0, 10) * top
    free, thrust = inflate(truth, pressure, x=0.0), np.pi * 5e-3**2 * pressure
    force = blocked_force(truth, pressure, 0.148, x=0.0)["force"].values
    hardly = (force < 0.0) & (force > -0.1 * thrust)
    assert np.any(hardly)
    measured = [
        Measurement(
            guess, pressure, deformed_length=free["deformed_length"].values, rotation=free["rotation"].values,
            measured=("deformed_length", "rotation"), sigma={"deformed_length": 2e-4, "rotation": 1.0},
        ),
        Measurement(
            guess, pressure, deformed_length=0.148, force=np.where(hardly, -0.015 * thrust, force), measured="force",
            sigma={"force": 0.03},
        ),
    ]  # fmt: skip
    found = calibrate(measured, ["c10", "alpha"], ties={"c01": "0.5*c10"})
    assert found.values == pytest.approx([c10, alpha], rel=0.02)
    assert found.predicted[1][:, 0] == pytest.approx(force, abs=0.06)
