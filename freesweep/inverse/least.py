"""Among designs that do what is wished for, those with the least of something, or a front between two of it."""

import numpy as np

from .misfit import FAR, Misfit

ROUNDS = 60
ENOUGH = 1e-8  # of the objective, relative
INSIDE = 0.5  # of a goal's tolerance that the search may use
NEAREST = 1e-3  # of the unit box: as near the search comes to where there is no state
ALIKE = 1e-5  # of the objectives: as little of one as another point has
ACTIVE = 1e-3  # of the unit box, or tolerances: a bound or a limit that stops the search


class Least:
    """The problem of one choice, for SciPy: the last ones of the wishes are the objectives."""

    def __init__(self, misfit: Misfit, choice, objectives, scale):
        self.misfit, self.choice, self.objectives = misfit, np.array([choice]), objectives
        self.scale = scale  # of the objectives, (objectives,)
        self._known = {}

    def known(self, u):
        """Values of all wishes and their slopes, in tolerances."""
        u = np.clip(u, 0.0, 1.0)
        if (key := u.tobytes()) not in self._known:
            found, _ = self.misfit.at(u[None], self.choice)
            slopes = np.nan_to_num(self.misfit.slopes(u[None], self.choice, found)[0])
            values = found.values[0] / self.misfit.tolerances
            values = np.where(np.isnan(values), self._far(-1.0), np.where(np.isinf(values), self._far(1.0), values))
            self._known = {key: (values, slopes)}  # the last one only
        return self._known[key]

    def _far(self, sign):
        """What stands for the values of states that are not there, beyond each range (-1), or of limit pressures where there
        is no limit, above each level (1); more than any objective.
        """
        low, high = np.array([(wish.low, wish.high) for wish in self.misfit.wishes]).T / self.misfit.tolerances
        beyond = np.where(np.isfinite(high), high + FAR, np.where(np.isfinite(low), low + sign * FAR, 0.0))
        beyond[len(beyond) - self.objectives :] = FAR * self.scale
        return beyond

    def is_there(self, u):
        """Whether all states are."""
        return not np.any(np.isnan(self.misfit.at(u[None], self.choice)[0].values))

    def objective(self, k):
        """One objective and its gradient, of size 1."""
        place = len(self.misfit.wishes) - self.objectives + k
        return (
            lambda u: self.known(u)[0][place] / self.scale[k],
            lambda u: self.known(u)[1][place] / self.scale[k],
        )

    def constraints(self, levels):
        """Goals and limits as SciPy takes them; and levels (k,) of objectives that are not to be passed, NaN for none."""
        found, wishes = [], self.misfit.wishes
        for j, wish in enumerate(wishes[: len(wishes) - self.objectives]):
            unit = self.misfit.tolerances[j]
            slack = INSIDE if j < self.misfit.goals else 0.0
            if np.isfinite(wish.low):
                found.append(self._one(j, 1.0, wish.low / unit - slack, max(abs(wish.low / unit), 1.0)))
            if np.isfinite(wish.high):
                found.append(self._one(j, -1.0, wish.high / unit + slack, max(abs(wish.high / unit), 1.0)))
        for k, level in enumerate(levels):
            if np.isfinite(level):
                found.append(self._one(len(wishes) - self.objectives + k, -1.0, level, self.scale[k]))
        return found

    def _one(self, j, sign, end, size):
        return {
            "type": "ineq",
            "fun": lambda u: sign * (self.known(u)[0][j] - end) / size,
            "jac": lambda u: sign * self.known(u)[1][j] / size,
        }

    def is_out_of_reach(self, u, levels):
        """Whether some objective is above its level and nothing that is open changes it."""
        values, slopes = (numbers[len(numbers) - self.objectives :] for numbers in self.known(u))
        above = values - np.array(levels) > ACTIVE * self.scale
        return bool(np.any(above & ~np.any(slopes, axis=1)))

    def search(self, u, k, levels):
        """The point with the least of objective ``k`` from ``u`` (p,) on: where that leads to where there is no state, from
        the last one that has all of them, within a box that is halved each time.
        """
        if not len(u):  # a choice leaves nothing open
            return u
        end, reach = self._descend(u, k, levels, 1.0), 0.5
        if self.is_there(end):
            return end
        while reach > NEAREST:
            end = self._descend(u, k, levels, reach)
            if self.is_there(end) and self.objective(k)[0](end) < self.objective(k)[0](u):
                u = end
            else:
                reach *= 0.5
        return u

    def _descend(self, u, k, levels, reach):
        from scipy.optimize import minimize

        fun, jac = self.objective(k)
        box = list(zip(np.maximum(u - reach, 0.0), np.minimum(u + reach, 1.0)))
        found = minimize(
            fun, u, jac=jac, method="SLSQP", bounds=box, constraints=self.constraints(levels),
            options={"maxiter": ROUNDS, "ftol": ENOUGH},
        )  # fmt: skip
        return np.clip(found.x, 0.0, 1.0)


def least(misfit: Misfit, u, choice, objectives, scale):
    """Points with the least of one objective (s, p), each from its start; the wishes end with the objective."""
    return np.array([Least(misfit, c, objectives, scale).search(one, 0, [np.nan]) for one, c in zip(u, choice)])


def front(misfit: Misfit, u, choice, count, scale):
    """``count`` points, and their choices, along the front of two objectives, from the starts that have the least of each:
    the second one's least while the first is held at its own least and at levels from there on.
    """
    ends, others = [], []
    for k in range(2):
        found = [Least(misfit, c, 2, scale).search(one, k, [np.nan] * 2) for one, c in zip(u, choice)]
        _, residuals = misfit.at(np.array(found), choice)
        values = np.array([Least(misfit, c, 2, scale).objective(k)[0](one) for one, c in zip(found, choice)])
        kept = np.all(np.abs(residuals[:, : len(misfit.wishes) - 2]) <= 1.0, axis=1)
        best = np.argmin(np.where(kept, values, np.inf))
        ends.append((found[best], choice[best]))
        others += [(found[i], choice[i]) for i in np.unique(choice, return_index=True)[1]]  # of each choice one
    place = len(misfit.wishes) - 2
    (first, one), (last, other) = ends
    levels = [Least(misfit, c, 2, scale).known(end)[0][place] for end, c in ends]
    points, choices = [], []
    for share in np.linspace(0.0, 1.0, max(count, 2))[:-1]:
        level = levels[0] + share * (levels[1] - levels[0])
        starts = [(points[-1], choices[-1]), (last, other)] if points else [(first, one)]
        starts += [(first + share * (last - first), one)] if points and one == other else []
        starts += others if len(np.unique(choice)) > 1 else []
        point, own = _best(misfit, scale, starts, level)
        points.append(point)
        choices.append(own)
    return np.array([*points, last]), np.array([*choices, other])


def beaten(values, scale):
    """Which points (n,) have no less of either objective (n, 2), and more of one, than some other point."""
    own, others, alike = values[:, None], values[None], ALIKE * scale
    return np.any(np.all(own >= others - alike, axis=2) & np.any(own > others + alike, axis=2), axis=1)


def _best(misfit, scale, starts, level):
    """The least of the second objective among what the ``starts`` lead to, the first one up to ``level``: point, choice."""
    found = []
    for start, choice in starts:
        at = Least(misfit, choice, 2, scale)
        levels = [level, np.nan]
        point = start if at.is_out_of_reach(start, levels) else at.search(start, 1, levels)
        broken = sum(max(0.0, -float(each["fun"](point)) - ACTIVE) for each in at.constraints(levels))
        found.append((broken, float(at.objective(1)[0](point)), point, choice))
    return min(found, key=lambda one: one[:2])[2:]


def multipliers(misfit: Misfit, u, slopes, values, objectives):
    """What each wish (w,) and each bound (p,) costs where one objective is least: its change by one unit of theirs.

    Stationarity: the objective's gradient is a sum of those of what is active, none of them pulling the wrong way.
    """
    from scipy.optimize import nnls

    wishes, last, slopes = misfit.wishes, len(misfit.wishes) - objectives, np.nan_to_num(slopes)
    gradient = slopes[last] * misfit.tolerances[last]
    columns, names = [], []
    for j in range(last):
        value, unit, wish = values[j], misfit.tolerances[j], wishes[j]
        near = max(ACTIVE * max(abs(value), unit), 2.0 * unit)
        own = slopes[j] * unit
        if np.isfinite(wish.low) and value < wish.low + near:
            columns.append(own)
            names.append((j, 1.0))
        if np.isfinite(wish.high) and value > wish.high - near:
            columns.append(-own)
            names.append((j, -1.0))
    for i, at in enumerate(u):
        if at < ACTIVE or at > 1.0 - ACTIVE:
            unit = np.zeros(len(u))
            unit[i] = 1.0 if at < ACTIVE else -1.0
            columns.append(unit)
            names.append((last + i, unit[i]))
    found, bounds = np.zeros(last), np.zeros(len(u))
    if columns:
        matrix = np.array(columns).T
        size = np.maximum(np.linalg.norm(matrix, axis=0), 1e-300)
        for (j, sign), value in zip(names, nnls(matrix / size, gradient)[0] / size):
            if j < last:
                found[j] += sign * value
            else:
                bounds[j - last] += sign * value
    return found, bounds
