"""Derivatives of many random states of all kinds against differences of the solver: `-m long`, a few here.

A difference is taken at steps of several sizes, each of them extrapolated from three; that counts whose two last
extrapolations, the states' own bounds, and a slope that jumps within it, leave least open. That is what it may err by: where
it is more than 1e-5 of the derivative (a fold, a family that goes slack within the step), the difference says nothing, and
is counted as such.
"""

import warnings
import zlib
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import pytest
from random_states import LOADS, moved, parameters_of, random_state, size_of, solved

import freesweep as fs
from freesweep.derivative.extremes import EXTREMES

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
MORE_KINDS = (
    "physical single held rotation", "physical single varying", "physical single body", "single varying held length",
    "single varying held rotation", "single body held length", "balloon varying held length", "balloon body held length",
    "thick balloon held length", "yeoh extension held length", "yeoh extension held rotation",
    "physical yeoh extension held length", "physical yeoh extension held rotation", "physical extension held rotation",
    "physical yeoh varying loads", "physical yeoh body", "physical extension body", "physical body locked", "buckled",
    "loose membrane held length", "loose membrane held rotation", "loose membrane varying loads", "loose membrane body",
    "thick varying held length", "thick body held rotation",
    "physical at a change", "physical at a change held length", "physical at a change held rotation",
    "physical varying at a change", "physical varying at a change held rotation", "physical single at a change",
    "loose membrane at a change", "loose membrane varying at a change", "physical body at a change",
    "physical yeoh extension at a change",
)  # fmt: skip
SCALES = (1.0, 0.1, 0.01)  # of steps
ACCURACY = {False: 1e-10, True: 1e-9}  # of the solver; of physical tubes that vary
OF_BOUNDS, OF_CORNERS = (
    6.0,
    40.0,
)  # states' bounds, by the step: what an extrapolated difference, and a jump, may err by
ONE_SIDED = 4.0  # times as much: a shorter step, and one order more that is extrapolated
CLOSE, TELLING = 1e-6, 1e-5  # of a derivative: what it may differ by; what a difference that tells anything leaves open


def difference(way, state, name, outputs, accuracy):
    """Differences of the solver, and by how much they may err: (outputs,) each."""
    best, doubt = np.full(len(outputs), np.nan), np.full(len(outputs), np.inf)
    at, worst = state.get(name, 1.0 if name == "fiber_extension" else 0.0), np.zeros(len(outputs))

    def values(by):
        found = solved(way, state | {name: moved(at, by)}, accuracy=accuracy)
        np.maximum(worst, [found[f"{output}_error"].item() for output in outputs], out=worst)
        return np.array([found[output].item() for output in outputs])

    here = values(0.0)
    for scale in SCALES:
        h = 4e-3 * size_of(name, state) * scale
        worst[:] = 0.0
        one_sided = name == "fiber_extension" and at == 1.0  # the least
        if one_sided:
            f = [here, *(values(part * h) for part in (0.125, 0.25, 0.5, 1.0))]
            slopes = [(one - f[0]) / (part * h) for one, part in zip(f[1:], (0.125, 0.25, 0.5, 1.0))]
            slopes = [2.0 * near - far for near, far in pairwise(slopes)]
            corner = np.zeros(len(outputs))
        else:
            ahead, behind = ([values(side * part * h) for part in (0.25, 0.5, 1.0)] for side in (1.0, -1.0))
            slopes = [(one - other) / (2.0 * part * h) for one, other, part in zip(ahead, behind, (0.25, 0.5, 1.0))]
            bends = [(one - 2.0 * here + other) / (part * h) for one, other, part in zip(ahead, behind, (0.25, 0.5))]
            corner = 2.0 * np.maximum(np.abs(2.0 * bends[0] - bends[1]) - OF_CORNERS * worst / h, 0.0)
        found, before = ((4.0 * near - far) / 3.0 for near, far in pairwise(slopes))
        error = (np.abs(found - before) + corner + OF_BOUNDS * worst / h) * (ONE_SIDED if one_sided else 1.0)
        better = np.isfinite(found) & (error < doubt)
        best, doubt = np.where(better, found, best), np.where(better, error, doubt)
        if np.all(doubt <= CLOSE * np.abs(best)):
            break
    return best, doubt


class Tally(NamedTuple):
    """Of a kind of states: how many derivatives were compared, how many of the differences told something, how many to 1e-6;
    and what is wrong: ``(parameter, output, derivative, difference, bound, doubt, way, state)`` each.
    """

    compared: int
    telling: int
    sharp: int
    wrong: list


def judged(kind, count, seed) -> Tally:
    """Derivatives of ``count`` random states by two parameters each."""
    rng = np.random.default_rng([seed, zlib.crc32(kind.encode())])
    accuracy = (
        ACCURACY["varying" in kind or "body" in kind] if kind.startswith(("physical", "thick", "loose")) else 1e-10
    )
    states, tallies = 0, []
    while states < count:
        try:
            way, state = random_state(kind, rng)
            if int(solved(way, state)["status"]) != 0:
                continue
            names = parameters_of(way, state)
            if "at a change" in kind and "extension" not in kind:  # no difference to one side sees a corner there
                names.remove("fiber_extension")
            names = [str(name) for name in rng.choice(names, 2, replace=False)]
            found = solved(way, state, derivatives=names)
        except fs.ActuatorError:
            continue
        states += 1
        tallies += [compared(way, state, name, found, accuracy) for name in names]
    return Tally(*(sum(part[1:], part[0]) for part in zip(*tallies)))


def compared(way, state, name, found, accuracy) -> Tally:
    """All derivatives of one state by one parameter."""
    ending = f"_d_{name}"
    outputs = [one[2 : -len(ending)] for one in found.data_vars if one.startswith("d_") and one.endswith(ending)]
    assert len(outputs) == 11
    try:
        told, doubts = difference(way, state, name, outputs, accuracy)
    except fs.ActuatorError:  # a step beyond what an actuator may be
        return Tally(0, 0, 0, [])
    telling, sharp, wrong = 0, 0, []
    for output, other, doubt in zip(outputs, told, doubts):
        exact, bound = (found[f"d_{output}_d_{name}{end}"].item() for end in ("", "_error"))
        size = max(abs(other), 1e-3 * abs(found[output].item()) / size_of(name, state))
        if output not in EXTREMES:  # of which many do not change at all
            telling += doubt <= TELLING * size
            sharp += doubt <= CLOSE * size
        elif np.isnan(exact):  # of a cylinder, which is the largest all along
            continue
        if not np.isnan(other) and not abs(exact - other) <= max(CLOSE * abs(exact), bound) + doubt:
            wrong.append((name, output, exact, other, bound, doubt, way, state))
    own = [output not in EXTREMES for output in outputs]
    return Tally(int(np.sum(np.isfinite(told)[own])), telling, sharp, wrong)


def count_of(kind):
    """How many states of a kind: as many as take half a minute."""
    if kind in MORE_KINDS:
        return 30
    return 30 if kind.startswith(("physical ", "thick ")) else 150


@pytest.mark.long
@pytest.mark.parametrize("kind", KINDS + MORE_KINDS)
def test_derivatives_of_random_states_are_what_differences_tell(kind):
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", category=UserWarning)  # of odd tubes; lost derivatives are NaN, and wrong
        found = judged(kind, count_of(kind), seed=17)
    silent = found.compared - found.telling
    print(f"{kind}: {found.compared} compared, {silent} of them say nothing, {len(found.wrong)} wrong")
    assert not found.wrong
    assert found.telling > 0.3 * found.compared > 0


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
