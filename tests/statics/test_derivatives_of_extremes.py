"""Derivatives of what is largest and least along a tube, and of the shares of it along which fibers are slack: by scaling
laws, by differences of the solver as far as its bounds tell, and where there is nothing to be told.
"""

import numpy as np
import pytest

import freesweep as fs
from freesweep.derivative import asked, attach
from freesweep.derivative.extremes import EXTREMES

RUBBER = fs.MooneyRivlin(c10=0.11e6, c01=0.06e6)
TUBE = {"alpha": 30, "beta": -50, "length": 0.12, "radius": 4.76e-3, "wall": 1.59e-3, "material": RUBBER}
LOADS = {"pressure": 5e4, "force": 1.0, "torque": 4e-3}
TWISTED = {"alpha": 40, "beta": 5, "model": "physical"}  # some of whose threads are slack
# powers of a length and of a stress in each parameter, and output
LENGTHS = {"length": 1, "radius": 1, "wall": 1, "force": 2, "torque": 3, "outer_radius": 1}
LENGTHS |= {"least_tension_alpha": 2, "least_tension_beta": 2}
STRESSES = dict.fromkeys(("c10", "c01", "pressure", "force", "torque", "least_tension_alpha", "least_tension_beta"), 1)
KINDS = {
    "source": {},
    "physical": {"model": "physical"},
    "slack": TWISTED,
    "pushed": {"alpha": 40, "beta": 5},
    "varying": {"alpha": [(0, 25), (1, 40)]},
    "jump": {"model": "physical", "wall": [(0, 1e-3), (0.5, 1e-3), (0.5, 1.5e-3), (1, 1.5e-3)]},
    "body": {"taper": 0.2, "bulge": 0.1},
}


def found_of(changes, **more):
    return fs.inflate(fs.Actuator(**TUBE | changes), **LOADS, x=[0.0], **more)


@pytest.fixture(params=[True, False], ids=["vectors", "meshes"])
def by_vectors(request, monkeypatch):
    monkeypatch.setattr(attach, "is_worth_vectors", lambda *_: request.param)
    return request.param


VARYING = "varying", "jump", "body"  # of which vectors tell nothing
SCALED = [
    pytest.param(kind, powers, way == "vectors", id=f"{kind}-{what}-{way}")
    for kind in KINDS
    for what, powers in (("lengths", LENGTHS), ("stresses", STRESSES))
    for way in ("vectors", "meshes")
    # a wall that jumps is not scaled, but moved, by its derivative
    if not (way == "vectors" and kind in VARYING) and not (what == "lengths" and kind == "jump")
]


@pytest.mark.parametrize(("kind", "powers", "in_vectors"), SCALED)
def test_extremes_scale_as_lengths_and_stresses_do(kind, powers, in_vectors, monkeypatch):
    """A homogeneous function's derivatives add up to its own multiple (Euler)."""
    monkeypatch.setattr(attach, "is_worth_vectors", lambda *_: in_vectors)
    if in_vectors:
        monkeypatch.setattr(asked.Asked, "state", None)
    changes = KINDS[kind]
    found = found_of(changes, derivatives="all")
    assert int(found["status"]) == 0
    sizes = {"length": 0.12, "radius": 4.76e-3, "wall": 1.59e-3, "c10": RUBBER.c10, "c01": RUBBER.c01} | LOADS
    for output in EXTREMES:
        total = bound = 0.0
        for name, size in sizes.items():
            if powers.get(name):
                total += powers[name] * size * float(found[f"d_{output}_d_{name}"])
                bound += powers[name] * size * float(found[f"d_{output}_d_{name}_error"])
        exact = powers.get(output, 0) * float(found[output])
        assert abs(total - exact) <= bound + powers.get(output, 0) * float(found[f"{output}_error"]), output
        assert bound <= 1e-4 * (abs(exact) or 1.0), output


@pytest.mark.parametrize(("kind", "name", "step"), [
    ("source", "alpha", 0.05), ("physical", "wall", 2e-6), ("slack", "pressure", 50.0), ("pushed", "beta", 0.02),
    pytest.param("varying", "alpha", 0.05, marks=pytest.mark.long),
    pytest.param("body", "taper", 1e-3, marks=pytest.mark.long),
])  # fmt: skip
def test_extremes_change_as_differences_tell(kind, name, step):
    changes = KINDS[kind]
    found = found_of(changes, derivatives=name)
    at = LOADS.get(name, (TUBE | changes).get(name))

    def moved(by):
        value = [(x, one + by) for x, one in at] if isinstance(at, list) else at + by
        own = changes if name in LOADS else changes | {name: value}
        loads = LOADS | ({name: value} if name in LOADS else {})
        return fs.inflate(fs.Actuator(**TUBE | own), **loads, x=[0.0], accuracy=1e-10)

    far, near = [[moved(side * part * step) for side in (1.0, -1.0)] for part in (1.0, 0.5)]
    changing = 0
    for output in EXTREMES:
        slopes = [
            float(one[output] - other[output]) / (2.0 * part * step) for (one, other), part in ((far, 1.0), (near, 0.5))
        ]
        told = (4.0 * slopes[1] - slopes[0]) / 3.0
        doubt = abs(told - slopes[1]) + 4.0 * max(float(one[f"{output}_error"]) for one in near) / step
        exact, bound = (float(found[f"d_{output}_d_{name}{end}"]) for end in ("", "_error"))
        assert abs(exact - told) <= bound + doubt, output
        changing += exact != 0.0
    assert changing >= 3


def test_where_a_tube_is_widest_beside_the_end_of_a_piece_it_changes_as_it_does_there():
    """Just before the middle of a tube whose angle jumps: differences of the solver at 1e-9, of 0.4 and 0.2 um."""
    jump = 0.2555703014317311
    tube = fs.Actuator(
        alpha=[(0, -36.57092911645241), (jump, -36.57092911645241), (jump, -24.054645459761577), (1, -24.054645459761577)],
        beta=None, length=22.502998987404904e-3, radius=1.2617630552164583e-3, wall=94.28407504254959e-6,
        fiber_radius=1.2988651472655834e-3, material=fs.MooneyRivlin(105036.31618377719, 112744.54925920445),
    )  # fmt: skip
    found = fs.inflate(tube, 43286.218583800786, torque=-3.733862778560661e-4, derivatives="wall")
    for output, told, doubt in (("outer_radius", -129.18097, 3e-5), ("largest_stretch", -117168.096, 0.03)):
        exact, bound = (float(found[f"d_{output}_d_wall{end}"]) for end in ("", "_error"))
        assert abs(exact - told) <= doubt
        assert doubt < bound < 2e-4 * abs(told)


def test_where_a_tube_stretches_most_just_where_fibers_go_slack_it_changes_as_that_place_moves(monkeypatch):
    """The stretch has a corner there, in which it is no end that stays, and no place of vanishing slope."""
    monkeypatch.setattr(attach, "is_worth_vectors", lambda *_: False)
    tube = fs.Actuator(
        alpha=83.4, beta=-83.4, length=0.0415, radius=0.014, wall=4.15e-3, fiber_radius="middle", model="physical",
        material=fs.NeoHookean(145530.0),
    )  # fmt: skip
    loads, torque, step = {"pressure": 1.8e5, "force": 118.0}, 0.99, 2e-3
    found = fs.inflate(tube, **loads, torque=torque, x=[0.0], derivatives="torque")
    far, near = (
        [fs.inflate(tube, **loads, torque=torque + side * by, x=[0.0], accuracy=1e-10) for side in (1.0, -1.0)]
        for by in (step, 0.5 * step)
    )
    slopes = [float(one["largest_stretch"] - other["largest_stretch"]) for one, other in (far, near)]
    told = (8.0 * slopes[1] - slopes[0]) / (6.0 * step)
    exact, bound = (float(found[f"d_largest_stretch_d_torque{end}"]) for end in ("", "_error"))
    assert 0.0 < float(found["slack_beta"]) < 1.0
    assert exact == pytest.approx(told, rel=1e-6)
    assert bound < 1e-6


def test_shares_that_are_none_or_all_do_not_change(by_vectors):
    found = found_of({}, derivatives="alpha")
    for family in ("alpha", "beta"):
        assert float(found[f"slack_{family}"]) == 0.0
        assert float(found[f"d_slack_{family}_d_alpha"]) == 0.0


def test_share_along_which_fibers_would_have_to_push_changes_as_where_they_bear_nothing(monkeypatch):
    """Pulls hardly change along the tube where they end: what counts as none there, a billionth of the load, moves that."""
    tube = fs.Actuator(
        alpha=85, beta=-58.9, length=0.05037, radius=3.016e-3, wall=0.6665e-3, wall_model="membrane", fibers="bonded",
        fiber_radius="outer", material=fs.MooneyRivlin(66186.0, 61797.0),
    )  # fmt: skip
    one, other = (
        told_by(way, monkeypatch, tube, pressure=8390.3, force=0.16848, torque=4.3354e-4) for way in (True, False)
    )
    assert 0.98 < float(one["slack_beta"]) < 1.0
    for name in ("alpha", "length", "pressure", "torque"):
        (exact, bound), (told, doubt) = (
            [float(found[f"d_slack_beta_d_{name}{end}"]) for end in ("", "_error")] for found in (one, other)
        )
        assert abs(exact - told) <= bound + doubt, name
        assert bound + doubt <= 1e-6 * abs(exact), name


def test_loose_tubes_that_hardly_bend_are_told_as_exactly_as_they_settle(monkeypatch):
    """Of what bends them little is left of the resultant's digits: vectors are as far from meshes as their bounds say."""
    tube = fs.Actuator(
        alpha=2.0, beta=None, length=6.3e-3, radius=2.73e-3, wall=1.72e-3, fiber_extension=1.0027, model="physical",
        material=fs.MooneyRivlin(192606.0, 56182.0),
    )  # fmt: skip
    one, other = (
        told_by(way, monkeypatch, tube, pressure=4166.0, force=0.0967, torque=1.16e-4) for way in (True, False)
    )
    for output in ("deformed_length", "rotation", "volume"):
        for name in ("pressure", "force", "torque"):
            (exact, bound), (told, doubt) = (
                [float(found[f"d_{output}_d_{name}{end}"]) for end in ("", "_error")] for found in (one, other)
            )
            assert abs(exact - told) <= bound + doubt, (output, name)


def told_by(in_vectors, monkeypatch, tube, **loads):
    monkeypatch.setattr(attach, "is_worth_vectors", lambda *_: in_vectors)
    return fs.inflate(tube, **loads, x=[0.0], accuracy=1e-6 if in_vectors else 1e-9, derivatives="all")


def test_tension_of_slack_threads_does_not_change(by_vectors):
    found = found_of(TWISTED, derivatives="pressure")
    some = [family for family in ("alpha", "beta") if 0.0 < float(found[f"slack_{family}"]) < 1.0]
    assert some
    for family in some:
        assert float(found[f"d_least_tension_{family}_d_pressure"]) == 0.0
        assert abs(float(found[f"d_slack_{family}_d_pressure"])) > 1e-9


def test_a_family_that_is_not_there_has_no_derivative_but_zero(by_vectors):
    found = found_of({"beta": None, "model": "physical"}, derivatives="pressure")
    assert float(found["d_least_tension_beta_d_pressure"]) == float(found["d_slack_beta_d_pressure"]) == 0.0
    assert float(found["d_least_tension_alpha_d_pressure"]) != 0.0


def test_a_locked_shape_s_tensions_are_per_pressure():
    found = fs.lock(fs.Actuator(**TUBE), x=[0.0], derivatives="all")
    assert found["d_least_tension_alpha_d_beta"].attrs["units"] == "N/Pa/degree"
    assert float(found["d_least_tension_alpha_d_c10"]) == 0.0
    exact = 2.0 * float(found["least_tension_alpha"])  # an area
    total = sum(TUBE[name] * float(found[f"d_least_tension_alpha_d_{name}"]) for name in ("length", "radius", "wall"))
    assert total == pytest.approx(exact, rel=1e-6)


def test_a_cylinder_that_is_largest_all_along_has_none():
    state = {"alpha": 40, "beta": -40, "wall": [(0, 1e-3), (1, 2e-3)]}
    tube = fs.Actuator(**TUBE | state)
    found = fs.blocked_force(tube, 5e4, x=[0.0], derivatives="pressure")
    exact, bound = (float(found[f"d_largest_stretch_d_pressure{end}"]) for end in ("", "_error"))
    assert np.isnan(exact) or bound >= abs(exact) or float(found["largest_stretch"]) > 1.0 + 1e-9
