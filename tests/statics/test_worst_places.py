"""The largest and the least along a tube, against the formulas of its uniform middle and finer stations."""

import numpy as np
import pytest

import freesweep as fs

RUBBER = fs.MooneyRivlin(0.17e6, 0.08e6)
SECTION = {"radius": 4.76e-3, "wall": 1.59e-3, "material": RUBBER}
NAMES = ("outer_radius", "largest_stretch", "slack_alpha", "slack_beta", "least_tension_alpha", "least_tension_beta")


@pytest.mark.parametrize("model", ["source", "physical"])
def test_a_tube_at_rest_is_as_large_as_it_was_made_unstretched_and_nowhere_slack(model):
    state = fs.inflate(fs.Actuator(alpha=0, beta=30, length=0.131, model=model, **SECTION), 0.0)
    assert float(state.outer_radius) == pytest.approx(SECTION["radius"] + SECTION["wall"], abs=1e-12)
    assert float(state.largest_stretch) == pytest.approx(1.0, abs=1e-9)
    assert [float(state[name]) for name in NAMES[2:]] == [0.0] * 4


@pytest.mark.parametrize("model", ["source", "physical"])
def test_a_long_muscle_is_widest_in_its_uniform_middle_and_its_wall_keeps_its_volume(model):
    tube = fs.Actuator(alpha=30, beta=-30, length=0.4, model=model, **SECTION)
    state = fs.inflate(tube, 1e5, x=[0.0, 0.2])
    axial = np.cos(np.radians(state.alpha_deformed[1])) / np.cos(np.radians(30))  # the fibers keep their length
    fibers, inner, outer = tube.fiber_surface, tube.radius, tube.radius + tube.wall
    at = {rho: np.sqrt(state.mid_radius**2 + (rho**2 - fibers**2) / axial) for rho in (inner, outer)}
    assert float(state.outer_radius) == pytest.approx(float(at[outer]), abs=2 * float(state.outer_radius_error) + 1e-12)
    assert float(axial * (at[outer] ** 2 - at[inner] ** 2)) == pytest.approx(outer**2 - inner**2)
    assert float(state.largest_stretch) == pytest.approx(
        float(at[inner] / inner), rel=3e-12 if model == "physical" else 1e-6
    )


def test_a_muscle_that_gets_thin_is_widest_at_its_clamped_ends_to_all_digits():
    tube = fs.Actuator(alpha=70, beta=-72, length=0.1, model="physical", **SECTION)
    states = fs.inflate(tube, np.linspace(2e4, 2e5, 20))
    assert np.all(states.mid_radius < tube.fiber_surface)
    assert np.all(np.abs(states.outer_radius - tube.radius - tube.wall) <= 1e-14)
    assert np.all(states.outer_radius_error < 1e-11)


def test_what_counts_along_the_tube_does_not_hang_on_the_stations_that_were_asked_for():
    tube = fs.Actuator(alpha=0, beta=30, length=0.131, **SECTION)
    whole, few = fs.inflate(tube, 3e4), fs.inflate(tube, 3e4, x=[0.02])
    assert few.sizes["x"] == 1
    for name in NAMES:
        assert float(few[name]) == pytest.approx(float(whole[name]), rel=1e-9), name


@pytest.mark.parametrize("model", ["source", "physical"])
def test_slack_shares_and_least_tensions_are_those_of_finer_stations(model):
    tube = fs.Actuator(alpha=0, beta=30, length=0.131, model=model, **SECTION)
    x = np.linspace(0.0, tube.length, 2001)
    state = fs.inflate(tube, 3e4, x=x)
    tension = state.fiber_tension_alpha.values
    share = np.mean((tension <= 0.0)[1:-1])
    assert 0.9 < share < 1.0
    assert float(state.slack_alpha) == pytest.approx(share, abs=float(state.slack_alpha_error) + 1e-3)
    assert float(state.slack_alpha_error) < 0.01
    missed = float(state.least_tension_alpha) - tension.min()
    assert abs(missed) <= float(state.least_tension_alpha_error + state.fiber_tension_alpha_error.max())


STEP = [(0.0, 2.625525e-3), (0.180897768, 2.625525e-3), (0.180897768, 1.636846e-3), (1.0, 1.636846e-3)]
IN_LAYERS = {  # found by a mesh of 1600 midpoint cells of our own, extrapolated; [N], and how well it is known
    "of loose threads under a force": (
        {
            "alpha": -33.644513684, "beta": 77.274735013, "length": 0.18867867, "wall": 2.575606098e-3,
            "material": fs.MooneyRivlin(0.15e6, 156065.14), "fiber_extension": 1.00248920665, "model": "physical",
        },
        (8309.121, 1.355638867), 0.443323, 1e-4,
    ),
    "beside a jump of the wall": (
        {
            "alpha": -63.520384823, "beta": 70.286375406, "length": 0.114506894, "wall": STEP,
            "material": fs.MooneyRivlin(0.15e6, 200907.04),
        },
        (51914.384, 0.0), 0.6701, 1e-3,
    ),
    "close to an end": (
        {
            "alpha": 8.778645725, "beta": -8.778645725, "length": 0.151477191, "wall": 0.507507770e-3,
            "material": fs.MooneyRivlin(0.15e6, 97293.03),
        },
        (285653.815, 0.0), 149.55388, 6e-4,
    ),
}  # fmt: skip


@pytest.mark.parametrize("where", IN_LAYERS)
def test_a_least_tension_in_a_layer_thinner_than_the_stations_are_apart_is_seen(where):
    tube, loads, right, known = IN_LAYERS[where]
    state = fs.inflate(fs.Actuator(radius=5e-3, **tube), *loads, x=0.0)
    found, error = float(state.least_tension_alpha), float(state.least_tension_alpha_error)
    assert abs(found - right) <= error + known
    assert error <= 0.5 * right


def swung(u):
    return 4.8080746169045625 - 70.39667204277125 * np.sin(np.pi * u) ** 2


AT_BENDS = {  # elements of degree four of our own, on two meshes; how well that is known
    "where the wall bends": (
        {
            "alpha": -4.246773537948471, "beta": 81.72372536210455, "length": 0.18596983933118014,
            "radius": 0.018361731155595706, "material": fs.NeoHookean(68133.38230849979),
            "wall": [(0, 0.8563655932129379e-3), (0.7386132682554598, 0.9175276372348344e-3), (1, 0.7878655843828179e-3)],
        },
        (2514.8247754184827, 0.0, -0.03587481480585733), "outer_radius", 0.019630059655159206, 1e-11,
    ),
    "where fibers bend": (
        {
            "alpha": 15.64826261708697, "length": 0.04595961790054501, "radius": 0.017669825782482853,
            "beta": [(0, -15.578011711836929), (0.520937357111358, 2.3750602299749666), (1, -7.812606769953913)],
            "wall": 1.7218515774894848e-3, "material": fs.MooneyRivlin(32943.10070691838, 45892.85591853071),
        },
        (3174.7825623248336,), "least_tension_beta", -2.0576862511830836, 1e-8,
    ),
    "where the wall of loose threads bends": (
        {
            "alpha": 71.98610073492108, "beta": 33.94628522437044, "length": 0.046471492744538864,
            "radius": 6.885568468756367e-3, "fibers": "loose", "fiber_radius": 7.4458678975883605e-3,
            "wall": [(0, 2.0140525841039307e-3), (0.8371376347742303, 2.290870264074471e-3), (1, 2.0609174093331106e-3)],
            "material": fs.MooneyRivlin(991849.6939222252, 965431.685207576), "fiber_extension": 1.005,
        },
        (474466.0526411105,), "outer_radius", 9.297637289295215e-3, 1e-11,
    ),
    "where threads go slack": (
        {
            "alpha": 28.129865153845856, "beta": swung, "length": 0.047334649240991136, "radius": 5.316356259685909e-3,
            "wall": 1.983806343213692e-3, "fibers": "loose",
            "material": fs.MooneyRivlin(193500.058725973, 36980.92601726271),
        },
        (76498.74774768495,), "largest_stretch", 1.1239190979229239, 1e-8,
    ),
}  # fmt: skip


@pytest.mark.parametrize("where", AT_BENDS)
def test_what_is_largest_or_least_at_a_corner_is_within_its_bound(where):
    """Stations to both sides of the corner had passed it by up to twice the bound."""
    tube, loads, name, right, known = AT_BENDS[where]
    state = fs.inflate(fs.Actuator(**tube), *loads, x=0.0)
    assert abs(float(state[name]) - right) <= float(state[f"{name}_error"]) + known
    assert float(state[f"{name}_error"]) <= (2e-6 if where.endswith(" bends") else 2e-4) * abs(right) + 4e-6


@pytest.mark.parametrize("place", [0.01, 0.08, 0.3, 0.505, 0.72, 0.98])
@pytest.mark.parametrize("length", [0.054, 0.097, 0.151, 0.159])
def test_on_a_jump_all_of_a_place_is_told_from_before_it(place, length):
    """Rounding had put x/l to one side and the distance in radii to the other: tensions of neither, bounds of nothing."""

    def inflated(jump):
        angles = [(0.0, 20.0), (jump, 20.0), (jump, 35.0), (1.0, 35.0)]
        tube = fs.Actuator(alpha=angles, beta=-40.0, length=length, radius=5e-3, wall=1e-3, material=RUBBER)
        return fs.inflate(tube, 8e4, x=place * length * np.array([1.0 - 1e-9, 1.0, 1.0 + 1e-9]))

    state, beside = inflated(place), inflated(place * (1.0 + 1e-9))
    for name in ("alpha_deformed", "fiber_tension_alpha", "fiber_tension_beta"):
        before, on, _ = state[name].values
        assert on == pytest.approx(before, rel=1e-5), name
    allowed = 1e-6 + float(state.largest_stretch_error)
    assert float(state.largest_stretch) == pytest.approx(float(beside.largest_stretch), abs=allowed)
    assert float(state.largest_stretch_error) < 1e-3


def test_no_more_than_all_of_a_tube_is_slack():
    """Cells' lengths had added up to a little more than one."""
    own = {name: [(0.0, a), (0.69096, a), (0.69096, b), (1.0, b)] for name, a, b in (
        ("alpha", 10.654784312, 18.086305407), ("beta", -35.735639152, -40.038848751),
    )}  # fmt: skip
    tube = fs.Actuator(
        **own, length=0.01942895222817203, radius=5e-3, wall=2.511728956e-3, fibers="loose", fiber_extension=1.01376846,
        material=fs.MooneyRivlin(150e3, 66487.736),
    )  # fmt: skip
    held = fs.blocked_force(tube, 1258.194585, 0.01942896851174648, -5.4432685e-5, x=0.0)
    assert float(held.slack_alpha) == 1.0
    assert float(held.slack_beta) == 1.0


def test_where_there_is_no_state_there_is_no_number():
    state = fs.inflate(fs.Actuator(alpha=30, beta=-30, length=0.1, **SECTION), 1e4, force=-1000.0)
    assert int(state.status) != 0
    assert all(np.isnan(float(state[name])) for name in NAMES)


POINTS = {  # of which kernels say that a family pulls nowhere, at some place, and how they are asked
    "of loose threads, beside straight ones": ({"alpha": 55, "beta": 0, "length": 0.425, "fibers": "loose"}, "inflate"),
    "the same, of physical tubes": ({"alpha": 0, "beta": -10, "length": 0.234, "model": "physical"}, "inflate"),
    "one that varies": ({"alpha": [(0, 25), (1, 35)], "beta": 0, "length": 0.2, "fibers": "loose"}, "inflate"),
    "a locked one": ({"alpha": [(0, 25), (1, 35)], "beta": 0, "length": 0.2, "fibers": "loose"}, "lock"),
    "a held one": ({"alpha": 0, "beta": -10, "length": 0.234, "model": "physical"}, "blocked_force"),
    "what ends within a micrometre": ({"alpha": 5, "beta": 80, "length": 0.161, "wall_model": "thick"}, "inflate"),
}
ASKED = {
    "inflate": lambda tube: fs.inflate(tube, [0.0, 1e-3, 10.0, 1e4, 1e5], x=0.0),
    "lock": lambda tube: fs.lock(tube, x=0.0).expand_dims("pressure"),
    "blocked_force": lambda tube: fs.blocked_force(tube, [1e4, 1e5], 0.97 * tube.length, x=0.0),
}


def told(states):
    """Flags of both families, and their shares, (2, n) each."""
    shares = np.array([states.slack_alpha.values, states.slack_beta.values])
    return np.array([states.slack_fiber.values & 1, states.slack_fiber.values & 2]) > 0, shares


@pytest.mark.parametrize(("design", "asked"), POINTS.values(), ids=POINTS)
def test_a_family_is_called_slack_where_it_is_so_over_more_than_a_point(design, asked):
    section = {"radius": 5e-3, "wall": 0.8e-3, "material": fs.MooneyRivlin(0.11e6, 0.06e6)}
    flags, shares = told(ASKED[asked](fs.Actuator(**design, **section)))
    np.testing.assert_array_equal(flags, shares > 1e-6)


def test_an_atlas_its_exact_answers_and_wishes_call_slack_what_single_tubes_do(tmp_path):
    fixed = {"length": 0.234, "radius": 5e-3, "wall": 0.8e-3, "model": "physical", "c10": 0.11e6, "c01": 0.06e6}
    grid = {"alpha": [0.0, 10.0], "beta": [-10.0, 40.0], "pressure": [1e4, 1e5]}
    atlas = fs.sweep(**grid, **fixed, out=tmp_path / "points.nc")
    flags, shares = told(atlas.data)
    np.testing.assert_array_equal(flags, shares > 1e-6)
    assert flags.any()
    assert not flags.all()
    solved = atlas.query(alpha=0.0, beta=-12.5, pressure=[1e4, 1e5], refine=True)
    flags, shares = told(solved)
    np.testing.assert_array_equal(flags, shares > 1e-6)
    muscle = fs.Actuator(alpha=0, beta=-12, length=0.234, radius=5e-3, wall=0.8e-3, model="physical",
                         material=fs.MooneyRivlin(0.11e6, 0.06e6))  # fmt: skip
    for goal in (fs.Goal("rotation", 30, pressure=1e5), fs.Goal("force", 0.0, pressure=1e5, deformed_length=0.23)):
        found = fs.design(muscle, {"beta": (-15, -5)}, [goal], count=1)
        assert found.slack_fiber.values.tolist() == [0]
