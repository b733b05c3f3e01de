"""What designs do: the wished-for output of each, many at a time.

Tubes that are the same all along are solved in vectors (``vectors``); others, and what those do not tell, one by one
(``singles``).
"""

import math
import warnings
from typing import NamedTuple

import numpy as np

from ..status import INVALID, OK, VALUED
from .space import Space
from .wishes import HELD, STIFF

UNKNOWN, UNSTABLE, STABLE = -1, 0, 1  # of a state; vectors do not tell it of physical tubes that are held bent


class Predicted(NamedTuple):
    """Values (n, wishes) in SI units and degrees, NaN where there is no state; bounds of their errors; status; the middle's
    radius [m] where vectors tell it; whether states are STABLE; and which fiber families are slack in some state, or would
    have to push (n,).
    """

    values: np.ndarray
    bounds: np.ndarray
    status: np.ndarray
    middles: np.ndarray
    stable: np.ndarray
    slack: np.ndarray

    def held(self, wishes, states) -> dict:
        """Held state -> (load, the middle's radius), (2, n), of those of the ``wishes``."""
        own = [k for k, wish in enumerate(wishes) if wish.output in HELD]
        return {states[k]: np.array([self.values[:, k], self.middles[:, k]]) for k in own}

    @property
    def falls(self):
        """Which of the states (n, wishes) that are there are known to be unstable."""
        return (self.stable == UNSTABLE) & np.isin(self.status, VALUED)

    def part(self, where):
        """Some of the designs."""
        return Predicted(*(array[where] for array in self))


class State(NamedTuple):
    """A state in which outputs are wished for: ``kind`` as of :class:`Wish`, its conditions, and for a limit pressure the
    pressure up to which it has to be known, None for none.
    """

    kind: str
    conditions: tuple
    least: float | None

    @property
    def pressure(self):
        """The pressure [Pa], None where it is free."""
        return self.least if self.kind == "limit" else dict(self.conditions).get("pressure")


def state_of(wish) -> State:
    """The state of a wish."""
    least = wish.low if wish.kind == "limit" and math.isfinite(wish.low) else None
    return State(wish.kind, wish.conditions, least)


def _tell_stiffness(space, asked, answers, columns, u, choice, accuracy):
    """Write stiffnesses to the ``answers`` of states that vectors found, but tell no derivative of: each by itself."""
    from .singles import solve_singles

    for state, names in asked.items():
        for name in set(names) & set(STIFF):
            values, bounds = answers[state][name]
            left = np.flatnonzero(np.isnan(values) & np.isin(answers[state]["status"], VALUED))
            if len(left):
                tubes = [space.actuator_or_none(u[i], choice[i]) for i in left]
                own = {key: column[left] for key, column in columns.items()}
                values[left], bounds[left] = solve_singles(tubes, {state: [name]}, own, accuracy)[state][name]


def predict(space: Space, wishes, u, choice, accuracy, thorough=True, sure=False, near=None) -> Predicted:
    """What the designs at points u (n, p) of the ``space``, with ``choice`` (n,), do; if not ``thorough``, of those that
    vectors can tell, where they tell any; ``sure``, as of :func:`vectors.solve_vectors`;
    ``near``: what was :class:`Predicted` of designs beside these.
    """
    from .singles import solve_singles
    from .vectors import Kind, solve_vectors

    shape, accuracy = (len(u), len(wishes)), space.accuracy(accuracy)
    found = Predicted(
        *np.full((2, *shape), np.nan), np.full(shape, INVALID), np.full(shape, np.nan), np.full(shape, STABLE, np.int8),
        np.zeros(len(u), np.int8),
    )  # fmt: skip
    columns, states = space.columns(u, choice), [state_of(wish) for wish in wishes]
    for k, wish in enumerate(wishes):
        if wish.kind == "design":
            found.values[:, k], found.bounds[:, k], found.status[:, k] = columns[wish.output], 0.0, OK
    asked = {
        state: [w.output for w, s in zip(wishes, states) if s == state]
        for state in states
        if state.kind not in ("design", "every")
    }
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # designs on the way are nobody's
        own = Kind.of(space.template)
        quick = {
            state: names
            for state, names in asked.items()
            if space.is_alike and all(own.tells(name, state.kind) for name in names)
        }
        known = {} if near is None else near.held(wishes, states)
        answers = solve_vectors(space.template, quick, columns, accuracy, thorough, sure, known)
        if len(quick) < len(asked):
            tubes = [space.actuator_or_none(one, k) for one, k in zip(u, choice)]
            rest = {state: names for state, names in asked.items() if state not in quick}
            answers |= solve_singles(tubes, rest, columns, accuracy)
        if thorough is True:
            _tell_stiffness(space, quick, answers, columns, u, choice, accuracy)
    for k, (wish, state) in enumerate(zip(wishes, states)):
        if state in answers:
            found.values[:, k], found.bounds[:, k] = answers[state][wish.output]
            found.status[:, k], found.middles[:, k] = answers[state]["status"], answers[state]["middle"]
            found.stable[:, k] = answers[state]["stable"]
            found.slack[:] |= answers[state]["slack"]
    falls = np.any(found.falls, axis=1)
    for k, wish in enumerate(wishes):
        if wish.kind == "every":
            found.values[:, k], found.bounds[:, k], found.status[:, k] = ~falls, 0.0, OK
    return found
