"""What was found, in sentences: whether it can be done, what stands against it, and what that costs."""

import numpy as np

from ..status import NOT_CONVERGED
from .in_units import amount, shown_unit, titled

NONE = "none of the designs that were looked at"  # more than that no search knows
FIGHT = -0.3  # cosine of two gradients: goals that pull against each other
NOTHING = 1e-6  # tolerances that a goal changes over all that is free, or a share of what is minimized: it is not moved
SHARE = 0.1  # of a range or a level: what is offered to be given up


def sentence(misfit, result, residuals, u, slopes) -> str:
    """How many candidates do it; if none: what the nearest one misses, and which goals and limits fight. ``residuals``
    (wishes,): by how many tolerances the nearest one misses each, with a sign.
    """
    count = int(np.sum(result["met"].values))
    if count:
        said = f"{count} of {len(u)} candidates meet every goal and keep every limit"
        falling = int(np.sum(result["met"].values & (result["stable"].values == 0)))
        if falling:
            said += f"; in {falling} of them a state is unstable: the smallest disturbance ends it (stable)"
        pushing = int(np.sum(result["met"].values & (result["slack_fiber"].values > 0)))
        if pushing == 0 or misfit.space.template.is_loose:  # slack threads are none the worse
            return said
        return f"{said}; in {pushing} of them threads would have to push (slack_fiber)"
    missed, wishes = np.nan_to_num(np.abs(residuals), nan=np.inf), misfit.wishes
    if not any(each > 1.0 for each, wish in zip(missed, wishes) if wish.kind != "every"):
        limits = zip(result["limit"].values.tolist(), result["limit_kept"].values[0])
        broken = [titled(name, misfit.shown) for name, kept in limits if not kept]
        return f"{NONE} meets the goals and keeps the limits: {', '.join(broken)}"
    groups = [name for name in ("goal_value", "limit_value") if name in result]
    values = np.concatenate([result[name].values[0] for name in groups])
    worst = int(np.argmax(missed[: len(values)]))
    wish, shown = wishes[worst], misfit.shown
    title = titled(wish.title, shown)
    reached = amount(values[worst], wish.output, shown)
    said = f"{NONE} does it; the nearest one has {title} of {reached} instead of {_range(wish, shown)}"
    if np.isnan(values[worst]):
        state = "no state was found" if result["status"].values[0] == NOT_CONVERGED else "there is no state"
        return f"{NONE} does it; of the nearest one {state} in which {title} counts"
    if np.all(np.abs(slopes[0][worst]) < NOTHING * max(missed[worst], 1.0)):
        if not misfit.space.names:
            return (
                f"{said}; lists name what can be bought, and nothing between: ranges are (low, high), or start and stop"
            )
        return f"{said}: nothing that is free changes it"
    pulls = np.nan_to_num(slopes[0]) * np.sign(np.nan_to_num(residuals))[:, None]
    for other in np.argsort(-missed):
        a, b = pulls[worst], pulls[other]
        size = np.linalg.norm(a) * np.linalg.norm(b)
        if other != worst and missed[other] > 0.0 and size > 0.0 and a @ b < FIGHT * size:
            same = f", {_range(wishes[other], shown)}" if wishes[other].title == wish.title else ""
            return f"{said}: it fights with {titled(wishes[other].title, shown)}{same}"
    held = [f"{name} at {amount(end, name, shown)}" for name, end, _ in _stopping(misfit, u[0], pulls[worst])]
    if not held:
        return said
    return f"{said}: the bounds {', '.join(held)} stop it{_bought(misfit, u[0], pulls[worst], worst)}"


def _stopping(misfit, u, pulls):
    """(name, its bound, its place) of what is free and at the bound at which it misses least."""
    space = misfit.space
    for i, (name, at) in enumerate(zip(space.names, u)):
        if at <= 0.0 and pulls[i] > 0.0:
            yield name, space.low[i], i
        elif at >= 1.0 and pulls[i] < 0.0:
            yield name, space.high[i], i


def _bought(misfit, u, pulls, worst):
    """What the bound that stops a goal most would buy if it were moved."""
    space, wish = misfit.space, misfit.wishes[worst]
    name, _, i = max(_stopping(misfit, u, pulls), key=lambda one: abs(pulls[one[2]]))
    size = space.high[i] - space.low[i]
    step = round_amount(SHARE * size, name, misfit.shown)
    won = amount(abs(pulls[i]) * misfit.tolerances[worst] * step / size, wish.output, misfit.shown, 3)
    more = "more" if u[i] >= 1.0 else "less"
    return f"; {amount(step, name, misfit.shown)} {more} of {name} would buy {won}"


def prices(result, wishes, names, shown) -> str:
    """What holds the best candidate's minimized number, dearest first, in one sentence; "" if nothing does.

    ``wishes``: goals, limits and what is minimized; ``names`` of what is free; units as they are ``shown``.
    """
    objective, found = wishes[-1], []
    held = [(wish.title, wish.output, _level(wish)) for wish in wishes[:-1]]
    costs = [result[f"{group}_price"].values[0] for group in ("goal", "limit") if f"{group}_price" in result]
    for (title, output, level), price in zip(held, np.concatenate(costs)):
        found.append(_saved(price, level, output, titled(title, shown), shown))
    for name, price, end in zip(names, result["bound_price"].values[0], _ends(result, names)):
        if name == objective.output:
            continue  # that goes without saying
        found.append(_saved(price, abs(end), name, name, shown))
    least = NOTHING * abs(result["objective"].values[0, 0])
    words = [
        f"{what} would save {amount(won, objective.output, shown, 2)}"
        for won, what in sorted(found, reverse=True)
        if won > least
    ]
    return f"least {titled(objective.title, shown)}: {'; '.join(words)}" if words else ""


def _saved(price, level, name, title, shown):
    """``(what it saves, words)`` of giving up a round amount of what is called by its ``title``."""
    step = round_amount(SHARE * level, name, shown)
    return abs(price) * step, f"{amount(step, name, shown)} {'less' if price > 0 else 'more'} of {title}"


def _level(wish):
    """By what a wish's range is measured."""
    return max((abs(end) for end in (wish.low, wish.high) if np.isfinite(end)), default=0.0) or 1.0


def _ends(result, names):
    """What is free of the best candidate, as numbers."""
    for name in names:
        own, _, knot = name.partition("[")
        values = result[own].values[0]
        yield float(values[int(knot[:-1])] if knot else values)


def round_amount(size, name, shown):
    """About a ``size`` of a parameter or an output, which is a round number where it is shown: its first digit."""
    _, scale = shown_unit(name, shown)
    return float(f"{size * scale:.0e}") / scale if size > 0.0 else 1.0 / scale


def _range(wish, shown):
    low, high = (amount(end, wish.output, shown) for end in (wish.low, wish.high))
    if wish.low == wish.high:
        return low
    if np.isinf(wish.high):
        return f"at least {low}"
    return f"at most {high}" if np.isinf(wish.low) else f"{low} to {high}"
