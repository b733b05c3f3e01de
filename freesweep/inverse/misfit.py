"""How far designs are from what was wished for, and how that changes with what is free."""

from typing import NamedTuple

import numpy as np

from ..query.exact import MESHES
from ..report import SHOWN
from .exact import exact_slopes, held_slopes
from .predict import predict
from .wishes import HELD, RELATIVE

STEP = 1e-4  # of the unit box, of central differences
LOOKING, POLISHING = 1e-4, 1e-8  # accuracies of the solver: held states are told to little more in vectors
NATURAL = {"rotation": 1.0, "stroke": 0.01}  # [degree], [1]: a wish for 0 is measured by
SHARE = {"deformed_length": "length", "length_change": "length", "mid_radius": "radius", "outer_radius": "radius"}
INSIDE = 1e-2  # tolerances: a limit is kept where the search ends a little short of it
WISHED = "values", "bounds", "status", "middles", "stable"  # what is predicted of each wish
FAR = 1e3  # tolerances by which a state that is not there counts as missed


class Misfit(NamedTuple):
    """Wishes in units of their tolerances: goals first, then limits."""

    space: object
    wishes: list
    goals: int
    tolerances: np.ndarray
    is_dear: bool = False  # vectors tell no state of any design that is near: each is solved by itself
    left_out: list | None = None  # takes whether unstable states were taken for none; None: they count as others do
    shown: dict = SHOWN  # units of what is said

    @property
    def is_quick(self) -> bool:
        """Whether vectors tell all that is wished for."""
        from .vectors import Kind

        own = Kind.of(self.space.template)
        return self.space.is_alike and all(
            wish.kind in ("design", "every") or own.tells(wish.output, wish.kind) for wish in self.wishes
        )

    def residuals(self, values):
        """By how many tolerances ``values`` (n, wishes) miss each wish: beyond its range, with a sign."""
        low = np.array([wish.low for wish in self.wishes])
        high = np.array([wish.high for wish in self.wishes])
        within = np.where(
            np.arange(len(low)) < self.goals, 0.0, np.minimum(INSIDE * self.tolerances, 0.5 * (high - low))
        )
        low, high = low + within, high - within
        with np.errstate(invalid="ignore"):
            above, below = np.maximum(values - high, 0.0), np.minimum(values - low, 0.0)
            missed = np.where(np.isfinite(values), above + below, np.where(values > 0, 0.0, np.nan))
        return missed / self.tolerances

    def at(self, u, choice, accuracy=POLISHING, thorough=True, near=None):
        """``(what is predicted, residuals)`` at points u (n, p); ``near``: that of points beside."""
        dear = self.is_dear and not self._is_followed(near)
        found = predict(self.space, self.wishes, u, choice, accuracy, thorough or dear, near=near)
        if self.left_out is not None and np.any(found.falls):
            self.left_out.append(True)
            found = found._replace(values=np.where(found.falls, np.nan, found.values))
        return found, self.residuals(found.values)

    def _is_followed(self, near):
        """Whether held states are known from which those beside them are found."""
        held = [wish.output in HELD for wish in self.wishes]
        return near is not None and bool(np.any(np.isfinite(near.middles[:, held])))

    def slopes(self, u, choice, found, on_meshes=None):
        """Derivatives (n, wishes, p) of the predicted values, in tolerances, along u: exact ones where vectors give them,
        else central differences, one-sided where the other side has no state; of held states, beside these, of those
        ``on_meshes`` (n,) by meshes. NaN where nothing is known.
        """
        slopes = exact_slopes(self.space, self.wishes, u, choice, found.values, found.middles)
        held_slopes(self.space, self.wishes, u, choice, found, slopes)
        there = np.isfinite(found.values)
        missing = there & np.any(np.isnan(slopes), axis=2)
        wishes = np.any(missing, axis=0)
        own = [wish for wish, lost in zip(self.wishes, wishes) if lost]
        meshed = np.zeros(len(u), bool) if on_meshes is None else on_meshes
        for way, part in ((False, ~meshed), (MESHES, meshed)):
            rows = np.any(missing, axis=1) & part
            if not np.any(rows):
                continue
            near = found.part(rows)
            near = near._replace(**{name: getattr(near, name)[:, wishes] for name in WISHED})
            table, known = np.ix_(rows, wishes), slopes[np.ix_(rows, wishes)]
            other = self._differences(own, u[rows], choice[rows], near, way)
            slopes[table] = np.where(np.isnan(known), other, known)
        return slopes / self.tolerances[:, None]

    def _differences(self, wishes, u, choice, found, thorough=False):
        """Central differences (n, wishes, p) about points of which that was ``found``, as ``thorough`` as it was."""
        count, free = u.shape
        step, middle = STEP * np.eye(free), found.values
        ends = np.concatenate([np.clip(u[:, None] + step, 0.0, 1.0), np.clip(u[:, None] - step, 0.0, 1.0)], axis=1)
        values = predict(
            self.space,
            wishes,
            ends.reshape(-1, free),
            np.repeat(choice, 2 * free),
            POLISHING,
            thorough=thorough,
            near=found.part(np.repeat(np.arange(count), 2 * free)),
        ).values.reshape(count, 2 * free, -1)
        middle, there = middle[:, None], np.isfinite(values)
        values = np.where(there, values, middle)
        along = np.arange(free)
        width = ends[:, :free][:, along, along] - ends[:, free:][:, along, along]
        sides = there[:, :free].astype(int) + there[:, free:]  # that have a state
        with np.errstate(invalid="ignore"):
            slope = (values[:, :free] - values[:, free:]) / (0.5 * np.maximum(sides, 1) * width[..., None])
        return np.moveaxis(np.where(sides > 0, slope, np.nan), 1, 2)

    def ahead(self, found, slopes, step):
        """What was ``found``, a ``step`` (n, p) further along the ``slopes`` (n, wishes, p)."""
        change = np.einsum("nwp,np->nw", np.nan_to_num(slopes), step)
        return found._replace(values=found.values + change * self.tolerances)


def make(space, goals, limits) -> Misfit:
    """The misfit of goals and limits: tolerances that are not given are a share of the value, or of its natural size."""
    wishes = [*goals, *limits]
    return Misfit(space, wishes, len(goals), np.array([_tolerance(space, wish) for wish in wishes]))


def _tolerance(space, wish):
    if np.isfinite(wish.tolerance):
        return wish.tolerance
    ends = [abs(end) for end in (wish.low, wish.high) if np.isfinite(end)]
    size = max(ends, default=0.0)
    if size == 0.0:
        r = space.held["radius"]
        natural = NATURAL | {"force": np.pi * r**2 * 1e4, "torque": np.pi * r**3 * 1e4}
        size = natural.get(wish.output) or 0.1 * space.held.get(SHARE.get(wish.output), 0.0) or 1.0
    return RELATIVE * size
