"""Derivatives of many random states of all kinds against differences of the solver: `-m long`, a few here.

A difference is taken at steps of several sizes, extrapolated; that counts which its own estimate calls best. Where even that
tells less than the derivative's bound (a fold, a family that goes slack within the step), it decides by its estimate.
"""

import warnings
import zlib
from itertools import pairwise

import numpy as np
import pytest

import freesweep as fs

KINDS = (
    "free", "loads", "extension", "locked", "held length", "held rotation", "varying", "varying held length",
    "physical", "physical loads", "physical held length", "thick", "loose membrane", "yeoh",
    "varying held rotation", "physical varying", "physical varying loads", "physical held rotation",
    "body", "body held length", "body held rotation", "physical body", "physical body held length",
    "physical body loads", "physical body held rotation", "physical varying held length", "physical varying held rotation",
    "thick body", "physical varying locked", "single", "single loads", "single held length", "single held rotation",
    "physical single", "physical single loads", "physical single held length", "single varying", "single body", "balloon",
    "balloon held length", "balloon loads", "thick balloon", "balloon body", "balloon varying", "physical yeoh",
    "physical yeoh held length", "extension held length", "physical extension", "thick loads", "thick held rotation",
    "yeoh varying", "yeoh body", "physical locked",
)  # fmt: skip
C10 = 0.11e6
LOADS = ("pressure", "force", "torque", "deformed_length", "rotation")
SCALES = (1.0, 0.1, 0.01)  # of steps
ACCURACY = {False: 1e-10, True: 1e-9}  # of the solver; of physical tubes
SCATTER = 10.0  # accuracies: of what differences of two states scatter
ONE_SIDED = 4.0  # times as much: a shorter step, and one order more that is extrapolated


def along(state, rng):
    """The angle or the wall of a state, with a slope or a jump."""
    name = rng.choice([name for name in ("alpha", "beta", "wall") if state[name] is not None])
    at = state[name]
    other = (
        at * rng.uniform(0.7, 1.3)
        if name == "wall"
        else at + np.sign(at - (state["beta" if name == "alpha" else "alpha"] or 0.0)) * 5
    )
    pairs = [(0, at), (1, other)], [(0, at), (0.5, at), (0.5, other), (1, other)]
    return state | {name: pairs[rng.integers(2)] if abs(other) < 85 or name == "wall" else at}


def random_state(kind, rng):
    """``(way, state)``: name -> value of the actuator and its loads."""
    alpha, beta = rng.uniform(0, 85), rng.uniform(-85, 85)
    if abs(alpha - beta) < 3.0:
        return random_state(kind, rng)
    r = rng.uniform(3e-3, 12e-3)
    state = {
        "alpha": alpha,
        "beta": beta,
        "length": r * rng.uniform(5, 60),
        "radius": r,
        "wall": r * rng.uniform(0.05, 0.4),
    }
    rubber = {"c10": C10 * rng.uniform(0.5, 2), "c01": C10 * rng.uniform(0.1, 1)}
    if "yeoh" in kind:
        rubber = {"c1": C10, "c2": C10 * rng.uniform(0.02, 0.3), "c3": C10 * rng.uniform(0.001, 0.02)}
    state |= rubber
    if kind.startswith("physical"):
        state["model"] = "physical"
    if kind.startswith("thick"):
        state |= {"wall_model": "thick", "fiber_radius": str(rng.choice(["inner", "middle", "outer"]))}
    if kind == "loose membrane":
        state["fibers"] = "loose"
    if "balloon" in kind or "single" in kind:
        none = ("alpha", "beta") if "balloon" in kind else (str(rng.choice(["alpha", "beta"])),)
        state |= dict.fromkeys(none)
    if "extension" in kind:
        state["fiber_extension"] = rng.uniform(1.001, 1.03)
    if "varying" in kind:
        state = along(state, rng)
    if "body" in kind:
        state |= {"taper": rng.uniform(-0.3, 0.3), "bulge": rng.uniform(-0.2, 0.4)}
    if "locked" in kind:
        return "lock", state
    state["pressure"] = 10 ** rng.uniform(3.5, 5.3)
    pull, twist = state["pressure"] * np.pi * r**2, state["pressure"] * np.pi * r**3
    if "length" in kind:
        held = {"deformed_length": state["length"] * rng.uniform(0.8, 1.1), "torque": twist * rng.uniform(-0.3, 0.3)}
        return "blocked_force", state | held
    if "rotation" in kind:
        turn = np.degrees(0.2 * state["length"] / r)
        return "blocked_torque", state | {"rotation": turn * rng.uniform(-1, 1), "force": pull * rng.uniform(-0.3, 0.5)}
    if "loads" in kind:
        state |= {"force": pull * rng.uniform(-0.3, 0.8), "torque": twist * rng.uniform(-0.3, 0.3)}
    return "inflate", state


def solved(way, state, **more):
    design = {name: value for name, value in state.items() if name not in LOADS}
    rubber = [design.pop(name) for name in ("c10", "c01", "c1", "c2", "c3") if name in design]
    material = (fs.MooneyRivlin if len(rubber) == 2 else fs.Yeoh)(*rubber)
    loads = {name: state[name] for name in LOADS if name in state}
    return getattr(fs, way)(fs.Actuator(**design, material=material), **loads, x=[0.0], **more)


def moved(value, by):
    return [(share, number + by) for share, number in value] if isinstance(value, list) else value + by


def size_of(name, state):
    """What a step is a part of."""
    r, pressure = state["radius"], state.get("pressure", 0.0)
    size = {"alpha": 25.0, "beta": 25.0, "fiber_extension": 1.0, "rotation": 60.0, "taper": 0.5, "bulge": 0.5}
    size |= {"force": pressure * np.pi * r**2, "torque": pressure * np.pi * r**3}
    at = state.get(name)
    return size.get(name) or (at[0][1] if isinstance(at, list) else at)


def difference(way, state, name, outputs, accuracy, sizes):
    """Differences of the solver, and by how much they may err: (outputs,) each."""
    best, doubt = np.full(len(outputs), np.nan), np.full(len(outputs), np.inf)
    at = state.get(name, 1.0 if name == "fiber_extension" else 0.0)

    def values(by):
        found = solved(way, state | {name: moved(at, by)}, accuracy=accuracy)
        return np.array([found[output].item() for output in outputs])

    for scale in SCALES:
        h = 4e-3 * size_of(name, state) * scale
        one_sided = name == "fiber_extension" and at == 1.0  # the least
        if one_sided:
            f = [values(part * h) for part in (0.0, 0.125, 0.25, 0.5, 1.0)]
            slopes = [(one - f[0]) / (part * h) for one, part in zip(f[1:], (0.125, 0.25, 0.5, 1.0))]
            slopes = [2.0 * near - far for near, far in pairwise(slopes)]
        else:
            slopes = [(values(part * h) - values(-part * h)) / (2.0 * part * h) for part in (0.25, 0.5, 1.0)]
        found, before = ((4.0 * near - far) / 3.0 for near, far in pairwise(slopes))
        error = (np.abs(found - before) + SCATTER * accuracy * sizes / h) * (ONE_SIDED if one_sided else 1.0)
        better = np.isfinite(found) & (error < doubt)
        best, doubt = np.where(better, found, best), np.where(better, error, doubt)
        if np.all(doubt <= 1e-6 * np.abs(best)):
            break
    return best, doubt


def judged(kind, count, seed):
    """How many derivatives of ``count`` states were compared, how many of them told to 1e-5 or better, and what is wrong."""
    rng = np.random.default_rng([seed, zlib.crc32(kind.encode())])
    states = compared = sharp = 0
    wrong = []
    physical = kind.startswith(("physical", "thick")) or kind == "loose membrane"
    while states < count:
        way, state = random_state(kind, rng)
        try:
            if int(solved(way, state)["status"]) != 0:
                continue
            loads = {"lock": (), "inflate": LOADS[:3], "blocked_force": ("pressure", "torque", "deformed_length")}
            names = [*(set(state) - {"model", "wall_model", "fibers", *LOADS}), "fiber_extension"]
            names = [name for name in names if name not in state or not isinstance(state[name], str | None)]
            names = sorted({*names, *loads.get(way, ("pressure", "force", "rotation"))})
            names = [str(name) for name in rng.choice(names, 2, replace=False)]
            found = solved(way, state, derivatives=names)
        except fs.ActuatorError:
            continue
        states += 1
        for name in names:
            ending = f"_d_{name}"
            outputs = [
                one[2 : -len(ending)] for one in found.data_vars if one.startswith("d_") and one.endswith(ending)
            ]
            assert len(outputs) == 5
            sizes = np.array([max(abs(found[output].item()), 1e-6) for output in outputs])
            try:
                told, doubts = difference(way, state, name, outputs, ACCURACY[physical], sizes)
            except fs.ActuatorError:  # a step beyond what an actuator may be
                continue
            for output, other, doubt in zip(outputs, told, doubts):
                exact, bound = (found[f"d_{output}_d_{name}{end}"].item() for end in ("", "_error"))
                size = max(abs(exact), 1e-3 * abs(found[output].item()) / size_of(name, state))
                compared += np.isfinite(other)
                sharp += doubt <= 1e-5 * size
                if not abs(exact - other) <= max(1e-6 * size, bound) + doubt and not np.isnan(other):
                    wrong.append((name, output, exact, other, bound, doubt, way, state))
    return compared, sharp, wrong


@pytest.mark.long
@pytest.mark.parametrize("kind", KINDS)
def test_derivatives_of_random_states_are_what_differences_tell(kind):
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", category=UserWarning)  # of odd tubes; lost derivatives are NaN, and wrong
        count = 30 if kind.startswith(("physical ", "thick ")) else 150  # half a minute each
        compared, sharp, wrong = judged(kind, count, seed=17)
    print(f"{kind}: {compared} compared, {sharp} of them to 1e-5, {len(wrong)} wrong")
    assert not wrong
    assert sharp > 0.3 * compared > 0


def lacks(way, found, state):
    """By what share of its terms each identity is missed that derivatives by loads and by what is held keep: Maxwell's
    symmetries of what these work on, and that the energy stored is their work.
    """
    held = {"blocked_force": "deformed_length", "blocked_torque": "rotation"}.get(way)
    works = {"pressure": ("volume", 1.0), "force": ("deformed_length", 1.0), "torque": ("rotation", np.radians(1.0))}
    given = {name: of for name, of in works.items() if of[0] != held}
    unknown = next((name for name in works if name not in given), None)

    def by(output, name):
        return found[f"d_{output}_d_{name}"].item()

    missed = []
    names = list(given)
    for k, one in enumerate(names):
        for other in names[k + 1 :]:
            (a, unit), (b, size) = given[one], given[other]
            missed.append((unit * by(a, other), -size * by(b, one)))
        if unknown is not None:  # the load that holds, and what it is conjugate to
            (a, unit), (_, size) = given[one], works[unknown]
            missed.append((size * by(unknown, one), unit * by(a, held)))
    for name in (*names, *(() if held is None else (held,))):
        work = [-state.get(load, 0.0) * unit * by(output, name) for load, (output, unit) in given.items()]
        if name == held:
            work.append(-found[unknown].item() * works[unknown][1])
        missed.append((by("strain_energy", name), *work))
    return [abs(sum(terms)) / (sum(map(abs, terms)) + 1e-300) for terms in missed]


def kept(kind, count, seed):
    """The largest of :func:`lacks` in ``count`` random states; where derivatives are lost, not a number."""
    rng, worst = np.random.default_rng([seed, zlib.crc32(kind.encode())]), []
    names = {"inflate": LOADS[:3], "blocked_force": ("pressure", "torque", "deformed_length")}
    while len(worst) < count:
        way, state = random_state(kind, rng)
        try:
            if int(solved(way, state)["status"]) == 0:
                names_of = names.get(way, ("pressure", "force", "rotation"))
                worst.append(max(lacks(way, solved(way, state, derivatives=names_of, accuracy=1e-8), state)))
        except fs.ActuatorError:
            continue
    return np.max(worst)


IDENTITIES = [kind for kind in KINDS if "locked" not in kind]


@pytest.mark.long
@pytest.mark.parametrize("kind", IDENTITIES)
def test_derivatives_of_random_states_keep_the_work_of_loads(kind):
    assert kept(kind, 30, seed=18) < 1e-7


@pytest.mark.parametrize("kind", ["held length", "varying held rotation", "physical"])
def test_derivatives_keep_the_work_of_loads(kind):
    assert kept(kind, 2, seed=19) < 1e-7
