"""Candidates as people read them: a table, a CSV file, lines of Python."""

import csv as files
import io

from ..report import FAMILIES, SHOWN, THREADS, aligned
from .in_units import shown_unit, title_parts

NAMES = ("alpha", "beta", "length", "radius", "wall", "fiber_radius", "fiber_extension", "pressure", "force", "torque")
MISSED = "!"


def columns_of(found):
    """(heading, values (candidates,)) of everything that is one number each."""
    for name in found.data_vars:
        variable = found[name]
        if variable.dims == ("candidate",) and name != "python":
            yield f"{name} [{variable.attrs['units']}]" if "units" in variable.attrs else name, variable.values
        elif variable.dims == ("candidate", "knot"):
            for k in range(variable.sizes["knot"]):
                yield f"{name}[{k}] [{variable.attrs['units']}]", variable.values[:, k]
    for group in ("goal", "limit"):
        for k in range(found.sizes.get(group, 0)):
            title = found[group].values[k]
            yield f"{title}", found[f"{group}_value"].values[:, k]
            yield f"{title}: error", found[f"{group}_error"].values[:, k]
            if f"{group}_spread" in found:
                yield f"{title}: spread", found[f"{group}_spread"].values[:, k]
    for k in range(found.sizes.get("minimized", 0)):
        yield f"least {found['minimized'].values[k]}", found["objective"].values[:, k]


def csv(found) -> str:
    """A CSV file of all candidates, the Python line of each at the end."""
    stream = io.StringIO()
    writer = files.writer(stream)
    columns = [("candidate", found["candidate"].values), *columns_of(found), ("python", found["python"].values)]
    writer.writerow([heading for heading, _ in columns])
    writer.writerows(zip(*(values.tolist() for _, values in columns)))
    return stream.getvalue()


def table(found, shown=SHOWN) -> str:
    """What is free and what the goals came to, a row for each candidate, in units such as
    :func:`freesweep.report.shown_in` finds; then what its marks mean.
    """
    free = {name.partition("[")[0] for name in found["parameter"].values.tolist()}
    tied = {name for name in NAMES if name in found and len(set(found[name].values.ravel().tolist())) > 1}
    columns = [("", [str(k) for k in found["candidate"].values])]
    for name in NAMES:
        if name in found and name in free | tied - {"fiber_radius"} and found[name].dims == ("candidate",):
            unit, scale = shown_unit(name, shown)
            columns.append((_headed(name, unit), [f"{value * scale:.6g}" for value in found[name].values]))
    if "material" in found:
        columns.append(("material", found["material"].values.tolist()))
    for group, fine in (("goal", "goal_met"), ("limit", "limit_kept")):
        for k in range(found.sizes.get(group, 0)):
            heading, scale = _title(found[group].values[k], shown)
            marks = ["" if one else f" {MISSED}" for one in found[fine].values[:, k]]
            values = scale * found[f"{group}_value"].values[:, k]
            spreads = [""] * len(values)
            if f"{group}_spread" in found:
                spreads = [f" +- {scale * spread:.2g}" for spread in found[f"{group}_spread"].values[:, k]]
            texts = [f"{value:.6g}{spread}{mark}" for value, spread, mark in zip(values, spreads, marks)]
            columns.append((heading, texts))
    for k in range(found.sizes.get("minimized", 0)):
        heading, scale = _title(found["minimized"].values[k], shown)
        columns.append((f"least {heading}", [f"{scale * value:.6g}" for value in found["objective"].values[:, k]]))
    families = [FAMILIES[flag] for flag in found["slack_fiber"].values.tolist()]
    word, meaning = THREADS[found.attrs["fibers"]]
    if any(families):
        columns.append((word, [which or "-" for which in families]))
    rows = aligned([[heading for heading, _ in columns], *zip(*(values for _, values in columns))])
    if any(MISSED in text for _, values in columns for text in values):
        rows.append(f"{MISSED} misses its goal, or breaks its limit")
    return "\n".join([*rows, f"{word}: {meaning}"] if any(families) else rows)


def _headed(name, unit):
    return f"{name} [{unit}]" if unit else name


def _title(title, shown):
    """``(heading, scale)`` of a wish's title, with its units as they are shown."""
    output, state = title_parts(title, shown)
    unit, scale = shown_unit(output, shown)
    heading = _headed(output, unit)
    return f"{heading} at {state}" if state else heading, scale


def lines(found) -> str:
    """The Python line of the best candidate."""
    return f"the first one in Python:\n  {found['python'].values[0]}"
