"""What vectors tell of designs is what the public functions tell of each: both models, fewer families, held and free."""

import numpy as np
import pytest

import freesweep as fs
from freesweep.inverse import freedom, misfit
from freesweep.inverse.exact import exact_slopes
from freesweep.inverse.predict import predict, state_of
from freesweep.inverse.singles import solve_single

RUBBER = fs.MooneyRivlin(1.2e5, 6e4)
MORE = {"length": 0.1, "radius": 6e-3, "wall": 1e-3, "material": RUBBER}
TUBES = {
    "source": fs.Actuator(alpha=30, beta=-40, model="source", **MORE),
    "physical": fs.Actuator(alpha=30, beta=-40, model="physical", **MORE),
    "loose membrane": fs.Actuator(alpha=30, beta=-40, model="source", fibers="loose", **MORE),
    "single": fs.Actuator(alpha=None, beta=-40, model="physical", **MORE),
}
FREE = ("rotation", "deformed_length", "slack_beta", "least_tension_alpha", "least_tension_beta", "stroke")
WORST = ("outer_radius", "largest_stretch")
HELD = {"force": {"deformed_length": 0.097}, "torque": {"rotation": 5.0}}
SAMPLED = 0.02  # of the length, or of a pull: what the public functions miss of the source's tubes between stations


@pytest.mark.parametrize("kind", TUBES)
def test_vectors_tell_what_one_tube_at_a_time_tells(kind):
    tube, faults = TUBES[kind], []
    space = freedom.read(tube, {"wall": (8e-4, 1.2e-3)}, faults)
    assert not faults
    asked = [fs.Goal(name, 0.0, pressure=4e4) for name in (*FREE, *WORST)]
    asked += [fs.Goal(name, 0.0, pressure=4e4, **held) for name, held in HELD.items()]
    if kind != "single":
        asked += [fs.Goal("least_tension_alpha", 0.0, pressure=np.inf)]
    asked = [wish for goal in asked for wish in goal.wishes([])]
    found = predict(space, asked, np.array([[0.5]]), np.zeros(1, int), 1e-7, thorough=False)
    names = {}
    for wish in asked:
        names.setdefault(state_of(wish), []).append(wish.output)
    alone = solve_single(tube, names, {"pressure": 0.0, "force": 0.0, "torque": 0.0} | tube.design(), 1e-7)
    for k, wish in enumerate(asked):
        value, bound = alone[state_of(wish)][wish.output]
        close = found.bounds[0, k] + bound + 1e-7 * abs(value)
        if kind == "source" and ("tension" in wish.output or wish.output in WORST):
            close += SAMPLED * abs(value)
        assert abs(found.values[0, k] - value) <= close, wish.title
        assert found.bounds[0, k] <= (5e-3 if "tension" in wish.output else 1e-5) * max(abs(value), 1e-2), wish.title


def test_the_largest_stretch_of_a_source_s_tube_is_told_from_its_middle():
    """Profiles tell the same, at their stations; where both surfaces are strained alike, it is the membrane's."""
    tube = TUBES["source"]
    found = fs.inflate(tube, 4e4)
    wish = fs.Goal("largest_stretch", 1.0, pressure=4e4).wishes([])
    space = freedom.read(tube, {"wall": (8e-4, 1.2e-3)}, [])
    told = predict(space, wish, np.array([[0.5]]), np.zeros(1, int), 1e-7)
    assert told.values.item() == pytest.approx(found["largest_stretch"].item(), rel=1e-3)


def test_a_held_length_that_loads_cannot_reach_is_left_to_its_own_way():
    """A physical tube that is to be half as long: vectors of free tubes say nothing, and the own way says why."""
    space = freedom.read(TUBES["physical"], {"wall": (8e-4, 1.2e-3)}, [])
    wish = fs.Goal("force", 0.0, pressure=4e4, deformed_length=0.9).wishes([])
    u, choice = np.array([[0.5]]), np.zeros(1, int)
    assert np.isnan(predict(space, wish, u, choice, 1e-7, thorough=False).values).all()
    own = predict(space, wish, u, choice, 1e-7)
    assert np.isnan(own.values).all()
    assert own.status.item() == int(fs.blocked_force(TUBES["physical"], 4e4, 0.9, x=0.0)["status"])


def test_slack_shares_and_physical_tubes_are_found_quickly():
    """A hidden physical tube under free and held goals, and the source's with a share of slack fibers: of processor time, a
    hundredth of what one tube at a time takes.
    """
    import time

    secret = fs.Actuator(alpha=12, beta=-50, model="physical", **MORE)
    goals = [
        fs.Goal("rotation", fs.inflate(secret, 5e4, x=0.0)["rotation"].item(), pressure=5e4),
        fs.Goal("force", fs.blocked_force(secret, 3e4, x=0.0)["force"].item(), pressure=3e4),
    ]
    free = {"alpha": (0, 85), "beta": (-85, 85)}
    fs.design(TUBES["physical"], free, goals, count=2)
    begun = time.process_time()
    found = fs.design(TUBES["physical"], free, goals, count=2)
    assert found["met"].values[0]
    assert time.process_time() - begun < 10.0
    slack = fs.Actuator(alpha=5, beta=30, model="source", **MORE)
    state = fs.inflate(slack, 5e4, x=0.0)
    assert state["slack_alpha"] + state["slack_beta"] > 0.0
    name = "slack_alpha" if state["slack_alpha"] > state["slack_beta"] else "slack_beta"
    goals = [fs.Goal("rotation", state["rotation"].item(), pressure=5e4), fs.Goal(name, at_least=0.02, pressure=5e4)]
    begun = time.process_time()
    found = fs.design(TUBES["source"], free, goals, count=2)
    assert found["met"].values[0]
    assert time.process_time() - begun < 10.0


@pytest.mark.parametrize(("output", "held"), [("torque", {}), ("torque", {"rotation": 0.0}), ("force", {})])
def test_slopes_of_a_tube_that_is_held_as_it_is_are_exact(output, held):
    """In closed form, of stiff ones, too (216 N, 7 N): differences tell the same, as exactly as they can."""
    free = {"alpha": (5, 80), "wall": (5e-4, 2e-3), "pressure": (1e4, 1e5)}
    space = freedom.read(fs.Actuator(**MORE | {"length": 0.15}, alpha=30, beta=-40, model="source"), free, [])
    wish = fs.Goal(output, 1.0, **held).wishes([])
    problem, u, choice = misfit.make(space, wish, []), np.random.default_rng(0).uniform(size=(6, 3)), np.zeros(6, int)
    found, _ = problem.at(u, choice)
    slopes = exact_slopes(space, wish, u, choice, found.values)
    assert np.all(np.isfinite(slopes))
    assert np.all(slopes[..., 1] == 0.0)  # the wall is not strained
    differences = problem._differences(wish, u, choice, found)
    assert slopes == pytest.approx(differences, rel=2e-4, abs=1e-9 * np.max(np.abs(slopes)))


def test_a_physical_tube_that_no_given_load_would_hold_is_found_again():
    """Its torque at no rotation is that of the straight cylinder, which loads alone do not lead to."""
    more = {"alpha": 18.93, "beta": -55.75, "radius": 10.8e-3, "wall": 1.46e-3, "material": RUBBER, "model": "physical"}
    secret = fs.Actuator(length=65e-3, **more)
    goals = [
        fs.Goal("torque", fs.blocked_torque(secret, 2.08e5, x=0.0)["torque"].item()),
        fs.Goal("rotation", fs.inflate(secret, 1.43e5, x=0.0)["rotation"].item(), pressure=1.43e5),
    ]
    found = fs.design(fs.Actuator(length=0.15, **more), {"pressure": (2e4, 3e5), "length": (0.05, 0.3)}, goals, count=2)
    assert found["met"].values[0]
    assert found["length"].values[0] == pytest.approx(65e-3, rel=1e-3)


def test_candidates_that_meet_everything_come_first():
    """Also where loads hold the best of a look in a state to which its own way, with the length held, does not lead."""
    more = {"alpha": 48.62050626086252, "radius": 4.953634403647539e-3, "material": RUBBER, "model": "physical"}
    free = {"length": (0.05, 0.3), "beta": (-85, 85), "pressure": (2e4, 3e5), "wall": (3e-4, 2e-3)}
    goals = [
        fs.Goal("mid_radius", 0.010188133598426956),
        fs.Goal("force", 351.4984370435624, pressure=57801.45496298658),
        fs.Goal("rotation", -621.4139918461849, pressure=127770.33624305867),
    ]
    found = fs.design(fs.Actuator(length=0.175, beta=0.0, wall=1.15e-3, **more), free, goals)
    met = found["met"].values
    assert met[0]
    assert np.all(np.diff(met.astype(int)) <= 0)


def test_slopes_that_nobody_knows_are_none():
    """Where neither side has a state; they were 0, and a wish was told that nothing changes what it wants."""
    space = freedom.read(TUBES["source"], {"wall": (8e-4, 1.2e-3), "beta": (-45, -35)}, [])
    wish = fs.Goal("rotation", 10.0, pressure=4e4).wishes([])
    problem, u, choice = misfit.make(space, wish, []), np.full((1, 2), 0.5), np.zeros(1, int)
    found, _ = problem.at(u, choice)
    known = problem._differences(wish, u, choice, found)
    assert np.all(np.isfinite(known))
    beyond = fs.Goal("rotation", 10.0, pressure=4e4, force=-1e3).wishes([])  # the wall would have to be pushed
    assert np.isnan(problem._differences(beyond, u, choice, found)).all()


def test_held_tubes_are_looked_at_where_they_do_best_in_what_is_not_held():
    """Of four times as few designs, and those that miss the other goal least."""
    from freesweep.inverse import look

    space = freedom.read(TUBES["physical"], {"wall": (5e-4, 1.5e-3), "beta": (-80, -10)}, [])
    asked = [fs.Goal("force", 0.0, pressure=4e4), fs.Goal("rotation", 20.0, pressure=4e4)]
    problem = misfit.make(space, [wish for goal in asked for wish in goal.wishes([])], [])
    count = 4 * look.ENOUGH
    u, choice = np.random.default_rng(0).uniform(size=(count, 2)), np.zeros(count, int)
    residuals = look.by_and_by(problem, u, choice)
    told = np.isfinite(residuals[:, 0])
    assert 0 < np.count_nonzero(told) <= look.ENOUGH
    others = np.abs(residuals[:, 1])
    assert np.max(others[told]) <= np.sort(others[np.isfinite(others)])[look.ENOUGH]


def test_candidates_that_do_it_are_made_sure_of_on_their_own_way(monkeypatch):
    """The first one, and those that seem to meet everything; what others miss, vectors tell."""
    from freesweep.inverse import candidates

    asked, predicted = [], candidates.predict

    def seen(space, wishes, u, *rest, sure=False, **more):
        asked.append((len(u), sure))
        return predicted(space, wishes, u, *rest, sure=sure, **more)

    monkeypatch.setattr(candidates, "predict", seen)
    secret = fs.Actuator(alpha=30, beta=-40, model="physical", **MORE)
    force = fs.blocked_force(secret, 4e4, 0.097, x=0.0)["force"].item()
    goals = [fs.Goal("force", force, pressure=4e4, deformed_length=0.097), fs.Goal("wall", at_least=1.5e-3)]
    found = fs.design(secret, {"wall": (8e-4, 1.2e-3), "beta": (-45, -35)}, goals, count=4)
    assert not found["met"].any()
    assert asked == [(found.sizes["candidate"], False), (1, True)]
    assert found.attrs["summary"].startswith("none of the designs that were looked at does it")


ALONG = ("outer_radius", "largest_stretch", "least_tension_alpha", "least_tension_beta", "slack_alpha", "slack_beta")


@pytest.mark.parametrize("model", ["source", "physical"])
def test_slopes_of_what_is_largest_along_a_tube_are_exact(model):
    """Differences tell the same, as exactly as they can."""
    tube = fs.Actuator(**MORE, alpha=40, beta=5, model=model)  # a family is slack along a part, or would have to push
    space = freedom.read(tube, {"beta": (3, 8), "wall": (1e-3, 1.5e-3)}, [])
    wishes = [wish for name in ALONG for wish in fs.Goal(name, 0.1, pressure=5e4).wishes([])]
    problem, u, choice = (
        misfit.make(space, wishes, []),
        np.random.default_rng(0).uniform(0.2, 0.8, size=(4, 2)),
        np.zeros(4, int),
    )
    found, _ = problem.at(u, choice)
    slopes = exact_slopes(space, wishes, u, choice, found.values, found.middles)
    assert np.all(np.isfinite(slopes))
    differences = problem._differences(wishes, u, choice, found)
    for k, name in enumerate(ALONG):
        size = np.max(np.abs(slopes[:, k])) + 1e-3 * np.max(np.abs(found.values[:, k])) + 1e-9
        assert slopes[:, k] == pytest.approx(differences[:, k], rel=2e-3, abs=2e-3 * size), name


# angles apart by five degrees, and swollen four and six times: no quick way from rest leads vectors there
SWOLLEN = [
    ({"alpha": 77.84364, "beta": 72.74, "length": 0.2388795, "radius": 0.01135674, "wall": 3.873622e-4}, 105e3, "volume"),
    ({"alpha": 58.85298, "beta": 63.3148, "length": 0.1138253, "radius": 0.01006925, "wall": 4.926953e-4}, 62564.0,
     "mid_radius"),
]  # fmt: skip


@pytest.mark.parametrize(("design", "pressure", "output"), SWOLLEN)
def test_slopes_of_swollen_tubes_are_known_from_their_middles(design, pressure, output):
    """As differences of the public functions tell them."""
    tube = fs.Actuator(**design, material=RUBBER, model="source")
    wishes = fs.Goal(output, 0.0, pressure=pressure).wishes([])
    space = freedom.read(tube, {"beta": (60, 80), "wall": (3e-4, 6e-4)}, [])
    u, choice = space.point(np.array([tube.beta, tube.wall]))[None], np.zeros(1, int)
    assert np.isnan(predict(space, wishes, u, choice, 1e-9, thorough=False).values).all()
    found = predict(space, wishes, u, choice, 1e-9)
    slopes = exact_slopes(space, wishes, u, choice, found.values, found.middles)[0, 0]
    step = 1e-4
    for k in range(2):
        ends = np.repeat(u, 2, axis=0)
        ends[:, k] += [step, -step]
        values = predict(space, wishes, ends, np.zeros(2, int), 1e-9).values[:, 0]
        assert slopes[k] == pytest.approx((values[0] - values[1]) / (2 * step), rel=2e-3)
