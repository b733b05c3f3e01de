"""Tubes with one family of fibers, or none: balloons, against textbooks, linear elasticity and brute force."""

import numpy as np
import pytest
from loose_tubes import Tube
from matplotlib.figure import Figure
from scipy.optimize import brentq, minimize_scalar

from freesweep import (
    Actuator,
    ActuatorError,
    MooneyRivlin,
    NeoHookean,
    blocked_force,
    blocked_torque,
    inflate,
    lock,
)
from freesweep.cli import parser
from freesweep.cli.single import tube_of
from freesweep.description.tube_model import THREADS
from freesweep.plot.shape import draw_shape, shape_of
from freesweep.solver.physics import wall as kernels_of_walls
from freesweep.status import BEYOND_LIMIT, OK
from freesweep.sweep.spec import parse

RUBBER = MooneyRivlin(c10=0.17e6, c01=0.08e6)
RADIUS, WALL = 5e-3, 0.8e-3


def tube(alpha=None, beta=None, length=0.05, **more):
    return Actuator(
        **{"alpha": alpha, "beta": beta, "length": length, "radius": RADIUS, "wall": WALL, "material": RUBBER} | more
    )


# --- the textbook's long capped cylinder: twice the axial stress around


def textbook(y, rubber, thick):
    """Axial stretch and pressure [Pa] of a long balloon whose inner surface is stretched by ``y`` around."""
    outer = ((RADIUS + WALL) / RADIUS) ** 2
    places, weights = np.polynomial.legendre.leggauss(20) if thick else (np.array([-1.0]), np.array([2.0]))
    square, weight = 1.0 + 0.5 * (outer - 1.0) * (1.0 + places), 0.5 * (outer - 1.0) * weights

    def forces(s):
        """Derivatives of the strain energy over pi r^2 along the axial stretch s and y [Pa]: layers of radius^2 ``square``
        keep their volume.
        """
        h = np.sqrt((y * y + (square - 1.0) / s) / square)
        by_s = 2.0 * rubber.c10 * (s - 1.0 / (s**3 * h**2)) + 2.0 * rubber.c01 * (s * h**2 - 1.0 / s**3)
        by_h = 2.0 * rubber.c10 * (h - 1.0 / (s**2 * h**3)) + 2.0 * rubber.c01 * (s**2 * h - 1.0 / h**3)
        h_s, h_y = (1.0 - square) / (2.0 * s * s * h * square), y / (h * square)
        return weight @ (by_s + by_h * h_s), weight @ (by_h * h_y)

    def unbalanced(s):
        by_s, by_y = forces(s)
        return 2.0 * s * by_s - y * by_y  # p = W_s/y^2 = W_y/(2 y s)

    s = brentq(unbalanced, 0.7, 2.0 * y, xtol=1e-14)
    return s, forces(s)[0] / y**2


def textbook_limit(rubber, thick):
    """Where the textbook's pressure is largest [Pa]."""
    top = minimize_scalar(
        lambda y: -textbook(y, rubber, thick)[1], bounds=(1.1, 3.0), method="bounded", options={"xatol": 1e-7}
    )
    assert 1.2 < top.x < 2.9
    return -top.fun


LONG = 1.2  # [m]: the ends raise a limit by the fourth power of radius over length


@pytest.mark.parametrize(
    "rubber", [NeoHookean(c10=0.2e6), MooneyRivlin(c10=0.2e6, c01=0.02e6)], ids=["neo-Hookean", "Mooney-Rivlin"]
)
@pytest.mark.parametrize("wall_model", ["membrane", "thick"])
def test_a_long_balloon_ends_at_the_limit_pressure_of_the_textbook(rubber, wall_model):
    limit = textbook_limit(rubber, wall_model == "thick")
    balloon = tube(length=LONG, material=rubber, wall_model=wall_model)
    found = inflate(balloon, [0.5 * limit, 1.01 * limit], x=[0.0, 0.5 * LONG])
    assert found["status"].values.tolist() == [OK, BEYOND_LIMIT]
    assert found["limit_pressure"].item() == pytest.approx(limit, rel=1e-6)
    assert found["limit_pressure"].item() > limit * (1.0 - 1e-9)  # the ends hold
    y = found["mid_radius"][0].item() / RADIUS
    assert textbook(y, rubber, wall_model == "thick")[1] == pytest.approx(0.5 * limit, rel=1e-6)
    assert found["rotation"][0].item() == 0.0


# --- small pressures: linear elasticity of a tube with one inextensible family


def response(tangent, inner, outer, rubber):
    """Strains per pressure [1/Pa] of a long tube: along the axis, around at the fibers (radius 1), and the twist rate.

    A layer has the strains e, h = A/rho^2 - e/2 and rho psi, where A is half of the strain of the cavity's volume beside the
    axis' share, so the wall stores ``stiffness (4 (e^2 + e h + h^2) + rho^2 psi^2)`` over pi. A membrane is one layer.
    """
    area, stiffness = outer**2 - inner**2, rubber.c10 + rubber.c01
    if outer > 1.0 and inner == 1.0:  # a membrane at the fibers
        hoop, shear = area, area
    else:
        hoop, shear = 1.0 / inner**2 - 1.0 / outer**2, 0.5 * (outer**4 - inner**4)
    matrix = stiffness * np.diag([6.0 * area, 8.0 * hoop, 2.0 * shear])
    row = np.array([1.0 - 0.5 * tangent**2, tangent**2, tangent])[None]  # the strain of the fibers, of e, A, psi
    held = np.block([[matrix, stiffness * row.T], [stiffness * row, np.zeros((1, 1))]])
    e, growth, psi, _ = np.linalg.solve(held, [0.0, 2.0, 0.0, 0.0])  # stationary 2 p A - W at p = 1
    return e, growth - 0.5 * e, psi


@pytest.mark.parametrize("wall_model", ["membrane", "thick"])
@pytest.mark.parametrize("alpha", [20, 70])
def test_one_family_answers_a_small_pressure_as_linear_elasticity_does(alpha, wall_model):
    """In the middle of a long tube; the fibers outside a thick wall, inside a membrane."""
    pressure, inside = 2.0, wall_model == "membrane"
    one = tube(alpha, length=0.3, fibers="loose", wall_model=wall_model, fiber_radius="inner" if inside else "outer")
    with pytest.warns(UserWarning, match="hardly deforms"):
        found = inflate(one, pressure, x=[0.14, 0.15, 0.16], accuracy=1e-10)
    r = one.fiber_surface
    t = np.tan(np.radians(alpha))
    e, b, psi = response(t, RADIUS / r, (RADIUS + WALL) / r, RUBBER)
    z, turn = found["axial_position"].values, np.radians(found["twist"].values)
    assert found["slack_fiber"] == 0
    assert (found["deformed_radius"].values[1] / r - 1.0) / pressure == pytest.approx(b, rel=1e-4)
    assert ((z[2] - z[0]) / 0.02 - 1.0) / pressure == pytest.approx(e, rel=1e-4)
    assert (turn[2] - turn[0]) / 0.02 * r / pressure == pytest.approx(psi, rel=1e-4)


# --- against what eliminates nothing


def agree(found, expected, actuator, tolerance):
    r, c10 = actuator.fiber_surface, RUBBER.c10
    inside = (1.0 - (RADIUS / r) ** 2) * actuator.length / r
    mine = [
        found["deformed_length"].item() / r,
        found["volume"].item() / (np.pi * r**3) + inside,
        np.radians(found["rotation"].item()),
        found["strain_energy"].item() / (np.pi * r**3 * c10),
        found["mid_radius"].item() / r,
    ]
    assert mine == pytest.approx(expected[:5], rel=tolerance, abs=0.1 * tolerance)


def brute(actuator, pressure, **more):
    r = actuator.fiber_surface
    there = actuator.alpha is not None, actuator.beta is not None
    angles = [0.0 if angle is None else angle for angle in (actuator.alpha, actuator.beta)]
    outer = (RADIUS + WALL) / r
    wall = {"inner": RADIUS / r, "outer": outer} if actuator.is_thick else {"area": outer**2 - (RADIUS / r) ** 2}
    own = Tube(
        *angles,
        actuator.length / r,
        loose=actuator.is_loose,
        there=there,
        rubber=(RUBBER.c01 / RUBBER.c10, 0, 0),
        **wall,
    )
    return own.extrapolated(pressure / RUBBER.c10, **more)


@pytest.mark.parametrize(
    ("more", "pressure", "tolerance"),
    [
        ({}, 4e4, 1e-7),
        ({"model": "physical"}, 4e4, 1e-7),
        ({"alpha": 30}, 5e4, 1e-7),
        ({"beta": -55, "model": "physical"}, 6e4, 2e-5),
    ],
    ids=["balloon", "thick balloon", "one bonded family", "one loose family and a thick wall"],
)
def test_states_are_those_of_brute_force(more, pressure, tolerance):
    actuator = tube(**more)
    found = inflate(actuator, pressure, x=0.0)
    assert found["status"] == OK
    agree(found, brute(actuator, pressure), actuator, tolerance)


# --- what is said of families that there are not


def test_a_word_says_none_and_numbers_of_the_solver_are_those_of_the_description():
    assert tube("none", " None ") == tube()
    assert hash(tube("none")) == hash(tube())
    assert tube(30) != tube(None, 30)
    assert hash(tube(30)) != hash(tube(None, 30))
    known = kernels_of_walls.BONDED, kernels_of_walls.LOOSE, kernels_of_walls.ONE_LOOSE, kernels_of_walls.ONE_BONDED
    assert [THREADS[key] for key in ((2, "bonded"), (2, "loose"), (1, "loose"), (1, "bonded"))] == list(known)
    assert THREADS[0, "loose"] == THREADS[0, "bonded"] == kernels_of_walls.NONE
    assert [tube(*angles).threads for angles in ((30, -30), (30, None), (None, None))] == [0.0, 3.0, 4.0]
    assert [tube(*angles, fibers="loose").threads for angles in ((30, -30), (None, 30), (30, 30))] == [1.0, 2.0, 2.0]


def test_a_family_that_is_not_there_has_no_angle_and_no_tension_and_is_not_slack():
    pressure, x = 4e4, [0.0, 0.01, 0.025]
    alone, mirrored, both = (
        inflate(tube(*angles, fibers="loose"), pressure, x=x) for angles in ((30, None), (None, -30), (30, 30))
    )
    for found, there, missing in ((alone, "alpha", "beta"), (mirrored, "beta", "alpha")):
        assert np.all(np.isnan(found[f"{missing}_deformed"]))
        assert np.all(found[f"fiber_tension_{missing}"] == 0.0)
        assert found[f"slack_{missing}"] == 0.0
        assert found["slack_fiber"] == 0
        assert np.all(found[f"fiber_tension_{there}"] > 0.0)
    for name in ("deformed_length", "mid_radius", "largest_stretch", "outer_radius", "fiber_tension_alpha"):
        other = mirrored[name.replace("alpha", "beta")].values
        assert alone[name].values == pytest.approx(other, rel=1e-12), name
    assert mirrored["rotation"].item() == pytest.approx(-alone["rotation"].item(), rel=1e-9)
    # two families of one angle are one, of which each carries half
    assert both["rotation"].item() == pytest.approx(alone["rotation"].item(), rel=1e-12)
    assert both["fiber_tension_beta"].values == pytest.approx(0.5 * alone["fiber_tension_alpha"].values, rel=1e-12)
    assert both["beta_deformed"].values == pytest.approx(alone["alpha_deformed"].values, rel=1e-12)


def test_straight_fibers_alone_go_slack_where_the_tube_shortens():
    """A push shortens the tube: the straight threads let go, and it is the balloon that is left."""
    straight, balloon = tube(0, fibers="loose"), tube()
    found, other = (inflate(one, 5e4, -2.0, x=[0.01, 0.025]) for one in (straight, balloon))
    assert found["slack_fiber"] == 1
    assert found["slack_alpha"].item() > 0.9
    assert found["mid_radius"].item() == pytest.approx(other["mid_radius"].item(), rel=1e-6)


def test_a_torque_twists_a_balloon_as_it_twists_a_tube_of_rubber():
    """At small strains by G J/l: the shear modulus 2 (C10 + C01) and the ring's polar moment."""
    torque, one = 1e-6, tube(wall_model="thick", length=0.3)
    found = inflate(one, 1.0, torque=torque, x=[0.1, 0.2], accuracy=1e-9)
    polar = 0.5 * np.pi * ((RADIUS + WALL) ** 4 - RADIUS**4)
    rate = np.diff(np.radians(found["twist"].values)).item() / 0.1
    assert rate == pytest.approx(torque / (2.0 * (RUBBER.c10 + RUBBER.c01) * polar), rel=1e-4)


@pytest.mark.parametrize("angles", [(None, None), (40, None), (40, 40)])
def test_fewer_than_two_angles_have_no_locked_shape(angles):
    with pytest.raises(ActuatorError, match="no locked shape; use inflate"):
        lock(tube(*angles, fibers="loose"))


def test_what_is_not_there_for_such_tubes_is_refused_with_a_reason():
    with pytest.raises(ActuatorError, match="fewer than two families would leave it open"):
        tube(30, energy="principal")
    with pytest.raises(ActuatorError, match=r"one fiber family leaves.*or beta=None, or loose"):
        tube(30, 30)
    with pytest.raises(ActuatorError, match="derivatives: found two families of one angle"):
        inflate(tube(30, 30, fibers="loose"), 1e4, derivatives="all")
    with pytest.raises(ActuatorError, match="derivatives: found str 'beta'; choose from alpha, length"):
        inflate(tube(30), 1e4, derivatives="beta")
    for one in (tube(), tube(0, fibers="loose")):
        with pytest.raises(ActuatorError, match="does not rotate"):
            blocked_torque(one, 1e4)


@pytest.mark.parametrize(
    "more",
    [{}, {"wall_model": "thick"}, {"beta": -50}, {"alpha": 30, "model": "physical"}],
    ids=["balloon", "thick balloon", "bonded beta", "physical alpha"],
)
def test_derivatives_are_symmetric_scale_and_are_those_of_a_difference(more):
    """Maxwell's symmetries; a tube twice as large turns as much under four times the force, eight times the torque."""
    loads, own = {"pressure": 8e3, "force": 0.3, "torque": 1e-3}, tube(**more)
    found = inflate(own, **loads, x=[0.0], derivatives="all")

    def slope(of, by):
        return found[f"d_{of}_d_{by}"].item()

    assert slope("rotation", "force") == pytest.approx(np.degrees(slope("deformed_length", "torque")), rel=1e-7)
    assert slope("volume", "force") == pytest.approx(slope("deformed_length", "pressure"), rel=1e-7)
    sizes = [(own.length, "length"), (RADIUS, "radius"), (WALL, "wall"), (0.6, "force"), (3e-3, "torque")]
    for output, power in (("rotation", 0.0), ("deformed_length", 1.0), ("volume", 3.0)):
        total, parts = power * found[output].item(), [size * slope(output, name) for size, name in sizes]
        assert sum(parts) == pytest.approx(total, abs=1e-6 * max(map(abs, parts)))
    name = next((name for name in ("alpha", "beta") if name in more), "wall")
    step = 0.02 if name in more else 2e-7
    ends = [inflate(tube(**more | {name: getattr(own, name) + by}), **loads, x=[0.0]) for by in (step, -step)]
    for output in ("rotation", "deformed_length", "mid_radius"):
        difference = (ends[0][output].item() - ends[1][output].item()) / (2.0 * step)
        assert slope(output, name) == pytest.approx(difference, rel=1e-5)


# --- held


@pytest.mark.long  # as the next: the scalar kernels of held physical tubes are compiled for them alone
@pytest.mark.parametrize(
    ("more", "tolerance"), [({}, 1e-7), ({"alpha": 30, "fibers": "loose"}, 2e-5)], ids=["balloon", "one loose family"]
)
def test_a_held_length_is_that_of_brute_force(more, tolerance):
    actuator, pressure = tube(**more), 4e4
    found = blocked_force(actuator, pressure, x=0.0)
    assert found["status"] == OK
    r = actuator.fiber_surface
    expected = brute(actuator, pressure, held="length", target=actuator.length / r)
    agree(found, expected, actuator, tolerance)
    assert found["force"].item() / (np.pi * r**2 * RUBBER.c10) == pytest.approx(expected[5], rel=tolerance)


@pytest.mark.long
def test_a_held_rotation_of_one_family_is_that_of_brute_force():
    actuator, pressure = tube(30, fibers="loose"), 4e4
    found = blocked_torque(actuator, pressure, x=0.0)
    assert found["status"] == OK
    r = actuator.fiber_surface
    expected = brute(actuator, pressure, held="rotation", target=0.0)
    agree(found, expected, actuator, 2e-5)
    assert found["torque"].item() / (np.pi * r**3 * RUBBER.c10) == pytest.approx(expected[5], rel=2e-5)


# --- what else such tubes are made of, and shown by


def test_a_single_family_that_varies_by_nothing_is_the_constant_one():
    one, other = tube(30, fibers="loose"), tube(lambda share: 30.0 + 0.0 * share, fibers="loose")
    found, again = (inflate(each, 4e4, x=[0.01, 0.025]) for each in (one, other))
    for name in ("deformed_length", "rotation", "mid_radius", "largest_stretch", "outer_radius"):
        assert again[name].item() == pytest.approx(found[name].item(), rel=1e-9), name


def test_what_threads_are_made_of_is_nothing_to_a_balloon():
    found, other = (inflate(one, 4e4, x=0.0) for one in (tube(), tube(fiber_extension=1.02)))
    for name in ("deformed_length", "mid_radius", "strain_energy"):
        assert other[name].item() == pytest.approx(found[name].item(), rel=1e-7), name


def test_one_family_alone_keeps_a_neo_hookean_tube_from_bulging():
    """Where the balloon has long reached its limit; a steep pair of stretches from the energy of a uniform tube itself."""
    rubber = NeoHookean(c10=0.2e6)
    pressure = 1.2 * textbook_limit(rubber, False)
    one = tube(45, length=0.3, material=rubber, fibers="loose")
    found = inflate(one, pressure, x=[0.149, 0.15, 0.151])
    assert found["status"] == OK
    assert np.isnan(found["limit_pressure"])
    y = found["deformed_radius"].values[1] / RADIUS
    s = np.diff(found["axial_position"].values)[0] / 1e-3
    psi = np.diff(np.radians(found["twist"].values))[0] / 1e-3 * RADIUS
    section = ((RADIUS + WALL) / RADIUS) ** 2 - 1.0

    def energy(y, psi):
        """Of the uniform tube whose 45 degree fibers keep their length, per pi r^2 c10 and length."""
        square = 2.0 - y * y * (1.0 + psi) ** 2
        wall = section * (square + y * y * (1.0 + psi * psi) + 1.0 / (square * y * y) - 3.0)
        return pressure / rubber.c10 * y * y * np.sqrt(square) - wall

    assert s**2 == pytest.approx(2.0 - y * y * (1.0 + psi) ** 2, rel=1e-5)
    h = 1e-5
    assert energy(y + h, psi) - energy(y - h, psi) == pytest.approx(0.0, abs=2e-6 * h)
    assert energy(y, psi + h) - energy(y, psi - h) == pytest.approx(0.0, abs=2e-6 * h)


def test_a_shell_and_a_sweep_know_the_word():
    sizes = ["--length", "50 mm", "--radius", "5 mm", "--wall", "0.8 mm", "--c10", "0.17 MPa", "--c01", "0.08 MPa"]
    words = ["inflate", "--alpha", "none", "--beta", "none", *sizes, "--pressure", "1 kPa"]
    assert tube_of(parser().parse_args(words)) == tube()
    text = '[actuator]\nalpha = "none"\nbeta = 30\nlength = 0.1\nradius = 5e-3\nwall = 1e-3\nc10 = 1e5\n[load]\npressure = 1'
    assert parse(text).families == ("beta",)


def test_a_balloon_is_drawn_without_fibers():
    state = inflate(tube(), 4e4)
    shape = shape_of(tube(), state)
    assert shape.counts == (0, 0)
    assert shape.radius.max() == pytest.approx(1e3 * state["mid_radius"].item(), rel=1e-6)
    assert shape_of(tube(30)).counts[1] == 0
    shown = tube(30)._repr_html_()
    assert "none" in shown
    assert "nan" not in shown
    draw_shape(Figure().add_subplot(), shape)


def test_the_thin_wall_of_a_balloon_is_told_as_linear_elasticity_has_it():
    """What a thick wall deforms more than a thin one at small pressure, without threads and with one family."""
    for angle in (None, 50):
        thin, thick = (
            inflate(tube(angle, length=0.3, wall_model=word), 50.0, x=[0.15], accuracy=1e-9)
            for word in ("membrane", "thick")
        )
        growth = []
        for one in (thin, thick):
            y, z = one["deformed_radius"].item() / RADIUS, one["deformed_length"].item() / 0.3
            growth.append(y * y * z - 1.0)
        assert thin.attrs["thin_wall_ratio"] == pytest.approx(growth[1] / growth[0], rel=0.02)


@pytest.mark.parametrize("model", [{}, {"model": "physical"}, {"fibers": "loose"}], ids=str)
@pytest.mark.parametrize("beta", [None, -24.3])
def test_held_at_its_free_length_or_rotation_a_tube_of_one_family_is_the_free_one_all_along(beta, model):
    """A slope turns such fibers; held tubes had the angles, tensions and widths of one that their stretch alone tells."""
    own, loads = tube(beta=beta, **model), (3e4, 0.3, 2e-3 if beta is None else 0.0)
    x = np.linspace(0.0, own.length, 9)
    free = inflate(own, *loads, x=x)
    held = [blocked_force(own, loads[0], free.deformed_length.item(), loads[2], x=x)]
    if beta is not None:  # whose rotation can be held
        held += [blocked_torque(own, loads[0], free.rotation.item(), loads[1], x=x)]
    along = [f"{what}_{family}" for what in ("fiber_tension", "least_tension") for family in ("alpha", "beta")]
    for state in held:
        assert int(state.status) == OK
        for name in ("beta_deformed", "twist", "axial_position", "outer_radius", "largest_stretch", *along):
            if beta is None and name == "beta_deformed":
                continue
            allowed = 3.0 * (state[f"{name}_error"] + free[f"{name}_error"]) + 1e-6 * np.abs(free[name]).max()
            assert np.all(np.abs(state[name] - free[name]) <= allowed), name


@pytest.mark.parametrize("fibers", ["loose", "bonded"])
@pytest.mark.parametrize("extension", [1.02, 1.03])
def test_extended_fibers_of_one_steep_family_meet_clamped_ends_whichever_way_they_wind(fibers, extension):
    """Two families could not: a single one turns. To one side it had been called invalid."""
    left, right = (
        inflate(tube(beta=beta, length=0.02, fibers=fibers, fiber_extension=extension), 8e5, x=0.0)
        for beta in (-79.3, 79.3)
    )
    assert int(left.status) == int(right.status) == OK
    for name in ("deformed_length", "rotation", "outer_radius"):
        sign = -1.0 if name == "rotation" else 1.0
        assert float(left[name]) == pytest.approx(sign * float(right[name]), rel=1e-6), name
