"""Candidates as people read them: a table, a CSV file, lines of Python."""

import csv as files
import io

NAMES = ("alpha", "beta", "length", "radius", "wall", "fiber_radius", "fiber_extension", "pressure", "force", "torque")


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


def table(found) -> str:
    """What is free and what the goals came to, a row for each candidate."""
    free = {name.partition("[")[0] for name in found["parameter"].values.tolist()}
    tied = {name for name in NAMES if name in found and len(set(found[name].values.ravel().tolist())) > 1}
    columns = [("", [str(k) for k in found["candidate"].values])]
    for name in NAMES:
        if name in found and name in free | tied and found[name].dims == ("candidate",):
            unit = found[name].attrs["units"]
            columns.append((f"{name} [{unit}]", [f"{value:.6g}" for value in found[name].values]))
    for group in ("goal", "limit"):
        done = found[f"{group}_met" if group == "goal" else f"{group}_kept"] if found.sizes.get(group) else None
        for k in range(found.sizes.get(group, 0)):
            marks = ["" if fine else " !" for fine in done.values[:, k]]
            values = found[f"{group}_value"].values[:, k]
            spreads = [""] * len(values)
            if f"{group}_spread" in found:
                spreads = [f" +- {spread:.2g}" for spread in found[f"{group}_spread"].values[:, k]]
            texts = [f"{value:.6g}{spread}{mark}" for value, spread, mark in zip(values, spreads, marks)]
            columns.append((found[group].values[k], texts))
    for k in range(found.sizes.get("minimized", 0)):
        columns.append((f"least {found['minimized'].values[k]}", [f"{v:.6g}" for v in found["objective"].values[:, k]]))
    widths = [max(len(heading), *map(len, values)) for heading, values in columns]
    rows = [[heading for heading, _ in columns], *zip(*(values for _, values in columns))]
    return "\n".join("  ".join(text.rjust(width) for text, width in zip(row, widths)) for row in rows)


def lines(found) -> str:
    """The Python line of the best candidate."""
    return f"the first one in Python:\n  {found['python'].values[0]}"
