"""Which families of fibers a tube has: two, one or none, and what its results say of those it has not.

The solver follows two lines of the wall. They are the fibers of two families; of one family they are its fibers and a line
that carries nothing, whose tangent is less by OFFSET; of a tube without threads the axis takes the family's place. Stretch
and twist follow from the deformed angles of both lines. Two loose families of one angle are one that both share.

A family that is not there has no angle (NaN) and no tension (0), and is not slack.
"""

from typing import NamedTuple

import numpy as np

from .tube_model import THREADS

FAMILIES = ("alpha", "beta")
OFFSET = 1.0  # of the tangent: a line at 45 degree to the axis of a balloon
BITS = {"alpha": 1, "beta": 2}  # of ``slack_fiber``
A_POINT = (
    1e-6  # of the length, the accuracy of outputs: a pull that ends over less ends at a single place, or in rounding
)


def is_none(value) -> bool:
    """Whether a fiber angle is that of no family: None, or the word."""
    return value is None or (isinstance(value, str) and value.strip().lower() == "none")


def followed(tube) -> tuple:
    """Names of the families whose fibers the solver follows: both, one or none."""
    given = given_by(tube)
    return given[:1] if len(given) == 2 and is_one(tube) else given


def given_by(tube) -> tuple:
    """Names of the families that a tube has."""
    return tuple(name for name in FAMILIES if getattr(tube, name) is not None)


def is_one(tube) -> bool:
    """Whether both families have one angle all along."""
    return tube.alpha == tube.beta


def threads(tube) -> float:
    """What the solver takes for the families that there are, and whether they may push."""
    return THREADS[len(followed(tube)), "loose" if tube.is_loose else "bonded"]


class Lines(NamedTuple):
    """What the solver follows of many designs, arrays (n,): angles [degree] of both lines, what families there are as the
    solver takes it, and whether they are fewer than two.
    """

    alpha: np.ndarray
    beta: np.ndarray
    threads: np.ndarray
    single: np.ndarray


def lines_of(alpha, beta, names, loose, single=None) -> Lines:
    """The lines of designs that have the families ``names``, of fiber angles (n,) [degree]; those that are ``single`` if it
    is known, else where loose families share an angle.
    """
    fibers = "loose" if loose else "bonded"
    if single is None:
        single = (alpha == beta) & loose if len(names) == 2 else np.ones(alpha.shape, bool)
    first = beta if names == ("beta",) else alpha if names else np.zeros_like(alpha)
    with np.errstate(invalid="ignore"):
        beside = np.degrees(np.arctan(other_line(np.tan(np.radians(first)))))
    threads = np.where(single, THREADS[min(len(names), 1), fibers], THREADS[2, fibers])
    return Lines(first, np.where(single, beside, beta), threads, single)


def families_of(attributes) -> tuple:
    """The families that an atlas tells in its attributes."""
    return tuple(name for name in FAMILIES if attributes.get(f"family_{name}") != "none")


def other_line(tangent):
    """Tangent of the line beside one family."""
    return tangent - OFFSET


def told(tube, found) -> dict:
    """Variables by name, ``<name>_alpha`` and the like, of the lines that the solver follows, as those of the families: name
    -> array.
    """
    first, given = followed(tube), given_by(tube)
    if len(first) == 2:
        return found
    result = dict(found)
    for name in found:
        family = next((family for family in FAMILIES if family in name), None)
        if family is None:
            continue
        line = name.replace(family, "alpha")
        if family not in given:
            result[name] = found[line] * (np.nan if "deformed" in name else 0.0)
        else:
            result[name] = found[line] * (1.0 / len(given) if "tension" in name else 1.0)
    return result


def beyond_a_point(slack_fiber, alpha, beta):
    """``slack_fiber`` as it is told: a family has its bit where it is slack, or would have to push, over more than
    :data:`A_POINT` of the length. ``alpha`` and ``beta`` are the shares of the length over which they are; the flags given
    tell of single places, too.
    """
    points = (alpha <= A_POINT) * BITS["alpha"] | (beta <= A_POINT) * BITS["beta"]
    return slack_fiber & ~points


def told_slack(tube, slack_fiber):
    """The flag of slack families, from that of the lines."""
    first = followed(tube)
    if len(first) == 2:
        return slack_fiber
    return np.where((slack_fiber & BITS["alpha"]) > 0, sum(BITS[name] for name in given_by(tube)), 0)
