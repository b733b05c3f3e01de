"""Datasets of single actuators as text for people."""

from .status import STATUSES, VALUED

COLUMNS = ("force", "torque", "deformed_length", "rotation", "mid_radius", "volume", "strain_energy")
SHOWN = {
    "m": ("mm", 1e3),
    "m3": ("mL", 1e6),
    "degree": ("deg", 1.0),
    "J": ("mJ", 1e3),
    "Pa": ("kPa", 1e-3),
    "N": ("N", 1.0),
    "N m": ("mN m", 1e3),
}
FAMILIES = "", "alpha", "beta", "alpha, beta"  # by the flags of slack_fiber
THREADS = {  # what families without a pull do: loose ones go slack, bonded ones are asked to push
    "loose": ("slack", "a fiber family hangs loose somewhere, and carries nothing there"),
    "bonded": (
        "would push",
        "the state relies on a fiber family that would have to push somewhere; fibers cannot",
    ),
}


def quantity(value, units, shown=SHOWN) -> str:
    """A number in everyday units, or in those that :func:`shown_in` finds."""
    unit, scale = shown.get(units, (units.removeprefix("1"), 1.0))
    return f"{value * scale:.6g} {unit}".rstrip()


def shown_in(asked) -> dict:
    """:data:`SHOWN`, but kinds of quantities in the unit of the question that named one first: ``asked`` are pairs of a
    text and the unit in which its kind is kept.
    """
    from .description.units import factor, unit_of

    found = {}
    for text, kept in asked:
        if unit := unit_of(text):
            found.setdefault(kept, (unit, 1.0 / factor(unit, kept)))
    return SHOWN | found


def table(dataset, shown=SHOWN) -> str:
    """One line for each pressure: outputs in units such as :func:`shown_in` finds, status, slack fibers; then what the
    statuses mean.
    """
    heads, rows = [], []
    pascal, press = shown["Pa"]
    points = dataset.drop_dims("x")
    columns = [name for name in COLUMNS if f"{name}_error" in dataset]
    if "pressure" in points.dims:
        heads.append(f"pressure [{pascal}]")
        states = [points.isel(pressure=k) for k in range(points.sizes["pressure"])]
    else:
        states = [points]
    for name in columns:
        unit, _ = shown[dataset[name].attrs["units"]]
        heads.append(f"{name.replace('_', ' ')} [{unit}]")
    for state in states:
        row = [f"{state['pressure'].item() * press:.6g}"] if "pressure" in points.dims else []
        for name in columns:
            _, scale = shown[dataset[name].attrs["units"]]
            row.append(number(state[name].item() * scale, state[f"{name}_error"].item() * scale))
        rows.append([*row, STATUSES[int(state["status"])].meaning + _flags(state)])
    lines = aligned([[*heads, "status"], *rows])
    seen = sorted({int(value) for value in dataset["status"].values.ravel()} - {0})
    lines += [f"{STATUSES[value].meaning}: {STATUSES[value].sentence}" for value in seen]
    if "limit_found" in dataset and bool(dataset["limit_found"]):
        lines.append(f"limit pressure: {dataset['limit_pressure'].item() * press:.6g} {pascal}")
    if bool((dataset["slack_fiber"] > 0).any()):
        lines.append(": ".join(_words_of(dataset)))
    if any("unstable" in row[-1] for row in rows):
        lines.append("unstable: an equilibrium that the smallest disturbance makes the tube leave")
    if not all(int(value) in VALUED for value in dataset["status"].values.ravel()):
        lines.append("a dash stands where there is no result")
    return "\n".join(lines)


def number(value, error):
    """A value with the digits that its error bound leaves, seven at most."""
    if value != value:
        return "-"
    if error > 0.0 and value != 0.0:
        digits = 0
        while digits < 7 and abs(value) * 10.0**-digits > error:
            digits += 1
        return f"{value:.{max(digits, 1)}g}"
    return f"{value:.7g}"


def _words_of(results):
    return THREADS["loose" if results.attrs.get("fibers") == "loose" else "bonded"]


def _flags(state):
    """Slack fibers and instability, in words."""
    which, (word, _) = ("", "alpha ", "beta ", "")[flag := int(state["slack_fiber"])], _words_of(state)
    slack = f", {which}fibers {word}" if flag else ""
    return slack + (", unstable" if int(state["status"]) in VALUED and not int(state["stable"]) else "")


def aligned(rows):
    """Rows of texts as lines, columns set flush right."""
    widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
    return ["  ".join(cell.rjust(width) for cell, width in zip(row, widths)).rstrip() for row in rows]
