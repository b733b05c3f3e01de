"""Candidates as people read them: a table, a CSV file, lines of Python."""

import csv as files
import io
from typing import NamedTuple

import numpy as np

from ..report import FAMILIES, SHOWN, THREADS, aligned
from ..status import STATUSES
from .in_units import shown_unit, title_parts, unit_of

NAMES = ("alpha", "beta", "length", "radius", "wall", "fiber_radius", "fiber_extension", "pressure", "force", "torque")
MISSED = "!"
WIDTH = 120  # letters of a line that a screen shows


def columns_of(found):
    """(heading, values (candidates,)) of everything that is one number each, with its kept unit; statuses in words."""
    for name in found.data_vars:
        variable = found[name]
        if name == "status":
            yield name, np.array([STATUSES[code].meaning for code in variable.values])
        elif variable.dims == ("candidate",) and name != "python":
            yield _headed(name, variable.attrs.get("units", "1")), variable.values
        elif variable.dims == ("candidate", "knot"):
            for k in range(variable.sizes["knot"]):
                yield f"{name}[{k}] [{variable.attrs['units']}]", variable.values[:, k]
    for group in ("goal", "limit"):
        for k in range(found.sizes.get(group, 0)):
            title = _kept(found[group].values[k])
            yield title, found[f"{group}_value"].values[:, k]
            yield f"{title}: error", found[f"{group}_error"].values[:, k]
            if f"{group}_spread" in found:
                yield f"{title}: spread", found[f"{group}_spread"].values[:, k]
    for k in range(found.sizes.get("minimized", 0)):
        yield f"least {_kept(found['minimized'].values[k])}", found["objective"].values[:, k]


def csv(found) -> str:
    """A CSV file of all candidates, the Python line of each at the end."""
    stream = io.StringIO()
    writer = files.writer(stream)
    columns = [("candidate", found["candidate"].values), *columns_of(found), ("python", found["python"].values)]
    writer.writerow([heading for heading, _ in columns])
    writer.writerows(zip(*(values.tolist() for _, values in columns)))
    return stream.getvalue()


def table(found, shown=SHOWN) -> str:
    """What is free and what the goals came to, a row for each candidate, or a column where that is too wide for a screen; in
    units such as :func:`freesweep.report.shown_in` finds. Then what its marks mean.
    """
    columns = [*_free(found, shown), *_wishes(found, shown)]
    families = [FAMILIES[flag] for flag in found["slack_fiber"].values.tolist()]
    word, meaning = THREADS[found.attrs["fibers"]]
    if any(families):
        columns.append(Column(word, "", [which or "-" for which in families]))
    numbers = [str(k) for k in found["candidate"].values]
    rows = _beside(numbers, columns)
    if max(map(len, rows)) > WIDTH:
        rows = _below(numbers, columns)
    if any(MISSED in text for column in columns for text in column.texts):
        rows.append(f"{MISSED} misses its goal, or breaks its limit")
    return "\n".join([*rows, f"{word}: {meaning}"] if any(families) else rows)


class Column(NamedTuple):
    """What is told of each candidate: ``heading``, the ``state`` or place where it is so, and ``texts`` (candidates,)."""

    heading: str
    state: str
    texts: list


def _free(found, shown):
    """Columns of what is free or follows it; of a profile, of each of its knots."""
    free = {name.partition("[")[0] for name in found["parameter"].values.tolist()}
    tied = {name for name in NAMES if name in found and len(set(found[name].values.ravel().tolist())) > 1}
    for name in (name for name in NAMES if name in found and name in free | tied - {"fiber_radius"}):
        unit, scale = shown_unit(name, shown)
        values = scale * found[name].values
        if found[name].dims == ("candidate",):
            yield Column(_headed(name, unit), "", [f"{value:.6g}" for value in values])
        else:
            for place, own in zip(found[f"{name}_place"].values, values.T):
                yield Column(_headed(name, unit), f"at x/l {place:.3g}", [f"{value:.6g}" for value in own])
    if "material" in found:
        yield Column("material", "", found["material"].values.tolist())


def _wishes(found, shown):
    """Columns of goals, limits, and of what is minimized."""
    for group, fine in (("goal", "goal_met"), ("limit", "limit_kept")):
        for k in range(found.sizes.get(group, 0)):
            heading, state, scale = _title(found[group].values[k], shown)
            marks = ["" if one else f" {MISSED}" for one in found[fine].values[:, k]]
            values = scale * found[f"{group}_value"].values[:, k]
            spreads = [""] * len(values)
            if f"{group}_spread" in found:
                spreads = [f" +- {scale * spread:.2g}" for spread in found[f"{group}_spread"].values[:, k]]
            texts = [f"{value:.6g}{spread}{mark}" for value, spread, mark in zip(values, spreads, marks)]
            yield Column(heading, state, texts)
    for k in range(found.sizes.get("minimized", 0)):
        heading, state, scale = _title(found["minimized"].values[k], shown)
        yield Column(f"least {heading}", state, [f"{scale * value:.6g}" for value in found["objective"].values[:, k]])


def _beside(numbers, columns):
    """Lines of the table with a row for each candidate."""
    heads = [["", *(column.heading if column.state else "" for column in columns)]] * any(c.state for c in columns)
    heads.append(["", *(column.state or column.heading for column in columns)])
    return aligned([*heads, *zip(numbers, *(column.texts for column in columns))])


def _below(numbers, columns):
    """Lines with a column for each candidate, as many side by side as a line holds."""
    names = ["", *(f"{column.heading} {column.state}".rstrip() for column in columns)]
    margin = max(map(len, names))
    cells = [[number, *(column.texts[k] for column in columns)] for k, number in enumerate(numbers)]
    count = max(1, (WIDTH - margin) // (2 + max(len(text) for column in cells for text in column)))
    rows = []
    for first in range(0, len(cells), count):
        block = [[name.ljust(margin) for name in names], *cells[first : first + count]]
        rows += [*([""] if first else []), *aligned([*zip(*block)])]
    return rows


def _headed(name, unit):
    return f"{name} [{unit}]" if unit not in ("", "1") else name


def _kept(title):
    """A wish's title with the unit that its output is kept in."""
    output, at, state = title.partition(" at ")
    return f"{_headed(output, unit_of(output))}{at}{state}"


def _title(title, shown):
    """``(heading, state, scale)`` of a wish's title, with its units as they are shown."""
    output, state = title_parts(title, shown)
    unit, scale = shown_unit(output, shown)
    return _headed(output, unit), f"at {state}" if state else "", scale


def lines(found) -> str:
    """The Python line of the best candidate."""
    return f"the first one in Python:\n  {found['python'].values[0]}"
