"""Numbers of a sweep that are allowed but look like slips of units: told once, before anything is solved."""

import numpy as np

LARGEST_RADIUS = 1.0  # [m]: beyond any tube that is wound by hand or machine
USUAL = 1e-3, 1e3  # of the highest pressure over c10, which is a hundredth to a few
HINT = 'plain numbers are in SI units, others need theirs, as in "4.76 mm" or "0.17 MPa"'


def doubts(sweep) -> list:
    """Sentences about a sweep's tubes and pressures; none for most."""
    radius, wall, c10, pressure = (_values(sweep, name) for name in ("radius", "wall", "c10", "pressure"))
    columns = (sweep.designs or {}).get("columns", {})
    thick = wall > radius if {"wall", "radius"} <= set(columns) else wall.max(keepdims=True) > radius.min()
    found = []
    if np.any(thick):
        found.append(
            f"walls up to {wall.max():g} m are thicker than the inner radius, {radius.min():g} m at least: the model takes a"
            " thin wall"
        )
    if radius.max() > LARGEST_RADIUS:
        found.append(f"the radius reaches {radius.max():g} m; {HINT}")
    low, high = USUAL
    highest, softest = pressure.max(), c10.min()
    if 0.0 < highest < low * softest:
        found.append(f"no pressure exceeds {highest:g} Pa, which hardly deforms a c10 of {softest:g} Pa; {HINT}")
    if highest > high * softest:
        found.append(f"the pressure reaches {highest:g} Pa, far beyond a c10 of {softest:g} Pa; {HINT}")
    return found


def _values(sweep, name):
    """Every value of a parameter, shape (n,)."""
    if name in sweep.profiles:
        return np.array([value for _, value in sweep.profiles[name]])
    given = sweep.fixed | sweep.axes | (sweep.designs or {}).get("columns", {})
    return np.atleast_1d(given[name])
