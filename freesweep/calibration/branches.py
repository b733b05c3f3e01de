"""Curves of a measurement, and loops: loading and unloading become their mean, and half of what parts them."""

from dataclasses import replace

import numpy as np

from .measured import BENCHES, FREE

ALIKE = 0.01  # share of the largest number within which settings of a bench are one setting
LEAST = 3  # states of each branch, at least, that make a loop of what rises, then falls
BRANCHES = dict.fromkeys(("loading", "load", "up", "rising", "increasing", "inflation", "inflating", "1", "+1"), 1)
BRANCHES |= dict.fromkeys(("unloading", "unload", "down", "falling", "decreasing", "deflation", "deflating", "-1"), -1)


def branch_faults(found) -> list:
    """Sentences on words of the columns ``found`` that name no branch."""
    words = found.values["branch"]
    wrong = [row for row, word in enumerate(words) if word.lower() not in BRANCHES]
    return [
        f"branch: found {words[row]!r:.30}; write loading or unloading {found.where('branch', row)}"
        for row in wrong[:5]
    ]


def curves_of(measurement):
    """Number of the curve of each state (n,), and the name of what is swept along: pressure, or what the bench imposes."""
    load = next((name for name in measurement.measured if name in BENCHES), None)
    imposed = BENCHES[load].imposed if load else FREE.imposed
    settings = {"pressure": measurement.pressure} | {name: measurement.imposed(name) for name in imposed}
    labels = {name: _settings(array) for name, array in settings.items()}
    for name, own in labels.items():
        for other in labels:
            groups = [labels[other][own == k] for k in np.unique(own)]
            if other != name and sum(len(np.unique(group)) > 1 for group in groups) * 2 > len(groups):
                rest = [labels[third] for third in labels if third != other]
                return np.unique(np.column_stack(rest), axis=0, return_inverse=True)[1].ravel(), other
    return np.zeros(len(measurement), int), "pressure"


def _settings(array):
    """Which of a bench's settings each number is (n,): gaps part them."""
    order = np.argsort(array, kind="stable")
    gaps = np.diff(array[order]) > ALIKE * max(np.max(np.abs(array)), 1e-300)
    found = np.empty(len(array), int)
    found[order] = np.concatenate([[0], np.cumsum(gaps)])
    return found


def mean_of_loops(measurement):
    """The measurement with its loops averaged, and a sentence on that; the same and nothing where there are none."""
    curve, swept = curves_of(measurement)
    along = measurement.pressure if swept == "pressure" else measurement.imposed(swept)
    kept, values, halves, loops, averaged = [], [], [], 0, 0
    names = measurement.measured
    table = np.column_stack([getattr(measurement, name) for name in names])
    for k in np.unique(curve):
        rows = np.flatnonzero(curve == k)
        branch = _branch(along[rows]) if measurement.branch is None else measurement.branch[rows]
        up, down = (rows[branch == sign] for sign in (1, -1))
        if len(up) < 2 or len(down) < 2:
            kept += rows.tolist()
            values += table[rows].tolist()
            halves += np.full((len(rows), len(names)), np.nan).tolist()
            continue
        loops += 1
        both = (along[up] >= along[down].min()) & (along[up] <= along[down].max())
        other = _interpolated(along[up], along[down], table[down])
        alone = down[(along[down] < along[up].min()) | (along[down] > along[up].max())]
        averaged += int(both.sum())
        kept += [*up.tolist(), *alone.tolist()]
        values += np.where(both[:, None], 0.5 * (table[up] + other), table[up]).tolist() + table[alone].tolist()
        half = np.where(both[:, None], 0.5 * (table[up] - other), np.nan)
        halves += half.tolist() + np.full((len(alone), len(names)), np.nan).tolist()
    if not loops:
        return measurement, ""
    kept, values, halves = np.array(kept), np.array(values), np.array(halves)
    mean = np.isfinite(halves[:, 0])
    columns = {
        name: getattr(measurement, name)[kept]
        for name in ("pressure", "deformed_length", "rotation", "mid_radius", "force", "torque")
        if getattr(measurement, name) is not None
    }
    columns |= {name: values[:, k] for k, name in enumerate(names)}
    sigma = {name: array[kept] / np.where(mean, np.sqrt(2.0), 1.0) for name, array in measurement.sigma.items()}
    half_width = {name: halves[:, k] for k, name in enumerate(names)}
    made = replace(
        measurement, **columns, contraction=None, stroke=None, length_as=measurement.length_as, sigma=sigma, branch=None,
        half_width=half_width,
    )  # fmt: skip
    count = f"{len(measurement)} states of {loops} loop{'s' * (loops > 1)}"
    return made, f"{count}: {averaged} of the mean curve and {len(kept) - averaged} of one branch alone were fitted"


def _branch(along):
    """+1 of what comes before the turn, -1 of what comes after it; all +1 where nothing turns, or more than once."""
    signs = np.sign(np.diff(along))
    signs = signs[signs != 0.0]
    turns = np.flatnonzero(np.diff(signs) != 0.0)
    branch = np.ones(len(along), int)
    if len(turns) == 1 and len(signs) + 1 >= 2 * LEAST:
        top = int(np.argmax(along) if signs[0] > 0.0 else np.argmin(along))
        if top + 1 >= LEAST and len(along) - top - 1 >= LEAST:
            branch[top + 1 :] = -1
    return branch


def _interpolated(at, places, table):
    order = np.argsort(places, kind="stable")
    return np.column_stack([np.interp(at, places[order], column[order]) for column in table.T])


def hysteresis_of(measurements) -> dict:
    """Half of what parts the branches of loops, root mean square, by quantity."""
    found = {}
    for measurement in measurements:
        for name, half in measurement.half_width.items():
            found.setdefault(name, []).append(half[np.isfinite(half)])
    joined = {name: np.concatenate(parts) for name, parts in found.items()}
    return {name: float(np.sqrt(np.mean(array**2))) for name, array in joined.items() if len(array)}
